//! Immediates of compute shaders, at places that are known and that are computed, against the same
//! sums in Rust.

use super::{devices, module};
use estampe::{
    BindGroupDescriptor, BindingResource, ComputePipelineDescriptor, Device, Dispatch,
    DispatchError, DispatchErrorKind, EntryPointDescriptor, ImmediatesError, ShaderModule,
    ShaderSource, ShaderStage, bytes_of,
};

const WGSL: &str = "
struct Item { words: array<u32, 3>, scale: vec2u }
struct P { width: u32, table: vec4u, m: mat2x3f, items: array<Item, 2> }
var<immediate> p: P;
@group(0) @binding(0) var<storage, read_write> out: array<u32>;
@compute @workgroup_size(4, 2)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= p.width { return; }
    let item = p.items[id.y % 2u];
    let at = id.y * p.width + id.x;
    out[at] = p.table[id.x % 4u] + u32(p.m[id.x % 2u][id.y % 3u])
        + p.items[id.x % 2u].words[at % 3u] * p.items[1].scale[id.y % 2u]
        + item.words[2] * item.scale.x;
}
";

const GLSL: &str = "#version 450
layout(local_size_x = 4, local_size_y = 2) in;
struct Item { uint words[3]; uvec2 scale; };
layout(push_constant) uniform P { uint width; uvec4 table; mat2x3 m; Item items[2]; } p;
layout(std430, set = 0, binding = 0) buffer Out { uint words[]; };
void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (id.x >= p.width) return;
    uint at = id.y * p.width + id.x;
    uint y = id.y % 2u;
    words[at] = p.table[id.x % 4u] + uint(p.m[id.x % 2u][id.y % 3u])
        + p.items[id.x % 2u].words[at % 3u] * p.items[1].scale[y]
        + p.items[y].words[2] * p.items[y].scale.x;
}
";

/// The columns of `p.m`.
const M: [[u32; 3]; 2] = [[1, 20, 300], [4000, 50_000, 600_000]];

/// Width 0, table 16, m 32, items 64 and 88 of 24 bytes: words 0, scale 16. 112 bytes.
fn compute_words() -> Vec<u32> {
    let mut words = vec![9, 99, 99, 99, 3, 5, 7, 11];
    words.extend([1.0_f32, 20.0, 300.0, 99.0].map(f32::to_bits));
    words.extend([4000.0_f32, 50_000.0, 600_000.0, 99.0].map(f32::to_bits));
    words.extend([1_000_000, 2_000_000, 3_000_000, 99, 2, 3]);
    words.extend([4_000_000, 5_000_000, 6_000_000, 99, 5, 7]);
    words
}

fn computed(words: &[u32]) -> Vec<u32> {
    let width = words[0] as usize;
    let item = |at: usize| &words[16 + 6 * at..][..6];
    let of = |at: usize| {
        let [x, y] = [at % width, at / width];
        let number = M[x % 2][y % 3];
        let product = item(x % 2)[at % 3].wrapping_mul(item(1)[4 + y % 2]);
        let last = item(y % 2)[2].wrapping_mul(item(y % 2)[4]);
        (words[4 + x % 4] + number)
            .wrapping_add(product)
            .wrapping_add(last)
    };
    (0..width * 6).map(of).collect()
}

/// The words that work-groups store, as many, with these bytes of immediates.
fn dispatched(
    device: &Device,
    module: &ShaderModule,
    immediates: &[u8],
    (count, words): ([u32; 3], usize),
) -> Result<Vec<u32>, DispatchError> {
    let program = device.create_compute_program(&EntryPointDescriptor::new(module));
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor::new(program));
    let pipeline = pipeline.unwrap_or_else(|error| panic!("{error}"));
    let out = device.create_buffer_of_words(vec![0; words]);
    let out = out.expect("a small buffer");
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.bind_group_layouts()[0],
        entries: &[(0, BindingResource::Buffer(out.slice(..)))],
    });
    device.dispatch(&Dispatch {
        bind_groups: &[group.unwrap_or_else(|error| panic!("{error}"))],
        immediates,
        ..Dispatch::new(&pipeline, count)
    })?;
    let mut read = vec![0; words * 4];
    out.read(0, &mut read).expect("it can be read");
    let (read, _) = read.as_chunks::<4>();
    Ok(read.iter().map(|word| u32::from_le_bytes(*word)).collect())
}

