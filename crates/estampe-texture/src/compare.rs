//! Comparison of depth images with a reference depth, for shadow maps.
//!
//! A sample compares the four texels around (u, v) with the reference, *reference ≤ texel*, and
//! filters the results, 1 or 0, linearly; coordinates are clamped to the edge. Filtering the
//! results instead of the depths is percentage-closer filtering (Reeves, Salesin and Cook 1987).
//!
//! # Many samples at once
//!
//! In nearly all packets, all texels are lit or all are in shadow. Then the depth min/max of the
//! window of 8×8 texels that [`sample_compare_sum`] can reach decides the packet: that takes one
//! load per lane, instead of four for each sample. The sum is the same, because results that are
//! all 1 or all 0 keep their value when they are filtered.
//!
//! If the bounds do not decide, 3×3 samples one texel apart share their texels: 16 texels are
//! compared instead of 36.

use crate::texel::mix;
use crate::view::{load, packet};
use crate::wrap::place;
use estampe_simd::{LANES, Level, Packet, SimdBase, bits_of, dispatch, f32x16};
use estampe_types::morton::spread_lanes;
use estampe_types::{AddressMode, FilterMode, Int, Real, ShadowMap, Vec2};

/// The filtered share of the texels around (u, v) that pass *reference ≤ texel*, 0..=1: WebGPU's
/// `textureSampleCompareLevel` with a linear, clamped *less-equal* sampler. An empty image reads as
/// depth 0. What lies outside the map is compared with its edge: a shader whose light has an end
/// must treat coordinates beyond 0..=1 itself.
#[inline(always)]
pub fn sample_compare_level<R: Real>(texture: &ShadowMap, uv: Vec2<R>, reference: R) -> R {
    sample_compare_sum(texture, uv, &[[0.0; 2]], reference)
}

/// The sum of [`sample_compare_level`] at (u, v) + offset for each offset, in order. Divided by
/// their number, it is a soft shadow.
#[inline(always)]
pub fn sample_compare_sum<R: Real, const N: usize>(
    texture: &ShadowMap,
    uv: Vec2<R>,
    offsets: &[[f32; 2]; N],
    reference: R,
) -> R {
    let map = Map::new(texture);
    if R::EMULATED_LANES {
        return reference.with_lanes(
            #[inline(always)]
            |lane| {
                let uv = Vec2::new(uv.x.lane_to_store(lane), uv.y.lane_to_store(lane));
                sum_of_lane(&map, uv, offsets, reference.lane_to_store(lane))
            },
        );
    }
    reference.out_of_line(
        #[inline(always)]
        || map.sum(uv, offsets, reference),
    )
}

/// The sum of one fragment, for SIMD levels with emulated lanes.
#[inline(never)]
fn sum_of_lane(map: &Map<'_>, uv: Vec2<f32>, offsets: &[[f32; 2]], reference: f32) -> f32 {
    map.sum(uv, offsets, reference)
}

/// The shares of [`sample_compare_level`] for sixteen lanes at each of some coordinates, with one
/// reference.
///
/// Shaders filter shadows with several samples near each other: the depth min/max of the blocks
/// around all of them often decides all.
#[inline(never)]
pub fn compare_packets(
    texture: &ShadowMap,
    level: Level,
    (at, reference): (&[[&Packet<f32>; 2]], &Packet<f32>),
    shares: &mut [Packet<f32>],
) {
    let map = Map::new(texture);
    dispatch!(@wide level, s => {
        let zero: f32x16<_> = SimdBase::splat(s, 0.0);
        map.packets(zero, (at, reference), shares);
    }, scalar => {
        for ([u, v], share) in at.iter().zip(shares) {
            for lane in 0..LANES {
                let uv = Vec2::new(u.0[lane], v.0[lane]);
                share.0[lane] = map.sample(uv, reference.0[lane]);
            }
        }
    });
}

/// A depth image as lane code reads it.
pub(crate) struct Map<'a> {
    depths: &'a [u32],
    windows: &'a [u32],
    width: i32,
    height: i32,
    /// Words in a row of the windows.
    stride: i32,
}

impl<'a> Map<'a> {
    #[inline(always)]
    pub(crate) fn new(texture: &'a ShadowMap) -> Self {
        let side = |texels: u32| texels.clamp(1, ShadowMap::MAX_SIDE).cast_signed();
        let (width, height) = (side(texture.width()), side(texture.height()));
        Self {
            depths: bits_of(texture.depths()),
            windows: texture.windows(),
            width,
            height,
            stride: (width + 63) / 64 * 16,
        }
    }

