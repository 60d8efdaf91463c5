// Points and lines: vertex colours without light, fading with the distance.

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 vertex_color;
uniform mat4 clip_from_unit, view_from_unit;
uniform vec3 color, distant_color;
uniform float share_at_furthest, nearest, furthest, point_size_px;
out vec3 faded;

void main() {
    float far = -(view_from_unit * vec4(position, 1.0)).z;
    float depth = clamp((far - nearest) / (furthest - nearest), 0.0, 1.0);
    faded = mix(vertex_color.rgb * color, distant_color, depth * share_at_furthest);
    gl_Position = clip_from_unit * vec4(position, 1.0);
    gl_PointSize = point_size_px;
}
