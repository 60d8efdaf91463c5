//! Blocks of 16×16 pixels blended *over* what is there, from interpolated colours.
//!
//! The case that fills screens: a shader that passes its colour on, straight alpha, one sample of
//! unorm8. A block that a triangle covers whole shares its products of columns and rows, and
//! colours go from the planes to the attachment in registers. Nothing is rounded otherwise than in
//! [`color`](super::color); what is left out changes nothing:
//!
//! * a source is not clamped where the planes' extremes lie in 0..=1 (planes are monotone in x and
//!   in y, rounding included, so that the extremes are at corners);
//! * the blend of values in 0..=1 is not clamped: it is at least 0, and it exceeds 1 by rounding
//!   alone, which gives the code 255 as well;
//! * the alpha of what is opaque already is not computed: it stays 255.

use super::compare::compare;
use super::sample_tests::SampleTests;
use crate::bounds::plane::Plane;
use crate::fragment::interpolate::{DepthPlane, PlaneBlock, PlaneOrigin, VaryingPlanes};
use crate::raster::{TileShape, packet_origin};
use estampe_simd::{
    Bytes, LANES, Lanes, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, f32x16, i32x16, u32x16,
};

/// Planes of a triangle's colour: R, G, B and straight alpha, linear in the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColorPlanes {
    origin: PlaneOrigin,
    channels: [Plane; 4],
    /// True if no value in the tile needs clamping.
    is_in_range: bool,
    /// True if alpha is constant over the triangle.
    has_one_alpha: bool,
}

impl ColorPlanes {
    /// The first four varyings of a triangle whose 1/w are equal, in a tile; `is_bgra` says that
    /// texels have blue in the low byte.
    #[inline(always)]
    pub(crate) fn new(
        origin: PlaneOrigin,
        planes: &VaryingPlanes<'_>,
        tile: TileShape,
        is_bgra: bool,
    ) -> Self {
        let mut channels = [planes.of(0), planes.of(1), planes.of(2), planes.of(3)];
        if is_bgra {
            channels.swap(0, 2);
        }
        let side = tile.side() as f32;
        let (x, y) = (tile.x as f32 - origin.x, tile.y as f32 - origin.y);
        // Pixels' centres lie within this square, so the planes' values at its corners bound
        // theirs.
        let corners = [[0.0, 0.0], [side, 0.0], [0.0, side], [side, side]];
        let is_in_range = channels.iter().all(|plane| {
            corners.iter().all(|[right, lower]| {
                let value = plane.origin + ((x + right) * plane.dx + (y + lower) * plane.dy);
                (0.0..=1.0).contains(&value)
            })
        });
        let Plane { dx, dy, .. } = channels[3];
        Self {
            origin,
            channels,
            is_in_range,
            has_one_alpha: dx == 0.0 && dy == 0.0,
        }
    }
}

/// A block of a tile: sixteen packets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileBlock {
    /// The block's first pixel in the target.
    pixel: [i32; 2],
    /// Its first packet in the tile.
    first_packet: usize,
}

impl TileBlock {
    /// Block number `block` of a tile, 0 to 15.
    #[inline(always)]
    pub(crate) fn new(tile: TileShape, block: u32) -> Self {
        let (x, y) = packet_origin(block * 16);
        Self {
            pixel: [tile.x + x, tile.y + y],
            first_packet: block as usize * LANES,
        }
    }
}

/// The lanes of each packet of a block in which a triangle passes the depth test; depth is written
/// if the state says so. The tests must be of depth alone.
#[inline(always)]
pub(crate) fn test_block<S: Lanes>(
    s: S,
    tests: &SampleTests,
    plane: &DepthPlane,
    block: TileBlock,
    stored: &mut [[f32; LANES]],
) -> [u16; LANES] {
    debug_assert!(tests.is_depth_alone(), "stencil is tested packet by packet");
    let mut masks = [u16::MAX; LANES];
    let Some(state) = tests.depth else {
        return masks;
    };
    let steps = PlaneBlock::new(s, &plane.origin, &plane.z, block.pixel, [0.5; 2]);
    let lines = stored[block.first_packet..].iter_mut();
    for (packet, (mask, line)) in masks.iter_mut().zip(lines).enumerate() {
        let new = tests.stored.of(s, steps.at(packet));
        let old = f32x16::load_array_ref(s, line);
        let passes = compare(state.compare, new, old);
        if state.write_enabled {
            passes.select(new, old).store_array(line);
        }
        *mask = s.bits_of_mask(passes);
    }
    masks
}

