//! Memory layout of buffers, bindings and textures; splitting and assembly of attributes and
//! varyings.

use super::super::*;
use estampe_types::shader::{Attributes, Sink, Source, Varyings};
use std::collections::VecDeque;
use std::sync::Arc;

/// Rows: V2.
#[test]
fn buffers_are_bytes_in_little_endian_words() {
    let bytes: Vec<u8> = (1..=9).collect();
    let buffer = BufferData::from_bytes(&bytes);
    assert_eq!(buffer.len_bytes(), 9);
    assert_eq!(buffer.words(), [0x0403_0201, 0x0807_0605, 9]);
    let floats = BufferData::from_f32s(&[1.0, -2.0]);
    assert_eq!(floats.len_bytes(), 8);
    assert_eq!(floats.words(), [0x3F80_0000, 0xC000_0000]);
    assert_eq!(BufferData::from_words(vec![7, 8]).words(), [7, 8]);
    assert_eq!(BufferData::from_bytes(&[]).words(), [0; 0]);
    // Both the core's readers and the oracle's give zero beyond the end.
    for (format, expected) in [
        (IndexFormat::Uint8, [1, 2, 9, 0]),
        (IndexFormat::Uint16, [0x0201, 0x0403, 0, 0]),
        (IndexFormat::Uint32, [0x0403_0201, 0x0807_0605, 0, 0]),
    ] {
        let positions = [0, 1, 8, u32::MAX];
        let read = positions.map(|at| fetch::raw_index(format, &buffer, at));
        assert_eq!(read, expected);
    }
    assert_eq!(
        [0, 8, 9, usize::MAX].map(|at| buffer.byte(at)),
        [1, 9, 0, 0]
    );
    let words = [0, 3, 6, 8, 9, usize::MAX].map(|at| buffer.word_at(at));
    assert_eq!(words, [0x0403_0201, 0x0706_0504, 0x0009_0807, 9, 0, 0]);
}

/// Rows: V1.
#[test]
fn bindings_are_found_by_group_and_number() {
    let buffer = |first: f32| BufferData::from_f32s(&[first, first + 1.0, first + 2.0]);
    let bound = |number, first, offset, is_dynamic: bool| {
        let buffer = buffer(first);
        let binding = BoundResource::Buffer {
            buffer,
            offset,
            size: u32::MAX,
            dynamic_offset: is_dynamic.then_some(0),
        };
        (number, binding)
    };
    let group = |entries, dynamic_offset| BoundGroup {
        group: Arc::new(BoundResources { entries }),
        dynamic_offsets: [dynamic_offset; MAX_DYNAMIC_OFFSETS],
    };
    let bindings = Bindings {
        groups: vec![
            group(vec![bound(5, 10.0, 0, false)], 8),
            group(vec![bound(5, 20.0, 4, false), bound(0, 30.0, 0, true)], 4),
        ],
        ..Bindings::default()
    };
    assert_eq!(bindings.f32s(0, 5, 0), [10.0, 11.0, 12.0]);
    assert_eq!(bindings.f32s(1, 5, 0), [21.0, 22.0, 0.0]);
    assert_eq!(bindings.f32s(1, 0, 4), [32.0]);
    assert_eq!(bindings.f32s(1, 1, 0), [0.0]);
    assert_eq!(bindings.f32s(2, 5, 0), [0.0]);
    let numbers: Vec<f32> = (0..16).map(|k| k as f32).collect();
    let matrix = BoundResource::Buffer {
        buffer: BufferData::from_f32s(&numbers),
        offset: 0,
        size: u32::MAX,
        dynamic_offset: None,
    };
    let bindings = Bindings {
        groups: vec![group(vec![(0, matrix)], 0)],
        ..Bindings::default()
    };
    assert_eq!(bindings.mat4(0, 0, 0).0[1], [4.0, 5.0, 6.0, 7.0]);
}

