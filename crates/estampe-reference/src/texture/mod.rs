//! Sampling of 2D textures with mip levels, texel by texel; views of every dimension are in
//! [`view`].
//!
//! In · Out: (u, v) of each lane · linear values 0..=1. Precision: f32 in the order of NUMERICS.md,
//! *Textures*. Each quad has one level of detail, from the derivatives at its first lane.

pub mod cube;
pub mod texel;
pub mod view;

pub use view::ReferenceView;

use crate::arithmetic::{clamp, max, min};
use crate::color::INVERSE_255;
use crate::srgb;
use estampe_types::shader::Sample2d;
use estampe_types::{
    AddressMode, FilterMode, MipLevel, Real, SamplerDescriptor, TexelData, Vec2, Vec4,
};
use std::sync::Arc;

/// A polynomial for log₂(1 + t) ÷ t, t in 0..1, by powers of t: times t it is within 1.2·10⁻⁴ of
/// log₂.
const LOG2: [f32; 4] = [1.438_725_7, -0.677_783_9, 0.321_188_8, -0.082_130_6];

/// A 2D texture and its sampler.
#[derive(Debug, Clone)]
pub struct ReferenceTexture {
    /// The texels.
    pub texture: Arc<TexelData>,
    /// Addressing, filtering and the range of λ.
    pub sampler: SamplerDescriptor,
}

impl Sample2d for ReferenceTexture {
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        // Two packet pairs have sixty-four lanes; a single fragment is its own quad.
        let mut texels = [[0.0; 4]; 64];
        let gradients = [uv.x.ddx(), uv.y.ddx(), uv.x.ddy(), uv.y.ddy()];
        for (lane, texel) in texels.iter_mut().enumerate().take(R::LANES) {
            let first = if R::LANES >= 4 { lane / 4 * 4 } else { 0 };
            let lod = self.lod(gradients.map(|gradient| gradient.lane(first)));
            *texel = self.sample_level([uv.x.lane(lane), uv.y.lane(lane)], lod);
        }
        let channel = |k: usize| uv.x.with_lanes(|lane| texels[lane][k]);
        Vec4::new(channel(0), channel(1), channel(2), channel(3))
    }
}

impl ReferenceTexture {
    /// Pairs a texture with a sampler.
    #[must_use]
    pub fn new(texture: Arc<TexelData>, sampler: SamplerDescriptor) -> Self {
        Self { texture, sampler }
    }

    /// λ from ∂u/∂x, ∂v/∂x, ∂u/∂y, ∂v/∂y: log₂ of the number of texels that a pixel spans, clamped
    /// to the sampler's range.
    #[must_use]
    pub fn lod(&self, [du_dx, dv_dx, du_dy, dv_dy]: [f32; 4]) -> f32 {
        let Some(base) = self.texture.levels.first() else {
            return 0.0;
        };
        let (width, height) = (base.width as f32, base.height as f32);
        let span_squared = |du: f32, dv: f32| {
            let (texels_u, texels_v) = (du * width, dv * height);
            texels_u * texels_u + texels_v * texels_v
        };
        let rho_squared = max(
            max(span_squared(du_dx, dv_dx), span_squared(du_dy, dv_dy)),
            0.0,
        );
        let lod = 0.5 * log2(rho_squared);
        clamp(lod, self.sampler.lod_min_clamp, self.sampler.lod_max_clamp)
    }

    /// The filtered value at (u, v) with level of detail `lod`.
    #[must_use]
    pub fn sample_level(&self, uv: [f32; 2], lod: f32) -> [f32; 4] {
        let Some(last) = self.texture.levels.len().checked_sub(1) else {
            return [0.0; 4];
        };
        let sampler = &self.sampler;
        let filter = if lod <= 0.0 {
            sampler.mag_filter
        } else {
            sampler.min_filter
        };
        let lod = clamp(lod, 0.0, last as f32);
        let filtered = match sampler.mipmap_filter {
            FilterMode::Nearest => self.filter((lod + 0.5).floor(), uv, filter),
            FilterMode::Linear => {
                let level = lod.floor();
                let finer = self.filter(level, uv, filter);
                let coarser = self.filter(min(level + 1.0, last as f32), uv, filter);
                mix(finer, coarser, lod - level)
            }
        };

        // Scale to values last: filtering is in units of codes.
        let [r, g, b, a] = filtered;
        if self.texture.format.is_srgb() {
            [r, g, b, a * INVERSE_255]
        } else {
            [r, g, b, a].map(|codes| codes * INVERSE_255)
        }
    }

