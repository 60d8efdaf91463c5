//! Measures the time of a sample of any texture, by the code of views, on one core.
//!
//! `cargo run --release -p estampe-texture --example view_bench [LEVEL] [CASE]`. Tiles of 64×64
//! pixels of a 640×320 frame are sampled packet by packet; the figure is the sum over the tile rows
//! of the best of ten times.

use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{
    AddressMode, Coordinates, FilterMode, LevelData, Limits, Lod, MipGeneration, SampledTexture,
    SamplerDescriptor, TexelDescriptor, TexelView, TexelViewDescriptor, TextureDimension,
    TextureFormat, ViewDimension,
};
use estampe_types::state::CompareFunction;
use estampe_types::{Real, Vec2, Vec3};
use std::time::Instant;

const FRAME: [usize; 2] = [640, 320];
const TILE: usize = 64;

/// One row of tiles: the sum of all channels of all samples.
#[inline(always)]
fn sample_row<S: Lanes>(simd: S, view: &SampledTexture, tile_y: usize) -> f32 {
    let size = view.view().size(0)[0] as f32;
    let lane_x = f32x16::load_array(simd, LANE_X.map(f32::from));
    let lane_y = f32x16::load_array(simd, LANE_Y.map(f32::from));
    let mut sum: f32x16<S> = SimdBase::splat(simd, 0.0);
    for tile_x in (0..FRAME[0]).step_by(TILE) {
        for packet_y in (tile_y..tile_y + TILE).step_by(4) {
            let scale = 2.5 / (1.0 + packet_y as f32 * 0.006) / size;
            for packet_x in (tile_x..tile_x + TILE).step_by(4) {
                let (x, y) = (lane_x + packet_x as f32, lane_y + packet_y as f32);
                let (u, v) = ((x * 1.1 + y * 0.3) * scale, (y * 1.3 - x * 0.2) * scale);
                let at = match view.view().dimension() {
                    ViewDimension::D1 => Coordinates::d1(u),
                    ViewDimension::D2 => Coordinates::d2(Vec2::new(u, v)),
                    ViewDimension::D2Array => {
                        let layer = Real::to_int(x * 0.01);
                        Coordinates::d2_array(Vec2::new(u, v), layer)
                    }
                    _ => Coordinates::d3(Vec3::new(u, v, u * 0.7 - v * 0.4 + 0.3)),
                };
                if view.sampler().compare.is_some() {
                    sum += view.sample_compare(at, u * 0.5, Lod::Implicit, [0; 2]);
                } else {
                    let color = view.sample(at);
                    sum += (color.x + color.y) + (color.z + color.w);
                }
            }
        }
    }
    sum.to_array().iter().sum()
}

#[inline(never)]
fn row(level: Level, view: &SampledTexture, tile_y: usize) -> f32 {
    dispatch!(level, s => sample_row(s, view, tile_y))
}

/// A texture of noise: floats in 0..1, codes of all values.
fn view(
    dimension: ViewDimension,
    format: TextureFormat,
    sampler: SamplerDescriptor,
) -> SampledTexture {
    let (width, height, slices) = match dimension {
        ViewDimension::D1 => (1024, 1, 1),
        ViewDimension::D2 => (1024, 1024, 1),
        ViewDimension::D2Array => (512, 512, 8),
        ViewDimension::Cube | ViewDimension::CubeArray => (512, 512, 6),
        ViewDimension::D3 => (128, 128, 128),
    };
    let descriptor = TexelDescriptor {
        dimension: match dimension {
            ViewDimension::D1 => TextureDimension::D1,
            ViewDimension::D3 => TextureDimension::D3,
            _ => TextureDimension::D2,
        },
        depth_or_layers: slices,
        ..TexelDescriptor::new_2d(width, height, format)
    };
    let is_color = format.is_color();
    let descriptor = if is_color {
        descriptor.with_all_levels()
    } else {
        descriptor
    };
    let texels = (width * height * slices) as usize;
    let channels = texels * format.components();
    let mut random = fastrand::Rng::with_seed(1);
    let bytes: Vec<u8> = match format.block_bytes() as usize / format.components() {
        4 => (0..channels)
            .flat_map(|_| random.f32().to_le_bytes())
            .collect(),
        2 => (0..channels)
            .flat_map(|_| {
                // Halves from ¼ to 4.
                [random.u8(..), 0x34 | random.u8(..4)]
            })
            .collect(),
        _ => (0..channels).map(|_| random.u8(..)).collect(),
    };
    let mips = if is_color {
        MipGeneration::Full
    } else {
        MipGeneration::None
    };
    let texture = descriptor
        .create(&[LevelData::tight(&bytes)], mips, &Limits::default())
        .expect("a valid texture");
    let descriptor = TexelViewDescriptor {
        dimension: Some(dimension),
        ..TexelViewDescriptor::default()
    };
    let view = TexelView::new(texture, &descriptor).expect("a view");
    SampledTexture::new(view, sampler).expect("a sampler")
}

