// `heavy_fs`: sphere tracing (Hart 1996) of rounded boxes, warped by sines.

// Width and height of the frame in pixels.
@group(0) @binding(0) var<uniform> frame: vec4f;

const eye = vec3f(1.0, 1.0, 3.0);
const towards_light = vec3f(0.48, 0.64, 0.6);
const background = vec3f(0.05, 0.07, 0.1);

@vertex
fn vertex(@location(0) position: vec2f) -> @builtin(position) vec4f {
    return vec4f(position, 0.5, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = (position.xy * 2.0 - frame.xy) / frame.y;
    let ray = normalize(vec3f(at.x, -at.y, -1.6));
    var distance = 0.0;
    var hit = false;
    for (var step = 0; step < 64; step++) {
        let near = distance_to_boxes(eye + ray * distance);
        if near < 0.001 {
            hit = true;
            break;
        }
        distance += near;
        if distance > 24.0 {
            break;
        }
    }
    var color = background;
    if hit {
        color = mix(background, surface_color(eye + ray * distance), exp(distance * -0.12));
    }
    return vec4f(color, 1.0);
}

// A lower bound of the distance to rounded boxes that repeat every two units.
fn distance_to_boxes(p: vec3f) -> f32 {
    let warped = p + sin(p.yzx * 2.0) * 0.15;
    let in_cell = abs(warped - floor(warped * 0.5 + 0.5) * 2.0);
    return (length(max(in_cell - 0.4, vec3f(0.0))) - 0.12) * 0.8;
}

// Lambert's cosine law and noise at a point of a surface.
fn surface_color(p: vec3f) -> vec3f {
    // The gradient of the distance, from the four corners of a tetrahedron.
    let e = vec2f(0.001, -0.001);
    let gradient = e.xyy * distance_to_boxes(p + e.xyy) + e.yyx * distance_to_boxes(p + e.yyx)
        + e.yxy * distance_to_boxes(p + e.yxy) + e.xxx * distance_to_boxes(p + e.xxx);
    let light = max(dot(normalize(gradient), towards_light), 0.0) * 0.85 + 0.15;
    let noise = layered_noise(vec2f(p.x + p.z, p.y - p.z) * 6.0);
    return vec3f(0.9, noise * 0.4 + 0.55, noise * 0.6 + 0.3) * light;
}

// Four octaves of noise, each rotated and twice as fine as the previous one.
fn layered_noise(start: vec2f) -> f32 {
    var p = start;
    var sum = 0.0;
    var weight = 0.5;
    for (var octave = 0; octave < 4; octave++) {
        sum += value_noise(p) * weight;
        p = vec2f(p.x * 1.6 + p.y * 1.2, p.y * 1.6 - p.x * 1.2);
        weight *= 0.5;
    }
    return sum;
}

// Random values at integer points, interpolated smoothly.
fn value_noise(p: vec2f) -> f32 {
    let corner = floor(p);
    let f = p - corner;
    let weight = f * f * (3.0 - f * 2.0);
    let cell = vec2i(corner);
    let upper = mix(unit_hash(cell), unit_hash(cell + vec2i(1, 0)), weight.x);
    let lower = mix(unit_hash(cell + vec2i(0, 1)), unit_hash(cell + vec2i(1, 1)), weight.x);
    return mix(upper, lower, weight.y);
}

// A pseudo-random number in 0..1 for an integer point.
fn unit_hash(p: vec2i) -> f32 {
    var mixed = (u32(p.x) * 0x9e3779b9u) ^ (u32(p.y) * 0x85ebca6bu);
    mixed = (mixed ^ (mixed >> 16u)) * 0x7feb352du;
    mixed = (mixed ^ (mixed >> 15u)) * 0x846ca68bu;
    mixed ^= mixed >> 16u;
    return f32(mixed >> 8u) * (1.0 / 16777216.0);
}
