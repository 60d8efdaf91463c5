//! Measures a trilinear sample of each kind of view, in nanoseconds per packet of sixteen
//! fragments.
//!
//! `cargo run --release -p estampe-texture --example views`

#![expect(clippy::print_stdout, reason = "a program for the terminal")]

use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{
    Coordinates, FilterMode, LevelData, Limits, MipGeneration, SampledTexture, SamplerDescriptor,
    TexelDescriptor, TexelView, TexelViewDescriptor, TextureFormat, ViewDimension,
};
use estampe_types::{Real, Vec2, Vec3};
use std::time::Instant;

/// Texels of a side.
const SIDE: u32 = 256;
/// Packets in a row of the image that is sampled.
const PACKETS: usize = 64;
/// The number of times that each view's image is sampled; the least time counts, because other
/// processes may use the processor.
const ROUNDS: usize = 500;

fn main() {
    let level = Level::best();
    println!("{} packets at level {}", PACKETS * PACKETS, level.name());
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8Unorm,
        TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba8Snorm,
    ];
    let dimensions = [
        ViewDimension::D2,
        ViewDimension::D2Array,
        ViewDimension::Cube,
    ];
    let mut cases = Vec::new();
    for dimension in dimensions {
        for format in formats {
            cases.push((dimension, format, view(dimension, format)));
        }
    }
    let mut best = vec![f64::INFINITY; cases.len()];
    for _ in 0..ROUNDS {
        for ((dimension, _, view), best) in cases.iter().zip(&mut best) {
            let start = Instant::now();
            std::hint::black_box(dispatch!(level, s => image(s, view, *dimension)));
            let ns = start.elapsed().as_secs_f64() * 1e9;
            *best = best.min(ns / (PACKETS * PACKETS) as f64);
        }
    }
    for ((dimension, format, _), ns) in cases.iter().zip(&best) {
        println!(
            "{dimension:?} {:20} {ns:6.1}  {:.2}",
            format.name(),
            ns / best[0]
        );
    }
}

/// A view of a texture of noise with all mip levels, sampled linearly everywhere.
fn view(dimension: ViewDimension, format: TextureFormat) -> SampledTexture {
    let layers = match dimension {
        ViewDimension::Cube => 6,
        ViewDimension::D2Array => 4,
        _ => 1,
    };
    let descriptor = TexelDescriptor {
        depth_or_layers: layers,
        ..TexelDescriptor::new_2d(SIDE, SIDE, format).with_all_levels()
    };
    let bytes = SIDE * SIDE * layers * format.block_bytes();
    let mut bytes =
        Vec::from_iter((0..bytes).map(|at| at.wrapping_mul(0x9E37_79B9).to_le_bytes()[3]));
    if format == TextureFormat::Rgba32Float {
        // Numbers from ½ to 2: arithmetic with tiny ones, whose products are denormal, is slow on
        // some processors.
        for number in bytes.chunks_exact_mut(4) {
            number[3] = 0x3F;
        }
    }
    let texture = descriptor
        .create(
            &[LevelData::tight(&bytes)],
            MipGeneration::Full,
            &Limits::default(),
        )
        .expect("a valid texture");
    let descriptor = TexelViewDescriptor {
        dimension: Some(dimension),
        ..TexelViewDescriptor::default()
    };
    let sampler = SamplerDescriptor {
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    };
    let view = TexelView::new(texture, &descriptor).expect("a valid view");
    SampledTexture::new(view, sampler).expect("a valid sampler")
}

/// Samples an image of packets with about 1.4 texels a pixel.
#[inline(always)]
fn image<S: Lanes>(s: S, view: &SampledTexture, dimension: ViewDimension) -> f32 {
    let lanes = |from: &[u8; LANES]| {
        let mut offsets = [0.0; LANES];
        for (to, from) in offsets.iter_mut().zip(from) {
            *to = f32::from(*from);
        }
        f32x16::load_array(s, offsets)
    };
    let (x, y) = (lanes(&LANE_X), lanes(&LANE_Y));
    let mut sum: f32x16<S> = SimdBase::splat(s, 0.0);
    // Away from the borders.
    let step = 0.9 / (PACKETS * 4) as f32 * 1.4 * 0.7;
    for row in 0..PACKETS {
        for column in 0..PACKETS {
            let u = (x + (column * 4) as f32) * step + 0.05;
            let v = (y + (row * 4) as f32) * step + 0.05;
            let at = match dimension {
                ViewDimension::Cube => {
                    Coordinates::cube(Vec3::new(u * 2.0 - 1.0, v * 2.0 - 1.0, u.splat(1.0)))
                }
                ViewDimension::D2Array => Coordinates::d2_array(Vec2::new(u, v), u.splat_int(1)),
                _ => Coordinates::d2(Vec2::new(u, v)),
            };
            let color = view.sample(at);
            sum += (color.x + color.y) + (color.z + color.w);
        }
    }
    sum.lane(0)
}
