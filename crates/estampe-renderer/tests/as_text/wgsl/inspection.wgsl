// Normals, depth, texture coordinates, faces, barycentric coordinates and overdraw as colours.

struct View {
    clip_from_unit: mat4x4f,
    view_from_unit: mat4x4f,
    view_from_normal: mat3x3f,
    nearest: f32,
    furthest: f32,
}
@group(0) @binding(0) var<uniform> scene: View;
override ORTHOGRAPHIC: bool = false;

struct Vector { @builtin(position) at: vec4f, @location(0) value: vec3f }
struct Seen { @builtin(position) at: vec4f, @location(0) view: vec3f, @location(1) normal: vec3f }
struct Number { @builtin(position) at: vec4f, @location(0) value: f32 }
struct Face { @builtin(position) at: vec4f, @location(0) @interpolate(flat) value: vec3f }
struct Uv { @builtin(position) at: vec4f, @location(0) value: vec2f }

fn clip(position: vec3f) -> vec4f { return scene.clip_from_unit * vec4f(position, 1.0); }
fn view(position: vec3f) -> vec3f { return (scene.view_from_unit * vec4f(position, 1.0)).xyz; }

@vertex fn seen(@location(0) position: vec3f, @location(1) normal: vec3f) -> Seen {
    return Seen(clip(position), view(position), scene.view_from_normal * normal);
}
@fragment fn normals(in: Seen, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    var normal = normalize(-in.view);
    if ORTHOGRAPHIC { normal = vec3f(0.0, 0.0, 1.0); }
    let squared = dot(in.normal, in.normal);
    if squared > 1e-12 {
        let scale = 1.0 / sqrt(squared);
        normal = in.normal * select(-scale, scale, front_facing);
    }
    return vec4f(normal * 0.5 + 0.5, 1.0);
}

@vertex fn far(@location(0) position: vec3f) -> Number {
    let distance = -view(position).z;
    return Number(clip(position), (scene.furthest - distance) / (scene.furthest - scene.nearest));
}
@fragment fn depth(in: Number) -> @location(0) vec4f {
    return vec4f(vec3f(saturate(in.value)), 1.0);
}

@vertex fn with_uv(@location(0) position: vec3f, @location(1) uv: vec2f) -> Uv {
    return Uv(clip(position), uv);
}
fn wrapped(value: f32) -> f32 {
    return select(fract(value), value, value >= 0.0 && value <= 1.0);
}
@fragment fn uv(in: Uv) -> @location(0) vec4f {
    return vec4f(wrapped(in.value.x), wrapped(in.value.y), 0.0, 1.0);
}

@vertex fn with_face(@location(0) position: vec3f, @location(1) face: vec3f) -> Face {
    return Face(clip(position), face);
}
@fragment fn faces(in: Face) -> @location(0) vec4f { return vec4f(in.value, 1.0); }

@vertex fn with_corner(@location(0) position: vec3f, @location(1) corner: vec3f) -> Vector {
    return Vector(clip(position), corner);
}
@fragment fn barycentric(in: Vector) -> @location(0) vec4f { return vec4f(in.value, 1.0); }

@vertex fn alone(@location(0) position: vec3f) -> @builtin(position) vec4f { return clip(position); }
@fragment fn overdraw() -> @location(0) vec4f {
    return vec4f(32.0 / 255.0, 8.0 / 255.0, 1.0 / 255.0, 1.0);
}
