//! Compute shaders whose textures are packed, by machine code that knows it, against the
//! interpreter, which asks for each texel.

use estampe_shader::lower::lower;
use estampe_shader::program::TextCompute;
use estampe_simd::Level;
use estampe_texture::{
    BoundTexture, LevelData, MipGeneration, TexelDescriptor, TexelView, create_storage_texture,
    storage_bytes,
};
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources, OtherResource};
use estampe_types::shader::{ComputeProgram, Workgroups};
use estampe_types::{Bindings, BufferData, Limits, TextureFormat};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::sync::Arc;

/// The sides of the texture that is loaded from, and of the one that is stored to.
const SIDES: [[u32; 2]; 2] = [[37, 21], [29, 23]];

/// The work-groups of 16×2 invocations along x and y.
const COUNT: [u32; 3] = [3, 13, 1];

const SOURCE: &str = "
@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var target_: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(2) var<storage, read> numbers: array<vec4f>;
@compute @workgroup_size(16, 2) fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2i(textureDimensions(source));
    let at = vec2i(id.xy);
    // A row that is clamped, one that leaves the texture, and places without order.
    var sum = textureLoad(source, clamp(at - vec2i(3, 1), vec2i(0), size - 1), 0);
    sum += textureLoad(source, at + vec2i(5, -2), 0);
    for (var k = 0; k < i32(id.y % 3u); k++) {
        sum *= textureLoad(source, vec2i(at.y * 3 - k, (at.x * 7) % 40 - 9), 0);
    }
    let own = numbers[id.y * 48u + id.x];
    if id.x % 5u != 2u {
        textureStore(target_, at - vec2i(2, 1), sum.wzyx * 0.5 + own);
    }
}";

fn program() -> TextCompute {
    let module = naga::front::wgsl::parse_str(SOURCE).expect("it parses");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).expect("a valid module");
    let stage = lower(&module, &info, 0).expect("a shader that is supported");
    TextCompute::new(&stage, 1 << 20).expect("it is small")
}

/// Runs a program on textures of these formats. Returns whether machine code accessed their words,
/// and the bytes that were stored.
fn stored(program: &TextCompute, level: Level, formats: [TextureFormat; 2]) -> (bool, Vec<u8>) {
    let mut random = fastrand::Rng::with_seed(11);
    let limits = Limits::default();
    let [[width, height], to] = SIDES;
    let bytes = width * height * formats[0].block_bytes();
    // Halves of floats below 1.
    let bytes: Vec<u8> = (0..bytes).map(|_| random.u8(..56)).collect();
    let data = LevelData::tight(&bytes);
    let source = TexelDescriptor::new_2d(width, height, formats[0]);
    let source = source
        .create(&[data], MipGeneration::None, &limits)
        .unwrap();
    let source = BoundTexture::new(TexelView::of(source).unwrap(), None, level);
    let target = TexelDescriptor::new_2d(to[0], to[1], formats[1]);
    let target = create_storage_texture(&target, None, &limits).unwrap();
    let numbers = (0..48 * 26 * 4).map(|_| match random.u32(0..8) {
        0 => random.u32(..),
        _ => (random.f32() * 1.4 - 0.4).to_bits(),
    });
    let numbers = BoundResource::Buffer {
        buffer: BufferData::from_words(numbers.collect::<Vec<u32>>()),
        offset: 0,
        size: u32::MAX,
        dynamic_offset: None,
    };
    let source = BoundResource::Other(OtherResource(Arc::new(source)));
    let stored = BoundResource::StorageTexture(target.clone());
    let entries = vec![(0, source), (1, stored), (2, numbers)];
    let group = BoundGroup {
        group: Arc::new(BoundResources { entries }),
        ..BoundGroup::default()
    };
    let bindings = Bindings {
        groups: vec![group],
        ..Bindings::default()
    };
    let range = 0..COUNT.map(u64::from).iter().product();
    let work = Workgroups {
        count: COUNT,
        range,
    };
    let run = program.run_workgroups(level, &bindings, &work);
    run.expect("it ends");
    (
        program.accesses_words(level, &bindings),
        storage_bytes(&target),
    )
}

#[test]
fn packed_texels_are_what_the_interpreter_stores() {
    use TextureFormat::{Bgra8Unorm, Rgba8Unorm, Rgba16Float};
    let (compiled, interpreted) = (program(), program().interpreted());
    for level in Level::all_available() {
        for (formats, is_packed) in [
            ([Rgba8Unorm, Rgba8Unorm], true),
            ([Bgra8Unorm, Bgra8Unorm], true),
            ([Rgba16Float, Rgba8Unorm], false),
            ([Rgba8Unorm, Rgba16Float], false),
        ] {
            let (accesses_words, found) = stored(&compiled, level, formats);
            let has_machine_code =
                cfg!(target_arch = "x86_64") && format!("{level:?}").to_lowercase().contains("avx");
            assert_eq!(accesses_words, is_packed && has_machine_code, "{level:?}");
            let (accesses_words, expected) = stored(&interpreted, level, formats);
            assert!(!accesses_words);
            assert_eq!(found, expected, "{level:?}, {formats:?}");
            assert!(found.iter().filter(|byte| **byte != 0).count() > found.len() / 2);
        }
    }
}
