//! Texels of every format: uploads with padded rows and images, and fetching, inside and outside.

#![expect(
    clippy::cast_possible_truncation,
    reason = "sizes and masks of small textures"
)]

use estampe_reference::texture::ReferenceView;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_tests::Random;
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor, TexelView};
use estampe_types::{
    Limits, Pair, Quad, Real, SampleType, SamplerDescriptor, TexelData, TexelViewDescriptor,
    TextureAspect, TextureDimension, TextureFormat, Vec4, ViewDimension,
};
use std::sync::Arc;

/// A texture of a format with several mip levels and slices, or with samples, uploaded from padded
/// rows. Checks that each byte arrives at its position.
fn texture(random: &mut Random, format: TextureFormat) -> (Arc<TexelData>, ViewDimension) {
    let is_flat = format.is_compressed() || format.has_depth() || format.has_stencil();
    let (dimension, view) = match random.below(if is_flat { 2 } else { 4 }) {
        0 | 1 => (TextureDimension::D2, ViewDimension::D2Array),
        2 => (TextureDimension::D1, ViewDimension::D1),
        _ => (TextureDimension::D3, ViewDimension::D3),
    };
    let height = if dimension == TextureDimension::D1 {
        1
    } else {
        1 + random.below(13)
    };
    let mut descriptor = TexelDescriptor {
        dimension,
        depth_or_layers: if dimension == TextureDimension::D1 {
            1
        } else {
            1 + random.below(4)
        },
        ..TexelDescriptor::new_2d(1 + random.below(13), height, format)
    };
    let mut view = view;
    if dimension == TextureDimension::D2 && !format.is_compressed() && random.once_in(2) {
        descriptor.sample_count = random.pick(&[2, 4, 8, 16]);
        descriptor.depth_or_layers = 1;
        view = ViewDimension::D2;
    } else {
        descriptor = descriptor.with_all_levels();
    }
    let [block_width, block_height] = format.block_size();
    let block_bytes = format.block_bytes() as usize;
    let mut levels = Vec::new();
    let mut tight = Vec::new();
    for level in 0..descriptor.mip_level_count {
        let columns = (descriptor.width >> level).max(1).div_ceil(block_width) as usize;
        let rows = (descriptor.height >> level).max(1).div_ceil(block_height) as usize;
        let slices = match dimension {
            TextureDimension::D3 => (descriptor.depth_or_layers >> level).max(1),
            _ => descriptor.depth_or_layers,
        } as usize;
        let row_bytes = columns * block_bytes * descriptor.sample_count as usize;
        let [stride, image_rows] = [row_bytes + random.index(9), rows + random.index(3)];
        let bytes: Vec<u8> = (0..stride * image_rows * slices)
            .map(|_| random.byte())
            .collect();
        for slice in 0..slices {
            for row in 0..rows {
                let begin = (slice * image_rows + row) * stride;
                tight.extend_from_slice(&bytes[begin..begin + row_bytes]);
            }
        }
        levels.push((bytes, stride as u32, image_rows as u32));
    }
    let data: Vec<_> = levels
        .iter()
        .map(|(bytes, stride, rows)| LevelData {
            bytes,
            bytes_per_row: Some(*stride),
            rows_per_image: Some(*rows),
        })
        .collect();
    let made = descriptor.create(&data, MipGeneration::None, &Limits::default());
    let made = made.unwrap_or_else(|error| panic!("{format:?}: {error}"));
    if !format.is_compressed() {
        let stored = made.texels.chunks_exact(made.words_per_texel());
        let bytes: Vec<u8> = stored
            .flat_map(|words| {
                let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                bytes.truncate(block_bytes);
                if format.is_bgra() {
                    bytes.swap(0, 2);
                }
                bytes
            })
            .collect();
        // Bytes that belong to no aspect become zeros.
        for texel in tight.chunks_exact_mut(block_bytes) {
            match format {
                TextureFormat::Depth24Plus => texel[3] = 0,
                TextureFormat::Depth32FloatStencil8 => texel[5..].fill(0),
                _ => {}
            }
        }
        assert_eq!(bytes, tight, "{format:?}: other bytes than were given");
    }
    (Arc::new(made), view)
}

