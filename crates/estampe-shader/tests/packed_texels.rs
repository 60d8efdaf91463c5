//! Compute shaders whose textures are packed, by machine code that knows it and by the interpreter,
//! which asks for each texel, against the oracle's codec.

use estampe_reference::color::{bytes, codes, decode, encode};
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

/// The invocations of a work-group along x and y.
const GROUP: [u32; 2] = [16, 2];

const SOURCE: &str = "
struct Offsets { clamped: vec2i, leaving: vec2i, scattered: vec2i, stored: vec2i, skipped: u32 }
@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var target_: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(2) var<storage, read> numbers: array<vec4f>;
@group(0) @binding(3) var<storage, read> offsets: Offsets;
@compute @workgroup_size(16, 2) fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let size = vec2i(textureDimensions(source));
    let at = vec2i(id.xy);
    // A row that is clamped, one that leaves the texture, and places without order.
    var sum = textureLoad(source, clamp(at - offsets.clamped, vec2i(0), size - 1), 0);
    sum += textureLoad(source, at + offsets.leaving, 0);
    for (var k = 0; k < i32(id.y % 3u); k++) {
        sum *= textureLoad(source, vec2i(at.y * 3 - k, (at.x * 7) % 40) + offsets.scattered, 0);
    }
    let own = numbers[id.y * groups.x * 16u + id.x];
    if id.x % 5u != offsets.skipped {
        textureStore(target_, at - offsets.stored, sum.wzyx * 0.5 + own);
    }
}";

/// The textures and buffers of a dispatch.
struct Case {
    /// The formats and sides of the texture that is loaded from, and of the one that is stored to.
    formats: [TextureFormat; 2],
    sides: [[u32; 2]; 2],
    texels: Vec<u8>,
    numbers: Vec<[f32; 4]>,
    offsets: [[i32; 2]; 4],
    skipped: u32,
    /// The work-groups along x and y.
    count: [u32; 2],
}

impl Case {
    fn new(random: &mut fastrand::Rng, formats: [TextureFormat; 2]) -> Self {
        let sides = [(); 2].map(|()| [random.u32(1..40), random.u32(1..40)]);
        let count = [random.u32(1..5), random.u32(1..20)];
        let number = |random: &mut fastrand::Rng| match random.u32(0..8) {
            0 => f32::from_bits(random.u32(..)),
            _ => random.f32() * 1.4 - 0.4,
        };
        let invocations = count[0] * GROUP[0] * count[1] * GROUP[1];
        let numbers = (0..invocations).map(|_| [(); 4].map(|()| number(random)));
        let numbers = numbers.collect();
        let bytes = sides[0][0] * sides[0][1] * formats[0].block_bytes();
        // Halves of floats below 1.
        let texels = (0..bytes).map(|_| match formats[0] {
            TextureFormat::Rgba16Float => random.u8(..56),
            _ => random.u8(..),
        });
        Self {
            formats,
            sides,
            texels: texels.collect(),
            numbers,
            offsets: [(); 4].map(|()| [random.i32(-5..6), random.i32(-5..6)]),
            skipped: random.u32(0..6),
            count,
        }
    }

    /// The texels that the stored texture holds, by the oracle's codec.
    fn expected(&self) -> Vec<u8> {
        let [[width, height], to] = self.sides.map(|sides| sides.map(u32::cast_signed));
        let [from, into] = self.formats;
        let is_inside = |[x, y]: [i32; 2], [width, height]: [i32; 2]| {
            (0..width).contains(&x) && (0..height).contains(&y)
        };
        let texel_at = |[x, y]: [i32; 2], width: i32, format: TextureFormat| {
            let texel = usize::try_from(y * width + x).expect("inside");
            let bytes = format.block_bytes() as usize;
            texel * bytes..(texel + 1) * bytes
        };
        let load = |at: [i32; 2]| match is_inside(at, [width, height]) {
            true => decode(from, codes(from, &self.texels[texel_at(at, width, from)])),
            false => [0.0; 4],
        };
        let [clamped, leaving, scattered, stored] = self.offsets;
        let add = |[x, y]: [i32; 2], [by_x, by_y]: [i32; 2]| [x + by_x, y + by_y];
        let texels = self.sides[1][0] * self.sides[1][1];
        let mut image = vec![0; (texels * into.block_bytes()) as usize];
        let across = (self.count[0] * GROUP[0]).cast_signed();
        for (at, own) in (0..).zip(&self.numbers) {
            let at = [at % across, at / across];
            let [x, y] = [at[0] - clamped[0], at[1] - clamped[1]];
            let first = load([x.clamp(0, width - 1), y.clamp(0, height - 1)]);
            let second = load(add(at, leaving));
            let mut sum: [f32; 4] = std::array::from_fn(|c| first[c] + second[c]);
            for k in 0..at[1] % 3 {
                let factor = load(add([at[1] * 3 - k, at[0] * 7 % 40], scattered));
                sum = std::array::from_fn(|c| sum[c] * factor[c]);
            }
            let to_at = [at[0] - stored[0], at[1] - stored[1]];
            if at[0] % 5 != self.skipped.cast_signed() && is_inside(to_at, to) {
                let color = std::array::from_fn(|c| sum[3 - c] * 0.5 + own[c]);
                let texel = bytes(into, encode(into, color));
                image[texel_at(to_at, to[0], into)].copy_from_slice(&texel);
            }
        }
        image
    }

