// Edges as distances in pixels, over faces that hide the edges behind them.

in vec3 corner;
uniform vec4 line, face;
uniform float half_width_px;
out vec4 result;

float gradient(float value) { return max(length(vec2(dFdx(value), dFdy(value))), 1e-6); }

void main() {
    vec3 rates = vec3(gradient(corner.x), gradient(corner.y), gradient(corner.z));
    vec3 distances = corner / rates;
    float nearest = min(min(distances.x, distances.y), distances.z);
    float coverage = clamp(half_width_px + 0.5 - nearest, 0.0, 1.0);
    // |∇a × ∇b| = 1 ÷ 2·area: edges of small triangles fade.
    float area = abs(dFdx(corner.x) * dFdy(corner.y) - dFdy(corner.x) * dFdx(corner.y));
    float side_px = sqrt(1.0 / max(area, 1e-9));
    float strength = clamp(side_px * (1.0 / 11.0) + 0.18, 0.0, 1.0);
    result = mix(face, vec4(line.rgb, 1.0), coverage * strength * line.a);
}
