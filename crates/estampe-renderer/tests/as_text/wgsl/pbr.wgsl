// Physically based surfaces: glTF's metal and roughness with its clear coat, sheen, specular,
// anisotropy, iridescence, transmission, volume and dispersion extensions, under lights and light
// from all around.

struct Light {
    // The position; of parallel light the direction towards it.
    place: vec3f,
    // 0: parallel; 1: from a point, decreasing linearly; 2: with the squared distance.
    kind: u32,
    color: vec3f,
    // 1 ÷ the distance at which it ends.
    inverse_reach: f32,
    axis: vec3f,
    cone_scale: f32,
    cone_offset: f32,
    has_cone: u32,
}
struct Scene {
    clip_from_unit: mat4x4f,
    view_from_unit: mat4x4f,
    view_from_normal: mat3x3f,
    map_from_view: mat3x3f,
    lights: array<Light, 5>,
    light_count: u32,
    // Irradiance ÷ π in spherical harmonics.
    diffuse: array<vec3f, 9>,
    roughest_level: f32,
    exposure: f32,
    base: vec4f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    normal_u: vec3f,
    normal_v: vec3f,
    occlusion_strength: f32,
    emissive: vec3f,
    dielectric_f0: f32,
    specular_color: vec3f,
    specular_factor: f32,
    coat_factor: f32,
    coat_roughness: f32,
    sheen_color: vec3f,
    sheen_roughness: f32,
    groove_strength: f32,
    // Cosine and sine.
    groove_rotation: vec2f,
    film_factor: f32,
    film_ior: f32,
    // In nanometres, where the texture is 0 and where it is 1.
    film_thickness: vec2f,
    transmission: f32,
    // Indices of refraction of red, green and blue.
    iors: vec3f,
    thickness: f32,
    // Halvings of light per length.
    absorption: vec3f,
    clip_from_view: mat4x4f,
    // log₂ of the longer side of the picture of what is behind.
    last_level: f32,
    background: vec3f,
    alpha_cutoff: f32,
}
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var base_texture: texture_2d<f32>;
@group(0) @binding(2) var repeating: sampler;
@group(0) @binding(3) var heights: texture_2d<f32>;
@group(0) @binding(4) var surroundings: texture_cube<f32>;
@group(0) @binding(5) var albedos: texture_2d<f32>;
// Opaque surfaces, drawn before: light times coverage.
@group(0) @binding(6) var behind: texture_2d<f32>;

override ORTHOGRAPHIC: bool = false;
override HAS_TEXTURES: bool = false;
override HAS_NORMAL_MAP: bool = false;
override HAS_SPECULAR: bool = false;
override HAS_COAT: bool = false;
override HAS_SHEEN: bool = false;
override HAS_GROOVES: bool = false;
override HAS_FILM: bool = false;
override TRANSMITS: bool = false;
override HAS_VOLUME: bool = false;
override CLEAR_BACKGROUND: bool = false;
override BLENDS: bool = false;
override UNLIT: bool = false;
override IGNORES_ALPHA: bool = false;
override CUTS_OUT: bool = false;
// 0: none; 1: Khronos PBR Neutral; 2: AgX; 3: ACES.
override TONE_MAP: u32 = 0u;

const PI_INVERSE: f32 = 0.31830987;
const TAU_INVERSE: f32 = 0.15915494;
const COAT_F0: f32 = 0.04;

struct Varyings {
    @builtin(position) at: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) uv1: vec2f,
    @location(5) color: vec4f,
}

@vertex
fn vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) uv1: vec2f,
    @location(5) color: vec4f,
) -> Varyings {
    let at = vec4f(position, 1.0);
    let view = (scene.view_from_unit * at).xyz;
    let direction = vec4f(scene.view_from_normal * tangent.xyz, tangent.w);
    let clip = scene.clip_from_unit * at;
    return Varyings(clip, view, scene.view_from_normal * normal, direction, uv, uv1, color);
}

fn eye_direction(view: vec3f) -> vec3f {
    if ORTHOGRAPHIC { return vec3f(0.0, 0.0, 1.0); }
    return normalize(-view);
}

