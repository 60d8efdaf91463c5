// `particles`: a lit sphere, soft quads that face the camera, tone mapping.

struct Camera {
    clip_from_world: mat4x4f,
    // The size of a pixel in normalised device coordinates, in xy.
    pixel: vec4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var disc: texture_2d<f32>;

const towards_light = vec3f(0.48, 0.64, 0.6);

struct SphereVaryings {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
}

@vertex
fn sphere_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
) -> SphereVaryings {
    return SphereVaryings(camera.clip_from_world * vec4f(position, 1.0), normal);
}

@fragment
fn sphere_fragment(in: SphereVaryings) -> @location(0) vec4f {
    let diffuse = max(dot(normalize(in.normal), towards_light), 0.0);
    return vec4f(vec3f(0.10, 0.09, 0.12) * (0.2 + 0.8 * diffuse), 1.0);
}

struct ParticleVaryings {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) color: vec3f,
}

@vertex
fn particle_vertex(
    @builtin(vertex_index) number: u32,
    @location(0) center: vec3f,
    @location(1) size: f32,
    @location(2) color: vec4f,
) -> ParticleVaryings {
    let corner = vec2f(f32(number & 1u), f32(number >> 1u));
    let clip = camera.clip_from_world * vec4f(center, 1.0);
    let moved = clip.xy + (corner - 0.5) * camera.pixel.xy * (size * clip.w);
    return ParticleVaryings(vec4f(moved, clip.zw), corner, color.rgb * color.a);
}

@fragment
fn particle_fragment(in: ParticleVaryings) -> @location(0) vec4f {
    return vec4f(in.color * textureSample(disc, trilinear, in.uv).r, 0.0);
}

@vertex
fn screen_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@group(0) @binding(0) var lit: texture_2d<f32>;

@fragment
fn tone_map(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let color = textureLoad(lit, vec2i(position.xy), 0).rgb;
    return vec4f(1.0 - exp2(-2.0 * color), 1.0);
}
