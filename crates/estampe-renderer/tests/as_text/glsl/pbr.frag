// Physically based surfaces: glTF's metal and roughness with its clear coat, sheen, specular,
// anisotropy, iridescence, transmission, volume and dispersion extensions, under lights and light
// from all around.

struct Light {
    vec3 place; // The position; of parallel light the direction towards it.
    uint kind; // 0: parallel; 1: from a point, decreasing linearly; 2: with the squared distance.
    vec3 color;
    float inverse_reach; // 1 ÷ the distance at which it ends.
    vec3 axis;
    float cone_scale, cone_offset;
    uint has_cone;
};

uniform mat3 map_from_view;
uniform Light lights[5];
uniform uint light_count;
uniform vec3 diffuse[9]; // Irradiance ÷ π in spherical harmonics.
uniform float roughest_level, exposure;
uniform vec4 base;
uniform float metallic, roughness, normal_scale;
uniform vec3 normal_u, normal_v;
uniform float occlusion_strength;
uniform vec3 emissive;
uniform float dielectric_f0;
uniform vec3 specular_color;
uniform float specular_factor, coat_factor, coat_roughness;
uniform vec3 sheen_color;
uniform float sheen_roughness, alpha_cutoff;
uniform float groove_strength;
uniform vec2 groove_rotation; // Cosine and sine.
uniform float film_factor, film_ior;
uniform vec2 film_thickness; // In nanometres, where the texture is 0 and where it is 1.
uniform float transmission, thickness, last_level;
uniform vec3 iors, absorption, background;
uniform mat4 clip_from_view;
uniform sampler2D base_texture, heights, albedos;
uniform sampler2D behind; // Opaque surfaces, drawn before: light times coverage.
uniform samplerCube surroundings;

in vec3 view, view_normal;
in vec4 view_tangent;
in vec2 uv, uv1;
in vec4 color;
out vec4 result;

const float PI_INVERSE = 0.31830987, TAU_INVERSE = 0.15915494, COAT_F0 = 0.04;

float saturate(float value) { return clamp(value, 0.0, 1.0); }

vec3 eye_direction() {
#ifdef ORTHOGRAPHIC
    return vec3(0.0, 0.0, 1.0);
#else
    return normalize(-view);
#endif
}

vec3 shading_normal(vec3 normal, vec3 to_eye) {
    float squared = dot(normal, normal);
    if (!(squared > 1e-12)) return to_eye;
    float scale = 1.0 / sqrt(squared);
    return normal * (gl_FrontFacing ? scale : -scale);
}

// The second texture coordinates, transformed.
vec2 normal_coordinates() {
    return vec2(
        uv1.x * normal_u.x + uv1.y * normal_u.y + normal_u.z,
        uv1.x * normal_v.x + uv1.y * normal_v.y + normal_v.z);
}

struct Frame { vec3 tangent, bitangent, normal, unit; float side; };

// Tangent and bitangent by the derivatives of texture coordinates.
void derive(vec3 normal, vec2 at, out vec3 tangent, out vec3 bitangent) {
    vec3 step_x = dFdx(view), step_y = dFdy(view);
    vec2 uv_x = dFdx(at), uv_y = dFdy(at);
    vec3 r1 = cross(step_y, normal), r2 = cross(normal, step_x);
    tangent = r1 * uv_x.x + r2 * uv_y.x;
    bitangent = -(r1 * uv_x.y + r2 * uv_y.y);
    float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    float size = sqrt(longest);
    float scale = 1.0 / (dot(step_x, r1) < 0.0 ? -size : size);
    tangent = longest > 1e-30 ? tangent * scale : vec3(0.0);
    bitangent = longest > 1e-30 ? bitangent * scale : vec3(0.0);
}

Frame frame_of(vec3 to_eye) {
    Frame frame;
    frame.unit = shading_normal(view_normal, to_eye);
    frame.side = gl_FrontFacing ? 1.0 : -1.0;
#ifdef HAS_NORMAL_MAP
    vec2 at = normal_coordinates();
#else
    vec2 at = uv;
#endif
    frame.normal = frame.unit * frame.side;
    derive(frame.normal, at, frame.tangent, frame.bitangent);
    vec3 given = view_tangent.xyz;
    if (dot(given, given) > 1e-6) {
        frame.tangent = given;
        frame.bitangent = cross(view_normal, given) * view_tangent.w;
        frame.normal = view_normal;
    }
    return frame;
}

