// `ui`: the vertex's premultiplied colour times the coverage in the atlas.

struct Screen {
    // Width and height in pixels.
    size: vec4f,
}
@group(0) @binding(0) var<uniform> screen: Screen;
@group(0) @binding(1) var linear: sampler;
@group(0) @binding(2) var atlas: texture_2d<f32>;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) color: vec4f,
}

@vertex
fn vertex(
    @location(0) position: vec2f,
    @location(1) uv: vec2f,
    @location(2) color: vec4f,
) -> Varyings {
    let across = 2.0 * position.x / screen.size.x - 1.0;
    let up = 1.0 - 2.0 * position.y / screen.size.y;
    return Varyings(vec4f(across, up, 0.0, 1.0), uv, color);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    return in.color * textureSample(atlas, linear, in.uv).r;
}
