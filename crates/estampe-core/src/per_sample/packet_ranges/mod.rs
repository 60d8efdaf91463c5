//! Hierarchical z of packets: the least and the greatest stored depth of each 4×4 pixels, for
//! draws that read depth and count in the stencil.
//!
//! The triangles of a shadow volume are many, and thin, and each is before or behind what a packet
//! holds; which of the two decides where the stencil counts. Such a draw stores no depth, so that
//! ranges which are scanned once serve all of its triangles, and the sixteen packets of a block are
//! the lanes of one comparison:
//!
//! ```text
//!     nearer than all that is stored:  passes; nothing changes, the packet is not even covered
//!     behind all of it:                fails; the stencil changes, no depth is evaluated
//!     otherwise                        every sample is tested
//! ```
//!
//! As for [blocks](super::hiz), a plane's extremes over a packet are its values at two corners.
//! Rounding to fixed point moves a depth by less than two codes; ranges are compared with a margin
//! of four, in place of the division.

use super::compare::{extremes, orders, prefers_less};
use super::hiz::{HizQuery, corner, starts_of_units};
use super::sample_tests::SampleTests;
use crate::bounds::plane::Plane;
use crate::depth_format::clamp_depth;
use crate::fragment::interpolate::evaluate;
use crate::raster::{PacketClasses, packet_origin};
use estampe_simd::{LANES, Lanes, SimdBase, f32x16};

/// Blocks of a tile, at most.
const BLOCKS: usize = 16;

/// Ranges of the stored depths of a tile's packets.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct PacketRanges {
    /// By block and packet.
    least: [[f32; LANES]; BLOCKS],
    greatest: [[f32; LANES]; BLOCKS],
    /// Blocks whose ranges are out of date, one bit each.
    stale: u16,
}

impl Default for PacketRanges {
    fn default() -> Self {
        Self {
            least: [[0.0; LANES]; BLOCKS],
            greatest: [[0.0; LANES]; BLOCKS],
            stale: u16::MAX,
        }
    }
}

impl PacketRanges {
    /// Returns true if the packets of a draw with these tests are worth a look: most of its samples
    /// change nothing, or only their stencil value, and it stores no depth.
    pub(crate) fn serve(tests: &SampleTests) -> bool {
        let ordered = tests.depth.is_some_and(|state| orders(state.compare));
        tests.stencil.is_some() && ordered && !tests.writes_depth()
    }

    /// Notes that blocks were written.
    #[inline(always)]
    pub(crate) fn invalidate(&mut self, blocks: u16) {
        self.stale |= blocks;
    }

    /// Scans those of some blocks that are out of date.
    #[inline(always)]
    pub(crate) fn refresh(&mut self, blocks: u16, samples: usize, stored: &[[f32; LANES]]) {
        let stale = self.stale & blocks;
        if stale != 0 {
            self.scan(stale, samples, stored);
        }
    }

    #[inline(never)]
    fn scan(&mut self, mut blocks: u16, samples: usize, stored: &[[f32; LANES]]) {
        self.stale &= !blocks;
        while blocks != 0 {
            let block = blocks.trailing_zeros() as usize % BLOCKS;
            blocks &= blocks - 1;
            let lines = stored.chunks_exact(samples).skip(block * LANES);
            for (packet, lines) in lines.take(LANES).enumerate() {
                let [least, greatest] = extremes(lines);
                (self.least[block][packet], self.greatest[block][packet]) = (least, greatest);
            }
        }
    }
}

/// A triangle whose packets are compared with the ranges.
pub(crate) struct PacketQuery<'a, S: Lanes> {
    ranges: &'a PacketRanges,
    plane: Plane,
    range: [f32; 2],
    /// Distances from the plane's origin of the least and of the greatest corner of the packets of
    /// a block that begins at the window's first pixel: columns, rows.
    least: [f32x16<S>; 2],
    greatest: [f32x16<S>; 2],
    /// The tile's first pixel.
    tile: [i32; 2],
    margin: f32,
    is_less: bool,
    /// Packets that fail, or pass, change nothing.
    hides_failing: bool,
    hides_passing: bool,
}

impl<'a, S: Lanes> PacketQuery<'a, S> {
    #[inline(always)]
    pub(crate) fn new<const N: usize>(
        s: S,
        look: &HizQuery<'_, N>,
        ranges: &'a PacketRanges,
    ) -> Self {
        let HizQuery { plane, tests, .. } = look;
        let positions = look.samples.subpixels();
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let [columns, rows] = starts_of_units(s, 4);
        let origin = plane.origin;
        // Positions are multiples of 1/256 below 2¹⁶: every sum is exact.
        let from = |least: bool| {
            [
                corner(&positions, 0, plane.z.dx, least, 4) - origin.x,
                corner(&positions, 1, plane.z.dy, least, 4) - origin.y,
            ]
        };
        let ([least_x, least_y], [greatest_x, greatest_y]) = (from(true), from(false));
        Self {
            ranges,
            plane: plane.z,
            range: tests.stored.range,
            least: [columns + splat(least_x), rows + splat(least_y)],
            greatest: [columns + splat(greatest_x), rows + splat(greatest_y)],
            tile: [look.tile.x, look.tile.y],
            margin: tests.stored.format.step() * 4.0,
            is_less: tests.depth.is_none_or(|state| prefers_less(state.compare)),
            hides_failing: tests.early_failure_is_final(),
            hides_passing: look.passes_in_vain,
        }
    }
}

impl<S: Lanes> PacketClasses<S> for PacketQuery<'_, S> {
    /// Those that are tested, and those of which every sample fails the depth test.
    #[inline(always)]
    fn of_block(&self, s: S, block: usize, packets: u16) -> [u16; 2] {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        #[expect(clippy::cast_possible_truncation, reason = "a tile has sixteen blocks")]
        let (x, y) = packet_origin((block % BLOCKS * LANES) as u32);
        let x = splat((self.tile[0] + x) as f32);
        let y = splat((self.tile[1] + y) as f32);
        let least = evaluate(s, &self.plane, [self.least[0] + x, self.least[1] + y]);
        let greatest = evaluate(s, &self.plane, [self.greatest[0] + x, self.greatest[1] + y]);
        let least = clamp_depth(s, least, self.range) - splat(self.margin);
        let greatest = clamp_depth(s, greatest, self.range) + splat(self.margin);
        let stored_least = f32x16::load_array_ref(s, &self.ranges.least[block % BLOCKS]);
        let stored_greatest = f32x16::load_array_ref(s, &self.ranges.greatest[block % BLOCKS]);
        let above = s.bits_of_mask(least.simd_gt(stored_greatest));
        let below = s.bits_of_mask(greatest.simd_lt(stored_least));
        let (fails, passes) = if self.is_less {
            (above, below)
        } else {
            (below, above)
        };
        let packets = if self.hides_passing {
            packets & !passes
        } else {
            packets
        };
        if self.hides_failing {
            [packets & !fails, 0]
        } else {
            [packets & !fails, packets & fails]
        }
    }
}

#[cfg(test)]
mod tests;