vec3 mapped_normal(Frame frame) {
    vec3 texel = texture(heights, normal_coordinates()).xyz * 2.0 - 1.0;
    vec3 bent = frame.tangent * (texel.x * normal_scale)
        + frame.bitangent * (texel.y * normal_scale);
    bent = (bent + frame.normal * texel.z) * frame.side;
    float squared = dot(bent, bent);
    return squared > 1e-12 && !isinf(squared) ? bent / sqrt(squared) : frame.unit;
}

// Roughness with the spread of the normals in a pixel.
float filtered(float perceptual, vec3 normal) {
    vec3 across = dFdx(normal), down = dFdy(normal);
    float spread = dot(across, across) + dot(down, down);
    float added = min(spread * (2.0 * 0.25), 0.18);
    float alpha = perceptual * perceptual;
    return sqrt(sqrt(min(alpha * alpha + added, 1.0)));
}

float schlick(float cosine) {
    float x = saturate(1.0 - cosine);
    float squared = x * x;
    return x * (squared * squared);
}

float density_ggx(float n_dot_h, float sin_squared, float alpha) {
    float scaled = n_dot_h * alpha;
    float ratio = alpha / (scaled * scaled + sin_squared);
    return ratio * ratio * PI_INVERSE;
}

float masked(float cosine, float alpha_squared) {
    return sqrt(cosine * cosine * (1.0 - alpha_squared) + alpha_squared);
}

float visibility_ggx(float n_dot_l, float n_dot_v, float alpha) {
    float squared = alpha * alpha;
    float sum = n_dot_l * masked(n_dot_v, squared) + n_dot_v * masked(n_dot_l, squared);
    return 0.5 / max(sum, 1e-6);
}

float density_sheen(float n_dot_h, float alpha) {
    float inverse = 1.0 / alpha;
    float sin_squared = max(1.0 - n_dot_h * n_dot_h, 1e-7);
    return (inverse + 2.0) * pow(sin_squared, inverse * 0.5) * TAU_INVERSE;
}

// The grooves of a surface: tangent and bitangent across the shading normal.
struct Grooves { vec3 tangent, bitangent; float strength; };

Grooves grooves_of(Frame frame, vec3 normal) {
    vec2 along = groove_rotation;
    float strength = groove_strength;
#ifdef HAS_TEXTURES
    vec3 texel = texture(heights, uv1).xyz;
    vec2 d = texel.xy * 2.0 - 1.0;
    d /= length(d);
    along = vec2(
        d.x * groove_rotation.x - d.y * groove_rotation.y,
        d.x * groove_rotation.y + d.y * groove_rotation.x);
    strength *= texel.z;
#endif
    vec3 direction = frame.tangent * along.x + frame.bitangent * along.y;
    vec3 across = direction - normal * dot(normal, direction);
    float squared = dot(across, across);
    Grooves g;
    if (squared > 1e-12 && !isinf(squared)) {
        g.tangent = across / sqrt(squared);
        g.strength = saturate(strength);
    } else {
        vec3 axis = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
        g.tangent = normalize(cross(normal, axis));
        g.strength = 0.0;
    }
    g.bitangent = cross(normal, g.tangent);
    return g;
}

// α along the grooves' tangent and bitangent.
vec2 alphas(Grooves g, float alpha) {
    return vec2(alpha + (1.0 - alpha) * (g.strength * g.strength), alpha);
}

float density_of_grooves(Grooves g, vec3 middle, float n_dot_h, vec2 a) {
    float product = a.x * a.y;
    vec3 v = vec3(dot(g.tangent, middle) * a.y, dot(g.bitangent, middle) * a.x, n_dot_h * product);
    float w = product / dot(v, v);
    return product * w * w * PI_INVERSE;
}