    /// Runs a program. Returns whether machine code accessed the textures' words, and the bytes
    /// that were stored.
    fn stored(&self, program: &TextCompute, level: Level) -> (bool, Vec<u8>) {
        let limits = Limits::default();
        let [[width, height], to] = self.sides;
        let source = TexelDescriptor::new_2d(width, height, self.formats[0]);
        let data = LevelData::tight(&self.texels);
        let source = source.create(&[data], MipGeneration::None, &limits);
        let source = TexelView::of(source.expect("a small texture")).expect("a view of all");
        let source = BoundTexture::new(source, None, level);
        let target = TexelDescriptor::new_2d(to[0], to[1], self.formats[1]);
        let target = create_storage_texture(&target, None, &limits).expect("a small texture");
        let bits = |numbers: &[f32; 4]| numbers.map(f32::to_bits);
        let numbers: Vec<u32> = self.numbers.iter().flat_map(bits).collect();
        let offsets = self.offsets.as_flattened().iter().copied();
        let offsets = offsets.map(i32::cast_unsigned);
        let offsets: Vec<u32> = offsets.chain([self.skipped, 0]).collect();
        let [numbers, offsets] = [numbers, offsets].map(|words| BoundResource::Buffer {
            buffer: BufferData::from_words(words),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        });
        let source = BoundResource::Other(OtherResource(Arc::new(source)));
        let stored = BoundResource::StorageTexture(target.clone());
        let entries = vec![(0, source), (1, stored), (2, numbers), (3, offsets)];
        let group = BoundGroup {
            group: Arc::new(BoundResources { entries }),
            ..BoundGroup::default()
        };
        let bindings = Bindings {
            groups: vec![group],
            ..Bindings::default()
        };
        let [x, y] = self.count;
        let work = Workgroups {
            count: [x, y, 1],
            range: 0..u64::from(x * y),
        };
        let run = program.run_workgroups(level, &bindings, &work);
        run.expect("it ends");
        (
            program.accesses_words(level, &bindings),
            storage_bytes(&target),
        )
    }
}

fn program() -> TextCompute {
    let module = naga::front::wgsl::parse_str(SOURCE).expect("it parses");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).expect("a valid module");
    let stage = lower(&module, &info, 0).expect("a shader that is supported");
    TextCompute::new(&stage, 1 << 20).expect("it is small")
}

#[test]
fn texels_that_are_packed_or_not_are_loaded_and_stored_as_by_the_oracle() {
    use TextureFormat::{Bgra8Unorm, Rgba8Unorm, Rgba16Float};
    let (compiled, interpreted) = (program(), program().interpreted());
    for level in Level::all_available() {
        let mut random = fastrand::Rng::with_seed(11);
        let has_machine_code =
            cfg!(target_arch = "x86_64") && format!("{level:?}").to_lowercase().contains("avx");
        let mut changed = 0;
        for number in 0..40 {
            let (formats, is_packed) = match number % 4 {
                0 => ([Rgba8Unorm, Rgba8Unorm], true),
                1 => ([Bgra8Unorm, Bgra8Unorm], true),
                2 => ([Rgba16Float, Rgba8Unorm], false),
                _ => ([Rgba8Unorm, Rgba16Float], false),
            };
            let case = Case::new(&mut random, formats);
            let expected = case.expected();
            changed += expected.iter().filter(|byte| **byte != 0).count();
            let name = format!("{level:?}, case {number}, {formats:?}");
            let (accesses_words, found) = case.stored(&compiled, level);
            assert_eq!(accesses_words, is_packed && has_machine_code, "{name}");
            assert!(found == expected, "{name}");
            let (accesses_words, found) = case.stored(&interpreted, level);
            assert!(!accesses_words, "{name}");
            assert!(found == expected, "{name}, interpreted");
        }
        assert!(changed > 20_000, "{level:?}: {changed} bytes are not 0");
    }
}
