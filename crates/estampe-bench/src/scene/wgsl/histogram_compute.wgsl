struct Histogram {
    bins: array<atomic<u32>, 256>,
    sums: array<u32, 256>,
    largest: atomic<u32>,
}

@group(0) @binding(0) var<storage, read> values: array<u32>;
@group(0) @binding(1) var<storage, read_write> histogram: Histogram;

@compute @workgroup_size(256)
fn clear(@builtin(local_invocation_index) bin: u32) {
    atomicStore(&histogram.bins[bin], 0u);
    if bin == 0u {
        atomicStore(&histogram.largest, 0u);
    }
}

var<workgroup> counts: array<atomic<u32>, 256>;

@compute @workgroup_size(256)
fn count(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    atomicStore(&counts[invocation], 0u);
    workgroupBarrier();
    for (var k = 0u; k < 16u; k++) {
        let value = values[group.x * 4096u + k * 256u + invocation];
        atomicAdd(&counts[value >> 24u], 1u);
    }
    workgroupBarrier();
    let counted = atomicLoad(&counts[invocation]);
    if counted != 0u {
        atomicAdd(&histogram.bins[invocation], counted);
    }
}

var<workgroup> running: array<u32, 256>;

@compute @workgroup_size(256)
fn sum(@builtin(local_invocation_index) bin: u32) {
    let counted = atomicLoad(&histogram.bins[bin]);
    atomicMax(&histogram.largest, counted);
    running[bin] = counted;
    workgroupBarrier();
    for (var distance = 1u; distance < 256u; distance *= 2u) {
        var before = 0u;
        if bin >= distance {
            before = running[bin - distance];
        }
        workgroupBarrier();
        running[bin] += before;
        workgroupBarrier();
    }
    histogram.sums[bin] = running[bin];
}

@group(0) @binding(0) var picture: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn paint(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(picture);
    if any(id.xy >= size) {
        return;
    }
    let bin = id.x * 256u / size.x;
    let height = size.y - id.y;
    var color = vec3f(20.0, 20.0, 24.0);
    // Eighths of the sums, times a height, stay below 2³².
    if height * (histogram.sums[255] >> 3u) <= (histogram.sums[bin] >> 3u) * size.y {
        color = vec3f(50.0, 70.0, 90.0);
    }
    if height * atomicLoad(&histogram.largest) <= atomicLoad(&histogram.bins[bin]) * size.y {
        color = vec3f(200.0, 120.0, 40.0);
    }
    textureStore(picture, vec2i(id.xy), vec4f(color / 255.0, 1.0));
}
