// Edges as distances in pixels, over faces that hide the edges behind them.

struct Wires { clip_from_unit: mat4x4f, line: vec4f, face: vec4f, half_width_px: f32 }
@group(0) @binding(0) var<uniform> scene: Wires;

struct Corner { @builtin(position) at: vec4f, @location(0) corner: vec3f }

@vertex fn vertex(@location(0) position: vec3f, @location(1) corner: vec3f) -> Corner {
    return Corner(scene.clip_from_unit * vec4f(position, 1.0), corner);
}

fn gradient(value: f32) -> f32 { return max(length(vec2f(dpdx(value), dpdy(value))), 1e-6); }

@fragment fn wireframe(in: Corner) -> @location(0) vec4f {
    let corner = in.corner;
    let rates = vec3f(gradient(corner.x), gradient(corner.y), gradient(corner.z));
    let distances = corner / rates;
    let distance = min(min(distances.x, distances.y), distances.z);
    let coverage = saturate(scene.half_width_px + 0.5 - distance);
    // |∇a × ∇b| = 1 ÷ 2·area: edges of small triangles fade.
    let area = abs(dpdx(corner.x) * dpdy(corner.y) - dpdy(corner.x) * dpdx(corner.y));
    let side_px = sqrt(1.0 / max(area, 1e-9));
    let strength = saturate(side_px * (1.0 / 11.0) + 0.18);
    return mix(scene.face, vec4f(scene.line.rgb, 1.0), coverage * strength * scene.line.a);
}
