// Surfaces: light at the fragments (Phong), or at the vertices (Gouraud, flat); one colour, or a
// texture with vertex colours.

override HAS_TEXTURE: bool = false;
override HAS_BUMPS: bool = false;
override IGNORES_ALPHA: bool = false;
override CUTS_OUT: bool = false;

struct AtFragment {
    @builtin(position) at: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
}

struct AtVertex {
    @builtin(position) at: vec4f,
    @location(0) front: vec3f,
    @location(1) front_added: vec3f,
    @location(2) back: vec3f,
    @location(3) back_added: vec3f,
    @location(4) uv: vec2f,
    @location(5) color: vec4f,
}

fn toward_fragments(position: vec3f, normal: vec3f, uv: vec2f, color: vec4f) -> AtFragment {
    let at = vec4f(position, 1.0);
    let view = (scene.view_from_unit * at).xyz;
    return AtFragment(scene.clip_from_unit * at, view, scene.view_from_normal * normal, uv, color);
}

@vertex
fn plain_for_fragments(@location(0) position: vec3f, @location(1) normal: vec3f) -> AtFragment {
    return toward_fragments(position, normal, vec2f(), vec4f());
}

@vertex
fn painted_for_fragments(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
) -> AtFragment {
    return toward_fragments(position, normal, uv, color);
}

fn lit(position: vec3f, normal: vec3f, lit_at: vec3f, uv: vec2f, color: vec4f) -> AtVertex {
    let view = (scene.view_from_unit * vec4f(lit_at, 1.0)).xyz;
    var to_eye = eye_direction(view);
    if VIEWER_AT_INFINITY { to_eye = vec3f(0.0, 0.0, 1.0); }
    let n = shading_normal(scene.view_from_normal * normal, to_eye, true);
    let front = light_at(view, n, to_eye);
    let back = light_at(view, -n, to_eye);
    let clip = scene.clip_from_unit * vec4f(position, 1.0);
    return AtVertex(clip, front.diffuse, front.added, back.diffuse, back.added, uv, color);
}

@vertex
fn plain_for_vertices(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) lit_at: vec3f,
) -> AtVertex {
    return lit(position, normal, lit_at, vec2f(), vec4f());
}

@vertex
fn painted_for_vertices(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) lit_at: vec3f,
    @location(3) uv: vec2f,
    @location(4) color: vec4f,
) -> AtVertex {
    return lit(position, normal, lit_at, uv, color);
}

fn painted(uv: vec2f, color: vec4f) -> vec4f {
    var base = color * scene.base_color;
    if HAS_TEXTURE { base *= textureSample(base_texture, repeating, uv); }
    if IGNORES_ALPHA { base.a = 1.0; }
    return base;
}

fn raised(uv: vec2f, uv_x: vec2f, uv_y: vec2f) -> f32 {
    let texel = textureSampleGrad(heights, repeating, uv, uv_x, uv_y);
    return (texel.r + texel.g + texel.b) * (1.0 / 3.0);
}

// A normal bent by the texture of heights (Blinn 1978, Mikkelsen 2010).
fn bent(normal: vec3f, view: vec3f, uv: vec2f, front_facing: bool) -> vec3f {
    let uv_x = dpdx(uv);
    let uv_y = dpdy(uv);
    let here = raised(uv, uv_x, uv_y);
    let rise_x = raised(uv + uv_x, uv_x, uv_y) - here;
    let rise_y = raised(uv + uv_y, uv_x, uv_y) - here;
    let step_x = dpdx(view);
    let step_y = dpdy(view);
    let r1 = cross(step_y, normal);
    let r2 = cross(normal, step_x);
    let det = dot(step_x, r1);
    let area_uv = abs(uv_x.x * uv_y.y - uv_x.y * uv_y.x);
    let above = 1.0 / (sqrt(abs(det)) * sqrt(area_uv)) * scene.bump_height;
    let height = select(-above, above, front_facing);
    let signed = select(height, -height, det < 0.0);
    let n = normal - (r1 * rise_x + r2 * rise_y) * signed;
    let size = length(n);
    return select(normal, n / size, size > 0.0 && size <= 3.4028234e38);
}

fn lit_here(base: vec3f, in: AtFragment, front_facing: bool) -> vec3f {
    let to_eye = eye_direction(in.view);
    var normal = shading_normal(in.normal, to_eye, front_facing);
    if HAS_BUMPS { normal = bent(normal, in.view, in.uv, front_facing); }
    return written(reflected(base, light_at(in.view, normal, to_eye)), in.at);
}

fn lit_before(base: vec3f, in: AtVertex, front_facing: bool) -> vec3f {
    let light = Light(
        select(in.back, in.front, front_facing),
        select(in.back_added, in.front_added, front_facing),
    );
    return written(reflected(base, light), in.at);
}

@fragment
fn plain_at_fragments(in: AtFragment, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(lit_here(scene.base_color.rgb, in, front), scene.base_color.a);
}

@fragment
fn plain_at_vertices(in: AtVertex, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(lit_before(scene.base_color.rgb, in, front), scene.base_color.a);
}

@fragment
fn painted_at_fragments(in: AtFragment, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = painted(in.uv, in.color);
    let color = lit_here(base.rgb, in, front);
    if CUTS_OUT && base.a < 0.5 { discard; }
    return vec4f(color, select(base.a, 1.0, CUTS_OUT));
}

@fragment
fn painted_at_vertices(in: AtVertex, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = painted(in.uv, in.color);
    if CUTS_OUT && base.a < 0.5 { discard; }
    let alpha = select(base.a, 1.0, CUTS_OUT);
    return vec4f(lit_before(base.rgb, in, front), alpha);
}

struct Weighted { @location(0) sum: vec4f, @location(1) revealage: vec4f }

@fragment
fn weighted(in: AtFragment, @builtin(front_facing) front: bool) -> Weighted {
    let base = painted(in.uv, in.color);
    let color = saturate(lit_here(base.rgb, in, front));
    let alpha = saturate(base.a);
    let near = 1.0 - in.at.z;
    let scale = alpha * (alpha * max(near * near * near * 3e3, 1e-2));
    return Weighted(vec4f(color * scale, scale), vec4f(alpha, alpha, alpha, 1.0));
}