fn shading_normal(normal: vec3f, to_eye: vec3f, front_facing: bool) -> vec3f {
    let squared = dot(normal, normal);
    let scale = 1.0 / sqrt(squared);
    return select(to_eye, normal * select(-scale, scale, front_facing), squared > 1e-12);
}

// The second texture coordinates, transformed.
fn normal_coordinates(in: Varyings) -> vec2f {
    return vec2f(
        in.uv1.x * scene.normal_u.x + in.uv1.y * scene.normal_u.y + scene.normal_u.z,
        in.uv1.x * scene.normal_v.x + in.uv1.y * scene.normal_v.y + scene.normal_v.z,
    );
}

struct Frame { tangent: vec3f, bitangent: vec3f, normal: vec3f, unit: vec3f, sign: f32 }

// Tangent and bitangent by the derivatives of texture coordinates.
fn derived(view: vec3f, normal: vec3f, uv: vec2f) -> array<vec3f, 2> {
    let step_x = dpdx(view);
    let step_y = dpdy(view);
    let uv_x = dpdx(uv);
    let uv_y = dpdy(uv);
    let r1 = cross(step_y, normal);
    let r2 = cross(normal, step_x);
    let tangent = r1 * uv_x.x + r2 * uv_y.x;
    let bitangent = -(r1 * uv_x.y + r2 * uv_y.y);
    let longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    let length = sqrt(longest);
    let scale = 1.0 / select(length, -length, dot(step_x, r1) < 0.0);
    let has_any = longest > 1e-30;
    return array(
        select(vec3f(), tangent * scale, has_any),
        select(vec3f(), bitangent * scale, has_any),
    );
}

fn frame_of(in: Varyings, to_eye: vec3f, front_facing: bool) -> Frame {
    let unit = shading_normal(in.normal, to_eye, front_facing);
    let sign = select(-1.0, 1.0, front_facing);
    let given = in.tangent.xyz;
    var uv = in.uv;
    if HAS_NORMAL_MAP { uv = normal_coordinates(in); }
    let made = derived(in.view, unit * sign, uv);
    let has_tangent = dot(given, given) > 1e-6;
    return Frame(
        select(made[0], given, has_tangent),
        select(made[1], cross(in.normal, given) * in.tangent.w, has_tangent),
        select(unit * sign, in.normal, has_tangent),
        unit,
        sign,
    );
}

fn mapped_normal(frame: Frame, uv: vec2f) -> vec3f {
    let texel = textureSample(heights, repeating, uv).xyz * 2.0 - 1.0;
    let flat = frame.tangent * (texel.x * scene.normal_scale)
        + frame.bitangent * (texel.y * scene.normal_scale);
    let bent = (flat + frame.normal * texel.z) * frame.sign;
    let squared = dot(bent, bent);
    return select(frame.unit, bent / sqrt(squared), squared > 1e-12 && squared <= 3.4028234e38);
}

// Roughness with the spread of the normals in a pixel.
fn filtered(roughness: f32, normal: vec3f) -> f32 {
    let across = dpdx(normal);
    let down = dpdy(normal);
    let spread = dot(across, across) + dot(down, down);
    let added = min(spread * (2.0 * 0.25), 0.18);
    let alpha = roughness * roughness;
    return sqrt(sqrt(min(alpha * alpha + added, 1.0)));
}

fn schlick(cosine: f32) -> f32 {
    let x = saturate(1.0 - cosine);
    let squared = x * x;
    return x * (squared * squared);
}

fn density_ggx(n_dot_h: f32, sin_squared: f32, alpha: f32) -> f32 {
    let scaled = n_dot_h * alpha;
    let ratio = alpha / (scaled * scaled + sin_squared);
    return ratio * ratio * PI_INVERSE;
}

fn masked(cosine: f32, alpha_squared: f32) -> f32 {
    return sqrt(cosine * cosine * (1.0 - alpha_squared) + alpha_squared);
}

