in vec3 faded;
uniform vec3 fog_color;
uniform float fog_start, fog_per_distance;
uniform vec2 fog_ray_x, fog_ray_y;
out vec4 result;

void main() {
    vec3 lit = faded;
#ifdef FOG
    vec4 at = gl_FragCoord;
    float x = at.x * fog_ray_x.x + fog_ray_x.y;
    float y = at.y * fog_ray_y.x + fog_ray_y.y;
    float far = length(vec3(x, y, 1.0)) / at.w;
    lit = mix(lit, fog_color, clamp((far - fog_start) * fog_per_distance, 0.0, 1.0));
#endif
    result = vec4(lit, 1.0);
}
