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
//! They are sums of three parts, of the triangle, the block and the packet, which are not rounded
//! as a sample's depth is, so that they are compared with a margin. Rounding to fixed point moves a
//! depth by less than two codes; there the margin has four more, in place of the division.

use super::compare::{extremes, orders, prefers_less};
use super::hiz::{HizQuery, corner, starts_of_units};
use super::sample_tests::SampleTests;
use crate::fragment::interpolate::PlaneOrigin;
use crate::raster::PacketClasses;
use estampe_simd::{LANES, Lanes, SimdBase, f32x16};

/// Blocks of a tile, at most.
const BLOCKS: usize = 16;
/// Sixteen roundings, relative to a sum of absolute values.
const ROUNDINGS: f32 = 16.0 / (1 << 24) as f32;

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

/// The distance by which ranges are compared: a fixed-point format's rounding.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Margin(f32);

impl Margin {
    pub(crate) fn of(tests: &SampleTests) -> Self {
        Self(tests.stored.format.step() * 4.0)
    }
}

/// A triangle whose packets are compared with the ranges.
pub(crate) struct PacketQuery<'a, S: Lanes> {
    ranges: &'a PacketRanges,
    /// By block: the difference of its depths to those of the tile's first block.
    blocks: [f32; BLOCKS],
    /// Bounds of the depths of the packets of the tile's first block, with every margin.
    least: f32x16<S>,
    greatest: f32x16<S>,
    /// The range that depth is clamped to, with the format's margin.
    clamp: [f32; 2],
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
        Margin(margin): Margin,
    ) -> Self {
        let HizQuery { plane, tests, .. } = look;
        let positions = look.samples.subpixels();
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let PlaneOrigin { x, y } = plane.origin;
        let (x, y) = (look.tile.x as f32 - x, look.tile.y as f32 - y);
        // Positions are multiples of 1/256 below 2¹⁶: every sum is exact.
        let at = |least: bool| {
            let x = x + corner(&positions, 0, plane.z.dx, least, 4);
            let y = y + corner(&positions, 1, plane.z.dy, least, 4);
            plane.z.origin + (plane.z.dx * x + plane.z.dy * y)
        };
        // In roundings of this sum, a sample's depth is wrong by up to three, a bound by up to ten.
        let reach = look.tile.side() as f32;
        let greatest = plane.z.origin.abs()
            + (plane.z.dx.abs() * (x.abs() + reach) + plane.z.dy.abs() * (y.abs() + reach));
        let margin_of_sums = margin + greatest * ROUNDINGS;
        // Bounds of sums that overflow are infinite, and decide nothing.
        let ([dx, dy], [least, greatest]) = if margin_of_sums < f32::INFINITY {
            let bounds = [at(true) - margin_of_sums, at(false) + margin_of_sums];
            ([plane.z.dx, plane.z.dy], bounds)
        } else {
            ([0.0; 2], [f32::NEG_INFINITY, f32::INFINITY])
        };
        let [columns, rows] = starts_of_units(s, 4);
        let packets = columns * splat(dx) + rows * splat(dy);
        let mut blocks = [0.0; BLOCKS];
        (packets * splat(4.0)).store_array(&mut blocks);
        let [low, high] = tests.stored.range;
        Self {
            ranges,
            blocks,
            least: packets + splat(least),
            greatest: packets + splat(greatest),
            clamp: [low + margin, high - margin],
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
        let of_block = splat(self.blocks[block % BLOCKS]);
        let least = s.min_f32(self.least + of_block, splat(self.clamp[1]));
        let greatest = s.max_f32(self.greatest + of_block, splat(self.clamp[0]));
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
