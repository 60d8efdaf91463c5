// `shadow`: depth from the light, then Blinn-Phong with the mean of 3×3 comparisons.

struct Object {
    clip_from_object: mat4x4f,
    world_from_object: mat4x4f,
    light_from_object: mat4x4f,
    eye: vec4f,
    towards_light: vec4f,
}
@group(0) @binding(0) var<uniform> object: Object;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var diffuse_map: texture_2d<f32>;
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var compare: sampler_comparison;

const depth_bias = 0.004;

@vertex
fn depth_vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return object.light_from_object * vec4f(position, 1.0);
}

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    // Coordinates in the map, and depth.
    @location(3) in_map: vec3f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
) -> Varyings {
    let at = vec4f(position, 1.0);
    // The light's projection is orthographic: w is 1.
    let in_light = object.light_from_object * at;
    return Varyings(
        object.clip_from_object * at,
        (object.world_from_object * at).xyz,
        (object.world_from_object * vec4f(normal, 0.0)).xyz,
        uv,
        vec3f(in_light.x * 0.5 + 0.5, 0.5 - in_light.y * 0.5, in_light.z),
    );
}

@fragment
fn fragment(in: Varyings) -> @location(0) vec4f {
    let albedo = textureSample(diffuse_map, trilinear, in.uv).rgb;
    let normal = normalize(in.normal);
    let towards_light = object.towards_light.xyz;
    let towards_eye = normalize(object.eye.xyz - in.world);
    let half_vector = normalize(towards_light + towards_eye);

    let texel = 1.0 / vec2f(textureDimensions(shadow_map));
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = in.in_map.xy + vec2f(f32(x), f32(y)) * texel;
            lit += textureSampleCompareLevel(shadow_map, compare, at, in.in_map.z - depth_bias);
        }
    }
    lit *= 1.0 / 9.0;
    // Outside the map nothing is in shadow.
    if any(in.in_map.xy < vec2f(0.0)) || any(in.in_map.xy > vec2f(1.0)) {
        lit = 1.0;
    }

    let diffuse = max(dot(normal, towards_light), 0.0) * lit * 0.85 + 0.15;
    let specular = pow(max(dot(normal, half_vector), 0.0), 32.0) * 0.5 * lit;
    return vec4f(albedo * diffuse + specular, 1.0);
}
