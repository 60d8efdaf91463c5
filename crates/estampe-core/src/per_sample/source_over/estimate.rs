//! Codes by an estimate with a known error, which costs a third of the exact formula.
//!
//! A code is ⌊t⌋ for t = 255·v + ½, where v is the blended value, rounded after each operation. An
//! estimate e of 256 + t that is off by less than w tells the code wherever no integer is within w
//! of e (Ziv's rounding test). In the other lanes, one packet in forty, [`exact`](super::exact)
//! decides, so the estimate's own bits are never seen: it may be contracted, and may differ between
//! SIMD levels.
//!
//! As 256 ≤ e < 512, bits 15 to 22 of e *are* the code, and the bits below are the fraction, in
//! units of 2⁻¹⁵. A code c is a *raised code* 256 + c with the fraction 0: no conversion is needed
//! from codes, to codes or between layers.
//!
//! ```text
//!   31          23 22        15 14             0
//!   0 1000 0111     code         fraction            = 256 + code + fraction·2⁻¹⁵
//! ```
//!
//! With S the source's value, A its alpha and r = 1 − A:
//!
//! * one alpha: e = (256 + c)·r + P, where P = 255·A·S + 256·A + ½ is a plane;
//! * an alpha that varies: e = D + A·(P − D), where D = 256½ + c, and P = 255·S + 256½ is a plane.
//!
//! **The error.** Let u = 2⁻²⁴; a unit of the fraction is 512·u. [`Estimate::new`] makes sure that
//! all values are in 0..=1 in the tile, and |ΔX·dx|, |ΔY·dy| ≤ 1 for all planes, so that |dx| and
//! |dy| are at most 1/32. The exact formula's interpolated values are off by at most 5·u (two
//! products, their sum, the last sum); its products, sums and the factor 1/255 by u each, relative
//! to values of at most 1; the final sum by 128·u. With one alpha, whose r is the same number in
//! both formulas: 255·(6·A + 3·r + 2)·u + 128·u. The estimate's plane is a sum of three numbers
//! below 512 (a block's value from f64, a packet's step, a lane's step), each rounded to half a
//! unit or less, and steps are off by 1.4·A units; the product, if it is rounded, and the sum add r
//! and ½ units. Together at most 5.8 + 1.9·A units, below [`ONE_ALPHA`] = 8. With an alpha that
//! varies, the exact formula is off by 255·13·u + 128·u, or 6.7 units, and the estimate by 3 units
//! for its alpha, 3 for its plane and 1 for the rest: below [`MANY_ALPHAS`] = 16.

use super::{ColorPlanes, TileBlock};
use crate::bounds::plane::Plane;
use crate::raster::TileShape;
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes, SimdBase, SimdFloat, f32x16, mask32x16, u32x16,
};

/// The bits of 256: a raised code without the code.
const RAISED: u32 = 0x4380_0000;

/// The place of the code in a raised one.
const CODE: u32 = 0x007F_8000;

/// Everything of an estimate but the fraction.
const WITHOUT_FRACTION: u32 = 0xFFFF_8000;

/// The greatest error of an estimate with one alpha, in units of 2⁻¹⁵.
const ONE_ALPHA: u32 = 8;

/// The greatest error of an estimate with an alpha that varies, in units of 2⁻¹⁵.
const MANY_ALPHAS: u32 = 16;

/// The estimate of a triangle's colours in a tile: P of each channel, and with many alphas alpha
/// itself as the last one; at the plane's origin, and its slopes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Estimate([[f64; 3]; 4]);

/// An estimate in a block of the tile.
#[derive(Debug, Default, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct BlockEstimate {
    /// By channel: what each lane of a packet adds to its first pixel.
    lanes: [[f32; LANES]; 4],
    /// By channel: the values at the first pixels of the block's packets.
    packets: [[f32; LANES]; 4],
    /// 1 − alpha, if alpha is the same everywhere.
    rest: f32,
    has_one_alpha: bool,
}

