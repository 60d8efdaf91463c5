// `blend`: the interpolated vertex colour.

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) color: vec4f) -> Varyings {
    return Varyings(vec4f(position, 1.0), color);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    return in.color;
}