fn visibility_ggx(n_dot_l: f32, n_dot_v: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let sum = n_dot_l * masked(n_dot_v, squared) + n_dot_v * masked(n_dot_l, squared);
    return 0.5 / max(sum, 1e-6);
}

fn density_sheen(n_dot_h: f32, alpha: f32) -> f32 {
    let inverse = 1.0 / alpha;
    let sin_squared = max(1.0 - n_dot_h * n_dot_h, 1e-7);
    return (inverse + 2.0) * pow(sin_squared, inverse * 0.5) * TAU_INVERSE;
}

// The grooves of a surface: tangent and bitangent across the shading normal.
struct Grooves { tangent: vec3f, bitangent: vec3f, strength: f32 }

fn grooves_of(frame: Frame, normal: vec3f, uv1: vec2f) -> Grooves {
    let turn = scene.groove_rotation;
    var along = turn;
    var strength = scene.groove_strength;
    if HAS_TEXTURES {
        let texel = textureSample(heights, repeating, uv1);
        let direction = texel.xy * 2.0 - 1.0;
        let d = direction / length(direction);
        along = vec2f(d.x * turn.x - d.y * turn.y, d.x * turn.y + d.y * turn.x);
        strength *= texel.z;
    }
    let direction = frame.tangent * along.x + frame.bitangent * along.y;
    let across = direction - normal * dot(normal, direction);
    let squared = dot(across, across);
    let is_known = squared > 1e-12 && squared <= 3.4028234e38;
    let axis = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.y) < 0.9);
    let tangent = select(normalize(cross(normal, axis)), across / sqrt(squared), is_known);
    return Grooves(tangent, cross(normal, tangent), select(0.0, saturate(strength), is_known));
}

// α along the grooves' tangent and bitangent.
fn alphas(g: Grooves, alpha: f32) -> vec2f {
    return vec2f(alpha + (1.0 - alpha) * (g.strength * g.strength), alpha);
}

fn density_of_grooves(g: Grooves, half: vec3f, n_dot_h: f32, a: vec2f) -> f32 {
    let product = a.x * a.y;
    let v = vec3f(dot(g.tangent, half) * a.y, dot(g.bitangent, half) * a.x, n_dot_h * product);
    let w = product / dot(v, v);
    return product * w * w * PI_INVERSE;
}

fn masked_by_grooves(g: Grooves, direction: vec3f, cosine: f32, a: vec2f) -> f32 {
    return length(vec3f(dot(g.tangent, direction) * a.x, dot(g.bitangent, direction) * a.y, cosine));
}

// The reflectance of a thin film on a base, by Belcour and Barla.
fn film_fresnel(base_f0: vec3f, cosine: f32, thickness: f32) -> vec3f {
    let ior = max(scene.film_ior, 1.0);
    let ratio = (ior - 1.0) / (ior + 1.0);
    let outer = ratio * ratio;
    let first = schlick(cosine) * (1.0 - outer) + outer;
    let sine_squared = (1.0 - cosine * cosine) * (1.0 / (ior * ior));
    let inside = sqrt(max(1.0 - sine_squared, 0.0));
    let grazing = schlick(inside);
    let root = sqrt(clamp(base_f0, vec3f(), vec3f(0.9999)));
    let base_ior = (1.0 + root) / (1.0 - root);
    let r = (base_ior - ior) / (base_ior + ior);
    let normal = r * r;
    let second = normal + (1.0 - normal) * grazing;
    let through = 1.0 - first;
    let both = clamp(first * second, vec3f(1e-5), vec3f(0.9999));
    let rest = through * through * second / (1.0 - both);
    let wave = (rest - through) * sqrt(both);
    const PI: f32 = 3.1415927;
    let shift = select(vec3f(PI), vec3f(PI + PI), base_ior < vec3f(ior));
    let path = thickness * inside * (2.0 * ior);
    let once = sensitivity(path, shift) * 2.0;
    let twice = sensitivity(path * 2.0, shift * 2.0) * 2.0;
    return saturate(first + rest + wave * once + wave * sqrt(both) * twice);
}

