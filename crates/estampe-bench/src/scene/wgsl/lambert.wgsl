// `instances`: Lambert's cosine law with a colour from the draw's uniforms.

struct Instance {
    clip_from_object: mat4x4f,
    color: vec4f,
}
@group(0) @binding(0) var<uniform> instance: Instance;

const towards_light = vec3f(0.48, 0.64, 0.6);

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Varyings {
    return Varyings(instance.clip_from_object * vec4f(position, 1.0), normal);
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    let light = max(dot(normalize(in.normal), towards_light), 0.0);
    return vec4f(instance.color.rgb * (light * 0.75 + 0.25), 1.0);
}