float masked_by_grooves(Grooves g, vec3 direction, float cosine, vec2 a) {
    return length(vec3(dot(g.tangent, direction) * a.x, dot(g.bitangent, direction) * a.y, cosine));
}

vec3 times(vec3 x, vec3 y, vec3 z, vec3 v) { return vec3(dot(v, x), dot(v, y), dot(v, z)); }

float gaussian(float path, float shift, float height, float frequency, float decay) {
    return cos(path * frequency + shift) * height * exp2(path * path * -decay);
}

vec3 sensitivity(float path, vec3 shift) {
    vec3 xyz = vec3(
        gaussian(path, shift.x, 0.84659, 0.010562034, 2.4649122e-7)
            + gaussian(path, shift.x, 0.1538683, 0.014073707, 2.579051e-7),
        gaussian(path, shift.y, 1.0002219, 0.011280203, 5.2994645e-7),
        gaussian(path, shift.z, 1.0011225, 0.013875786, 3.7659425e-7));
    return times(
        vec3(3.2404542, -1.5371385, -0.4985314), vec3(-0.969266, 1.8760108, 0.041556),
        vec3(0.0556434, -0.2040259, 1.0572252), xyz);
}

// The reflectance of a thin film on a base, by Belcour and Barla.
vec3 film_fresnel(vec3 base_f0, float cosine, float nanometres) {
    const float PI = 3.1415927;
    float ior = max(film_ior, 1.0);
    float ratio = (ior - 1.0) / (ior + 1.0);
    float outer = ratio * ratio;
    float first = schlick(cosine) * (1.0 - outer) + outer;
    float sine_squared = (1.0 - cosine * cosine) * (1.0 / (ior * ior));
    float inside = sqrt(max(1.0 - sine_squared, 0.0));
    vec3 root = sqrt(clamp(base_f0, 0.0, 0.9999));
    vec3 base_ior = (1.0 + root) / (1.0 - root);
    vec3 r = (base_ior - ior) / (base_ior + ior);
    vec3 head_on = r * r;
    vec3 second = head_on + (1.0 - head_on) * schlick(inside);
    float through = 1.0 - first;
    vec3 both = clamp(first * second, 1e-5, 0.9999);
    vec3 rest = through * through * second / (1.0 - both);
    vec3 wave = (rest - through) * sqrt(both);
    vec3 shift = mix(vec3(PI), vec3(PI + PI), lessThan(base_ior, vec3(ior)));
    float path = nanometres * inside * (2.0 * ior);
    vec3 once = sensitivity(path, shift) * 2.0;
    vec3 twice = sensitivity(path * 2.0, shift * 2.0) * 2.0;
    return clamp(first + rest + wave * once + wave * sqrt(both) * twice, 0.0, 1.0);
}

vec3 albedo(float n_dot_v, float perceptual) {
    const float SIDE = 32.0, SCALE = (SIDE - 1.0) / SIDE, OFFSET = 0.5 / SIDE;
    return textureLod(albedos, vec2(n_dot_v, perceptual) * SCALE + OFFSET, 0.0).xyz;
}

vec3 radiance(vec3 direction, float perceptual) {
    return textureLod(surroundings, map_from_view * direction, perceptual * roughest_level).xyz;
}

vec3 irradiance(vec3 normal) {
    vec3 n = map_from_view * normal;
    vec3 sum = diffuse[0];
    sum += diffuse[1] * n.x;
    sum += diffuse[2] * n.y;
    sum += diffuse[3] * n.z;
    sum += diffuse[4] * (n.x * n.y);
    sum += diffuse[5] * (n.y * n.z);
    sum += diffuse[6] * (n.z * n.x);
    sum += diffuse[7] * (n.z * n.z * 3.0 - 1.0);
    sum += diffuse[8] * (n.x * n.x - n.y * n.y);
    return max(sum, 0.0);
}

struct Point {
    vec3 normal, to_eye, diffuse, f0;
    float f90, roughness, occlusion;
    vec3 coat_normal;
    float coat_factor, coat_roughness;
    vec3 sheen_color;
    float sheen_roughness, unfiltered_roughness;
    Grooves grooves;
    float film_factor, film_thickness;
};