fn gaussian(path: f32, shift: f32, height: f32, frequency: f32, decay: f32) -> f32 {
    return cos(path * frequency + shift) * height * exp2(path * path * -decay);
}

fn sensitivity(path: f32, shift: vec3f) -> vec3f {
    let xyz = vec3f(
        gaussian(path, shift.x, 0.84659, 0.010562034, 2.4649122e-7)
            + gaussian(path, shift.x, 0.1538683, 0.014073707, 2.579051e-7),
        gaussian(path, shift.y, 1.0002219, 0.011280203, 5.2994645e-7),
        gaussian(path, shift.z, 1.0011225, 0.013875786, 3.7659425e-7),
    );
    return times(
        vec3f(3.2404542, -1.5371385, -0.4985314),
        vec3f(-0.969266, 1.8760108, 0.041556),
        vec3f(0.0556434, -0.2040259, 1.0572252),
        xyz,
    );
}

// What is seen where the ray of an index of refraction leaves the body.
fn seen_behind(p: Point, ior: f32, thickness: f32) -> vec4f {
    var exit = p.position;
    if HAS_VOLUME {
        exit += normalize(refract(-p.to_eye, p.normal, 1.0 / ior)) * thickness;
    }
    let clip = scene.clip_from_view * vec4f(exit, 1.0);
    let at = vec2f(clip.x / clip.w * 0.5 + 0.5, clip.y / clip.w * -0.5 + 0.5);
    let blur = min(ior * 2.0 - 2.0, 1.0) * scene.last_level;
    return textureSampleLevel(behind, repeating, at, p.unfiltered_roughness * blur);
}

struct Behind { share: f32, tint: vec3f, light: vec3f, coverage: vec3f }

fn behind_of(p: Point, in: Varyings) -> Behind {
    var share = scene.transmission;
    var thickness = scene.thickness;
    if HAS_TEXTURES {
        share *= textureSample(base_texture, repeating, in.uv).x;
        thickness *= textureSample(heights, repeating, in.uv1).y;
    }
    if !HAS_VOLUME {
        let seen = seen_behind(p, scene.iors.y, 0.0);
        return Behind(share, vec3f(1.0), seen.xyz, vec3f(seen.w));
    }
    let red = seen_behind(p, scene.iors.x, thickness);
    let green = seen_behind(p, scene.iors.y, thickness);
    let blue = seen_behind(p, scene.iors.z, thickness);
    return Behind(
        share,
        exp2(scene.absorption * -thickness),
        vec3f(red.x, green.y, blue.z),
        vec3f(red.w, green.w, blue.w),
    );
}

fn albedo(n_dot_v: f32, roughness: f32) -> vec3f {
    const SIDE: f32 = 32.0;
    const SCALE: f32 = (SIDE - 1.0) / SIDE;
    const OFFSET: f32 = 0.5 / SIDE;
    let at = vec2f(n_dot_v * SCALE + OFFSET, roughness * SCALE + OFFSET);
    return textureSampleLevel(albedos, repeating, at, 0.0).xyz;
}

fn radiance(direction: vec3f, roughness: f32) -> vec3f {
    let at = scene.map_from_view * direction;
    return textureSampleLevel(surroundings, repeating, at, roughness * scene.roughest_level).xyz;
}

fn irradiance(normal: vec3f) -> vec3f {
    let n = scene.map_from_view * normal;
    var sum = scene.diffuse[0];
    sum += scene.diffuse[1] * n.x;
    sum += scene.diffuse[2] * n.y;
    sum += scene.diffuse[3] * n.z;
    sum += scene.diffuse[4] * (n.x * n.y);
    sum += scene.diffuse[5] * (n.y * n.z);
    sum += scene.diffuse[6] * (n.z * n.x);
    sum += scene.diffuse[7] * (n.z * n.z * 3.0 - 1.0);
    sum += scene.diffuse[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3f());
}

