layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_corner;
uniform mat4 clip_from_unit;
out vec3 corner;

void main() {
    gl_Position = clip_from_unit * vec4(position, 1.0);
    corner = vertex_corner;
}
