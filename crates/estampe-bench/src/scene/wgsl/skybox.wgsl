// `skybox`: a ground in haze, spheres that reflect a cube map, and the sky behind them.

struct Camera {
    clip_from_world: mat4x4f,
    eye: vec4f,
    // View rays: at (x, y) of the screen, x · right + y · up + forward.
    right: vec4f,
    up: vec4f,
    forward: vec4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var filtered: sampler;
@group(0) @binding(2) var ground_map: texture_2d<f32>;
@group(0) @binding(2) var sky_map: texture_cube<f32>;

const horizon = vec3f(0.62, 0.70, 0.80);

struct GroundVaryings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
}

@vertex
fn ground_vertex(@location(0) position: vec3f) -> GroundVaryings {
    return GroundVaryings(camera.clip_from_world * vec4f(position, 1.0), position);
}

@fragment
fn ground_fragment(in: GroundVaryings) -> @location(0) vec4f {
    let color = textureSample(ground_map, filtered, in.world.xz * 0.5).rgb * 0.5 + 0.2;
    let haze = 1.0 - exp2(-distance(in.world, camera.eye.xyz) / 12.0);
    return vec4f(mix(color, horizon, haze), 1.0);
}

struct SphereVaryings {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec3f,
}

@vertex
fn sphere_vertex(
    @location(0) position: vec3f,
    @location(1) center_and_radius: vec4f,
    @location(2) color: vec4f,
) -> SphereVaryings {
    let world = center_and_radius.xyz + position * center_and_radius.w;
    return SphereVaryings(camera.clip_from_world * vec4f(world, 1.0), world, position, color.rgb);
}

@fragment
fn sphere_fragment(in: SphereVaryings) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    let to_eye = normalize(camera.eye.xyz - in.world);
    let facing = max(dot(normal, to_eye), 0.0);
    let reflected = normal * (2.0 * dot(normal, to_eye)) - to_eye;
    let mirrored = textureSample(sky_map, filtered, reflected).rgb;
    // Schlick's approximation: white at grazing angles.
    let grazing = 1.0 - facing;
    let squared = grazing * grazing;
    return vec4f(mirrored * mix(in.color, vec3f(1.0), squared * squared * grazing), 1.0);
}

struct SkyVaryings {
    @builtin(position) position: vec4f,
    @location(0) ray: vec3f,
}

@vertex
fn sky_vertex(@builtin(vertex_index) corner: u32) -> SkyVaryings {
    let at = vec2f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0);
    let ray = camera.right.xyz * at.x + camera.up.xyz * at.y + camera.forward.xyz;
    return SkyVaryings(vec4f(at, 1.0, 1.0), ray);
}

@fragment
fn sky_fragment(in: SkyVaryings) -> @location(0) vec4f {
    return textureSample(sky_map, filtered, in.ray);
}
