// Points and lines: vertex colours without light, fading with the distance, in fog.

struct Cue {
    clip_from_unit: mat4x4f,
    view_from_unit: mat4x4f,
    color: vec3f,
    distant_color: vec3f,
    share_at_furthest: f32,
    nearest: f32,
    furthest: f32,
    fog_start: f32,
    fog_per_distance: f32,
    fog_color: vec3f,
    fog_ray_x: vec2f,
    fog_ray_y: vec2f,
}
@group(0) @binding(0) var<uniform> scene: Cue;
override FOG: bool = false;

struct Colored { @builtin(position) at: vec4f, @location(0) color: vec3f }

@vertex fn vertex(@location(0) position: vec3f, @location(1) color: vec4f) -> Colored {
    let distance = -(scene.view_from_unit * vec4f(position, 1.0)).z;
    let depth = saturate((distance - scene.nearest) / (scene.furthest - scene.nearest));
    let faded = mix(color.rgb * scene.color, scene.distant_color, depth * scene.share_at_furthest);
    return Colored(scene.clip_from_unit * vec4f(position, 1.0), faded);
}

@fragment fn points_and_lines(in: Colored) -> @location(0) vec4f {
    if !FOG { return vec4f(in.color, 1.0); }
    let x = in.at.x * scene.fog_ray_x.x + scene.fog_ray_x.y;
    let y = in.at.y * scene.fog_ray_y.x + scene.fog_ray_y.y;
    let distance = length(vec3f(x, y, 1.0)) / in.at.w;
    let share = saturate((distance - scene.fog_start) * scene.fog_per_distance);
    return vec4f(mix(in.color, scene.fog_color, share), 1.0);
}
