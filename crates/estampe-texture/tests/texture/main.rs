//! Textures are created by their rules, and every kind of number samples them as docs/NUMERICS.md
//! says, to the bit, at every SIMD level.

mod alpha_maps;
mod bindings;
mod bits;
mod blocks;
mod byte_squares;
mod bytes;
mod codes;
mod comparisons;
mod create;
mod descriptors;
mod fetch;
mod gather;
mod gradients;
mod mip_levels;
mod naive;
mod offsets;
mod packet_gathers;
mod pixel_blocks;
mod requests;
mod several;
mod squares;
mod storage_packets;
mod taps;
mod tiled_texels;
mod unorm8;
mod values;
mod views;

use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_texture::{
    MipGeneration, Rgba8Texture, SamplerDescriptor, TexelData, TextureFormat, create_texture,
};
use estampe_types::{Limits, Vec2, Vec4};

/// Random numbers from a seed.
struct Random(fastrand::Rng);

impl Random {
    fn new(seed: u32) -> Self {
        Self(fastrand::Rng::with_seed(seed.into()))
    }

    /// 24 bits.
    fn bits(&mut self) -> u32 {
        self.0.u32(..1 << 24)
    }

    /// In 0..1.
    fn unit(&mut self) -> f32 {
        self.0.f32()
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.0.u8(..)).collect()
    }
}

fn noise(width: u32, height: u32, format: TextureFormat) -> TexelData {
    let rgba = Random::new(width * 31 + height).bytes((width * height * 4) as usize);
    let limits = Limits::default();
    create_texture(width, height, format, &rgba, MipGeneration::Full, &limits).expect("valid")
}

/// The source of the level of detail.
#[derive(Clone, Copy, Debug)]
enum Lod {
    FromQuad,
    Given([f32; LANES]),
}

type Colors = [[f32; 4]; LANES];

/// One packet, sampled at a SIMD level.
fn sample_packet(level: Level, sampled: &Rgba8Texture, uv: [[f32; LANES]; 2], lod: Lod) -> Colors {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, sampled: &Rgba8Texture, uv: [[f32; LANES]; 2], lod: Lod) -> Colors {
        let [u, v] = uv;
        let uv = Vec2::new(f32x16::load_array(simd, u), f32x16::load_array(simd, v));
        let color = match lod {
            Lod::FromQuad => sampled.sample(uv),
            Lod::Given(lod) => sampled.sample_level(uv, f32x16::load_array(simd, lod)),
        };
        let Vec4 { x, y, z, w } = color;
        let channels = [x.to_array(), y.to_array(), z.to_array(), w.to_array()];
        std::array::from_fn(|lane| channels.map(|channel| channel[lane]))
    }
    dispatch!(level, s => wide(s, sampled, uv, lod))
}

/// Samples one packet of a view at a SIMD level; the call only has to return.
fn sample_view_packet(level: Level, view: &estampe_texture::SampledTexture) {
    #[inline(always)]
    fn wide<S: Lanes>(simd: S, view: &estampe_texture::SampledTexture) {
        let mut u = [0.0; LANES];
        for (lane, u) in (0..).zip(&mut u) {
            *u = (lane - 7) as f32 * 0.3;
        }
        let u = f32x16::load_array(simd, u);
        let at = estampe_texture::Coordinates::d3(estampe_types::Vec3::new(u, u * 0.7, u * -0.1));
        view.sample_with(at, estampe_texture::Lod::Implicit, [3, 0, 0]);
    }
    dispatch!(level, s => wide(s, &view.clone().at_level(level)));
}

fn array(color: Vec4<f32>) -> [f32; 4] {
    [color.x, color.y, color.z, color.w]
}

fn sampled(texture: TexelData, sampler: SamplerDescriptor) -> Rgba8Texture {
    Rgba8Texture::new(texture, sampler)
}
