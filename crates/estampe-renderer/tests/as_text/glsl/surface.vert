// Surfaces: light at the fragments (Phong), or at the vertices (Gouraud, flat).

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef AT_VERTICES
#define LIT_AT 1
layout(location = 2) in vec3 lit_at;
out vec3 front, front_added, back, back_added;
#else
#define LIT_AT 0
out vec3 view, view_normal;
#endif
#ifdef PAINTED
layout(location = 2 + LIT_AT) in vec2 vertex_uv;
layout(location = 3 + LIT_AT) in vec4 vertex_color;
out vec2 uv;
out vec4 color;
#endif

void main() {
#ifdef AT_VERTICES
    vec3 view = (view_from_unit * vec4(lit_at, 1.0)).xyz;
#ifdef VIEWER_AT_INFINITY
    vec3 to_eye = vec3(0.0, 0.0, 1.0);
#else
    vec3 to_eye = eye_direction(view);
#endif
    vec3 n = shading_normal(view_from_normal * normal, to_eye, true);
    Light of_front = light_at(view, n, to_eye);
    Light of_back = light_at(view, -n, to_eye);
    front = of_front.diffuse;
    front_added = of_front.added;
    back = of_back.diffuse;
    back_added = of_back.added;
#else
    view = (view_from_unit * vec4(position, 1.0)).xyz;
    view_normal = view_from_normal * normal;
#endif
#ifdef PAINTED
    uv = vertex_uv;
    color = vertex_color;
#endif
    gl_Position = clip_from_unit * vec4(position, 1.0);
}