struct Point {
    position: vec3f,
    normal: vec3f,
    to_eye: vec3f,
    diffuse: vec3f,
    f0: vec3f,
    f90: f32,
    roughness: f32,
    occlusion: f32,
    coat_normal: vec3f,
    coat_factor: f32,
    coat_roughness: f32,
    sheen_color: vec3f,
    sheen_roughness: f32,
    unfiltered_roughness: f32,
    grooves: Grooves,
    film_factor: f32,
    film_thickness: f32,
}

fn point(in: Varyings, base: vec3f, front_facing: bool) -> Point {
    var p: Point;
    p.position = in.view;
    p.to_eye = eye_direction(in.view);
    let frame = frame_of(in, p.to_eye, front_facing);
    p.normal = frame.unit;
    if HAS_NORMAL_MAP { p.normal = mapped_normal(frame, normal_coordinates(in)); }
    var metallic = scene.metallic;
    var roughness = scene.roughness;
    p.occlusion = 1.0;
    p.f0 = vec3f(scene.dielectric_f0);
    p.f90 = 1.0;
    p.coat_factor = scene.coat_factor;
    p.coat_roughness = scene.coat_roughness;
    p.sheen_color = scene.sheen_color;
    p.sheen_roughness = scene.sheen_roughness;
    var specular_color = scene.specular_color;
    var specular_factor = scene.specular_factor;
    if HAS_TEXTURES {
        let texel = textureSample(base_texture, repeating, in.uv);
        let second = textureSample(heights, repeating, in.uv1);
        metallic *= texel.z;
        roughness *= texel.y;
        p.occlusion = saturate((second.x - 1.0) * scene.occlusion_strength + 1.0);
        specular_color *= second.xyz;
        specular_factor *= texel.w;
        p.coat_factor *= second.x;
        p.coat_roughness *= texel.y;
        p.sheen_color *= texel.xyz;
        p.sheen_roughness *= second.w;
    }
    if HAS_SPECULAR {
        p.f0 = min(specular_color * scene.dielectric_f0, vec3f(1.0)) * specular_factor;
        p.f90 = specular_factor;
    }
    p.diffuse = base * (1.0 - metallic);
    p.f0 = mix(p.f0, base, metallic);
    p.f90 = mix(p.f90, 1.0, metallic);
    p.unfiltered_roughness = saturate(roughness);
    p.roughness = filtered(p.unfiltered_roughness, p.normal);
    if HAS_GROOVES { p.grooves = grooves_of(frame, p.normal, in.uv1); }
    p.film_factor = scene.film_factor;
    p.film_thickness = scene.film_thickness.y;
    if HAS_TEXTURES {
        let least = scene.film_thickness.x;
        p.film_factor *= textureSample(base_texture, repeating, in.uv).x;
        let share = textureSample(heights, repeating, in.uv1).y;
        p.film_thickness = share * (scene.film_thickness.y - least) + least;
    }
    p.film_factor = saturate(p.film_factor);
    p.coat_roughness = saturate(p.coat_roughness);
    p.coat_normal = frame.unit;
    return p;
}

// What several lobes need.
struct Shared {
    n_dot_v: f32,
    single: vec3f,
    multiple: vec3f,
    diffuse: vec3f,
    rest: vec3f,
    below: f32,
    coat: f32,
    sheen: f32,
}