Point point_of(vec3 surface) {
    Point p;
    p.to_eye = eye_direction();
    Frame frame = frame_of(p.to_eye);
#ifdef HAS_NORMAL_MAP
    p.normal = mapped_normal(frame);
#else
    p.normal = frame.unit;
#endif
    float metal = metallic, rough = roughness;
    p.occlusion = 1.0;
    p.f0 = vec3(dielectric_f0);
    p.f90 = 1.0;
    p.coat_factor = coat_factor;
    p.coat_roughness = coat_roughness;
    p.sheen_color = sheen_color;
    p.sheen_roughness = sheen_roughness;
    vec3 reflected = specular_color;
    float share = specular_factor;
#ifdef HAS_TEXTURES
    vec4 texel = texture(base_texture, uv), second = texture(heights, uv1);
    metal *= texel.z;
    rough *= texel.y;
    p.occlusion = saturate((second.x - 1.0) * occlusion_strength + 1.0);
    reflected *= second.xyz;
    share *= texel.w;
    p.coat_factor *= second.x;
    p.coat_roughness *= texel.y;
    p.sheen_color *= texel.xyz;
    p.sheen_roughness *= second.w;
#endif
#ifdef HAS_SPECULAR
    p.f0 = min(reflected * dielectric_f0, 1.0) * share;
    p.f90 = share;
#endif
    p.diffuse = surface * (1.0 - metal);
    p.f0 = mix(p.f0, surface, metal);
    p.f90 = mix(p.f90, 1.0, metal);
    p.unfiltered_roughness = saturate(rough);
    p.roughness = filtered(p.unfiltered_roughness, p.normal);
#ifdef HAS_GROOVES
    p.grooves = grooves_of(frame, p.normal);
#endif
    p.film_factor = film_factor;
    p.film_thickness = film_thickness.y;
#ifdef HAS_TEXTURES
    p.film_factor *= texel.x;
    p.film_thickness = second.y * (film_thickness.y - film_thickness.x) + film_thickness.x;
#endif
    p.film_factor = saturate(p.film_factor);
    p.coat_roughness = saturate(p.coat_roughness);
    p.coat_normal = frame.unit;
    return p;
}

// What several lobes need.
struct Shared { float n_dot_v; vec3 single, multiple, diffuse, rest; float below, coat, sheen; };

Shared shared_terms(Point p) {
    Shared s;
    s.n_dot_v = clamp(dot(p.normal, p.to_eye), 1e-4, 1.0);
    s.below = 1.0;
    s.coat = s.sheen = 0.0;
#ifdef HAS_SHEEN
    s.sheen = albedo(s.n_dot_v, p.sheen_roughness).z;
    float strongest = max(max(p.sheen_color.x, p.sheen_color.y), p.sheen_color.z);
    s.below *= 1.0 - strongest * s.sheen;
#endif
#ifdef HAS_COAT
    float cosine = clamp(dot(p.coat_normal, p.to_eye), 1e-4, 1.0);
    s.coat = (schlick(cosine) * (1.0 - COAT_F0) + COAT_F0) * p.coat_factor;
    s.below *= 1.0 - s.coat;
#endif
    vec3 f0 = p.f0;
    float f90 = p.f90;
#ifdef HAS_FILM
    float grazing = schlick(s.n_dot_v);
    vec3 seen = film_fresnel(p.f0, s.n_dot_v, p.film_thickness);
    f0 = mix(f0, clamp((seen - grazing) * (1.0 / (1.0 - grazing)), 0.0, 1.0), p.film_factor);
    f90 = mix(f90, 1.0, p.film_factor);
#endif
#ifdef HAS_GROOVES
    Grooves g = p.grooves;
    vec2 a = alphas(g, max(p.roughness * p.roughness, 0.002));
    float sideways = dot(g.bitangent, p.to_eye) * (a.y / a.x);
    float size = length(vec3(dot(g.tangent, p.to_eye), sideways, s.n_dot_v));
    vec3 of_ggx = albedo(s.n_dot_v / size, sqrt(sqrt((a.x * a.x + a.y * a.y) * 0.5)));
#else
    vec3 of_ggx = albedo(s.n_dot_v, p.roughness);
#endif
    s.single = f0 * of_ggx.x + of_ggx.y * f90;
    float lost = 1.0 - (of_ggx.x + of_ggx.y);
#ifdef HAS_GROOVES
    lost = max(lost - g.strength * 0.045, 0.0);
#endif
    vec3 mean = f0 + (1.0 - f0) * (1.0 / 21.0);
    s.multiple = s.single * mean / (1.0 - mean * lost) * lost;
    s.rest = 1.0 - s.single - s.multiple;
#ifdef HAS_FILM
    s.rest = mix(s.rest, vec3(min(min(s.rest.x, s.rest.y), s.rest.z)), p.film_factor);
#endif
    s.diffuse = p.diffuse * s.rest;
    return s;
}