/// Blends a triangle's colours over a block, in the lanes of the masks.
#[inline(always)]
pub(crate) fn blend_block<S: Lanes>(
    s: S,
    colors: &ColorPlanes,
    block: TileBlock,
    masks: &[u16; LANES],
    stored: &mut [[u32; LANES]],
) {
    let stored = &mut stored[block.first_packet..][..LANES];
    let steps = |channel: usize| {
        let plane = &colors.channels[channel];
        PlaneBlock::new(s, &colors.origin, plane, block.pixel, [0.5; 2])
    };
    let steps = [steps(0), steps(1), steps(2), steps(3)];
    match (colors.is_in_range, colors.has_one_alpha) {
        (true, true) => blend_packets::<S, true, true>(s, &steps, masks, stored),
        (true, false) => blend_packets::<S, true, false>(s, &steps, masks, stored),
        _ => blend_packets::<S, false, false>(s, &steps, masks, stored),
    }
}

#[inline(always)]
fn blend_packets<S: Lanes, const IN_RANGE: bool, const ONE_ALPHA: bool>(
    s: S,
    steps: &[PlaneBlock<S>; 4],
    masks: &[u16; LANES],
    stored: &mut [[u32; LANES]],
) {
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    let first_alpha = steps[3].at(0);
    let first_rest = one - first_alpha;
    for (packet, (line, &mask)) in stored.iter_mut().zip(masks).enumerate() {
        if mask == 0 {
            continue;
        }
        let mut source = [
            steps[0].at(packet),
            steps[1].at(packet),
            steps[2].at(packet),
            first_alpha,
        ];
        if !ONE_ALPHA {
            source[3] = steps[3].at(packet);
        }
        if !IN_RANGE {
            let mut channel = 0;
            while channel < 4 {
                source[channel] = saturate(s, source[channel]);
                channel += 1;
            }
        }
        let alpha = source[3];
        let rest = if ONE_ALPHA { first_rest } else { one - alpha };
        let old = u32x16::load_array_ref(s, line);
        let below = unpack(s, old);
        let color = [
            source[0] * alpha + below[0] * rest,
            source[1] * alpha + below[1] * rest,
            source[2] * alpha + below[2] * rest,
        ];
        let rgb = unorm_code(color[0]) | (unorm_code(color[1]) << 8) | (unorm_code(color[2]) << 16);
        // What is opaque stays so: a + (1 − a) is 1 but for a rounding, whose code is 255.
        let opaque = <u32x16<S> as SimdBase<S>>::splat(s, 0xFF00_0000);
        let codes = if s.bits_of_mask(old.simd_ge(opaque)) == u16::MAX {
            rgb | opaque
        } else {
            rgb | (unorm_code(alpha + below[3] * rest) << 24)
        };
        if mask == u16::MAX {
            codes.store_array(line);
        } else {
            s.mask_from_bits(mask).select(codes, old).store_array(line);
        }
    }
}

/// ⌊x·255 + ½⌋ of a value that is at least 0, and above 1 by less than 1/512.
#[inline(always)]
fn unorm_code<S: Lanes>(value: f32x16<S>) -> u32x16<S> {
    i32x16::truncate_from(value * 255.0 + 0.5).bitcast()
}

/// The channels of RGBA8 texels.
#[inline(always)]
fn unpack<S: Lanes>(s: S, packed: u32x16<S>) -> [f32x16<S>; 4] {
    let unorm = |code: u32x16<S>| {
        let signed: i32x16<S> = code.bitcast();
        f32x16::float_from(signed) * (1.0 / 255.0)
    };
    let byte = |code: u32x16<S>| code & <u32x16<S> as SimdBase<S>>::splat(s, 0xFF);
    [
        unorm(byte(packed)),
        unorm(byte(packed >> 8)),
        unorm(byte(packed >> 16)),
        unorm(packed >> 24),
    ]
}

/// 0..=1, NaN being 0.
#[inline(always)]
fn saturate<S: Lanes>(s: S, value: f32x16<S>) -> f32x16<S> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    s.min_f32(s.max_f32(value, zero), one)
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