/// Rows: F2.
#[test]
fn textures_are_stored_as_their_documentation_says() {
    let texture = |format| TexelData {
        format,
        levels: Vec::new(),
        texels: Arc::default(),
        is_opaque: false,
        alpha_maps: Arc::default(),
        squares: Arc::default(),
        shape: TextureShape::default(),
    };
    use TextureFormat as F;
    for (format, stored, words) in [
        (F::R8Unorm, F::R8Unorm, 1),
        (F::Bgra8Unorm, F::Rgba8Unorm, 1),
        (F::Bgra8UnormSrgb, F::Rgba8UnormSrgb, 1),
        (F::Rgba16Float, F::Rgba16Float, 2),
        (F::Rgba32Uint, F::Rgba32Uint, 4),
        (F::Depth32FloatStencil8, F::Depth32FloatStencil8, 2),
        (F::Bc1RgbaUnorm, F::Rgba8Unorm, 1),
        (F::Bc7RgbaUnormSrgb, F::Rgba8UnormSrgb, 1),
        (F::Bc4RSnorm, F::R32Float, 1),
        (F::EacRg11Unorm, F::Rg32Float, 2),
        (F::Bc6hRgbFloat, F::Rgba16Float, 2),
        (F::Astc5x4UnormSrgb, F::Rgba8UnormSrgb, 1),
    ] {
        assert_eq!(texture(format).stored_format(), stored, "{format:?}");
        assert_eq!(texture(format).words_per_texel(), words, "{format:?}");
    }
    let solid = TextureShape {
        dimension: TextureDimension::D3,
        depth_or_layers: 5,
        samples: 1,
    };
    assert_eq!([0, 1, 2, 3].map(|level| solid.slices(level)), [5, 2, 1, 1]);
    let layers = TextureShape {
        dimension: TextureDimension::D2,
        ..solid
    };
    assert_eq!([0, 1, 2].map(|level| layers.slices(level)), [5, 5, 5]);
    let storage = StorageTexture::zeros(F::Rg32Float, (4, 3), TextureDimension::D2, 2);
    let storage = storage.expect("a little memory");
    assert_eq!(storage.len(), 4 * 3 * 2 * 2);
    // (1·3 + 2)·4 + 3 texels precede it, of two words each.
    assert_eq!(storage.index([3, 2, 1]), Some(46));
    for outside in [[4, 0, 0], [0, 3, 0], [0, 0, 2], [-1, 0, 0]] {
        assert_eq!(storage.index(outside), None);
    }
}

/// Scalars, first in, first out.
#[derive(Default)]
struct Scalars(VecDeque<f32>);

impl Source<f32> for Scalars {
    fn take(&mut self) -> f32 {
        self.0.pop_front().expect("as many as are taken")
    }
}

impl Sink<f32> for Scalars {
    fn put(&mut self, value: f32) {
        self.0.push_back(value);
    }
}

/// Rows: V1, R5.
#[test]
fn attributes_and_varyings_are_scalars_in_the_order_written() {
    type Inputs = (Vec3<f32>, [f32; 1], (Vec2<f32>, Vec4<f32>));
    let mut components = Vec::new();
    Inputs::components(&mut components);
    assert_eq!(components, [3, 1, 2, 4]);
    let mut source = Scalars((1..=10_u8).map(f32::from).collect());
    let loaded = <Inputs as Attributes<f32>>::load(&mut source);
    assert_eq!(
        loaded,
        (
            Vec3::new(1.0, 2.0, 3.0),
            [4.0],
            (Vec2::new(5.0, 6.0), Vec4::new(7.0, 8.0, 9.0, 10.0))
        )
    );

    type Outputs = (
        Flat<Vec2<f32>>,
        Centroid<NoPerspective<[f32; 1]>>,
        PerSample<Vec2<f32>>,
        [f32; 1],
    );
    let values: Outputs = (
        Flat(Vec2::new(1.0, 2.0)),
        Centroid(NoPerspective([3.0])),
        PerSample(Vec2::new(4.0, 5.0)),
        [6.0],
    );
    let mut sink = Scalars::default();
    Varyings::store(values, &mut sink);
    assert_eq!(sink.0, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(<Outputs as Varyings<f32>>::load(&mut sink), values);
    let (mut modes, mut places) = (Vec::new(), Vec::new());
    Outputs::modes(&mut modes);
    Outputs::sampling(&mut places);
    use Interpolation as I;
    assert_eq!(
        modes,
        [
            I::Flat,
            I::Flat,
            I::NoPerspective,
            I::Smooth,
            I::Smooth,
            I::Smooth
        ]
    );
    use shader::Sampling as S;
    assert_eq!(
        places,
        [
            S::Center,
            S::Center,
            S::Centroid,
            S::Sample,
            S::Sample,
            S::Center
        ]
    );
}