float specular_occlusion(float n_dot_v, float occlusion, float perceptual) {
    if (!(occlusion < 1.0)) return occlusion;
    float exponent = exp2(perceptual * -16.0 - 1.0);
    return saturate(pow(n_dot_v + occlusion, exponent) - 1.0 + occlusion);
}

vec3 environment_light(Point p, Shared s) {
    vec3 mirrored = reflect(-p.to_eye, p.normal);
    vec3 turned = mirrored;
#ifdef HAS_GROOVES
    vec3 facing = cross(cross(p.grooves.bitangent, p.to_eye), p.grooves.bitangent);
    float kept = 1.0 - p.grooves.strength * (1.0 - p.roughness);
    float squared = kept * kept;
    turned = reflect(-p.to_eye, normalize(mix(facing, p.normal, squared * squared)));
#endif
    vec3 around = radiance(mix(turned, p.normal, p.roughness * p.roughness), p.roughness);
    float seen = specular_occlusion(s.n_dot_v, p.occlusion, p.roughness);
    vec3 spread = irradiance(p.normal) * (s.multiple + s.diffuse) * p.occlusion;
    vec3 sum = around * s.single * seen + spread;
    sum *= s.below;
#ifdef HAS_SHEEN
    sum += radiance(mirrored, max(p.sheen_roughness, 0.5)) * p.sheen_color * (s.sheen * p.occlusion);
#endif
#ifdef HAS_COAT
    sum += radiance(reflect(-p.to_eye, p.coat_normal), p.coat_roughness) * (s.coat * seen);
#endif
    return sum;
}

// The direction towards a light, and its illuminance.
vec3 arriving(Light light, out vec3 illuminance) {
    illuminance = light.color;
    if (light.kind == 0u) return light.place;
    vec3 way = light.place - view;
    if (light.kind == 1u) {
        float far = length(way);
        illuminance *= 1.0 - min(far * light.inverse_reach, 1.0);
        return way / max(far, 1e-18);
    }
    float squared = max(dot(way, way), 1e-12);
    vec3 towards = way / sqrt(squared);
    float share = 1.0 / squared;
    if (light.inverse_reach > 0.0) {
        float reached = squared * (light.inverse_reach * light.inverse_reach);
        share *= saturate(1.0 - reached * reached);
    }
    if (light.has_cone != 0u) {
        float inside = saturate(-dot(towards, light.axis) * light.cone_scale + light.cone_offset);
        share = share * inside * inside;
    }
    illuminance *= share;
    return towards;
}