fn shared_terms(p: Point) -> Shared {
    var s: Shared;
    s.n_dot_v = clamp(dot(p.normal, p.to_eye), 1e-4, 1.0);
    s.below = 1.0;
    if HAS_SHEEN {
        s.sheen = albedo(s.n_dot_v, p.sheen_roughness).z;
        let strongest = max(max(p.sheen_color.x, p.sheen_color.y), p.sheen_color.z);
        s.below *= 1.0 - strongest * s.sheen;
    }
    if HAS_COAT {
        let cosine = clamp(dot(p.coat_normal, p.to_eye), 1e-4, 1.0);
        s.coat = (schlick(cosine) * (1.0 - COAT_F0) + COAT_F0) * p.coat_factor;
        s.below *= 1.0 - s.coat;
    }
    var f0 = p.f0;
    var f90 = p.f90;
    if HAS_FILM {
        let weight = schlick(s.n_dot_v);
        let seen = film_fresnel(p.f0, s.n_dot_v, p.film_thickness);
        let of_film = saturate((seen - weight) * (1.0 / (1.0 - weight)));
        f0 = mix(f0, of_film, p.film_factor);
        f90 = mix(f90, 1.0, p.film_factor);
    }
    var cosine = s.n_dot_v;
    var roughness = p.roughness;
    if HAS_GROOVES {
        let g = p.grooves;
        let a = alphas(g, max(p.roughness * p.roughness, 0.002));
        let across = dot(g.bitangent, p.to_eye) * (a.y / a.x);
        cosine = s.n_dot_v / length(vec3f(dot(g.tangent, p.to_eye), across, s.n_dot_v));
        roughness = sqrt(sqrt((a.x * a.x + a.y * a.y) * 0.5));
    }
    let of_ggx = albedo(cosine, roughness);
    s.single = f0 * of_ggx.x + of_ggx.y * f90;
    var lost = 1.0 - (of_ggx.x + of_ggx.y);
    if HAS_GROOVES { lost = max(lost - p.grooves.strength * 0.045, 0.0); }
    const SHARE: f32 = 1.0 / 21.0;
    let mean = f0 + (1.0 - f0) * SHARE;
    s.multiple = s.single * mean / (1.0 - mean * lost) * lost;
    s.rest = 1.0 - s.single - s.multiple;
    if HAS_FILM {
        s.rest = mix(s.rest, vec3f(min(min(s.rest.x, s.rest.y), s.rest.z)), p.film_factor);
    }
    s.diffuse = p.diffuse * s.rest;
    return s;
}

fn specular_occlusion(n_dot_v: f32, occlusion: f32, roughness: f32) -> f32 {
    let exponent = exp2(roughness * -16.0 - 1.0);
    let seen = pow(n_dot_v + occlusion, exponent) - 1.0 + occlusion;
    return select(occlusion, saturate(seen), occlusion < 1.0);
}

fn environment_light(p: Point, s: Shared) -> vec3f {
    let mirrored = reflect(-p.to_eye, p.normal);
    var turned = mirrored;
    if HAS_GROOVES {
        let facing = cross(cross(p.grooves.bitangent, p.to_eye), p.grooves.bitangent);
        let kept = 1.0 - p.grooves.strength * (1.0 - p.roughness);
        let squared = kept * kept;
        turned = reflect(-p.to_eye, normalize(mix(facing, p.normal, squared * squared)));
    }
    let lobe = mix(turned, p.normal, p.roughness * p.roughness);
    let around = radiance(lobe, p.roughness);
    let seen = specular_occlusion(s.n_dot_v, p.occlusion, p.roughness);
    let spread = irradiance(p.normal) * (s.multiple + s.diffuse) * p.occlusion;
    var sum = around * s.single * seen + spread;
    sum *= s.below;
    if HAS_SHEEN {
        let light = radiance(mirrored, max(p.sheen_roughness, 0.5));
        sum += light * p.sheen_color * (s.sheen * p.occlusion);
    }
    if HAS_COAT {
        let light = radiance(reflect(-p.to_eye, p.coat_normal), p.coat_roughness);
        sum += light * (s.coat * seen);
    }
    return sum;
}

struct Arriving { towards: vec3f, illuminance: vec3f }

fn arriving(light: Light, position: vec3f) -> Arriving {
    if light.kind == 0u { return Arriving(light.place, light.color); }
    let way = light.place - position;
    if light.kind == 1u {
        let distance = length(way);
        let share = 1.0 - min(distance * light.inverse_reach, 1.0);
        return Arriving(way / max(distance, 1e-18), light.color * share);
    }
    let squared = max(dot(way, way), 1e-12);
    let towards = way / sqrt(squared);
    var share = 1.0 / squared;
    if light.inverse_reach > 0.0 {
        let reached = squared * (light.inverse_reach * light.inverse_reach);
        share *= saturate(1.0 - reached * reached);
    }
    if light.has_cone != 0u {
        let cosine = -dot(towards, light.axis);
        let inside = saturate(cosine * light.cone_scale + light.cone_offset);
        share = share * inside * inside;
    }
    return Arriving(towards, light.color * share);
}

