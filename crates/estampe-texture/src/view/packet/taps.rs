//! Samples of one texture at several places, which are blocks of pixels: the taps of a filter, or a
//! place in each packet of a batch.
//!
//! First all places are found, then all are filtered: the steps that lead to a place take long, and
//! no place waits for another. Taps whose u is the same read the same columns of texels, so a row
//! of texels is loaded and filtered along x once for all of them: of the 13 taps of a downsampling
//! filter, which stand in five columns, 56 rows of texels in place of 104. The arithmetic of each
//! place is that of `block.rs`, in the same order, so the bits are the same.

use super::block::{BlockLevel, Footprint};
use crate::PacketPlaces;
use crate::view::blocks::blocks_ahead;
use crate::view::coordinates::{Answers, packet};
use crate::view::packet_texel::RGBA16F;
use crate::view::{PacketLod, SampledTexture};
use estampe_simd::{
    Bytes, LANES, Lanes as SimdLanes, Packet as Values, SimdBase, dispatch, f32x16, mask32x16,
    u32x16,
};
use estampe_types::AddressMode;

/// The most places that are sampled together.
pub(in crate::view) const MOST_TAPS: usize = LANES;

/// The most rows of texels of taps that share their columns, less one: a power of two.
const MOST_LINES: usize = 16;

/// How many blocks before it is sampled a block is prefetched: those of a batch.
const AHEAD: u32 = 16;

/// Which of several places were sampled, and how: bit `i` is place `i`.
#[derive(Debug, Clone, Copy, Default)]
struct Taps {
    /// Those that are no blocks, of which nothing is stored that counts.
    others: u32,
    /// Those that shared rows of texels.
    sharing: u32,
}