/// Rows: G1, G2, G5
#[test]
fn work_groups_read_them_at_any_place() {
    let immediates = compute_words();
    let expected = computed(&immediates);
    let bytes = bytes_of(&immediates);
    for (name, device) in devices() {
        for source in [
            ShaderSource::Wgsl(WGSL),
            ShaderSource::GlslStage {
                stage: ShaderStage::Compute,
                text: GLSL,
            },
        ] {
            let module = module(&device, source);
            let run = |bytes: &[u8]| dispatched(&device, &module, bytes, ([3, 3, 1], 54));
            let stored = run(bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(stored, expected, "{name}: {source:?}");

            let error = run(&bytes[..108]).expect_err("too few");
            let too_few = ImmediatesError::TooFew {
                given: 108,
                needed: 112,
            };
            assert_eq!(error.kind, DispatchErrorKind::Immediates(too_few));
            assert_eq!(
                error.to_string(),
                "the dispatch: 108 bytes of immediates are given, and the shader reads 112"
            );
            let error = run(&[0; 132]).expect_err("too many");
            assert_eq!(
                error.to_string(),
                "the dispatch: 132 bytes of immediates are given; the limit max_immediate_size \
                 is 128"
            );
        }
    }
}

/// SPIR-V of `out[x] = p.scale * p.list[x]`, where `p` has `scale` at byte 4 and `list`, four
/// words, at byte 8.
#[rustfmt::skip]
fn spirv() -> Vec<u32> {
    // By SPIR-V's numbers of operations. Ids: 1 main, 2 void, 3 its function, 4 u32, 5 vec3u,
    // 6 to 8 the constants 0, 1 and 4, 9 the list, 10 the block, 11 and 12 what is stored to,
    // 13 to 17 pointers, 18 `p`, 19 `out`, 20 the invocation's id, from 21 on values.
    let operations: &[&[u32]] = &[
        &[17, 1], &[14, 0, 1],
        &[15, 5, 1, u32::from_le_bytes(*b"main"), 0, 20], &[16, 1, 17, 4, 1, 1],
        &[71, 20, 11, 28], &[71, 10, 2], &[72, 10, 0, 35, 4], &[72, 10, 1, 35, 8], &[71, 9, 6, 4],
        &[71, 11, 6, 4], &[71, 12, 2], &[72, 12, 0, 35, 0], &[71, 19, 34, 0], &[71, 19, 33, 0],
        &[19, 2], &[33, 3, 2], &[21, 4, 32, 0], &[23, 5, 4, 3],
        &[43, 4, 6, 0], &[43, 4, 7, 1], &[43, 4, 8, 4], &[28, 9, 4, 8], &[30, 10, 4, 9],
        &[29, 11, 4], &[30, 12, 11],
        &[32, 13, 9, 10], &[32, 14, 9, 4], &[32, 15, 12, 12], &[32, 16, 12, 4], &[32, 17, 1, 5],
        &[59, 13, 18, 9], &[59, 15, 19, 12], &[59, 17, 20, 1],
        &[54, 2, 1, 0, 3], &[248, 21],
        &[61, 5, 22, 20], &[81, 4, 23, 22, 0],
        &[65, 14, 24, 18, 6], &[61, 4, 25, 24],
        &[65, 14, 26, 18, 7, 23], &[61, 4, 27, 26],
        &[132, 4, 28, 25, 27],
        &[65, 16, 29, 19, 6, 23], &[62, 29, 28],
        &[253], &[56],
    ];
    let mut words = vec![0x0723_0203, 0x0001_0300, 0, 30, 0];
    for operation in operations {
        let length = u32::try_from(operation.len()).expect("short");
        words.push(length << 16 | operation[0]);
        words.extend(&operation[1..]);
    }
    words
}

/// Rows: G3
#[test]
fn push_constants_of_spirv_are_immediates() {
    for (name, device) in devices() {
        let module = module(&device, ShaderSource::SpirV(&spirv()));
        let block = module.uniforms("").expect("it has no name");
        let offsets = block.block().members.iter().map(|member| member.offset);
        assert_eq!(offsets.collect::<Vec<_>>(), [4, 8]);
        let immediates: [u32; 6] = [99, 3, 5, 7, 11, 13];
        let run = |bytes: &[u8]| dispatched(&device, &module, bytes, ([1, 1, 1], 4));
        let stored = run(bytes_of(&immediates)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(stored, [15, 21, 33, 39], "{name}");
        assert!(run(bytes_of(&immediates[..5])).is_err());
    }
}