vec3 punctual_light(Light light, Point p, Shared s) {
    vec3 illuminance;
    vec3 towards = arriving(light, illuminance);
    vec3 middle = normalize(towards + p.to_eye);
    float n_dot_l = dot(p.normal, towards);
    if (!(n_dot_l > 0.0)) return vec3(0.0);
    float v_dot_h = saturate(dot(p.to_eye, middle));
    float lit = max(n_dot_l, 0.0);
    float alpha = max(p.roughness * p.roughness, 0.002);
    vec3 across = cross(p.normal, middle);
    float n_dot_h = saturate(dot(p.normal, middle));
#ifdef HAS_GROOVES
    vec2 a = alphas(p.grooves, alpha);
    float masks = lit * masked_by_grooves(p.grooves, p.to_eye, s.n_dot_v, a)
        + s.n_dot_v * masked_by_grooves(p.grooves, towards, lit, a);
    float lobe = density_of_grooves(p.grooves, middle, n_dot_h, a) * (0.5 / max(masks, 1e-6));
#else
    float lobe = density_ggx(n_dot_h, dot(across, across), alpha)
        * visibility_ggx(lit, s.n_dot_v, alpha);
#endif
    float weight = schlick(v_dot_h);
    vec3 fresnel = p.f0 + (p.f90 - p.f0) * weight;
#ifdef HAS_FILM
    fresnel = mix(fresnel, film_fresnel(p.f0, v_dot_h, p.film_thickness), p.film_factor);
#endif
    vec3 reflectance = ((s.multiple + s.diffuse) * PI_INVERSE + fresnel * lobe) * s.below;
#ifdef HAS_SHEEN
    float fuzzy = max(p.sheen_roughness * p.sheen_roughness, 0.005);
    float visibility = 0.25 / max(lit + s.n_dot_v - lit * s.n_dot_v, 1e-6);
    reflectance += p.sheen_color * (density_sheen(n_dot_h, fuzzy) * visibility);
#endif
    vec3 sum = illuminance * reflectance * lit;
#ifdef HAS_COAT
    float rough = max(p.coat_roughness * p.coat_roughness, 0.002);
    vec3 sideways = cross(p.coat_normal, middle);
    float coat_lit = max(dot(p.coat_normal, towards), 0.0);
    float coat_seen = clamp(dot(p.coat_normal, p.to_eye), 1e-4, 1.0);
    float coat_lobe = density_ggx(saturate(dot(p.coat_normal, middle)), dot(sideways, sideways), rough)
        * visibility_ggx(coat_lit, coat_seen, rough);
    float of_coat = weight * (1.0 - COAT_F0) + COAT_F0;
    sum += illuminance * (coat_lobe * of_coat * p.coat_factor * coat_lit);
#endif
    return sum;
}

vec3 neutral(vec3 light) {
    const float START = 0.8 - 0.04, RANGE = 1.0 - START;
    float least = min(min(light.x, light.y), light.z);
    float toe = least - least * least * 6.25;
    vec3 kept = light - (least < 0.08 ? toe : 0.04);
    float peak = max(max(kept.x, kept.y), kept.z);
    if (peak < START) return kept;
    float compressed = 1.0 - (RANGE * RANGE) / max(peak + (RANGE - START), RANGE);
    float white = 1.0 - 1.0 / ((peak - compressed) * 0.15 + 1.0);
    return mix(kept * (compressed / max(peak, START)), vec3(compressed), white);
}

vec3 agx_curve(vec3 value) {
    const float LEAST = -12.47393, MOST = 4.026069;
    vec3 x = (clamp(log2(max(value, 1e-10)), LEAST, MOST) - LEAST) / (MOST - LEAST);
    vec3 sum = x * 15.5 - 40.14;
    sum = sum * x + 31.96;
    sum = sum * x - 6.868;
    sum = sum * x + 0.4298;
    sum = sum * x + 0.1191;
    return sum * x - 0.00232;
}

vec3 agx(vec3 light) {
    vec3 inset = times(
        vec3(0.84247906, 0.0784336, 0.079223745), vec3(0.042328242, 0.8784686, 0.07916613),
        vec3(0.042375654, 0.0784336, 0.879143), light);
    vec3 curved = times(
        vec3(1.196879, -0.09802088, -0.09902974), vec3(-0.05289685, 1.1519031, -0.09896118),
        vec3(-0.052971635, -0.09804345, 1.1510737), agx_curve(inset));
    return pow(max(curved, 0.0), vec3(2.2));
}

