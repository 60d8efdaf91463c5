//! The taps of a filter: samples of one texture at several places, which are blocks of pixels.
//!
//! Taps whose u is the same read the same columns of texels, so a row of texels is loaded and
//! filtered along x once for all of them: of the 13 taps of a downsampling filter, which stand in
//! five columns, 56 rows of texels in place of 104. The arithmetic of each tap is that of
//! `block.rs`, in the same order, so the bits are the same.

use super::block::{BlockLevel, NEIGHBOURS, WORDS};
use crate::view::coordinates::{Answers, packet};
use crate::view::packet_texel::RGBA16F;
use crate::view::{PacketLod, SampledTexture};
use crate::wrap::Place;
use estampe_simd::{
    Bytes, Columns, LANES, Lanes as SimdLanes, Packet as Values, SimdBase, dispatch, f32x16,
    i32x16, mask32x16, u32x16,
};
use estampe_types::AddressMode;

/// The most taps that are sampled together.
pub(in crate::view) const MOST_TAPS: usize = 32;

/// Taps whose places are found at once.
const AT_ONCE: usize = 3;

/// The most taps that share their columns.
const MOST_SHARING: usize = 3 * AT_ONCE;

/// The most rows of texels of taps that share their columns, less one: a power of two.
const MOST_LINES: usize = 16;

/// Which taps of several were sampled, and how: bit `i` is tap `i`.
#[derive(Debug, Clone, Copy, Default)]
struct Taps {
    /// Those that are no blocks, of which nothing is stored.
    others: u32,
    /// Those that shared rows of texels.
    sharing: u32,
}

impl SampledTexture {
    /// Samples the finest level at several places (u, v), as far as they are blocks; returns the
    /// others, of which nothing is stored: bit `i` is place `i`.
    pub(crate) fn sample_blocks(
        &self,
        lod: PacketLod,
        at: &[[Values<f32>; 2]],
        colors: &mut [Answers],
    ) -> u32 {
        self.sample_taps(lod, at, colors).others
    }

    /// How many of several places in the finest level share rows of texels; tests see by it which
    /// way the places take.
    #[doc(hidden)]
    #[must_use]
    pub fn sharing_taps(&self, at: &[[Values<f32>; 2]]) -> u32 {
        let mut colors = vec![Answers::default(); at.len()];
        let taps = self.sample_taps(PacketLod::Level, at, &mut colors);
        taps.sharing.count_ones()
    }

    fn sample_taps(&self, lod: PacketLod, at: &[[Values<f32>; 2]], colors: &mut [Answers]) -> Taps {
        let none = Taps {
            others: u32::MAX >> (32 - at.len().clamp(1, MOST_TAPS)),
            sharing: 0,
        };
        let is_finest = self.ignores_lod
            || lod == PacketLod::Level
                && self.sampler.lod_bias == 0.0
                && self.sampler.lod_min_clamp <= 0.0;
        let has_blocks = self.packets.is_some_and(|format| format.kind() == RGBA16F);
        if !(is_finest && has_blocks && self.is_simple) || at.is_empty() || at.len() > MOST_TAPS {
            return none;
        }
        dispatch!(@specialized_move self.level, s => {
            let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                return none;
            };
            // Clamping is most common, and needs few of the constants that wrapping does.
            if level.mode == AddressMode::ClampToEdge {
                level.sample_each::<true>(s, at, colors)
            } else {
                level.sample_each::<false>(s, at, colors)
            }
        }, others => none)
    }
}

/// Taps that share their columns, three in a register.
#[derive(Debug, Clone, Copy)]
struct Places {
    /// The left texel of each column, then the upper texels of each tap's rows of pixels.
    texels: Values<i32>,
    /// The positions between these texels and the next.
    fractions: Values<f32>,
}

impl Places {
    const NONE: Self = Self {
        texels: Values([0; LANES]),
        fractions: Values([0.0; LANES]),
    };
}

