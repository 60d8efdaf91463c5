// `wire`: a terrain coloured by height, filled in the dark, and its lines.

struct Camera {
    clip_from_world: mat4x4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;

const towards_light = vec3f(0.48, 0.64, 0.6);

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
}

@vertex
fn vertex(@location(0) position: vec3f) -> Varyings {
    return Varyings(camera.clip_from_world * vec4f(position, 1.0), position);
}

fn color_of_height(height: f32) -> vec3f {
    let up = clamp(height * 1.1 + 0.5, 0.0, 1.0);
    return mix(vec3f(0.10, 0.75, 0.85), vec3f(1.0, 0.85, 0.3), up);
}

@fragment
fn fill(in: Varyings) -> @location(0) vec4f {
    let normal = normalize(cross(dpdy(in.world), dpdx(in.world)));
    let diffuse = max(dot(normal, towards_light), 0.0);
    return vec4f(color_of_height(in.world.y) * (0.35 * diffuse), 1.0);
}

@fragment
fn line(in: Varyings) -> @location(0) vec4f {
    return vec4f(color_of_height(in.world.y), 1.0);
}