#[expect(clippy::print_stdout, reason = "the figures are the purpose")]
fn main() {
    let mut arguments = std::env::args().skip(1);
    let only = arguments.next().filter(|level| level != "all");
    let only_case = arguments.next();
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let bilinear = SamplerDescriptor {
        mipmap_filter: FilterMode::Nearest,
        ..trilinear
    };
    let anisotropic = SamplerDescriptor {
        max_anisotropy: 8,
        ..trilinear
    };
    let border = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToBorder,
        ..trilinear
    };
    let compare = SamplerDescriptor {
        compare: Some(CompareFunction::LessEqual),
        ..bilinear
    };
    use TextureFormat::{Depth32Float, R32Float, Rgba8Unorm, Rgba8UnormSrgb, Rgba16Float};
    use ViewDimension::{Cube, D1, D2, D2Array, D3};
    let cases = [
        ("common rgba8 trilinear", D2, Rgba8Unorm, trilinear),
        ("2d rgba16f trilinear", D2, Rgba16Float, trilinear),
        ("2d r32f trilinear", D2, R32Float, trilinear),
        ("2d r32f bilinear", D2, R32Float, bilinear),
        ("2d rgba8 border", D2, Rgba8Unorm, border),
        ("2d rgba8 anisotropic 8", D2, Rgba8Unorm, anisotropic),
        ("2d depth32 compare", D2, Depth32Float, compare),
        ("array rgba8 trilinear", D2Array, Rgba8Unorm, trilinear),
        ("array srgb8 trilinear", D2Array, Rgba8UnormSrgb, trilinear),
        ("cube rgba8 trilinear", Cube, Rgba8Unorm, trilinear),
        ("cube rgba16f trilinear", Cube, Rgba16Float, trilinear),
        ("3d rgba8 trilinear", D3, Rgba8Unorm, trilinear),
        ("1d rgba8 bilinear", D1, Rgba8Unorm, bilinear),
    ];
    for (name, dimension, format, sampler) in cases {
        if only_case.as_ref().is_some_and(|only| !name.contains(only)) {
            continue;
        }
        let view = view(dimension, format, sampler);
        for level in Level::all_available() {
            if only.as_ref().is_some_and(|only| only != level.name()) {
                continue;
            }
            let view = view.clone().at_level(level);
            let (mut best, mut sum) = (0.0, 0.0);
            for tile_y in (0..FRAME[1]).step_by(TILE) {
                let mut best_of_row = f64::INFINITY;
                let mut of_row = 0.0;
                for _ in 0..10 {
                    let start = Instant::now();
                    of_row = row(level, &view, tile_y);
                    best_of_row = best_of_row.min(start.elapsed().as_secs_f64());
                }
                best += best_of_row;
                sum += of_row;
            }
            let per_packet = best * 1e9 / (FRAME[0] * FRAME[1] / LANES) as f64;
            println!(
                "{name:24} {:7} {:7.2} ns a sample, {per_packet:7.1} a packet (checksum {sum})",
                level.name(),
                per_packet / LANES as f64
            );
        }
    }
}
