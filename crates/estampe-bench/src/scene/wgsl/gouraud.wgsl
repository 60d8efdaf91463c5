// `small_tris`: interpolated vertex colours of a model in perspective.

@group(0) @binding(0) var<uniform> clip_from_object: mat4x4f;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) color: vec4f) -> Varyings {
    return Varyings(clip_from_object * vec4f(position, 1.0), color);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    return in.color;
}