fn punctual_light(light: Light, p: Point, s: Shared) -> vec3f {
    let arrives = arriving(light, p.position);
    let towards = arrives.towards;
    let half = normalize(towards + p.to_eye);
    let n_dot_l = dot(p.normal, towards);
    let v_dot_h = saturate(dot(p.to_eye, half));
    let lit = max(n_dot_l, 0.0);
    let alpha = max(p.roughness * p.roughness, 0.002);
    let across = cross(p.normal, half);
    let n_dot_h = saturate(dot(p.normal, half));
    var lobe = density_ggx(n_dot_h, dot(across, across), alpha)
        * visibility_ggx(lit, s.n_dot_v, alpha);
    if HAS_GROOVES {
        let g = p.grooves;
        let a = alphas(g, alpha);
        let sum = lit * masked_by_grooves(g, p.to_eye, s.n_dot_v, a)
            + s.n_dot_v * masked_by_grooves(g, towards, lit, a);
        lobe = density_of_grooves(g, half, n_dot_h, a) * (0.5 / max(sum, 1e-6));
    }
    let weight = schlick(v_dot_h);
    var fresnel = p.f0 + (p.f90 - p.f0) * weight;
    if HAS_FILM {
        fresnel = mix(fresnel, film_fresnel(p.f0, v_dot_h, p.film_thickness), p.film_factor);
    }
    var reflectance = ((s.multiple + s.diffuse) * PI_INVERSE + fresnel * lobe) * s.below;
    if HAS_SHEEN {
        let rough = max(p.sheen_roughness * p.sheen_roughness, 0.005);
        let visibility = 0.25 / max(lit + s.n_dot_v - lit * s.n_dot_v, 1e-6);
        reflectance += p.sheen_color * (density_sheen(n_dot_h, rough) * visibility);
    }
    var sum = arrives.illuminance * reflectance * lit;
    if HAS_COAT {
        let rough = max(p.coat_roughness * p.coat_roughness, 0.002);
        let sideways = cross(p.coat_normal, half);
        let coat_lit = max(dot(p.coat_normal, towards), 0.0);
        let coat_seen = clamp(dot(p.coat_normal, p.to_eye), 1e-4, 1.0);
        let cosine = saturate(dot(p.coat_normal, half));
        let coat_lobe = density_ggx(cosine, dot(sideways, sideways), rough)
            * visibility_ggx(coat_lit, coat_seen, rough);
        let of_coat = weight * (1.0 - COAT_F0) + COAT_F0;
        sum += arrives.illuminance * (coat_lobe * of_coat * p.coat_factor * coat_lit);
    }
    return select(vec3f(), sum, n_dot_l > 0.0);
}

fn neutral(light: vec3f) -> vec3f {
    const START: f32 = f32(0.8) - f32(0.04);
    const RANGE: f32 = 1.0 - START;
    let least = min(min(light.x, light.y), light.z);
    let toe = least - least * least * 6.25;
    let color = light - select(0.04, toe, least < 0.08);
    let peak = max(max(color.x, color.y), color.z);
    let compressed = 1.0 - (RANGE * RANGE) / max(peak + (RANGE - START), RANGE);
    let white = 1.0 - 1.0 / ((peak - compressed) * 0.15 + 1.0);
    let bright = mix(color * (compressed / max(peak, START)), vec3f(compressed), white);
    return select(bright, color, peak < START);
}

fn times(x: vec3f, y: vec3f, z: vec3f, color: vec3f) -> vec3f {
    return vec3f(dot(color, x), dot(color, y), dot(color, z));
}