impl Estimate {
    /// The estimate, if its error is bounded. Sets the part of `of_blocks` that is the same in all
    /// blocks.
    #[inline(always)]
    pub(super) fn new(
        colors: &ColorPlanes,
        tile: TileShape,
        of_blocks: &mut BlockEstimate,
    ) -> Option<Self> {
        if !colors
            .channels
            .iter()
            .all(|plane| is_tame(colors, plane, tile))
        {
            return None;
        }
        let alpha = colors.channels[3];
        let has_one_alpha = alpha.dx == 0.0 && alpha.dy == 0.0;
        let rest = 1.0 - alpha.origin;
        let (mut scale, mut first) = (255.0, 256.5);
        let mut last = [alpha.origin, alpha.dx, alpha.dy].map(f64::from);
        if has_one_alpha {
            scale = 255.0 * f64::from(alpha.origin);
            first = 256.5 - 256.0 * f64::from(rest);
            last = [first + scale, 0.0, 0.0];
        }
        (of_blocks.rest, of_blocks.has_one_alpha) = (rest, has_one_alpha);
        let mut planes = [last; 4];
        for (plane, from) in planes.iter_mut().zip(&colors.channels[..3]) {
            let Plane { origin, dx, dy } = *from;
            *plane = [
                first + scale * f64::from(origin),
                scale * f64::from(dx),
                scale * f64::from(dy),
            ];
        }
        for (lanes, [_, dx, dy]) in of_blocks.lanes.iter_mut().zip(&planes) {
            let (dx, dy) = (rounded(*dx), rounded(*dy));
            for (lane, step) in lanes.iter_mut().enumerate() {
                *step = f32::from(LANE_X[lane]) * dx + f32::from(LANE_Y[lane]) * dy;
            }
        }
        Some(Self(planes))
    }

    /// Sets the values at the first pixels of a block's packets, which lie as the pixels of a
    /// packet do, four times as far apart.
    #[inline(always)]
    pub(super) fn set_block<S: Lanes>(
        &self,
        s: S,
        colors: &ColorPlanes,
        block: TileBlock,
        of_block: &mut BlockEstimate,
    ) {
        let x = f64::from(block.pixel[0]) + 0.5 - f64::from(colors.origin.x);
        let y = f64::from(block.pixel[1]) + 0.5 - f64::from(colors.origin.y);
        let channels = self.0.iter().zip(&of_block.lanes);
        for (([origin, dx, dy], lanes), packets) in channels.zip(&mut of_block.packets) {
            let first = rounded(origin + (x * dx + y * dy));
            let lanes = f32x16::load_array_ref(s, lanes);
            (lanes * 4.0 + first).store_array(packets);
        }
    }
}

impl BlockEstimate {
    /// Raised codes blended over raised codes in a packet of a block, and the lanes where they are
    /// not certain.
    #[inline(always)]
    pub(super) fn blend<S: Lanes, const CHANNELS: usize>(
        &self,
        s: S,
        packet: usize,
        below: &[u32x16<S>; 4],
    ) -> ([u32x16<S>; 4], mask32x16<S>) {
        let mut raised = *below;
        let mut channel = 0;
        if self.has_one_alpha {
            let rest = f32x16::splat(s, self.rest);
            while channel < CHANNELS {
                let below: f32x16<S> = below[channel].bitcast();
                let plane = self.plane(s, packet, channel);
                raised[channel] = below.mul_add(rest, plane).bitcast();
                channel += 1;
            }
            return (raised, uncertain::<_, CHANNELS>(s, &raised, ONE_ALPHA));
        }
        let alpha = self.plane(s, packet, 3);
        while channel < CHANNELS {
            let half = u32x16::splat(s, 1 << 14);
            let below: f32x16<S> = (below[channel] | half).bitcast();
            let plane = if channel < 3 {
                self.plane(s, packet, channel)
            } else {
                f32x16::splat(s, 511.5)
            };
            raised[channel] = alpha.mul_add(plane - below, below).bitcast();
            channel += 1;
        }
        (raised, uncertain::<_, CHANNELS>(s, &raised, MANY_ALPHAS))
    }

