// A shader for `estampe render MODEL -o OUT.png --shader FILE`.
//
// Uniforms get their values by these names, in any uniform block; all others are zeros, but for
// those that --set gives a value. Model space has the model's box between -1 and 1, and Y up.
struct Frame {
    clip_from_model: mat4x4f,
    view_from_model: mat4x4f,  // the camera is at 0 and looks down -z
    view_from_normal: mat4x4f,
    base_color: vec4f,         // of the material, linear
    light: vec3f,              // the unit direction towards the light, in view space
    eye: vec3f,                // the camera, in model space
    time: f32,                 // --time, in seconds
    resolution: vec2f,         // the picture's size in pixels
    gloss: f32,                // for example --set gloss=0.5
}
@group(0) @binding(0) var<uniform> frame: Frame;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,    // zeros if the model has none
    @location(3) color: vec4f, // white if the model has none
}

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f, // in view space
    @location(1) normal: vec3f,   // in view space
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
}

@vertex
fn vertex(in: Vertex) -> Surface {
    var out: Surface;
    out.clip = frame.clip_from_model * vec4f(in.position, 1.0);
    out.position = (frame.view_from_model * vec4f(in.position, 1.0)).xyz;
    out.normal = (frame.view_from_normal * vec4f(in.normal, 0.0)).xyz;
    out.uv = in.uv;
    out.color = in.color * frame.base_color;
    return out;
}

// The colour is linear; it is stored as sRGB.
@fragment
fn fragment(in: Surface, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let n = normalize(select(-in.normal, in.normal, is_front));
    let v = normalize(-in.position);
    let h = normalize(frame.light + v);
    let diffuse = max(dot(n, frame.light), 0.0);
    let highlight = frame.gloss * pow(max(dot(n, h), 0.0), 60.0);
    let rim = 0.25 * pow(1.0 - max(dot(n, v), 0.0), 3.0);
    let color = in.color.rgb * (0.15 + 0.85 * diffuse) + highlight + rim;
    return vec4f(color, 1.0);
}