impl<S: SimdLanes> BlockLevel<'_, S> {
    /// Samples at several places (u, v), as far as they are blocks. `CLAMPS` says that the mode is
    /// to clamp.
    #[inline(always)]
    fn sample_each<const CLAMPS: bool>(
        &self,
        s: S,
        at: &[[Values<f32>; 2]],
        colors: &mut [Answers],
    ) -> Taps {
        let mut taps = Taps::default();
        let mut left = u32::MAX >> (32 - at.len().clamp(1, MOST_TAPS));
        let (mut groups, mut count) = ([0; MOST_TAPS / 2], 0);
        let mut ungrouped = left;
        while !(ungrouped == 0 || ungrouped.is_power_of_two()) {
            let same = with_columns_of(s, at, ungrouped);
            ungrouped &= !same;
            if !same.is_power_of_two() {
                groups[count % groups.len()] = same;
                count += 1;
            }
        }
        if count > 0 {
            // Rows of texels, filtered along x, of one group after the other.
            let mut lines = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); MOST_LINES + 1];
            for &same in groups.iter().take(count) {
                if self.sample_sharing::<CLAMPS>(s, (at, same), colors, &mut lines) {
                    taps.sharing |= same;
                }
            }
        }
        left &= !taps.sharing;
        while left != 0 {
            let number = left.trailing_zeros() as usize;
            left &= left - 1;
            let Some(([u, v], colors)) = at.get(number).zip(colors.get_mut(number)) else {
                break;
            };
            let uv = [
                f32x16::load_array_ref(s, &u.0),
                f32x16::load_array_ref(s, &v.0),
            ];
            match self.sample::<CLAMPS>(s, uv) {
                Some([r, g, b, a]) => {
                    *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                }
                None => taps.others |= 1 << number,
            }
        }
        taps
    }

    /// Samples taps whose u is the same. False if they are no blocks, a texel is across a border,
    /// or texels are far apart; what is stored then means nothing.
    #[inline(always)]
    fn sample_sharing<const CLAMPS: bool>(
        &self,
        s: S,
        (at, taps): (&[[Values<f32>; 2]], u32),
        colors: &mut [Answers],
        lines: &mut [f32x16<S>; MOST_LINES + 1],
    ) -> bool {
        let Some([u, _]) = at.get(taps.trailing_zeros() as usize) else {
            return false;
        };
        let u = f32x16::load_array_ref(s, &u.0);
        let mut are_blocks: mask32x16<S> = u.simd_eq(s.first_row(u));
        let mut all = [Places::NONE; MOST_SHARING / AT_ONCE];
        let (mut top, mut bottom) = (i32::MAX, 0);
        let (mut columns, mut left) = (None, taps);
        for places in &mut all {
            if left == 0 {
                break;
            }
            let mut rows = [u; AT_ONCE];
            let mut slot = 0;
            while slot < AT_ONCE {
                // A register that is not full repeats its first tap.
                rows[slot] = rows[0];
                if let Some([_, v]) = at.get(left.trailing_zeros() as usize) {
                    rows[slot] = f32x16::load_array_ref(s, &v.0);
                    are_blocks &= rows[slot].simd_eq(s.first_column(rows[slot]));
                }
                left &= left.wrapping_sub(1);
                slot += 1;
            }
            let of_taps = s.columns_and_three_rows(u, rows);
            let Some(place) = self.place::<CLAMPS>(s, of_taps, u16::MAX) else {
                return false;
            };
            let place: Place<f32x16<S>> = place;
            places.texels.0 = place.texel.to_array();
            places.fractions = packet(place.fraction, 0);
            let mut row = 4;
            while row < LANES {
                // In a mirrored texture, any row may be the first or the last.
                if !CLAMPS || row % 4 == 0 || row % 4 == 3 {
                    top = top.min(places.texels.0[row]);
                    bottom = bottom.max(places.texels.0[row]);
                }
                row += 1;
            }
            columns = Some((place.texel, s.spread_columns(place.fraction)));
        }
        let Some(columns) = columns else {
            return false;
        };
        let last = (bottom - top).cast_unsigned() as usize + 1;
        let is_near = left == 0 && last < MOST_LINES;
        if !is_near || s.bits_of_mask(are_blocks) != u16::MAX {
            return false;
        }
        if self.lines(s, columns, top, &mut lines[..=last]).is_none() {
            return false;
        }
        let mut left = taps;
        for places in &all {
            let mut slot = 0;
            while slot < AT_ONCE {
                let Some(colors) = colors.get_mut(left.trailing_zeros() as usize) else {
                    return left == 0;
                };
                left &= left - 1;
                let mut filtered = [u; 4];
                let mut row = 0;
                while row < 4 {
                    let lane = 4 * slot + 4 + row;
                    let line = places.texels.0[lane].wrapping_sub(top).cast_unsigned() as usize;
                    // Below the number of lines already: without a test.
                    let line = line % MOST_LINES;
                    let (upper, lower) = (lines[line], lines[line + 1]);
                    let down = <f32x16<S> as SimdBase<S>>::splat(s, places.fractions.0[lane]);
                    filtered[row] = upper + (lower - upper) * down;
                    row += 1;
                }
                let [r, g, b, a] = s.channels_of_rows(filtered);
                *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                slot += 1;
            }
        }
        true
    }

    /// Rows of texels from `top` on, filtered between the texels of the columns; `None` if texels
    /// are far apart, or not in memory.
    #[inline(always)]
    fn lines(
        &self,
        s: S,
        (texel, across): (i32x16<S>, f32x16<S>),
        top: i32,
        lines: &mut [f32x16<S>],
    ) -> Option<()> {
        let [first, second, third, fourth, ..] = texel.to_array();
        let left = first.min(fourth);
        let before = top.cast_unsigned() as usize * self.row_words;
        let before = before + left.cast_unsigned() as usize * WORDS;
        let mut texels = self.texels.get(self.begin + before..)?;
        if [second, third, fourth] == [first + 1, first + 2, first + 3] {
            for (at, line) in lines.iter_mut().enumerate() {
                if at > 0 {
                    texels = texels.get(self.row_words..)?;
                }
                let words: &[u32; NEIGHBOURS] = texels.first_chunk()?;
                let right = s.row_of_halves(words.last_chunk()?)?;
                let left = s.row_of_halves(words.first_chunk()?)?;
                *line = left + (right - left) * across;
            }
            return Some(());
        }
        let columns = Columns::new(s, texel, left)?;
        for (at, line) in lines.iter_mut().enumerate() {
            if at > 0 {
                texels = texels.get(self.row_words..)?;
            }
            // At the end of the texture a part of the window may not be in memory.
            let [left, right] = s.half_texels(texels.first_chunk()?, &columns)?;
            *line = left + (right - left) * across;
        }
        Some(())
    }
}

/// The first of some taps, each a bit, and those whose u is the same: at most [`MOST_SHARING`].
#[inline(always)]
fn with_columns_of<S: SimdLanes>(s: S, at: &[[Values<f32>; 2]], taps: u32) -> u32 {
    let first = taps.trailing_zeros() as usize;
    let (mut same, mut left) = (1 << first, taps & (taps - 1));
    let Some([of_first, _]) = at.get(first) else {
        return same;
    };
    let first_lane = of_first.0[0].to_bits();
    let bits: u32x16<S> = f32x16::load_array_ref(s, &of_first.0).bitcast();
    let mut room = MOST_SHARING - 1;
    while left != 0 && room != 0 {
        let number = left.trailing_zeros() as usize;
        left &= left - 1;
        // Most taps differ in the first lane already.
        let Some([u, _]) = at
            .get(number)
            .filter(|[u, _]| u.0[0].to_bits() == first_lane)
        else {
            continue;
        };
        let of_tap: u32x16<S> = f32x16::load_array_ref(s, &u.0).bitcast();
        let is_same: mask32x16<S> = of_tap.simd_eq(bits);
        if s.bits_of_mask(is_same) == u16::MAX {
            same |= 1 << number;
            room -= 1;
        }
    }
    same
}