    #[inline(always)]
    fn sum<R: Real>(&self, uv: Vec2<R>, offsets: &[[f32; 2]], reference: R) -> R {
        // A single sample is as fast as a lookup of its bounds.
        if offsets.len() > 1 {
            let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
            for offset in offsets {
                for axis in 0..2 {
                    low[axis] = low[axis].min(offset[axis]);
                    high[axis] = high[axis].max(offset[axis]);
                }
            }
            // Rounding is monotonic, so every texel of every sample lies between these.
            let low = Vec2::new(uv.x + low[0], uv.y + low[1]);
            let high = Vec2::new(uv.x + high[0], uv.y + high[1]);
            if let Some(lit) = self.decided([low, high], reference) {
                return R::select(lit, uv.x.splat(offsets.len() as f32), uv.x.splat(0.0));
            }
        }
        if let Some(offsets) = square_of_three(offsets)
            && let Some(square) = self.square(uv, offsets)
        {
            return self.sum_of_square(&square, reference);
        }
        let mut sum = uv.x.splat(0.0);
        for &[x, y] in offsets {
            sum += self.sample(Vec2::new(uv.x + x, uv.y + y), reference);
        }
        sum
    }

    /// The shares of sixteen lanes at each of some coordinates.
    #[inline(always)]
    fn packets<R: Real>(
        &self,
        like: R,
        (at, reference): (&[[&Packet<f32>; 2]], &Packet<f32>),
        shares: &mut [Packet<f32>],
    ) {
        let reference = load(like, reference, 0);
        if let [first, others @ ..] = at
            && !others.is_empty()
        {
            let first = Vec2::new(load(like, first[0], 0), load(like, first[1], 0));
            let (mut low, mut high) = (first, first);
            let mut is_number = first.x.eq(first.x) & first.y.eq(first.y);
            for [u, v] in others {
                let uv = Vec2::new(load(like, u, 0), load(like, v, 0));
                low = Vec2::new(low.x.min(uv.x), low.y.min(uv.y));
                high = Vec2::new(high.x.max(uv.x), high.y.max(uv.y));
                is_number = is_number & uv.x.eq(uv.x) & uv.y.eq(uv.y);
            }
            // A least number says nothing of those that are none.
            if !R::any(!is_number)
                && let Some(lit) = self.decided([low, high], reference)
            {
                let share = packet(R::select(lit, like.splat(1.0), like.splat(0.0)), 0);
                shares.fill(share);
                return;
            }
        }
        for ([u, v], share) in at.iter().zip(shares) {
            let uv = Vec2::new(load(like, u, 0), load(like, v, 0));
            *share = packet(self.sample(uv, reference), 0);
        }
    }

    /// The lit lanes, if the bounds decide every lane: all texels of samples between two corners
    /// pass, or all fail.
    #[inline(always)]
    pub(crate) fn decided<R: Real>(
        &self,
        [low, high]: [Vec2<R>; 2],
        reference: R,
    ) -> Option<R::SelectMask> {
        let (x0, y0) = (
            axis(low.x, self.width).texel,
            axis(low.y, self.height).texel,
        );
        let (x1, y1) = (
            axis(high.x, self.width).texel,
            axis(high.y, self.height).texel,
        );
        let one = x0.splat(1);
        let x1 = (x1 + one).min(x0.splat(self.width - 1));
        let y1 = (y1 + one).min(x0.splat(self.height - 1));
        let (x0, x1, y0, y1) = (x0 >> 2, x1 >> 2, y0 >> 2, y1 >> 2);
        // Lanes whose texels span more than two 4×4 blocks across or down.
        let wide = one.lt((x1 - x0).max(y1 - y0));
        let window = (y0 * x0.splat(self.stride) + x0).gather(self.windows);
        let (least, greatest) = (window & x0.splat(0xFFFF), window.shr_unsigned(16));
        let scaled = reference * ShadowMap::BOUND_SCALE;
        let lit = scaled.le(least.to_real());
        let dark = scaled.gt(greatest.to_real());
        if R::any(wide | !(lit | dark)) {
            return None;
        }
        Some(lit)
    }

    /// The sum of 3×3 samples, row by row.
    #[inline(always)]
    fn sum_of_square<R: Real>(&self, square: &Square<R>, reference: R) -> R {
        let [y0, y1, y2] = square.down;
        let first = self.row_of_three(square, 0, reference);
        let second = self.row_of_three(square, 1, reference);
        let sum = add_row(reference.splat(0.0), first, second, y0);
        let third = self.row_of_three(square, 2, reference);
        let sum = add_row(sum, second, third, y1);
        let fourth = self.row_of_three(square, 3, reference);
        add_row(sum, third, fourth, y2)
    }

