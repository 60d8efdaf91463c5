@group(0) @binding(0) var picture: texture_storage_2d<rgba8unorm, write>;

const most = 256u;

@compute @workgroup_size(8, 8)
fn iterate(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(picture);
    if any(id.xy >= size) {
        return;
    }
    let pixel = 3.25 / f32(size.x);
    let real = -2.25 + (f32(id.x) + 0.5) * pixel;
    let imaginary = (f32(size.y) * 0.5 - (f32(id.y) + 0.5)) * pixel;
    var x = 0.0;
    var y = 0.0;
    var steps = 0u;
    loop {
        let x2 = x * x;
        let y2 = y * y;
        if steps >= most || x2 + y2 > 4.0 {
            break;
        }
        y = 2.0 * x * y + imaginary;
        x = x2 - y2 + real;
        steps++;
    }
    let share = select(f32(steps) / 256.0, 0.0, steps >= most);
    textureStore(picture, vec2i(id.xy), vec4f(share, sqrt(share), 1.0 - share, 1.0));
}