fn agx_curve(value: f32) -> f32 {
    const LEAST: f32 = -12.47393;
    const MOST: f32 = 4.026069;
    let x = (clamp(log2(max(value, 1e-10)), LEAST, MOST) - LEAST) / (MOST - LEAST);
    return ((((((x * 15.5 - 40.14) * x) + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
}

fn agx(color: vec3f) -> vec3f {
    let inset = times(
        vec3f(0.84247906, 0.0784336, 0.079223745),
        vec3f(0.042328242, 0.8784686, 0.07916613),
        vec3f(0.042375654, 0.0784336, 0.879143),
        color,
    );
    let shown = times(
        vec3f(1.196879, -0.09802088, -0.09902974),
        vec3f(-0.05289685, 1.1519031, -0.09896118),
        vec3f(-0.052971635, -0.09804345, 1.1510737),
        vec3f(agx_curve(inset.x), agx_curve(inset.y), agx_curve(inset.z)),
    );
    return pow(max(shown, vec3f()), vec3f(2.2));
}

fn aces(color: vec3f) -> vec3f {
    const EXPOSURE: f32 = f32(1.0) / f32(0.6);
    let v = times(
        vec3f(0.59719, 0.35458, 0.04823),
        vec3f(0.076, 0.90834, 0.01566),
        vec3f(0.0284, 0.13383, 0.83777),
        color * EXPOSURE,
    );
    let above = v * (v + 0.0245786) - 0.000090537;
    return saturate(times(
        vec3f(1.60475, -0.53108, -0.07367),
        vec3f(-0.10208, 1.10813, -0.00605),
        vec3f(-0.00327, -0.07276, 1.07602),
        above / (v * (v * 0.983729 + 0.432951) + 0.238081),
    ));
}

fn mapped(light: vec3f) -> vec3f {
    switch TONE_MAP {
        case 1u: { return neutral(light); }
        case 2u: { return agx(light); }
        case 3u: { return aces(light); }
        default: { return light; }
    }
}

// The colour, and the opacity before a transparent background.
fn shown(in: Varyings, base: vec3f, front_facing: bool) -> vec4f {
    if UNLIT { return vec4f(base, 1.0); }
    var p = point(in, base, front_facing);
    var passing = vec3f();
    var back: Behind;
    if TRANSMITS {
        back = behind_of(p, in);
        passing = p.diffuse * back.share * back.tint;
        p.diffuse *= 1.0 - back.share;
    }
    let s = shared_terms(p);
    var sum = environment_light(p, s);
    for (var i = 0u; i < scene.light_count; i++) { sum += punctual_light(scene.lights[i], p, s); }
    var emitted = scene.emissive;
    if HAS_TEXTURES { emitted *= textureSample(base_texture, repeating, in.uv).xyz; }
    sum += emitted;
    let light = sum * scene.exposure;
    if !TRANSMITS { return vec4f(mapped(light), 1.0); }
    passing *= s.rest;
    passing *= s.below;
    let covered = mapped(light + passing * (back.light / max(back.coverage, vec3f(1e-4))));
    let color = mix(mapped(light), covered, back.coverage);
    let clear = passing * (1.0 - back.coverage);
    if !CLEAR_BACKGROUND { return vec4f(color + scene.background * clear, 1.0); }
    let least = min(min(clear.x, clear.y), clear.z);
    let tinted = color + (clear - least) * 0.8879231;
    let brightest = max(max(tinted.x, tinted.y), tinted.z);
    return vec4f(tinted, saturate(max(1.0 - least, brightest)));
}

@fragment
fn fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    var base = in.color * scene.base;
    if HAS_TEXTURES { base *= textureSample(base_texture, repeating, in.uv); }
    let seen = shown(in, base.rgb, front);
    if CUTS_OUT && !(base.a >= scene.alpha_cutoff) { discard; }
    let alpha = select(base.a, 1.0, IGNORES_ALPHA || CUTS_OUT);
    if !(TRANSMITS && CLEAR_BACKGROUND) { return vec4f(seen.rgb, alpha); }
    return vec4f(select(seen.rgb, seen.rgb / max(seen.a, 1e-6), BLENDS), alpha * seen.a);
}
