// Normals, depth, texture coordinates, faces, barycentric coordinates and overdraw as colours.

#if defined(NORMALS)
in vec3 view, view_normal;
#elif defined(DEPTH)
in float grey;
#elif defined(UV)
in vec2 uv;
#elif defined(FACES)
flat in vec3 face;
#elif defined(BARYCENTRIC)
in vec3 corner;
#endif
out vec4 result;

float wrapped(float value) {
    return value >= 0.0 && value <= 1.0 ? value : fract(value);
}

void main() {
#if defined(NORMALS)
#ifdef ORTHOGRAPHIC
    vec3 normal = vec3(0.0, 0.0, 1.0);
#else
    vec3 normal = normalize(-view);
#endif
    float squared = dot(view_normal, view_normal);
    if (squared > 1e-12) {
        float scale = 1.0 / sqrt(squared);
        normal = view_normal * (gl_FrontFacing ? scale : -scale);
    }
    result = vec4(normal * 0.5 + 0.5, 1.0);
#elif defined(DEPTH)
    result = vec4(vec3(clamp(grey, 0.0, 1.0)), 1.0);
#elif defined(UV)
    result = vec4(wrapped(uv.x), wrapped(uv.y), 0.0, 1.0);
#elif defined(FACES)
    result = vec4(face, 1.0);
#elif defined(BARYCENTRIC)
    result = vec4(corner, 1.0);
#else
    result = vec4(32.0 / 255.0, 8.0 / 255.0, 1.0 / 255.0, 1.0);
#endif
}
