//! Depth images, compared with a reference: shadow maps.
//!
//! A sample compares the four texels around (u, v) with the reference, *reference ≤ texel*, and mixes the
//! answers, 1 or 0, as linear filtering mixes texels; borders are clamped. Filtering the answers rather
//! than the depths is percentage-closer filtering (Reeves, Salesin and Cook 1987).
//!
//! # Many samples at once
//!
//! Nearly everywhere all texels around a packet are lit, or all are in shadow; then the bounds of the two
//! by two blocks of 4×4 texels that [`sample_compare_sum`] can meet decide the packet with two loads of a
//! pair a lane, in place of four for each sample. The sum is the same: answers that are all 1 or all 0 stay
//! so when they are mixed.

use crate::texel::mix;
use crate::wrap::place;
use estampe_simd::bits_of;
use estampe_types::{AddressMode, DepthTexture, FilterMode, Int, Real, Vec2};

/// How much of the texels around (u, v) is not nearer than the reference, 0..=1: WebGPU's
/// `textureSampleCompareLevel` with a linear, clamped *less-equal* sampler. An empty image reads as depth 0.
#[inline(always)]
pub fn sample_compare_level<R: Real>(texture: &DepthTexture, uv: Vec2<R>, reference: R) -> R {
    sample_compare_sum(texture, uv, &[[0.0; 2]], reference)
}

/// The sum of [`sample_compare_level`] at (u, v) + offset for each offset, in order. Divided by their
/// number, it is a soft shadow.
#[inline(always)]
pub fn sample_compare_sum<R: Real, const N: usize>(
    texture: &DepthTexture,
    uv: Vec2<R>,
    offsets: &[[f32; 2]; N],
    reference: R,
) -> R {
    let map = Map::new(texture);
    if R::NARROW {
        return reference.with_lanes(
            #[inline(always)]
            |lane| {
                let uv = Vec2::new(uv.x.lane(lane), uv.y.lane(lane));
                sum_of_lane(&map, uv, offsets, reference.lane(lane))
            },
        );
    }
    reference.outlined(
        #[inline(always)]
        || map.sum(uv, offsets, reference),
    )
}

/// One fragment, for levels whose registers are narrow.
#[inline(never)]
fn sum_of_lane(map: &Map<'_>, uv: Vec2<f32>, offsets: &[[f32; 2]], reference: f32) -> f32 {
    map.sum(uv, offsets, reference)
}

/// A depth image as lane code needs it.
struct Map<'a> {
    depths: &'a [u32],
    bounds: &'a [u32],
    width: i32,
    height: i32,
    /// Words in a row of the bounds.
    stride: i32,
}

impl<'a> Map<'a> {
    #[inline(always)]
    fn new(texture: &'a DepthTexture) -> Self {
        let side = |texels: u32| texels.clamp(1, DepthTexture::MAX_SIDE).cast_signed();
        let (width, height) = (side(texture.width()), side(texture.height()));
        Self {
            depths: bits_of(texture.depths()),
            bounds: texture.bounds(),
            width,
            height,
            stride: (width + 63) / 64 * 16,
        }
    }

    #[inline(always)]
    fn sum<R: Real>(&self, uv: Vec2<R>, offsets: &[[f32; 2]], reference: R) -> R {
        // One sample is as quick as its bounds.
        if offsets.len() > 1
            && let Some(lit) = self.decided(uv, offsets, reference)
        {
            return R::select(lit, uv.x.splat(offsets.len() as f32), uv.x.splat(0.0));
        }
        let mut sum = uv.x.splat(0.0);
        for &[x, y] in offsets {
            sum += self.sample(Vec2::new(uv.x + x, uv.y + y), reference);
        }
        sum
    }