impl SampledTexture {
    /// Samples the finest level at several places (u, v), as far as they are blocks; returns the
    /// others, of which nothing is stored that counts: bit `i` is place `i`. `TAPS` says that the
    /// places are of the same fragments, and not of those of packet after packet.
    pub(crate) fn sample_blocks<const TAPS: bool>(
        &self,
        lod: PacketLod,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> u32 {
        self.sample_taps::<TAPS>(lod, places, colors).others
    }

    /// How many of several places in the finest level share rows of texels; tests see by it which
    /// way the places take.
    #[doc(hidden)]
    #[must_use]
    pub fn sharing_taps(&self, at: &[[Values<f32>; 2]]) -> u32 {
        let mut colors = vec![Answers::default(); at.len()];
        let places = PacketPlaces::of_pairs(at);
        let taps = self.sample_taps::<true>(PacketLod::Level, &places, &mut colors);
        taps.sharing.count_ones()
    }

    /// True if places may be blocks: of half floats, in the finest level.
    pub(in crate::view) fn may_have_blocks(&self, lod: PacketLod) -> bool {
        let is_finest = self.ignores_lod
            || lod == PacketLod::Level
                && self.sampler.lod_bias == 0.0
                && self.sampler.lod_min_clamp <= 0.0;
        let has_halves = self.packets.is_some_and(|format| format.kind() == RGBA16F);
        is_finest && has_halves && self.is_simple
    }

    fn sample_taps<const TAPS: bool>(
        &self,
        lod: PacketLod,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> Taps {
        let count = colors.len();
        let none = Taps {
            others: all_of(count),
            sharing: 0,
        };
        if !self.may_have_blocks(lod) || count == 0 || count > MOST_TAPS {
            return none;
        }
        dispatch!(@specialized_move self.level, s => {
            let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                return none;
            };
            // Clamping is most common, and needs few of the constants that wrapping does.
            if level.mode == AddressMode::ClampToEdge {
                self.sample_at_level::<_, true, TAPS>(s, &level, places, colors)
            } else {
                self.sample_at_level::<_, false, TAPS>(s, &level, places, colors)
            }
        }, others => none)
    }

    /// Samples at several places (u, v), as far as they are blocks. `CLAMPS` says that the mode is
    /// to clamp.
    #[inline(always)]
    fn sample_at_level<S: SimdLanes, const CLAMPS: bool, const TAPS: bool>(
        &self,
        s: S,
        level: &BlockLevel<'_, S>,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> Taps {
        let (mut blocks, mut first_lanes) = (0, Values([0; LANES]));
        for (at, (uv, colors)) in places.each().zip(colors.iter_mut()).enumerate() {
            blocks |= u32::from(level.find::<CLAMPS>(s, uv, colors)) << at;
            first_lanes.0[at % LANES] = uv[0].0[0].to_bits();
        }
        let mut taps = Taps::default();
        if TAPS {
            let taken = (places, &first_lanes, blocks);
            taps.sharing = level.sample_sharing::<CLAMPS>(s, taken, colors);
        }
        let mut left = blocks & !taps.sharing;
        while left != 0 {
            let at = left.trailing_zeros() as usize;
            left &= left - 1;
            let Some(colors) = colors.get_mut(at) else {
                break;
            };
            let footprint = Footprint::of(colors);
            let are_neighbours = footprint.are_neighbours(s);
            if !TAPS && are_neighbours {
                // A sample at the centre of a texel may be just before it.
                let block = [footprint.texel(0) + 1, footprint.texel(4) + 1];
                if let Some(ahead) = blocks_ahead(block, AHEAD) {
                    self.view.prefetch_blocks(s, &self.view.planes[0], ahead);
                }
            }
            match level.filter(s, footprint, are_neighbours) {
                Some([r, g, b, a]) => {
                    *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                }
                None => blocks &= !(1 << at),
            }
        }
        taps.others = all_of(colors.len()) & !blocks;
        taps
    }
}

/// A bit for each of so many places.
fn all_of(count: usize) -> u32 {
    (1 << count.min(MOST_TAPS)) - 1
}

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Samples taps whose u is that of other taps, which most differ in the first lane already;
    /// returns which were sampled. The footprints of blocks have been found; those of the others
    /// are left as they are.
    #[inline(always)]
    fn sample_sharing<const CLAMPS: bool>(
        &self,
        s: S,
        (places, first_lanes, blocks): (&PacketPlaces<'_>, &Values<u32>, u32),
        colors: &mut [Answers],
    ) -> u32 {
        let (mut groups, mut count) = ([0; MOST_TAPS / 2], 0);
        let of_taps = u32x16::load_array_ref(s, &first_lanes.0);
        let mut ungrouped = blocks;
        while !(ungrouped == 0 || ungrouped.is_power_of_two()) {
            let first = first_lanes.0[ungrouped.trailing_zeros() as usize % LANES];
            let is_same: mask32x16<S> = of_taps.simd_eq(u32x16::splat(s, first));
            let same = u32::from(s.bits_of_mask(is_same)) & ungrouped;
            ungrouped &= !same;
            if !same.is_power_of_two() {
                groups[count % groups.len()] = same;
                count += 1;
            }
        }
        let mut sharing = 0;
        if count > 0 {
            // Rows of texels, filtered along x, of one group after the other.
            let mut lines = [self.lengths; MOST_LINES + 1];
            for &taps in groups.iter().take(count) {
                if self.sample_group::<CLAMPS>(s, (places, taps), colors, &mut lines) {
                    sharing |= taps;
                }
            }
        }
        sharing
    }

    /// Samples taps whose u is the same. False if it is not, or texels are far apart or not in
    /// memory.
    #[inline(always)]
    fn sample_group<const CLAMPS: bool>(
        &self,
        s: S,
        (places, taps): (&PacketPlaces<'_>, u32),
        colors: &mut [Answers],
        lines: &mut [f32x16<S>; MOST_LINES + 1],
    ) -> bool {
        let first = taps.trailing_zeros() as usize;
        let (Some(of_first), Some(u)) = (colors.get(first), places.u_of(first)) else {
            return false;
        };
        let bits: u32x16<S> = f32x16::load_array_ref(s, &u.0).bitcast();
        let mut different: u32x16<S> = SimdBase::splat(s, 0);
        let (mut top, mut bottom) = (i32::MAX, 0);
        let mut left = taps;
        while left != 0 {
            let at = left.trailing_zeros() as usize;
            left &= left - 1;
            let (Some(colors), Some(u)) = (colors.get(at), places.u_of(at)) else {
                return false;
            };
            let of_tap: u32x16<S> = f32x16::load_array_ref(s, &u.0).bitcast();
            different |= of_tap ^ bits;
            let footprint = Footprint::of(colors);
            let mut row = 4;
            while row < 8 {
                // In a mirrored texture, any row may be the first or the last.
                if !CLAMPS || row == 4 || row == 7 {
                    top = top.min(footprint.texel(row));
                    bottom = bottom.max(footprint.texel(row));
                }
                row += 1;
            }
        }
        let is_same: mask32x16<S> = different.simd_eq(u32x16::splat(s, 0));
        let last = (bottom - top).cast_unsigned() as usize + 1;
        if last >= MOST_LINES || s.bits_of_mask(is_same) != u16::MAX {
            return false;
        }
        let columns = Footprint::of(of_first);
        if self.lines(s, columns, top, &mut lines[..=last]).is_none() {
            return false;
        }
        let mut left = taps;
        while left != 0 {
            let Some(colors) = colors.get_mut(left.trailing_zeros() as usize) else {
                return false;
            };
            left &= left - 1;
            let footprint = Footprint::of(colors);
            let mut filtered = [lines[0]; 4];
            let mut row = 0;
            while row < 4 {
                let line = footprint.texel(4 + row).wrapping_sub(top).cast_unsigned() as usize;
                // Below the number of lines already: without a test.
                let line = line % MOST_LINES;
                let (upper, lower) = (lines[line], lines[line + 1]);
                filtered[row] = upper + (lower - upper) * footprint.down(s, row);
                row += 1;
            }
            let [r, g, b, a] = s.channels_of_rows(filtered);
            *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
        }
        true
    }
}