    #[inline(always)]
    fn plane<S: Lanes>(&self, s: S, packet: usize, channel: usize) -> f32x16<S> {
        let lanes = f32x16::load_array_ref(s, &self.lanes[channel]);
        lanes + f32x16::splat(s, self.packets[channel][packet % LANES])
    }
}

/// Returns true if a plane's values are in 0..=1 in all of the tile, and its products at most 1.
#[inline(always)]
fn is_tame(colors: &ColorPlanes, plane: &Plane, tile: TileShape) -> bool {
    // Pixels' centres lie within this square, and planes are monotone in x and in y, rounding
    // included, so the values at its corners bound theirs.
    let side = tile.side() as f32;
    let (x, y) = (
        tile.x as f32 - colors.origin.x,
        tile.y as f32 - colors.origin.y,
    );
    let columns = [x * plane.dx, (x + side) * plane.dx];
    let rows = [y * plane.dy, (y + side) * plane.dy];
    columns.iter().chain(&rows).all(|step| step.abs() <= 1.0)
        && columns.iter().all(|column| {
            rows.iter()
                .all(|row| (0.0..=1.0).contains(&(plane.origin + (column + row))))
        })
}

/// The lanes in which an integer is within `error` of an estimate of some channel.
#[inline(always)]
fn uncertain<S: Lanes, const CHANNELS: usize>(
    s: S,
    estimates: &[u32x16<S>; 4],
    error: u32,
) -> mask32x16<S> {
    // Fractions from −error to error, moved to begin at 0, have no other bits.
    let others = u32x16::splat(s, !WITHOUT_FRACTION & !(2 * error - 1));
    let near = |estimate: u32x16<S>| ((estimate + error) & others).simd_eq(0);
    let mut any = near(estimates[0]);
    let mut channel = 1;
    while channel < CHANNELS {
        any |= near(estimates[channel]);
        channel += 1;
    }
    any
}

/// The raised codes of RGBA8 texels.
#[inline(always)]
pub(in crate::per_sample) fn raised_codes<S: Lanes>(s: S, texels: u32x16<S>) -> [u32x16<S>; 4] {
    let raise = |code: u32x16<S>| (code & u32x16::splat(s, CODE)) | u32x16::splat(s, RAISED);
    [
        raise(texels << 15),
        raise(texels << 7),
        raise(texels >> 1),
        raise(texels >> 9),
    ]
}

/// RGBA8 texels of estimates, or of raised codes.
#[inline(always)]
pub(in crate::per_sample) fn texels<S: Lanes>(s: S, of: &[u32x16<S>; 4]) -> u32x16<S> {
    let byte = |of: u32x16<S>, mask: u32| of & u32x16::splat(s, mask);
    byte(of[0] >> 15, 0xFF)
        | byte(of[1] >> 7, 0xFF00)
        | byte(of[2] << 1, 0x00FF_0000)
        | byte(of[3] << 9, 0xFF00_0000)
}

/// Raised codes of estimates that are certain.
#[inline(always)]
pub(super) fn without_fraction<S: Lanes>(s: S, estimate: u32x16<S>) -> u32x16<S> {
    estimate & u32x16::splat(s, WITHOUT_FRACTION)
}

/// The codes in raised codes.
#[inline(always)]
pub(super) fn lowered<S: Lanes>(s: S, raised: u32x16<S>) -> u32x16<S> {
    (raised >> 15) & u32x16::splat(s, 0xFF)
}

/// Codes raised.
#[inline(always)]
pub(super) fn raised<S: Lanes>(s: S, code: u32x16<S>) -> u32x16<S> {
    (code << 15) | u32x16::splat(s, RAISED)
}

/// The nearest f32.
#[expect(clippy::cast_possible_truncation, reason = "rounds, as the name says")]
#[inline(always)]
fn rounded(value: f64) -> f32 {
    value as f32
}
