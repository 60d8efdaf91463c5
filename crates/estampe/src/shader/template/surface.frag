#version 330 core
// A fragment shader for `estampe render MODEL -o OUT.png --shader FILE`.
//
// Inputs get their values by these names, and uniforms by those. Other uniforms are zeros, but for
// those that --set gives a value. Model space has the model's box between -1 and 1, and Y up.
in vec3 position;      // in model space
in vec3 normal;        // in view space, in which the camera is at 0 and looks down -z
in vec2 uv;            // zeros if the model has none
in vec4 color;         // the vertex colour times that of the material, linear
in vec3 view_position; // in view space

uniform vec3 light;      // the unit direction towards the light, in view space
uniform float time;      // --time, in seconds
uniform float gloss;     // for example --set gloss=0.5

// The colour is linear; it is stored as sRGB.
out vec4 result;

void main() {
    vec3 n = normalize(gl_FrontFacing ? normal : -normal);
    vec3 v = normalize(-view_position);
    vec3 h = normalize(light + v);
    float diffuse = max(dot(n, light), 0.0);
    float highlight = gloss * pow(max(dot(n, h), 0.0), 60.0);
    float bands = 0.5 + 0.5 * sin(20.0 * position.y + time);
    vec3 base = mix(color.rgb, vec3(0.8, 0.3, 0.1), 0.6 * bands);
    result = vec4(base * (0.15 + 0.85 * diffuse) + highlight, 1.0);
}
