// `stencil`: a lit scene, shadow volumes, and a darker colour where they leave a count.

struct Camera {
    clip_from_world: mat4x4f,
    eye: vec4f,
    light: vec4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
) -> Varyings {
    let clip = camera.clip_from_world * vec4f(position, 1.0);
    return Varyings(clip, position, normal, color);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    let towards_light = normalize(camera.light.xyz - in.world);
    let towards_eye = normalize(camera.eye.xyz - in.world);
    let diffuse = max(dot(normal, towards_light), 0.0);
    let half_vector = normalize(towards_light + towards_eye);
    let specular = pow(max(dot(normal, half_vector), 0.0), 32.0) * 0.3;
    return vec4f(in.color.rgb * (0.2 + 0.8 * diffuse) + vec3f(specular), 1.0);
}

@vertex
fn volume_vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return camera.clip_from_world * vec4f(position, 1.0);
}

@fragment
fn volume_fragment() -> @location(0) vec4f {
    return vec4f(0.0);
}

@vertex
fn screen_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn shade() -> @location(0) vec4f {
    return vec4f(0.35, 0.38, 0.5, 1.0);
}
