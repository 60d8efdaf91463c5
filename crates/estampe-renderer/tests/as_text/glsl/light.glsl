// What all surfaces share: uniforms, the sum of the light, steps and fog.

struct Directional { vec3 towards; float highlight; vec3 color; };
struct Positional { vec3 position; float inverse_reach; vec3 color; float highlight; };

uniform mat4 clip_from_unit, view_from_unit;
uniform mat3 view_from_normal;
uniform Directional directional[3];
uniform Positional positional[2];
uniform uint directional_count, positional_count;
uniform vec3 sky, ground, specular, emissive;
uniform vec4 base_color;
uniform vec3 fog_color;
uniform float fog_start, fog_per_distance;
uniform vec2 fog_ray_x, fog_ray_y, fog_depth;
uniform float bump_height;

struct Light { vec3 diffuse; vec3 added; };

float saturate(float value) { return clamp(value, 0.0, 1.0); }

vec3 eye_direction(vec3 view) {
#ifdef ORTHOGRAPHIC
    return vec3(0.0, 0.0, 1.0);
#else
    return normalize(-view);
#endif
}

// The normal on the side that is seen; towards the eye if the vertices have none.
vec3 shading_normal(vec3 normal, vec3 to_eye, bool front_facing) {
    float squared = dot(normal, normal);
    if (!(squared > 1e-12)) return to_eye;
    float scale = 1.0 / sqrt(squared);
    return normal * (front_facing ? scale : -scale);
}

float stepped(float value, float levels) {
    return min(floor(max(value, 0.0) * levels), levels - 1.0) / (levels - 1.0);
}

float luminance(vec3 color) {
    return color.r * 0.2126 + color.g * 0.7152 + color.b * 0.0722;
}

// A power by products: `pow` does so with constants up to 64.
float power(float base, uint exponent) {
    float result = 1.0, square = base;
    for (uint left = exponent; left != 0u; left >>= 1u) {
        if ((left & 1u) == 1u) result *= square;
        square *= square;
    }
    return result;
}

float highlight(vec3 towards, vec3 normal, vec3 to_eye) {
#ifdef HALF_VECTOR
    float cosine = dot(normal, normalize(towards + to_eye));
#else
    float cosine = dot(-reflect(to_eye, normal), towards);
#endif
#ifndef BY_POW
    if (SHININESS > 64.0) return power(saturate(cosine), uint(SHININESS));
#endif
    return pow(saturate(cosine), SHININESS);
}

void add(inout Light light, vec3 color, float strength, vec3 towards, vec3 normal, vec3 to_eye) {
    float n_dot_l = max(dot(normal, towards), 0.0);
    light.diffuse += color * n_dot_l;
    if (strength > 0.0 && specular != vec3(0.0)) {
        float lit = n_dot_l > 0.0 ? highlight(towards, normal, to_eye) * strength : 0.0;
        light.added += color * specular * lit;
    }
}

// Light from a point: the direction towards it, and the share that arrives.
vec4 arriving(Positional light, vec3 position) {
    vec3 way = light.position - position;
    float far = length(way);
    return vec4(way / max(far, 1e-18), 1.0 - min(far * light.inverse_reach, 1.0));
}

Light light_at(vec3 position, vec3 normal, vec3 to_eye) {
#if defined(UNLIT)
    return Light(vec3(1.0), emissive);
#elif defined(TOON_LEVELS)
    float sum = 0.0;
    for (uint i = 0u; i < directional_count; i++) {
        Directional light = directional[i];
        sum += max(dot(normal, light.towards), 0.0) * luminance(light.color);
    }
    for (uint i = 0u; i < positional_count; i++) {
        Positional light = positional[i];
        vec4 arrives = arriving(light, position);
        sum += max(dot(normal, arrives.xyz), 0.0) * luminance(light.color) * arrives.w;
    }
    return Light(vec3(saturate(sum)), emissive);
#else
    float upward = normal.y * 0.5 + 0.5;
    Light sum = Light(mix(ground, sky, upward), emissive);
    for (uint i = 0u; i < directional_count; i++) {
        Directional light = directional[i];
        add(sum, light.color, light.highlight, light.towards, normal, to_eye);
    }
    for (uint i = 0u; i < positional_count; i++) {
        Positional light = positional[i];
        vec4 arrives = arriving(light, position);
        add(sum, light.color * arrives.w, light.highlight, arrives.xyz, normal, to_eye);
    }
    return sum;
#endif
}

vec3 reflected(vec3 base, Light light) {
#ifdef TOON_LEVELS
    return base * (stepped(light.diffuse.x, TOON_LEVELS) * (1.0 - 0.3) + 0.3) + light.added;
#else
    return base * light.diffuse + light.added;
#endif
}
