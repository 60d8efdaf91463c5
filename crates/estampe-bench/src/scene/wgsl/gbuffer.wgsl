// `gbuffer`: surfaces, their light from 16 point lights, tone mapping.

struct Object {
    clip_from_object: mat4x4f,
    world_from_object: mat4x4f,
    eye: vec4f,
    towards_light: vec4f,
}
@group(0) @binding(0) var<uniform> object: Object;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var diffuse_map: texture_2d<f32>;
@group(0) @binding(3) var normal_map: texture_2d<f32>;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) tangent: vec4f,
    @location(2) uv: vec2f,
}

@vertex
fn surface_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
) -> Varyings {
    let normal_world = (object.world_from_object * vec4f(normal, 0.0)).xyz;
    let tangent_world = (object.world_from_object * vec4f(tangent.xyz, 0.0)).xyz;
    return Varyings(
        object.clip_from_object * vec4f(position, 1.0),
        normal_world,
        vec4f(tangent_world, tangent.w),
        uv,
    );
}

struct Surface {
    @location(0) albedo: vec4f,
    // World normal; roughness.
    @location(1) normal: vec4f,
}

@fragment
fn surface_fragment(in: Varyings) -> Surface {
    let albedo = textureSample(diffuse_map, trilinear, in.uv).rgb;
    let bump = textureSample(normal_map, trilinear, in.uv).xyz * 2.0 - 1.0;
    let n = normalize(in.normal);
    let t = normalize(in.tangent.xyz);
    let b = cross(n, t) * in.tangent.w;
    let normal = normalize(t * bump.x + b * bump.y + n * bump.z);
    return Surface(vec4f(albedo, 1.0), vec4f(normal, 0.25 + 0.6 * (1.0 - albedo.g)));
}

// One triangle that covers the screen.
@vertex
fn screen_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

struct PointLight {
    place_and_radius: vec4f,
    color: vec4f,
}
struct Lighting {
    eye: vec4f,
    // View rays; the view's depth is up.w / (depth + right.w).
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    lights: array<PointLight, 16>,
}
@group(0) @binding(0) var<uniform> lighting: Lighting;
@group(0) @binding(1) var albedo_image: texture_2d<f32>;
@group(0) @binding(2) var normal_image: texture_2d<f32>;
@group(0) @binding(3) var depth_image: texture_depth_2d;

@fragment
fn light(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let depth = textureLoad(depth_image, pixel, 0);
    if depth >= 1.0 {
        return vec4f(0.02, 0.03, 0.05, 1.0);
    }
    let size = vec2f(textureDimensions(depth_image));
    let ndc = vec2f(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y);
    let ray = lighting.right.xyz * ndc.x + lighting.up.xyz * ndc.y + lighting.forward.xyz;
    let world = lighting.eye.xyz + ray * (lighting.up.w / (depth + lighting.right.w));
    let albedo = textureLoad(albedo_image, pixel, 0).rgb;
    let normal_and_roughness = textureLoad(normal_image, pixel, 0);
    let normal = normal_and_roughness.xyz;
    let alpha = normal_and_roughness.w * normal_and_roughness.w;
    let towards_eye = normalize(lighting.eye.xyz - world);
    var color = albedo * 0.06;
    for (var i = 0; i < 16; i++) {
        let towards_light = lighting.lights[i].place_and_radius.xyz - world;
        let radius = lighting.lights[i].place_and_radius.w;
        let squared = dot(towards_light, towards_light);
        let ratio = squared / (radius * radius);
        let facing = dot(normal, towards_light);
        if ratio >= 1.0 || facing <= 0.0 {
            continue;
        }
        // Fades to zero at the radius.
        let window = (1.0 - ratio * ratio) * (1.0 - ratio * ratio) / (squared + 0.1);
        let inverse = inverseSqrt(squared);
        let half_vector = normalize(towards_light * inverse + towards_eye);
        let normal_half = max(dot(normal, half_vector), 0.0);
        let eye_half = max(dot(towards_eye, half_vector), 0.0);
        // A cheap form of GGX (Karis 2013).
        let spread = normal_half * normal_half * (alpha * alpha - 1.0) + 1.0;
        let specular = 0.04 * alpha * alpha
            / (spread * spread * max(eye_half * eye_half, 0.1) * (4.0 * alpha + 2.0));
        color += lighting.lights[i].color.rgb * (window * facing * inverse)
            * (albedo + vec3f(specular));
    }
    return vec4f(color, 1.0);
}

@group(0) @binding(0) var lit_image: texture_2d<f32>;

@fragment
fn tone_map(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let x = textureLoad(lit_image, vec2i(position.xy), 0).rgb;
    let y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    return vec4f(clamp(y, vec3f(0.0), vec3f(1.0)), 1.0);
}
