//! Measures the time of a texture sample, in nanoseconds, at every SIMD level of this processor:
//! `cargo run --release -p estampe-texture --example sample_bench [SIZE] [LEVEL] [CASE]`.
//!
//! A 1280×720 frame is covered once with a tilted, minified texture (2048×2048), tile by tile and
//! packet by packet as the pipeline does it. The best of several times of each row of tiles counts:
//! rows are so short that other processes do not interrupt all of them.

use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{
    FilterMode, Limits, MipGeneration, Rgba8Texture, SamplerDescriptor, TextureFormat,
    create_texture,
};
use estampe_types::Vec2;
use std::time::Instant;

const FRAME: [usize; 2] = [1280, 704];
const TILE: usize = 64;

/// The distance of neighbouring pixels in a row of the frame: from 4 texels of the base level at
/// the top to 1 at the bottom, so that mip levels change.
fn scale(size: u32, y: f32) -> f32 {
    4.0 / (1.0 + y * 0.004) / size as f32
}

/// One row of tiles: the sum of all channels of all samples.
#[inline(always)]
fn sample_row<S: Lanes>(simd: S, sampled: &Rgba8Texture, tile_y: usize) -> f32 {
    let size = sampled.texture().levels[0].width;
    let (lane_x, lane_y) = (LANE_X.map(f32::from), LANE_Y.map(f32::from));
    let lane_x = f32x16::load_array(simd, lane_x);
    let lane_y = f32x16::load_array(simd, lane_y);
    let mut sum = f32x16::splat(simd, 0.0);
    for tile_x in (0..FRAME[0]).step_by(TILE) {
        for packet_y in (tile_y..tile_y + TILE).step_by(4) {
            let top = scale(size, packet_y as f32);
            let bottom = scale(size, packet_y as f32 + 4.0);
            let scale = lane_y * ((bottom - top) * 0.25) + top;
            for packet_x in (tile_x..tile_x + TILE).step_by(4) {
                let (x, y) = (lane_x + packet_x as f32, lane_y + packet_y as f32);
                let u = (x * 1.1 + y * 0.3) * scale;
                let v = (y * 1.3 - x * 0.2) * scale;
                let color = sampled.sample(Vec2::new(u, v));
                sum += (color.x + color.y) + (color.z + color.w);
            }
        }
    }
    sum.to_array().iter().sum()
}

#[inline(never)]
fn row(level: Level, sampled: &Rgba8Texture, tile_y: usize) -> f32 {
    dispatch!(level, s => sample_row(s, sampled, tile_y))
}

#[expect(clippy::print_stdout, reason = "the figures are the purpose")]
fn main() {
    let mut arguments = std::env::args().skip(1);
    let size = arguments
        .next()
        .map_or(2048, |size| size.parse().expect("SIZE is a number"));
    let only = arguments.next().filter(|level| level != "all");
    let only_case = arguments.next();
    let mut random = fastrand::Rng::with_seed(1);
    let noise: Vec<u8> = (0..size * size * 4).map(|_| random.u8(..)).collect();
    let mut opaque_noise = noise.clone();
    for texel in opaque_noise.chunks_exact_mut(4) {
        texel[3] = 255;
    }
    let make = |format, noise: &[u8]| {
        let limits = Limits::default();
        create_texture(size, size, format, noise, MipGeneration::Full, &limits)
            .expect("a valid texture")
    };
    let unorm = std::sync::Arc::new(make(TextureFormat::Rgba8Unorm, &noise));
    let opaque = make(TextureFormat::Rgba8Unorm, &opaque_noise);
    let srgb = std::sync::Arc::new(make(TextureFormat::Rgba8UnormSrgb, &noise));
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let bilinear = SamplerDescriptor {
        mipmap_filter: FilterMode::Nearest,
        ..trilinear
    };
    let nearest = SamplerDescriptor {
        mag_filter: FilterMode::Nearest,
        min_filter: FilterMode::Nearest,
        ..bilinear
    };
    let cases = [
        ("nearest", Rgba8Texture::new(unorm.clone(), nearest)),
        ("bilinear", Rgba8Texture::new(unorm.clone(), bilinear)),
        ("trilinear", Rgba8Texture::new(unorm, trilinear)),
        ("trilinear opaque", Rgba8Texture::new(opaque, trilinear)),
        ("nearest srgb", Rgba8Texture::new(srgb.clone(), nearest)),
        ("bilinear srgb", Rgba8Texture::new(srgb.clone(), bilinear)),
        ("trilinear srgb", Rgba8Texture::new(srgb, trilinear)),
    ];
    for (name, sampled) in &cases {
        if only_case.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        for level in Level::all_available() {
            if only.as_ref().is_some_and(|only| only != level.name()) {
                continue;
            }
            let (mut best, mut sum) = (0.0, 0.0);
            for tile_y in (0..FRAME[1]).step_by(TILE) {
                let mut best_of_row = f64::INFINITY;
                let mut of_row = 0.0;
                for _ in 0..40 {
                    let start = Instant::now();
                    of_row = row(level, sampled, tile_y);
                    best_of_row = best_of_row.min(start.elapsed().as_secs_f64());
                }
                best += best_of_row;
                sum += of_row;
            }
            let per_packet = best * 1e9 / (FRAME[0] * FRAME[1] / LANES) as f64;
            let per_sample = per_packet / LANES as f64;
            println!(
                "{name:16} {:7} {per_sample:6.2} ns a sample, {per_packet:6.1} a packet (checksum {sum})",
                level.name()
            );
        }
    }
}