vec3 aces(vec3 light) {
    const float EXPOSURE = 1.0 / 0.6;
    vec3 v = times(
        vec3(0.59719, 0.35458, 0.04823), vec3(0.076, 0.90834, 0.01566),
        vec3(0.0284, 0.13383, 0.83777), light * EXPOSURE);
    vec3 above = v * (v + 0.0245786) - 0.000090537;
    vec3 curved = above / (v * (v * 0.983729 + 0.432951) + 0.238081);
    return clamp(times(
        vec3(1.60475, -0.53108, -0.07367), vec3(-0.10208, 1.10813, -0.00605),
        vec3(-0.00327, -0.07276, 1.07602), curved), 0.0, 1.0);
}

vec3 mapped(vec3 light) {
#if TONE_MAP == 1
    return neutral(light);
#elif TONE_MAP == 2
    return agx(light);
#elif TONE_MAP == 3
    return aces(light);
#else
    return light;
#endif
}

// What is seen where the ray of an index of refraction leaves the body.
vec4 seen_behind(Point p, float ior, float depth) {
    vec3 exit = view;
#ifdef HAS_VOLUME
    exit += normalize(refract(-p.to_eye, p.normal, 1.0 / ior)) * depth;
#endif
    vec4 clip = clip_from_view * vec4(exit, 1.0);
    vec2 at = vec2(clip.x / clip.w * 0.5 + 0.5, clip.y / clip.w * -0.5 + 0.5);
    float blur = min(ior * 2.0 - 2.0, 1.0) * last_level;
    return textureLod(behind, at, p.unfiltered_roughness * blur);
}

// The colour, and the opacity before a transparent background.
vec4 shown(vec3 surface) {
#ifdef UNLIT
    return vec4(surface, 1.0);
#else
    Point p = point_of(surface);
#ifdef TRANSMITS
    float share = transmission, depth = thickness;
#ifdef HAS_TEXTURES
    share *= texture(base_texture, uv).x;
    depth *= texture(heights, uv1).y;
#endif
    vec3 tint = vec3(1.0);
#ifdef HAS_VOLUME
    tint = exp2(absorption * -depth);
    vec4 red = seen_behind(p, iors.x, depth), green = seen_behind(p, iors.y, depth);
    vec4 blue = seen_behind(p, iors.z, depth);
    vec3 from = vec3(red.x, green.y, blue.z), coverage = vec3(red.w, green.w, blue.w);
#else
    vec4 once = seen_behind(p, iors.y, 0.0);
    vec3 from = once.xyz, coverage = vec3(once.w);
#endif
    vec3 passing = p.diffuse * share * tint;
    p.diffuse *= 1.0 - share;
#endif
    Shared s = shared_terms(p);
    vec3 sum = environment_light(p, s);
    for (uint i = 0u; i < light_count; i++) sum += punctual_light(lights[i], p, s);
    vec3 emitted = emissive;
#ifdef HAS_TEXTURES
    emitted *= texture(base_texture, uv).xyz;
#endif
    sum += emitted;
    vec3 light = sum * exposure;
#ifdef TRANSMITS
    passing *= s.rest;
    passing *= s.below;
    vec3 covered = mapped(light + passing * (from / max(coverage, 1e-4)));
    vec3 color = mix(mapped(light), covered, coverage), clear = passing * (1.0 - coverage);
#ifdef CLEAR_BACKGROUND
    float least = min(min(clear.x, clear.y), clear.z);
    color += (clear - least) * 0.8879231;
    float brightest = max(max(color.x, color.y), color.z);
    return vec4(color, saturate(max(1.0 - least, brightest)));
#else
    return vec4(color + background * clear, 1.0);
#endif
#else
    return vec4(mapped(light), 1.0);
#endif
#endif
}

void main() {
    vec4 surface = color * base;
#ifdef HAS_TEXTURES
    surface *= texture(base_texture, uv);
#endif
    vec4 seen = shown(surface.rgb);
#ifdef CUTS_OUT
    if (!(surface.a >= alpha_cutoff)) discard;
#endif
#if defined(IGNORES_ALPHA) || defined(CUTS_OUT)
    surface.a = 1.0;
#endif
#if defined(TRANSMITS) && defined(CLEAR_BACKGROUND)
#ifdef BLENDS
    seen.rgb /= max(seen.a, 1e-6);
#endif
    surface.a *= seen.a;
#endif
    result = vec4(seen.rgb, surface.a);
}
