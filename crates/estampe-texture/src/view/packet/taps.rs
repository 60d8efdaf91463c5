//! Samples of one texture at several places, which are blocks of pixels: the taps of a filter whose
//! places are known when the shader has computed them. (Taps at shifts that are known before are in
//! `filter.rs`.)
//!
//! First all places are found, then all are filtered: the steps that lead to a place take long, and
//! no place waits for another. Taps whose u is the same read the same columns of texels, so a row
//! of texels is loaded and filtered along x once for all of them: of the 13 taps of a downsampling
//! filter, which stand in five columns, 56 rows of texels in place of 104. The arithmetic of each
//! place is that of `block.rs`, in the same order, so the bits are the same.

use super::block::{BlockLevel, Footprint, Spot};
use crate::PacketPlaces;
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
pub(super) const MOST_LINES: usize = 16;

/// Which of several places were sampled, and how: bit `i` is place `i`.
#[derive(Debug, Clone, Copy, Default)]
struct Taps {
    /// Those that are no blocks, of which nothing is stored that counts.
    others: u32,
    /// Those that shared rows of texels.
    sharing: u32,
}

impl SampledTexture {
    /// Samples the finest level at several places (u, v) of the same fragments, as far as they are
    /// blocks; returns the others, of which nothing is stored that counts: bit `i` is place `i`.
    pub(crate) fn sample_blocks(
        &self,
        lod: PacketLod,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> u32 {
        self.sample_taps(lod, places, colors).others
    }

    /// How many of several places in the finest level share rows of texels; tests see by it which
    /// way the places take.
    #[doc(hidden)]
    #[must_use]
    pub fn sharing_taps(&self, at: &[[Values<f32>; 2]]) -> u32 {
        let mut colors = vec![Answers::default(); at.len()];
        let places = PacketPlaces::of_pairs(at);
        let taps = self.sample_taps(PacketLod::Level, &places, &mut colors);
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

    fn sample_taps(
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
                level.sample_each::<true>(s, places, colors)
            } else {
                level.sample_each::<false>(s, places, colors)
            }
        }, others => none)
    }
}

/// A bit for each of so many places.
pub(super) fn all_of(count: usize) -> u32 {
    (1 << count.min(MOST_TAPS)) - 1
}

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Samples at several places (u, v), as far as they are blocks. `CLAMPS` says that the mode is
    /// to clamp.
    #[inline(always)]
    fn sample_each<const CLAMPS: bool>(
        &self,
        s: S,
        places: &PacketPlaces<'_>,
        colors: &mut [Answers],
    ) -> Taps {
        let mut spots = [Spot::default(); MOST_TAPS];
        let (mut blocks, mut first_lanes) = (0, Values([0; LANES]));
        for (at, (uv, spot)) in places.each().zip(&mut spots).enumerate() {
            blocks |= u32::from(self.find::<CLAMPS>(s, uv, spot)) << at;
            first_lanes.0[at] = uv[0].0[0].to_bits();
        }
        let found = (&spots, &first_lanes, blocks);
        let sharing = self.sample_sharing(s, places, found, colors);
        let mut left = blocks & !sharing;
        while left != 0 {
            let at = left.trailing_zeros() as usize;
            left &= left - 1;
            let Some(colors) = colors.get_mut(at) else {
                break;
            };
            let footprint = Footprint::of(&spots[at % MOST_TAPS]);
            match self.filter(s, footprint, footprint.are_neighbours(s)) {
                Some([r, g, b, a]) => {
                    *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                }
                None => blocks &= !(1 << at),
            }
        }
        Taps {
            others: all_of(colors.len()) & !blocks,
            sharing,
        }
    }

    /// Samples taps whose u is that of other taps, which most differ in the first lane already;
    /// returns which were sampled. The spots of blocks have been found.
    #[inline(always)]
    fn sample_sharing(
        &self,
        s: S,
        places: &PacketPlaces<'_>,
        (spots, first_lanes, blocks): (&[Spot; MOST_TAPS], &Values<u32>, u32),
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
            let mut lines = [Values([0.0; LANES]); MOST_LINES + 1];
            for &taps in groups.iter().take(count) {
                if self.sample_group(s, places, (spots, taps), colors, &mut lines) {
                    sharing |= taps;
                }
            }
        }
        sharing
    }

    /// Samples taps whose u is the same. False if it is not, or texels are far apart or not in
    /// memory.
    #[inline(always)]
    fn sample_group(
        &self,
        s: S,
        places: &PacketPlaces<'_>,
        (spots, taps): (&[Spot; MOST_TAPS], u32),
        colors: &mut [Answers],
        lines: &mut [Values<f32>; MOST_LINES + 1],
    ) -> bool {
        let first = taps.trailing_zeros() as usize % MOST_TAPS;
        let Some(u) = places.u_of(first) else {
            return false;
        };
        let bits: u32x16<S> = f32x16::load_array_ref(s, &u.0).bitcast();
        let mut different: u32x16<S> = SimdBase::splat(s, 0);
        let mut lines_of = Lines::NONE;
        let mut left = taps;
        while left != 0 {
            let at = left.trailing_zeros() as usize % MOST_TAPS;
            left &= left - 1;
            let Some(u) = places.u_of(at) else {
                return false;
            };
            let of_tap: u32x16<S> = f32x16::load_array_ref(s, &u.0).bitcast();
            different |= of_tap ^ bits;
            lines_of.add(Footprint::of(&spots[at]));
        }
        let is_same: mask32x16<S> = different.simd_eq(u32x16::splat(s, 0));
        let columns = Footprint::of(&spots[first]);
        let are_neighbours = columns.columns_are_neighbours();
        if s.bits_of_mask(is_same) != u16::MAX
            || !self.filter_lines(s, (columns, are_neighbours), &lines_of, lines)
        {
            return false;
        }
        let mut left = taps;
        while left != 0 {
            let at = left.trailing_zeros() as usize % MOST_TAPS;
            left &= left - 1;
            let Some(colors) = colors.get_mut(at) else {
                return false;
            };
            let [r, g, b, a] = lines_of.between(s, Footprint::of(&spots[at]), lines);
            *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
        }
        true
    }

    /// Filters rows of texels along x for taps of the same columns, and brings them into
    /// [pairs](SimdLanes::paired). False if the rows are too many, or texels far apart or not in
    /// memory.
    #[inline(always)]
    pub(super) fn filter_lines<const ROOM: usize>(
        &self,
        s: S,
        columns: (Footprint<'_>, bool),
        of: &Lines,
        lines: &mut [Values<f32>; ROOM],
    ) -> bool {
        let last = of.bottom.wrapping_sub(of.top).cast_unsigned() as usize + 1;
        last < lines_of_room(ROOM)
            && self
                .lines::<true>(s, columns, of.top, &mut lines[..=last])
                .is_some()
    }
}

