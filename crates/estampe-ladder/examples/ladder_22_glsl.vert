#version 330 core
layout (location = 0) in vec3 vertex_position;
layout (location = 1) in vec3 vertex_normal;
layout (location = 2) in vec3 vertex_color;

// What each fragment gets, interpolated: position and normal in world space.
out struct fragment_data { vec3 position; vec3 normal; vec3 color; } fragment;

uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;

void main() {
    vec4 position = model * vec4(vertex_position, 1.0);
    // Normals stay perpendicular to the surface by the inverse transpose alone.
    mat4 modelNormal = transpose(inverse(model));
    vec4 normal = modelNormal * vec4(vertex_normal, 0.0);
    fragment.position = position.xyz;
    fragment.normal = normal.xyz;
    fragment.color = vertex_color;
    gl_Position = projection * view * position;
}
