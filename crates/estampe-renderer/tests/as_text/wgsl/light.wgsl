// What all surfaces share: uniforms, the sum of the light, steps and fog.

struct Directional { towards: vec3f, highlight: f32, color: vec3f }
struct Positional { position: vec3f, inverse_reach: f32, color: vec3f, highlight: f32 }
struct Scene {
    clip_from_unit: mat4x4f,
    view_from_unit: mat4x4f,
    view_from_normal: mat3x3f,
    directional: array<Directional, 3>,
    positional: array<Positional, 2>,
    directional_count: u32,
    positional_count: u32,
    sky: vec3f,
    ground: vec3f,
    base_color: vec4f,
    specular: vec3f,
    emissive: vec3f,
    // The colour; where it begins; 1 ÷ (end − start).
    fog_color: vec3f,
    fog_start: f32,
    fog_per_distance: f32,
    // The slope of the ray per pixel, and at the window's left and upper edge.
    fog_ray_x: vec2f,
    fog_ray_y: vec2f,
    // Distance per unit of depth, and at depth 0.
    fog_depth: vec2f,
    bump_height: f32,
}
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var base_texture: texture_2d<f32>;
@group(0) @binding(2) var repeating: sampler;
@group(0) @binding(3) var heights: texture_2d<f32>;

override ORTHOGRAPHIC: bool = false;
override VIEWER_AT_INFINITY: bool = false;
override HALF_VECTOR: bool = false;
override SHININESS: f32 = 1.0;
// Exponents above 64 by `pow`, as smaller ones.
override BY_POW: bool = false;
override UNLIT: bool = false;
// Steps of toon shading, and of each channel's colours; 0: none.
override TOON_LEVELS: f32 = 0.0;
override COLOR_LEVELS: f32 = 0.0;
override FOG: bool = false;

struct Light { diffuse: vec3f, added: vec3f }

fn eye_direction(view: vec3f) -> vec3f {
    if ORTHOGRAPHIC { return vec3f(0.0, 0.0, 1.0); }
    return normalize(-view);
}

// The normal on the side that is seen; towards the eye if the vertices have none.
fn shading_normal(normal: vec3f, to_eye: vec3f, front_facing: bool) -> vec3f {
    let squared = dot(normal, normal);
    let scale = 1.0 / sqrt(squared);
    return select(to_eye, normal * select(-scale, scale, front_facing), squared > 1e-12);
}

fn stepped(value: f32, levels: f32) -> f32 {
    return min(floor(max(value, 0.0) * levels), levels - 1.0) / (levels - 1.0);
}

fn luminance(color: vec3f) -> f32 {
    return color.r * 0.2126 + color.g * 0.7152 + color.b * 0.0722;
}

// A power by products: `pow` does so with constants up to 64.
fn power(base: f32, exponent: u32) -> f32 {
    var result = 1.0;
    var square = base;
    for (var left = exponent; left != 0u; left >>= 1u) {
        if (left & 1u) == 1u { result *= square; }
        square *= square;
    }
    return result;
}

fn highlight(towards: vec3f, normal: vec3f, to_eye: vec3f) -> f32 {
    var cosine = dot(-reflect(to_eye, normal), towards);
    if HALF_VECTOR { cosine = dot(normal, normalize(towards + to_eye)); }
    if SHININESS > 64.0 && !BY_POW { return power(saturate(cosine), u32(SHININESS)); }
    return pow(saturate(cosine), SHININESS);
}

fn added_by(light: Light, color: vec3f, strength: f32, towards: vec3f, normal: vec3f, to_eye: vec3f) -> Light {
    let n_dot_l = max(dot(normal, towards), 0.0);
    let diffuse = light.diffuse + color * n_dot_l;
    if strength <= 0.0 || all(scene.specular == vec3f()) { return Light(diffuse, light.added); }
    let lit = select(0.0, highlight(towards, normal, to_eye) * strength, n_dot_l > 0.0);
    return Light(diffuse, light.added + color * scene.specular * lit);
}

// Light from a point: the direction towards it, and the share that arrives.
fn arriving(light: Positional, position: vec3f) -> vec4f {
    let way = light.position - position;
    let distance = length(way);
    return vec4f(way / max(distance, 1e-18), 1.0 - min(distance * light.inverse_reach, 1.0));
}

fn all_terms(position: vec3f, normal: vec3f, to_eye: vec3f) -> Light {
    let upward = normal.y * 0.5 + 0.5;
    var sum = Light(mix(scene.ground, scene.sky, upward), scene.emissive);
    for (var i = 0u; i < scene.directional_count; i++) {
        let light = scene.directional[i];
        sum = added_by(sum, light.color, light.highlight, light.towards, normal, to_eye);
    }
    for (var i = 0u; i < scene.positional_count; i++) {
        let light = scene.positional[i];
        let arrives = arriving(light, position);
        sum = added_by(sum, light.color * arrives.w, light.highlight, arrives.xyz, normal, to_eye);
    }
    return sum;
}

fn lit_fraction(position: vec3f, normal: vec3f) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < scene.directional_count; i++) {
        let light = scene.directional[i];
        sum += max(dot(normal, light.towards), 0.0) * luminance(light.color);
    }
    for (var i = 0u; i < scene.positional_count; i++) {
        let light = scene.positional[i];
        let arrives = arriving(light, position);
        sum += max(dot(normal, arrives.xyz), 0.0) * luminance(light.color) * arrives.w;
    }
    return saturate(sum);
}

fn light_at(position: vec3f, normal: vec3f, to_eye: vec3f) -> Light {
    if UNLIT { return Light(vec3f(1.0), scene.emissive); }
    if TOON_LEVELS > 0.0 { return Light(vec3f(lit_fraction(position, normal)), scene.emissive); }
    return all_terms(position, normal, to_eye);
}

fn reflected(base: vec3f, light: Light) -> vec3f {
    if TOON_LEVELS > 0.0 {
        return base * (stepped(light.diffuse.x, TOON_LEVELS) * (1.0 - 0.3) + 0.3) + light.added;
    }
    return base * light.diffuse + light.added;
}

// What is written of a lit colour: in levels, behind fog.
fn written(lit: vec3f, at: vec4f) -> vec3f {
    var color = lit;
    if COLOR_LEVELS > 0.0 {
        color = vec3f(
            stepped(color.r, COLOR_LEVELS),
            stepped(color.g, COLOR_LEVELS),
            stepped(color.b, COLOR_LEVELS),
        );
    }
    if !FOG { return color; }
    let ray = vec3f(
        at.x * scene.fog_ray_x.x + scene.fog_ray_x.y,
        at.y * scene.fog_ray_y.x + scene.fog_ray_y.y,
        1.0,
    );
    var distance = length(ray) / at.w;
    if ORTHOGRAPHIC { distance = at.z * scene.fog_depth.x + scene.fog_depth.y; }
    let share = saturate((distance - scene.fog_start) * scene.fog_per_distance);
    return mix(color, scene.fog_color, share);
}