    /// Which lanes are lit, if in each of them all samples' texels agree for certain.
    #[inline(always)]
    fn decided<R: Real>(&self, uv: Vec2<R>, offsets: &[[f32; 2]], reference: R) -> Option<R::Mask> {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for offset in offsets {
            for axis in 0..2 {
                low[axis] = low[axis].min(offset[axis]);
                high[axis] = high[axis].max(offset[axis]);
            }
        }
        // Rounding keeps order, so every texel of every sample lies between these.
        let x0 = axis(uv.x + low[0], self.width).texel;
        let y0 = axis(uv.y + low[1], self.height).texel;
        let x1 = axis(uv.x + high[0], self.width).texel;
        let y1 = axis(uv.y + high[1], self.height).texel;
        let one = x0.splat(1);
        let x1 = (x1 + one).min(x0.splat(self.width - 1));
        let y1 = (y1 + one).min(x0.splat(self.height - 1));
        let (x0, x1, y0, y1) = (x0 >> 2, x1 >> 2, y0 >> 2, y1 >> 2);
        // More than two blocks across or down.
        let wide = one.lt((x1 - x0).max(y1 - y0));
        let stride = x0.splat(self.stride);
        // The right one of a pair may not be needed; then it can only hold the decision back.
        let (upper, lower) = (y0 * stride + x0, y1 * stride + x0);
        let (a, b) = (upper.gather(self.bounds), (upper + one).gather(self.bounds));
        let (c, d) = (lower.gather(self.bounds), (lower + one).gather(self.bounds));
        let half = x0.splat(0xFFFF);
        let least = (a & half).min(b & half).min((c & half).min(d & half));
        let above = a.shr_unsigned(16).max(b.shr_unsigned(16));
        let greatest = above.max(c.shr_unsigned(16).max(d.shr_unsigned(16)));
        let scaled = reference * DepthTexture::BOUND_SCALE;
        let lit = scaled.le(least.to_real());
        let dark = scaled.gt(greatest.to_real());
        if R::any(wide | !(lit | dark)) {
            return None;
        }
        Some(lit)
    }

    /// One sample.
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>, reference: R) -> R {
        let (x, y) = (axis(uv.x, self.width), axis(uv.y, self.height));
        let one = x.texel.splat(1);
        let right = (x.texel + one).min(one.splat(self.width - 1));
        let lower = (y.texel + one).min(one.splat(self.height - 1));
        let (left, right) = (column(x.texel), column(right));
        let (upper, lower) = (self.row(y.texel), self.row(lower));
        let above = mix(
            self.passes(left + upper, reference),
            self.passes(right + upper, reference),
            x.fraction,
        );
        let below = mix(
            self.passes(left + lower, reference),
            self.passes(right + lower, reference),
            x.fraction,
        );
        mix(above, below, y.fraction)
    }

    /// 1 where the reference is not beyond the texel, else 0.
    #[inline(always)]
    fn passes<R: Real>(&self, index: R::Int, reference: R) -> R {
        let depth = index.gather(self.depths).to_real_bits();
        R::select(
            reference.le(depth),
            reference.splat(1.0),
            reference.splat(0.0),
        )
    }

    /// What a row adds to the index of its texels.
    #[inline(always)]
    fn row<I: Int>(&self, y: I) -> I {
        let blocks = (y >> 6) * y.splat(self.stride / 16);
        (blocks << 12) + (spread(y) << 1)
    }
}

/// What a column adds to the index of its texels.
#[inline(always)]
fn column<I: Int>(x: I) -> I {
    ((x >> 6) << 12) + spread(x)
}

/// Moves bit i of the lowest six bits to bit 2i.
#[inline(always)]
fn spread<I: Int>(v: I) -> I {
    let v = v & v.splat(0x3F);
    let v = (v | (v << 4)) & v.splat(0x30F);
    let v = (v | (v << 2)) & v.splat(0x333);
    (v | (v << 1)) & v.splat(0x555)
}

#[inline(always)]
fn axis<R: Real>(u: R, side: i32) -> crate::wrap::Place<R> {
    place(u, side as f32, AddressMode::ClampToEdge, FilterMode::Linear)
}