type Places = [[i32; LANES]; 5];

#[inline(always)]
fn fetch<R: Real>(view: &TexelView, like: R, places: &Places, first: usize) -> Vec4<R> {
    let int = |k: usize| {
        let bits = like
            .with_lanes(|lane| f32::from_bits(places[k][(first + lane) % LANES].cast_unsigned()));
        Real::to_bits(bits)
    };
    view.fetch([int(0), int(1), int(2)], int(3), int(4))
}

fn packets(level: Level, view: &TexelView, places: &Places) -> [[f32; LANES]; 4] {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, view: &TexelView, places: &Places) -> [[f32; LANES]; 4] {
        let zero: f32x16<S> = SimdBase::splat(simd, 0.0);
        let Vec4 { x, y, z, w } = fetch(view, zero, places, 0);
        [x.to_array(), y.to_array(), z.to_array(), w.to_array()]
    }
    dispatch!(level, s => wide(s, view, places))
}

/// Rows: F2.
#[test]
fn every_format_is_uploaded_and_fetched() {
    for (number, &format) in TextureFormat::ALL.iter().enumerate() {
        for round in 0..6 {
            let random = &mut Random::new("texels/fetch", (number * 10 + round) as u64);
            let (texture, dimension) = texture(random, format);
            let aspect = if format.has_stencil() && round % 2 == 1 {
                TextureAspect::Stencil
            } else {
                TextureAspect::All
            };
            let descriptor = TexelViewDescriptor {
                dimension: Some(dimension),
                aspect,
                ..TexelViewDescriptor::default()
            };
            let view = TexelView::new(texture.clone(), &descriptor).expect("a view");
            let layers = match dimension {
                ViewDimension::D3 => 1,
                _ => texture.shape.depth_or_layers,
            };
            let reference = ReferenceView {
                dimension,
                levels: [0, texture.levels.len()],
                layers: [0, layers],
                aspect,
                sampler: SamplerDescriptor::default(),
                texture,
            };
            let places: Places = [15, 15, 6, 6, 18].map(|most| {
                std::array::from_fn(|_| {
                    if random.once_in(12) {
                        random.pick(&[i32::MIN, i32::MAX, 1 << 20, -1])
                    } else if most > 15 && reference.texture.shape.samples == 1 {
                        i32::from(random.once_in(20))
                    } else {
                        random.below(most).cast_signed()
                    }
                })
            });
            check(&view, &reference, &places);
        }
    }
}

fn check(view: &TexelView, reference: &ReferenceView, places: &Places) {
    let format = view.texture().format;
    let is_integer = matches!(format.sample_type(), SampleType::Uint | SampleType::Sint);
    let bits = |x: f32| {
        if x.is_nan() && !is_integer {
            0x7FC0_0000
        } else {
            x.to_bits()
        }
    };
    let same = |kind: &str, lane: usize, got: [f32; 4]| {
        let [x, y, z, level, sample] = places.map(|of_lanes| of_lanes[lane]);
        let wanted = reference.fetch([x, y, z], level, sample);
        assert_eq!(
            got.map(bits),
            wanted.map(bits),
            "{kind}: {got:?} is not {wanted:?}: {format:?}, {:?}, ({x}, {y}, {z}), level {level}, sample {sample}",
            view.texture().shape,
        );
    };
    for level in Level::all_available() {
        let got = packets(level, view, places);
        for lane in 0..LANES {
            same(level.name(), lane, got.map(|channel| channel[lane]));
        }
    }
    for first in (0..LANES).step_by(4) {
        let Vec4 { x, y, z, w } = fetch(view, Quad([0.0; 4]), places, first);
        for k in 0..4 {
            same("quad", first + k, [x.0[k], y.0[k], z.0[k], w.0[k]]);
        }
    }
    let pair = Pair(Quad([0.0; 4]), Quad([0.0; 4]));
    let pair = fetch(view, pair, places, 0);
    for lane in 0..8 {
        let got = [pair.x, pair.y, pair.z, pair.w].map(|channel| channel.lane(lane));
        same("pair", lane, got);
    }
}
