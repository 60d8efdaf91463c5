// `foliage`: cards whose alpha is tested, or becomes coverage.

struct Camera {
    clip_from_world: mat4x4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var plants: texture_2d_array<f32>;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) @interpolate(flat) layer: i32,
    @location(2) color: vec3f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) uv_and_layer: vec3f,
    @location(2) color: vec4f,
) -> Varyings {
    return Varyings(
        camera.clip_from_world * vec4f(position, 1.0),
        uv_and_layer.xy,
        i32(uv_and_layer.z),
        color.rgb,
    );
}

@fragment
fn ground_fragment(in: Varyings) -> @location(0) vec4f {
    return vec4f(in.color, 1.0);
}

@fragment
fn discarded(in: Varyings) -> @location(0) vec4f {
    let plant = textureSample(plants, trilinear, in.uv, in.layer);
    if plant.a < 0.5 {
        discard;
    }
    return vec4f(plant.rgb * in.color, 1.0);
}

// An edge of one pixel where alpha is 1/2, in quarters.
@fragment
fn covered(in: Varyings) -> @location(0) vec4f {
    let plant = textureSample(plants, trilinear, in.uv, in.layer);
    let slope = max(fwidthFine(plant.a), 0.0001);
    let coverage = clamp((plant.a - 0.5) / slope + 0.5, 0.0, 1.0);
    return vec4f(plant.rgb * in.color, 0.225 * floor(4.0 * coverage + 0.5));
}
