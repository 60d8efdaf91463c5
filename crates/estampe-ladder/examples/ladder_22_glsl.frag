#version 330 core
in struct fragment_data { vec3 position; vec3 normal; vec3 color; } fragment;

uniform vec3 light_position;
uniform vec3 light_color;
uniform vec3 eye_position;
uniform float a_ambient, a_diffuse, a_specular;

layout(location=0) out vec4 FragColor;

// The vertex shader has them too: a uniform that both declare is one.
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;

void main() {
    vec3 N = normalize(fragment.normal);
    vec3 L = normalize(light_position - fragment.position);
    float diffuse_magnitude = max(dot(N, L), 0.0);
    // Phong (1975): r = 2(l·n)n − l, and no highlight where n·l ≤ 0.
    vec3 V = normalize(eye_position - fragment.position);
    vec3 R = reflect(-L, N);
    float specular_magnitude = 0.0;
    if (diffuse_magnitude > 0.0) {
        specular_magnitude = pow(max(dot(R, V), 0.0), 64.0);
    }
    vec3 c = a_ambient * fragment.color * light_color;
    c = c + a_diffuse * diffuse_magnitude * fragment.color * light_color;
    c = c + a_specular * specular_magnitude * light_color;
    FragColor = vec4(c, 1.0);
}
