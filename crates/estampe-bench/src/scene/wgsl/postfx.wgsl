// `postfx`: a city at night, then bloom, blur and tone mapping over the screen.

struct CityVaryings {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn city_vertex(@location(0) position: vec2f, @location(1) color: vec4f) -> CityVaryings {
    return CityVaryings(vec4f(position, 0.0, 1.0), color);
}

@fragment
fn city_fragment(in: CityVaryings) -> @location(0) vec4f {
    return in.color;
}

@group(0) @binding(0) var linear: sampler;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(2) var blurred: texture_2d<f32>;
@group(0) @binding(3) var bloom: texture_2d<f32>;

struct ScreenVaryings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn screen_vertex(@builtin(vertex_index) corner: u32) -> ScreenVaryings {
    let at = vec2f(f32(corner & 1u), f32(corner >> 1u));
    let uv = vec2f(at.x * 2.0, 1.0 - at.y * 2.0);
    return ScreenVaryings(vec4f(at * 4.0 - 1.0, 0.0, 1.0), uv);
}

fn tap(uv: vec2f) -> vec3f {
    return textureSampleLevel(source, linear, uv, 0.0).rgb;
}

fn texel() -> vec2f {
    return 1.0 / vec2f(textureDimensions(source));
}

// What is brighter than 1.
@fragment
fn threshold(in: ScreenVaryings) -> @location(0) vec4f {
    let color = tap(in.uv);
    let brightest = max(color.r, max(color.g, color.b));
    return vec4f(color * (max(brightest - 1.0, 0.0) / max(brightest, 0.0001)), 1.0);
}

// Five boxes over each other of four bilinear taps.
@fragment
fn downsample(in: ScreenVaryings) -> @location(0) vec4f {
    let at = in.uv;
    let step = texel();
    var sum = tap(at) * 0.125;
    let corners = tap(at + step * vec2f(-2.0, -2.0)) + tap(at + step * vec2f(2.0, -2.0))
        + tap(at + step * vec2f(-2.0, 2.0)) + tap(at + step * vec2f(2.0, 2.0));
    sum += corners * 0.03125;
    let sides = tap(at + step * vec2f(0.0, -2.0)) + tap(at + step * vec2f(-2.0, 0.0))
        + tap(at + step * vec2f(2.0, 0.0)) + tap(at + step * vec2f(0.0, 2.0));
    sum += sides * 0.0625;
    let inner = tap(at + step * vec2f(-1.0, -1.0)) + tap(at + step * vec2f(1.0, -1.0))
        + tap(at + step * vec2f(-1.0, 1.0)) + tap(at + step * vec2f(1.0, 1.0));
    sum += inner * 0.125;
    return vec4f(sum, 1.0);
}

// A tent of 3×3 texels as four bilinear taps, with a weight of 0.6.
@fragment
fn upsample(in: ScreenVaryings) -> @location(0) vec4f {
    let half_texel = 0.5 / vec2f(textureDimensions(source));
    let sum = tap(in.uv - half_texel)
        + tap(in.uv + vec2f(half_texel.x, -half_texel.y))
        + tap(in.uv + vec2f(-half_texel.x, half_texel.y))
        + tap(in.uv + half_texel);
    return vec4f(sum * 0.15, 1.0);
}

// The binomial weights (1 8 28 56 70 56 28 8 1) ÷ 256, two texels in a tap.
fn gaussian(at: vec2f, direction: vec2f) -> vec4f {
    let step = direction / vec2f(textureDimensions(source));
    let near = step * (112.0 / 84.0);
    let far = step * (28.0 / 9.0);
    var sum = tap(at) * (70.0 / 256.0);
    sum += (tap(at + near) + tap(at - near)) * (84.0 / 256.0);
    sum += (tap(at + far) + tap(at - far)) * (9.0 / 256.0);
    return vec4f(sum, 1.0);
}

@fragment
fn blur_x(in: ScreenVaryings) -> @location(0) vec4f {
    return gaussian(in.uv, vec2f(1.0, 0.0));
}

@fragment
fn blur_y(in: ScreenVaryings) -> @location(0) vec4f {
    return gaussian(in.uv, vec2f(0.0, 1.0));
}

@fragment
fn combine(in: ScreenVaryings) -> @location(0) vec4f {
    let pixel = vec2i(in.position.xy);
    let from_center = in.uv * 2.0 - 1.0;
    let blur = clamp(dot(from_center, from_center) * 1.5 - 0.5, 0.0, 1.0);
    let sharp = textureLoad(source, pixel, 0).rgb;
    var color = mix(sharp, textureLoad(blurred, pixel, 0).rgb, blur);
    color += textureLoad(bloom, pixel, 0).rgb;
    return vec4f(sqrt(color / (1.0 + color)), 1.0);
}
