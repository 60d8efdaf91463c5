// `mid_tris` and `msaa4`: Blinn-Phong with a normal map.

struct Frame {
    clip_from_object: mat4x4f,
    world_from_object: mat4x4f,
    eye: vec4f,
    towards_light: vec4f,
}
@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var diffuse_map: texture_2d<f32>;
@group(0) @binding(3) var normal_map: texture_2d<f32>;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
) -> Varyings {
    let at = vec4f(position, 1.0);
    return Varyings(
        frame.clip_from_object * at,
        (frame.world_from_object * at).xyz,
        (frame.world_from_object * vec4f(normal, 0.0)).xyz,
        vec4f((frame.world_from_object * vec4f(tangent.xyz, 0.0)).xyz, tangent.w),
        uv,
    );
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    let albedo = textureSample(diffuse_map, trilinear, in.uv).rgb;
    let bump = textureSample(normal_map, trilinear, in.uv).xyz * 2.0 - 1.0;

    // The mapped normal, from tangent space to world space.
    let vertex_normal = normalize(in.normal);
    let tangent = normalize(in.tangent.xyz);
    let bitangent = cross(vertex_normal, tangent) * in.tangent.w;
    let normal = normalize(tangent * bump.x + bitangent * bump.y + vertex_normal * bump.z);

    let towards_light = frame.towards_light.xyz;
    let towards_eye = normalize(frame.eye.xyz - in.world);
    let half_vector = normalize(towards_light + towards_eye);
    let diffuse = max(dot(normal, towards_light), 0.0) * 0.85 + 0.15;
    let specular = pow(max(dot(normal, half_vector), 0.0), 32.0) * 0.5;
    return vec4f(albedo * diffuse + specular, 1.0);
}
