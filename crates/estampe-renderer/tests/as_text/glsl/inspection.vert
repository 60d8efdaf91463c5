// Normals, depth, texture coordinates, faces, barycentric coordinates and overdraw as colours.

layout(location = 0) in vec3 position;
uniform mat4 clip_from_unit, view_from_unit;
#if defined(NORMALS)
layout(location = 1) in vec3 normal;
uniform mat3 view_from_normal;
out vec3 view, view_normal;
#elif defined(DEPTH)
uniform float nearest, furthest;
out float grey;
#elif defined(UV)
layout(location = 1) in vec2 vertex_uv;
out vec2 uv;
#elif defined(FACES)
layout(location = 1) in vec3 vertex_face;
flat out vec3 face;
#elif defined(BARYCENTRIC)
layout(location = 1) in vec3 vertex_corner;
out vec3 corner;
#endif

void main() {
    gl_Position = clip_from_unit * vec4(position, 1.0);
#if defined(NORMALS)
    view = (view_from_unit * vec4(position, 1.0)).xyz;
    view_normal = view_from_normal * normal;
#elif defined(DEPTH)
    float far = -(view_from_unit * vec4(position, 1.0)).z;
    grey = (furthest - far) / (furthest - nearest);
#elif defined(UV)
    uv = vertex_uv;
#elif defined(FACES)
    face = vertex_face;
#elif defined(BARYCENTRIC)
    corner = vertex_corner;
#endif
}
