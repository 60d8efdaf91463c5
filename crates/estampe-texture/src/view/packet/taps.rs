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
    Bytes, Columns, Lanes as SimdLanes, Packet as Values, SimdBase, dispatch, f32x16, i32x16,
    mask32x16, u32x16,
};
use estampe_types::AddressMode;

/// The most taps that are sampled together.
pub(in crate::view) const MOST_TAPS: usize = 32;

/// The most taps that share their columns.
const MOST_SHARING: usize = 8;

/// The most rows of texels of taps that share their columns.
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

/// A tap among those that share their columns.
#[derive(Debug, Clone, Copy)]
struct Sharing<S: SimdLanes> {
    number: usize,
    /// The upper texel of each row of pixels.
    rows: [i32; 4],
    /// The positions between the texels of columns and rows.
    fraction: f32x16<S>,
}

/// Memory for taps that share their columns, one group after the other.
struct Room<S: SimdLanes> {
    taps: [Sharing<S>; MOST_SHARING],
    /// Rows of texels, filtered along x.
    lines: [f32x16<S>; MOST_LINES],
}

impl<S: SimdLanes> Room<S> {
    #[inline(always)]
    fn new(s: S) -> Self {
        let zero = SimdBase::splat(s, 0.0);
        let tap = Sharing {
            number: 0,
            rows: [0; 4],
            fraction: zero,
        };
        Self {
            taps: [tap; MOST_SHARING],
            lines: [zero; MOST_LINES],
        }
    }
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
        if at.len() > 1 {
            let mut room = Room::new(s);
            let mut first = left;
            while first != 0 {
                let same = with_columns_of(s, at, first);
                first &= !same;
                if !same.is_power_of_two()
                    && self.sample_sharing::<CLAMPS>(s, (at, same), colors, &mut room)
                {
                    left &= !same;
                    taps.sharing |= same;
                }
            }
        }
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
        (at, mut taps): (&[[Values<f32>; 2]], u32),
        colors: &mut [Answers],
        room: &mut Room<S>,
    ) -> bool {
        let Some([u, _]) = at.get(taps.trailing_zeros() as usize) else {
            return false;
        };
        let u = f32x16::load_array_ref(s, &u.0);
        let mut are_blocks: mask32x16<S> = u.simd_eq(s.first_row(u));
        let mut across = u;
        let mut texel = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let (mut top, mut bottom) = (i32::MAX, 0);
        let mut count = 0;
        while taps != 0 {
            let number = taps.trailing_zeros() as usize;
            taps &= taps - 1;
            let (Some([_, v]), Some(tap)) = (at.get(number), room.taps.get_mut(count)) else {
                return false;
            };
            let v = f32x16::load_array_ref(s, &v.0);
            are_blocks &= v.simd_eq(s.first_column(v));
            let Some(place) = self.place::<CLAMPS>(s, [u, v]) else {
                return false;
            };
            let place: Place<f32x16<S>> = place;
            let of_place = place.texel.to_array();
            let rows = [of_place[4], of_place[5], of_place[6], of_place[7]];
            *tap = Sharing {
                number,
                rows,
                fraction: place.fraction,
            };
            top = top.min(rows[0]).min(rows[3]);
            bottom = bottom.max(rows[0]).max(rows[3]);
            (texel, across) = (place.texel, place.fraction);
            count += 1;
        }
        if s.bits_of_mask(are_blocks) != u16::MAX {
            return false;
        }
        let across = s.spread_columns(across);
        let count_of_lines = (bottom - top).cast_unsigned() as usize + 2;
        let Some(lines) = room.lines.get_mut(..count_of_lines) else {
            return false;
        };
        if self.lines(s, (texel, across), top, lines).is_none() {
            return false;
        }
        for tap in room.taps.iter().take(count) {
            let down = s.spread_rows(tap.fraction);
            let mut filtered = [across; 4];
            let mut row = 0;
            while row < 4 {
                // In a mirrored texture, a row between may be beyond the first and the last.
                let line = tap.rows[row].wrapping_sub(top).cast_unsigned() as usize;
                let pair = lines.get(line..).and_then(|lines| lines.first_chunk());
                let Some(&[upper, lower]) = pair else {
                    return false;
                };
                filtered[row] = upper + (lower - upper) * down[row];
                row += 1;
            }
            let [r, g, b, a] = s.channels_of_rows(filtered);
            let Some(colors) = colors.get_mut(tap.number) else {
                return false;
            };
            *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
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
    // Of a block, these lanes are the four columns.
    let columns = |[u, _]: &[Values<f32>; 2]| [u.0[0], u.0[1], u.0[4], u.0[5]].map(f32::to_bits);
    let first = taps.trailing_zeros() as usize;
    let (mut same, mut left) = (1 << first, taps & (taps - 1));
    let Some(of_first) = at.get(first) else {
        return same;
    };
    let bits: u32x16<S> = f32x16::load_array_ref(s, &of_first[0].0).bitcast();
    let mut room = MOST_SHARING - 1;
    while left != 0 && room != 0 {
        let number = left.trailing_zeros() as usize;
        left &= left - 1;
        let Some(tap) = at
            .get(number)
            .filter(|tap| columns(tap) == columns(of_first))
        else {
            continue;
        };
        let of_tap: u32x16<S> = f32x16::load_array_ref(s, &tap[0].0).bitcast();
        let is_same: mask32x16<S> = of_tap.simd_eq(bits);
        if s.bits_of_mask(is_same) == u16::MAX {
            same |= 1 << number;
            room -= 1;
        }
    }
    same
}
