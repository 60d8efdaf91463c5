// `quad_draws`: the colour of the draw's uniforms.

struct Quad {
    clip_from_object: mat4x4f,
    color: vec4f,
}
@group(0) @binding(0) var<uniform> quad: Quad;

@vertex
fn vertex(@location(0) position: vec2f) -> @builtin(position) vec4f {
    return quad.clip_from_object * vec4f(position, 0.0, 1.0);
}

@fragment
fn fragment() -> @location(0) vec4f {
    return quad.color;
}
