//! Blocks of 16×16 pixels blended *over* what is there, from interpolated colours.
//!
//! The case that fills screens: a shader that passes its colour on, straight alpha, one sample of unorm8. A
//! block that a triangle covers whole shares its products of columns and rows, and colours go from the
//! planes to the attachment in registers. Nothing is rounded otherwise than in [`color`](super::color); what
//! is left out changes nothing:
//!
//! * a source is not clamped where the planes' extremes lie in 0..=1 (planes are monotone in x and in y,
//!   rounding included, so that the extremes are at corners);
//! * the blend of values in 0..=1 is not clamped: it is at least 0, and it exceeds 1 by rounding
//!   alone, which gives the code 255 as well;
//! * the alpha of what is opaque already is not computed: it stays 255.

use super::depth::{DepthTest, compare, line_mut};
use crate::fragment::interpolate::{DepthPlane, PlaneOrigin, VaryingPlanes};
use crate::fragment::queue::clamp_depth;
use crate::per_sample::codes::{alpha_code_unclamped, pack_color_unclamped, saturate, unpack};
use crate::raster::{TileShape, packet_origin};
use crate::tiles::Plane;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Select, SimdBase, f32x16, u32x16};

/// Planes of a triangle's colour: R, G, B and straight alpha, linear in the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColorPlanes {
    origin: PlaneOrigin,
    channels: [Plane; 4],
    /// Whether no value in the tile needs clamping.
    is_confined: bool,
    /// Whether alpha is the same everywhere.
    has_one_alpha: bool,
}

impl ColorPlanes {
    /// The first four varyings of a triangle whose 1/w are equal, in a tile.
    #[inline(always)]
    pub(crate) fn new(origin: PlaneOrigin, planes: &VaryingPlanes<'_>, tile: TileShape) -> Self {
        let channels = [planes.of(0), planes.of(1), planes.of(2), planes.of(3)];
        let side = tile.side() as f32;
        let (x, y) = (tile.x as f32 - origin.x, tile.y as f32 - origin.y);
        // Pixels' centres lie within this square, so the planes' values at its corners confine theirs.
        let corners = [[0.0, 0.0], [side, 0.0], [0.0, side], [side, side]];
        let is_confined = channels.iter().all(|plane| {
            corners.iter().all(|[right, lower]| {
                let value = plane.origin + ((x + right) * plane.dx + (y + lower) * plane.dy);
                (0.0..=1.0).contains(&value)
            })
        });
        let Plane { dx, dy, .. } = channels[3];
        Self {
            origin,
            channels,
            is_confined,
            has_one_alpha: dx == 0.0 && dy == 0.0,
        }
    }
}

/// The first pixel of a block in its tile.
#[inline(always)]
fn block_origin(block: usize) -> (i32, i32) {
    packet_origin(u32::try_from(block % LANES).unwrap_or_default() * 16)
}

/// The lanes of each packet of a block in which a triangle passes; depth is written if the state says so.
#[inline(always)]
pub(crate) fn test_block<S: Lanes>(
    s: S,
    test: &DepthTest,
    plane: &DepthPlane,
    block: usize,
    stored: &mut [f32],
) -> [u16; 16] {
    let (x, y) = block_origin(block);
    let (x, y) = (test.origin[0] + x, test.origin[1] + y);
    let steps = Steps::new(s, &plane.origin, [x, y], &plane.z);
    let mut masks = [u16::MAX; 16];
    for (packet, mask) in masks.iter_mut().enumerate() {
        if let Some(line) = line_mut(stored, block * 16 + packet) {
            let new = clamp_depth(s, steps.at(s, packet), test.range);
            let old = f32x16::load_array_ref(s, line);
            let passes = compare(s, test.state.compare, new, old);
            if test.state.write_enabled {
                passes.select(new, old).store_array(line);
            }
            *mask = s.bits_of_mask(passes);
        }
    }
    masks
}

