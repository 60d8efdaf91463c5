// Physically based surfaces.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 vertex_uv;
layout(location = 4) in vec2 vertex_uv1;
layout(location = 5) in vec4 vertex_color;
uniform mat4 clip_from_unit, view_from_unit;
uniform mat3 view_from_normal;
out vec3 view, view_normal;
out vec4 view_tangent;
out vec2 uv, uv1;
out vec4 color;

void main() {
    view = (view_from_unit * vec4(position, 1.0)).xyz;
    view_normal = view_from_normal * normal;
    view_tangent = vec4(view_from_normal * tangent.xyz, tangent.w);
    uv = vertex_uv;
    uv1 = vertex_uv1;
    color = vertex_color;
    gl_Position = clip_from_unit * vec4(position, 1.0);
}
