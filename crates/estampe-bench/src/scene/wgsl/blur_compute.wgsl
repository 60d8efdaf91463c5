@group(0) @binding(0) var<uniform> weights: array<vec4f, 4>;
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(2) var blurred: texture_storage_2d<rgba8unorm, write>;

const radius = 15u;

// A row of 256 texels, or eight columns of 32, with the texels on either side.
var<workgroup> texels: array<vec4f, 496>;

// The mean around a texel; its neighbours are so far away.
fn mean(at: u32, neighbour: u32) -> vec4f {
    var sum = texels[at] * weights[0].x;
    for (var k = 1u; k <= radius; k++) {
        let pair = texels[at - neighbour * k] + texels[at + neighbour * k];
        sum += pair * weights[k / 4u][k % 4u];
    }
    return sum;
}

@compute @workgroup_size(64)
fn blur_rows(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let size = vec2i(textureDimensions(blurred));
    let first = vec2i(i32(group.x) * 256, i32(group.y));
    for (var k = invocation; k < 286u; k += 64u) {
        let x = clamp(first.x - 15 + i32(k), 0, size.x - 1);
        texels[k] = textureLoad(source, vec2i(x, first.y), 0);
    }
    workgroupBarrier();
    for (var k = invocation; k < 256u; k += 64u) {
        let at = first + vec2i(i32(k), 0);
        if at.x < size.x {
            textureStore(blurred, at, mean(k + radius, 1u));
        }
    }
}

@compute @workgroup_size(8, 8)
fn blur_columns(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let size = vec2i(textureDimensions(blurred));
    let first = vec2i(i32(group.x) * 8, i32(group.y) * 32);
    for (var k = invocation; k < 496u; k += 64u) {
        let at = first + vec2i(i32(k % 8u), i32(k / 8u) - 15);
        texels[k] = textureLoad(source, clamp(at, vec2i(0), size - 1), 0);
    }
    workgroupBarrier();
    for (var k = invocation; k < 256u; k += 64u) {
        let at = first + vec2i(i32(k % 8u), i32(k / 8u));
        if all(at < size) {
            textureStore(blurred, at, mean(k + 8u * radius, 8u));
        }
    }
}