/// The most lines in memory with room for some more: a power of two.
const fn lines_of_room(room: usize) -> usize {
    1 << (room - 1).ilog2()
}

/// The rows of texels that taps of the same columns share.
pub(super) struct Lines {
    /// The first row.
    top: i32,
    /// The last row but one.
    bottom: i32,
}

impl Lines {
    pub(super) const NONE: Self = Self {
        top: i32::MAX,
        bottom: 0,
    };

    /// Adds those of a tap. Any of its rows may be the first or the last: a texture may be
    /// mirrored, and a packet may show several triangles.
    #[inline(always)]
    pub(super) fn add(&mut self, tap: Footprint<'_>) {
        let mut row = 0;
        while row < 4 {
            self.add_rows([tap.row(row); 2]);
            row += 1;
        }
    }

    /// Adds those between the rows after a first and a last one.
    #[inline(always)]
    pub(super) fn add_rows(&mut self, [first, last]: [i32; 2]) {
        self.top = self.top.min(first);
        self.bottom = self.bottom.max(last);
    }

    /// The channels of a tap whose rows are between these, which are filtered along x and in pairs.
    /// The number of lines is a power of two and at least one.
    #[inline(always)]
    pub(super) fn between<S: SimdLanes, const ROOM: usize>(
        &self,
        s: S,
        tap: Footprint<'_>,
        lines: &[Values<f32>; ROOM],
    ) -> [f32x16<S>; 4] {
        let mut filtered = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); 4];
        let mut row = 0;
        while row < 4 {
            let line = tap.row(row).wrapping_sub(self.top).cast_unsigned() as usize;
            // Below the number of lines already: without a test.
            let line = line % const { lines_of_room(ROOM) };
            let upper = f32x16::load_array_ref(s, &lines[line].0);
            let lower = f32x16::load_array_ref(s, &lines[line + 1].0);
            filtered[row] = upper + (lower - upper) * tap.down(s, row);
            row += 1;
        }
        s.channels_of_paired(filtered)
    }

    /// [`between`](Self::between) of a tap whose rows are neighbours: five lines, each loaded once.
    /// There is room for four lines more than a power of two.
    #[inline(always)]
    pub(super) fn between_neighbours<S: SimdLanes, const ROOM: usize>(
        &self,
        s: S,
        tap: Footprint<'_>,
        lines: &[Values<f32>; ROOM],
    ) -> [f32x16<S>; 4] {
        let line = tap.row(0).wrapping_sub(self.top).cast_unsigned() as usize;
        let line = line % const { ROOM - 4 };
        let mut upper = f32x16::load_array_ref(s, &lines[line].0);
        let mut filtered = [upper; 4];
        let mut row = 0;
        while row < 4 {
            let lower = f32x16::load_array_ref(s, &lines[line + row + 1].0);
            filtered[row] = upper + (lower - upper) * tap.down(s, row);
            upper = lower;
            row += 1;
        }
        s.channels_of_paired(filtered)
    }
}
