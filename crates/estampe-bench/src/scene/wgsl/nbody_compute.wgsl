struct Body {
    position: vec3f,
    mass: f32,
    velocity: vec4f,
}

struct Moved {
    position: vec4f,
    velocity: vec4f,
    acceleration: vec4f,
}

@group(0) @binding(0) var<storage, read> bodies: array<Body>;
@group(0) @binding(1) var<storage, read_write> moved: array<Moved>;

const softening = 0.0001;
const time_step = 0.02;

// The position and mass of 256 bodies.
var<workgroup> others: array<vec4f, 256>;

fn attraction(position: vec3f, other: vec4f) -> vec3f {
    let away = other.xyz - position;
    let near = inverseSqrt(dot(away, away) + softening);
    return away * (other.w * near * near * near);
}

fn step(at: u32, acceleration: vec3f) {
    let body = bodies[at];
    let velocity = body.velocity.xyz + acceleration * time_step;
    moved[at] = Moved(
        vec4f(body.position + velocity * time_step, body.mass),
        vec4f(velocity, 0.0),
        vec4f(acceleration, 0.0),
    );
}

@compute @workgroup_size(64)
fn attract(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let at = group.x * 256u + invocation;
    let a = bodies[at].position;
    let b = bodies[at + 64u].position;
    let c = bodies[at + 128u].position;
    let d = bodies[at + 192u].position;
    var of_a = vec3f();
    var of_b = vec3f();
    var of_c = vec3f();
    var of_d = vec3f();
    for (var first = 0u; first < arrayLength(&bodies); first += 256u) {
        for (var k = invocation; k < 256u; k += 64u) {
            let other = bodies[first + k];
            others[k] = vec4f(other.position, other.mass);
        }
        workgroupBarrier();
        for (var k = 0u; k < 256u; k++) {
            let other = others[k];
            of_a += attraction(a, other);
            of_b += attraction(b, other);
            of_c += attraction(c, other);
            of_d += attraction(d, other);
        }
        workgroupBarrier();
    }
    step(at, of_a);
    step(at + 64u, of_b);
    step(at + 128u, of_c);
    step(at + 192u, of_d);
}

@group(0) @binding(0) var picture: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn paint(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(picture);
    if any(id.xy >= size) {
        return;
    }
    let cell = id.xy * vec2u(128u, 64u) / size;
    let acceleration = moved[cell.x + 128u * cell.y].acceleration.xyz;
    let color = 0.25 + 0.25 * acceleration / (0.25 + length(acceleration));
    textureStore(picture, vec2i(id.xy), vec4f(color, 1.0));
}

@vertex
fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return vec4f(position.x / 2.2, position.y * (16.0 / 9.0) / 2.2, 0.0, 1.0);
}

@fragment
fn fragment() -> @location(0) vec4f {
    return vec4f(1.0, 0.9, 0.6, 1.0);
}
