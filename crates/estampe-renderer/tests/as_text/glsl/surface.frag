// Surfaces: one colour, or a texture with vertex colours.

#ifdef AT_VERTICES
in vec3 front, front_added, back, back_added;
#else
in vec3 view, view_normal;
#endif
#ifdef PAINTED
in vec2 uv;
in vec4 color;
#endif
layout(location = 0) out vec4 result;
#ifdef WEIGHTED
layout(location = 1) out vec4 revealage;
#endif
#ifdef HAS_TEXTURE
uniform sampler2D base_texture;
#endif
#ifdef HAS_BUMPS
uniform sampler2D heights;

float raised(vec2 at, vec2 uv_x, vec2 uv_y) {
    vec4 texel = textureGrad(heights, at, uv_x, uv_y);
    return (texel.r + texel.g + texel.b) * (1.0 / 3.0);
}

// A normal bent by the texture of heights (Blinn 1978, Mikkelsen 2010).
vec3 bent(vec3 normal) {
    vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
    float here = raised(uv, uv_x, uv_y);
    float rise_x = raised(uv + uv_x, uv_x, uv_y) - here;
    float rise_y = raised(uv + uv_y, uv_x, uv_y) - here;
    vec3 step_x = dFdx(view), step_y = dFdy(view);
    vec3 r1 = cross(step_y, normal), r2 = cross(normal, step_x);
    float det = dot(step_x, r1);
    float area_uv = abs(uv_x.x * uv_y.y - uv_x.y * uv_y.x);
    float above = 1.0 / (sqrt(abs(det)) * sqrt(area_uv)) * bump_height;
    float height = gl_FrontFacing ? above : -above;
    vec3 n = normal - (r1 * rise_x + r2 * rise_y) * (det < 0.0 ? -height : height);
    float size = length(n);
    return size > 0.0 && !isinf(size) ? n / size : normal;
}
#endif

// What is written of a lit colour: in levels, behind fog.
vec3 written(vec3 lit) {
#ifdef COLOR_LEVELS
    lit = vec3(
        stepped(lit.r, COLOR_LEVELS), stepped(lit.g, COLOR_LEVELS), stepped(lit.b, COLOR_LEVELS));
#endif
#ifdef FOG
    vec4 at = gl_FragCoord;
#ifdef ORTHOGRAPHIC
    float far = at.z * fog_depth.x + fog_depth.y;
#else
    vec3 ray = vec3(
        at.x * fog_ray_x.x + fog_ray_x.y, at.y * fog_ray_y.x + fog_ray_y.y, 1.0);
    float far = length(ray) / at.w;
#endif
    lit = mix(lit, fog_color, saturate((far - fog_start) * fog_per_distance));
#endif
    return lit;
}

void main() {
    vec4 base = base_color;
#ifdef PAINTED
    base = color * base_color;
#ifdef HAS_TEXTURE
    base *= texture(base_texture, uv);
#endif
#ifdef IGNORES_ALPHA
    base.a = 1.0;
#endif
#endif
#ifdef AT_VERTICES
    Light light = gl_FrontFacing ? Light(front, front_added) : Light(back, back_added);
#else
    vec3 to_eye = eye_direction(view);
    vec3 normal = shading_normal(view_normal, to_eye, gl_FrontFacing);
#ifdef HAS_BUMPS
    normal = bent(normal);
#endif
    Light light = light_at(view, normal, to_eye);
#endif
    result = vec4(written(reflected(base.rgb, light)), base.a);
#ifdef CUTS_OUT
    if (base.a < 0.5) discard;
    result.a = 1.0;
#endif
#ifdef WEIGHTED
    vec4 drawn = clamp(result, 0.0, 1.0);
    float near = 1.0 - gl_FragCoord.z;
    float scale = drawn.a * (drawn.a * max(near * near * near * 3e3, 1e-2));
    result = vec4(drawn.rgb * scale, scale);
    revealage = vec4(vec3(drawn.a), 1.0);
#endif
}