/// Blends a triangle's colours over a block, in the lanes of the masks.
#[inline(always)]
pub(crate) fn blend_block<S: Lanes>(
    s: S,
    colors: &ColorPlanes,
    (tile, block): (TileShape, usize),
    masks: &[u16; 16],
    stored: &mut [u32],
) {
    let (x, y) = block_origin(block);
    let pixel = [tile.x + x, tile.y + y];
    let Some(stored) = stored.get_mut(block * 256..block * 256 + 256) else {
        return;
    };
    let steps = |channel: usize| Steps::new(s, &colors.origin, pixel, &colors.channels[channel]);
    let steps = [steps(0), steps(1), steps(2), steps(3)];
    match (colors.is_confined, colors.has_one_alpha) {
        (true, true) => blend_packets::<S, true, true>(s, &steps, masks, stored),
        (true, false) => blend_packets::<S, true, false>(s, &steps, masks, stored),
        _ => blend_packets::<S, false, false>(s, &steps, masks, stored),
    }
}

#[inline(always)]
fn blend_packets<S: Lanes, const CONFINED: bool, const ONE_ALPHA: bool>(
    s: S,
    steps: &[Steps<S>; 4],
    masks: &[u16; 16],
    stored: &mut [u32],
) {
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    let first_alpha = steps[3].at(s, 0);
    let first_rest = one - first_alpha;
    for (packet, (line, &mask)) in stored.chunks_exact_mut(16).zip(masks).enumerate() {
        let Ok(line) = <&mut [u32; 16]>::try_from(line) else {
            return;
        };
        if mask == 0 {
            continue;
        }
        let mut source = [
            steps[0].at(s, packet),
            steps[1].at(s, packet),
            steps[2].at(s, packet),
            first_alpha,
        ];
        if !ONE_ALPHA {
            source[3] = steps[3].at(s, packet);
        }
        if !CONFINED {
            let mut channel = 0;
            while channel < 4 {
                source[channel] = saturate(s, source[channel]);
                channel += 1;
            }
        }
        let alpha = source[3];
        let rest = if ONE_ALPHA { first_rest } else { one - alpha };
        let old = u32x16::load_array_ref(s, line);
        let below = unpack(s, old, false);
        let color = [
            source[0] * alpha + below[0] * rest,
            source[1] * alpha + below[1] * rest,
            source[2] * alpha + below[2] * rest,
        ];
        // What is opaque stays so: a + (1 − a) is 1 but for a rounding, whose code is 255.
        let opaque = <u32x16<S> as SimdBase<S>>::splat(s, 0xFF00_0000);
        let codes = if s.bits_of_mask(old.simd_ge(opaque)) == u16::MAX {
            pack_color_unclamped(color) | opaque
        } else {
            pack_color_unclamped(color) | alpha_code_unclamped(alpha + below[3] * rest)
        };
        if mask == u16::MAX {
            codes.store_array(line);
        } else {
            s.mask_from_bits(mask).select(codes, old).store_array(line);
        }
    }
}

/// A plane over a block: what its four columns and rows of packets add to the origin's value.
struct Steps<S: Lanes> {
    origin: f32x16<S>,
    by_x: [f32x16<S>; 4],
    by_y: [f32x16<S>; 4],
}

impl<S: Lanes> Steps<S> {
    /// The plane at pixels' centres of the block at the target's pixel (x, y).
    #[inline(always)]
    fn new(s: S, origin: &PlaneOrigin, [x, y]: [i32; 2], plane: &Plane) -> Self {
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let (mut by_x, mut by_y) = ([zero; 4], [zero; 4]);
        for (step, at) in [0, 4, 8, 12].into_iter().enumerate() {
            by_x[step] = origin.columns_from(s, x + at, 0.5) * plane.dx;
            by_y[step] = origin.rows_from(s, y + at, 0.5) * plane.dy;
        }
        Self {
            origin: SimdBase::splat(s, plane.origin),
            by_x,
            by_y,
        }
    }

    /// The plane at a packet of the block.
    #[inline(always)]
    fn at(&self, _s: S, packet: usize) -> f32x16<S> {
        let (column, row) = (
            LANE_X[packet & 15] as usize & 3,
            LANE_Y[packet & 15] as usize & 3,
        );
        self.origin + (self.by_x[column] + self.by_y[row])
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_opaque_stays_so() {
        // As `blend_packets` would compute it, for alphas of every exponent and many mantissas.
        for bits in (0..=1.0f32.to_bits()).step_by(997) {
            let alpha = f32::from_bits(bits);
            let below = 255.0 * (1.0 / 255.0f32);
            let blended = alpha + below * (1.0 - alpha);
            let code = blended * 255.0 + 0.5;
            assert!((255.0..256.0).contains(&code), "{alpha}");
        }
    }
}
