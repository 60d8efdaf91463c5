// `textured`: the texture.

@group(0) @binding(0) var<uniform> clip_from_view: mat4x4f;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var base_color: texture_2d<f32>;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) uv: vec2f) -> Varyings {
    return Varyings(clip_from_view * vec4f(position, 1.0), uv);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    return textureSample(base_color, trilinear, in.uv);
}