    /// Finds the texels of 3×3 samples at (u, v) + (x of a column, y of a row). `None` unless
    /// neighbouring samples share texels in every lane: the right texel of a sample is the left
    /// texel of the next one, and its lower texel is the upper texel of the sample below. Each
    /// texel is then compared once; the arithmetic after that is the same.
    #[inline(always)]
    pub(crate) fn square<R: Real>(
        &self,
        uv: Vec2<R>,
        [columns, rows]: [[f32; 3]; 2],
    ) -> Option<Square<R>> {
        let [x0, x1, x2] = [
            axis(uv.x + columns[0], self.width),
            axis(uv.x + columns[1], self.width),
            axis(uv.x + columns[2], self.width),
        ];
        let [y0, y1, y2] = [
            axis(uv.y + rows[0], self.height),
            axis(uv.y + rows[1], self.height),
            axis(uv.y + rows[2], self.height),
        ];
        let one = x0.texel.splat(1);
        let (last_x, last_y) = (one.splat(self.width - 1), one.splat(self.height - 1));
        let next_x = (x0.texel + one).eq(x1.texel) & (x1.texel + one).eq(x2.texel);
        let next_y = (y0.texel + one).eq(y1.texel) & (y1.texel + one).eq(y2.texel);
        if R::any(!(next_x & next_y)) {
            return None;
        }
        Some(Square {
            columns: [
                column(x0.texel),
                column(x1.texel),
                column(x2.texel),
                column((x2.texel + one).min(last_x)),
            ],
            rows: [y0.texel, y1.texel, y2.texel, (y2.texel + one).min(last_y)],
            across: [x0.fraction, x1.fraction, x2.fraction],
            down: [y0.fraction, y1.fraction, y2.fraction],
        })
    }

    /// The comparison results of four texels of a row, filtered horizontally to three values.
    #[inline(always)]
    pub(crate) fn row_of_three<R: Real>(
        &self,
        square: &Square<R>,
        row: usize,
        reference: R,
    ) -> [R; 3] {
        let row = self.row(square.rows[row]);
        let a = self.passes(square.columns[0] + row, reference);
        let b = self.passes(square.columns[1] + row, reference);
        let c = self.passes(square.columns[2] + row, reference);
        let d = self.passes(square.columns[3] + row, reference);
        [
            mix(a, b, square.across[0]),
            mix(b, c, square.across[1]),
            mix(c, d, square.across[2]),
        ]
    }

    /// One sample: four comparisons, filtered linearly.
    #[inline(always)]
    pub(crate) fn sample<R: Real>(&self, uv: Vec2<R>, reference: R) -> R {
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

    /// 1 where *reference ≤ texel*, else 0.
    #[inline(always)]
    fn passes<R: Real>(&self, index: R::Int, reference: R) -> R {
        let depth = index.gather(self.depths).to_real_bits();
        R::select(
            reference.le(depth),
            reference.splat(1.0),
            reference.splat(0.0),
        )
    }

    /// The part of a texel's index that its row determines.
    #[inline(always)]
    fn row<I: Int>(&self, y: I) -> I {
        let blocks = (y >> 6) * y.splat(self.stride / 16);
        (blocks << 12) + (spread_lanes(y) << 1)
    }
}

/// The texels of 3×3 samples that share them.
pub(crate) struct Square<R: Real> {
    /// The part of a texel's index that each column of texels determines.
    columns: [R::Int; 4],
    /// The rows of texels.
    rows: [R::Int; 4],
    /// The weight of the right texel of each column of samples.
    across: [R; 3],
    /// The weight of the lower texel of each row of samples.
    pub(crate) down: [R; 3],
}

/// The x of columns and the y of rows, if the offsets are three rows of three.
#[inline(always)]
pub(crate) fn square_of_three(offsets: &[[f32; 2]]) -> Option<[[f32; 3]; 2]> {
    let [a, b, c, d, _, _, g, _, _] = *<&[[f32; 2]; 9]>::try_from(offsets).ok()?;
    let square = [[a[0], b[0], c[0]], [a[1], d[1], g[1]]];
    let is_square = offsets.iter().enumerate().all(|(index, offset)| {
        let expected = [square[0][index % 3], square[1][index / 3]];
        offset.map(f32::to_bits) == expected.map(f32::to_bits)
    });
    is_square.then_some(square)
}

/// Adds three samples to the sum, from left to right.
#[inline(always)]
fn add_row<R: Real>(sum: R, above: [R; 3], below: [R; 3], fraction: R) -> R {
    sum + mix(above[0], below[0], fraction)
        + mix(above[1], below[1], fraction)
        + mix(above[2], below[2], fraction)
}

/// The part of a texel's index that its column determines.
#[inline(always)]
fn column<I: Int>(x: I) -> I {
    ((x >> 6) << 12) + spread_lanes(x)
}

#[inline(always)]
fn axis<R: Real>(u: R, side: i32) -> crate::wrap::Place<R> {
    place(u, side as f32, AddressMode::ClampToEdge, FilterMode::Linear)
}