    /// The filtered value of one mip level, nearest or bilinear, in the units of
    /// [`texel`](Self::texel).
    fn filter(&self, level: f32, [u, v]: [f32; 2], filter: FilterMode) -> [f32; 4] {
        let index = usize::try_from(whole(level)).unwrap_or_default();
        let Some(level) = self.texture.levels.get(index) else {
            return [0.0; 4];
        };
        let (mode_u, mode_v) = (self.sampler.address_mode_u, self.sampler.address_mode_v);
        match filter {
            FilterMode::Nearest => {
                let x = nearest(mode_u, u, level.width);
                let y = nearest(mode_v, v, level.height);
                self.texel(level, x, y)
            }
            FilterMode::Linear => {
                let ([x0, x1], fx) = linear(mode_u, u, level.width);
                let ([y0, y1], fy) = linear(mode_v, v, level.height);
                let top = mix(self.texel(level, x0, y0), self.texel(level, x1, y0), fx);
                let bottom = mix(self.texel(level, x0, y1), self.texel(level, x1, y1), fx);
                mix(top, bottom, fy)
            }
        }
    }

    /// A texel in the units of filtering: codes 0..=255; R, G and B of sRGB formats linear, 0..=1.
    fn texel(&self, level: &MipLevel, x: u32, y: u32) -> [f32; 4] {
        let at = level.offset as usize + y as usize * level.width as usize + x as usize;
        let word = self.texture.texels.get(at).copied().unwrap_or_default();
        let [r, g, b, a] = word.to_le_bytes();
        let channel = |code: u8| {
            if self.texture.format.is_srgb() {
                srgb::linear(code.into())
            } else {
                f32::from(code)
            }
        };
        [channel(r), channel(g), channel(b), f32::from(a)]
    }
}

/// The texel under a coordinate.
fn nearest(mode: AddressMode, coordinate: f32, size: u32) -> u32 {
    let position = confined(mode, tiled(mode, coordinate) * size as f32, size);
    address(mode, whole(position.floor()), size)
}

/// The two texels whose centres surround a coordinate, and the weight of the second.
fn linear(mode: AddressMode, coordinate: f32, size: u32) -> ([u32; 2], f32) {
    let position = confined(mode, tiled(mode, coordinate) * size as f32 - 0.5, size);
    let floor = position.floor();
    let first = whole(floor);
    (
        [first, first + 1].map(|at| address(mode, at, size)),
        position - floor,
    )
}

/// A coordinate after repetition: in 0..=1 with `Repeat` and `MirrorRepeat`, unchanged otherwise.
fn tiled(mode: AddressMode, u: f32) -> f32 {
    match mode {
        AddressMode::ClampToEdge | AddressMode::MirrorOnce | AddressMode::ClampToBorder => u,
        AddressMode::Repeat => max(u - u.floor(), 0.0),
        AddressMode::MirrorRepeat => 1.0 - ((u - 2.0 * (u * 0.5).floor()) - 1.0).abs(),
    }
}

/// A position in texels, clamped between the first and the last texel unless the mode is `Repeat`.
fn confined(mode: AddressMode, position: f32, size: u32) -> f32 {
    match mode {
        AddressMode::Repeat => position,
        _ => clamp(position, 0.0, size.max(1) as f32 - 1.0),
    }
}

/// The texel of an integer coordinate after wrapping.
fn address(mode: AddressMode, at: i64, size: u32) -> u32 {
    let size = i64::from(size.max(1));
    let found = match mode {
        AddressMode::Repeat => at.rem_euclid(size),
        _ => at.clamp(0, size - 1),
    };
    u32::try_from(found).expect("below the size")
}

/// log₂ of a number ≥ 0 from its bits: the exponent field, and a polynomial in the mantissa field.
/// 0 gives −127; NaN counts as 0.
fn log2(value: f32) -> f32 {
    let bits = if value >= 0.0 { value.to_bits() } else { 0 };
    let exponent = (bits >> 23) as f32 - 127.0;
    let t = (bits & 0x007F_FFFF) as f32 / 8_388_608.0;
    let [a0, a1, a2, a3] = LOG2;
    (((a3 * t + a2) * t + a1) * t + a0) * t + exponent
}

/// An integral f32 as an integer.
#[expect(
    clippy::cast_possible_truncation,
    reason = "texel coordinates and levels are far below 2³²"
)]
fn whole(value: f32) -> i64 {
    value as i64
}

fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}
