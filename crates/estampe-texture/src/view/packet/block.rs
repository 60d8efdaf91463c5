//! Half floats for packets that are blocks of pixels whose samples stand in columns and rows, as
//! those of a full-screen pass do.
//!
//! Places are computed for four columns and four rows, all in one register. Rows of texels are
//! loaded as they lie in memory, four channels side by side, and filtered along x; a row that two
//! rows of pixels need is filtered once. Only the results are put into the order of lanes. The
//! arithmetic of each channel is that of the other cases, in the same order, so the bits are the
//! same.

use super::Packet;
use crate::view::coordinates::{Answers, load, packet};
use crate::view::packet_texel::RGBA16F;
use crate::view::plane::Plane;
use crate::view::{PacketLod, PacketRequest, SampledTexture};
use crate::wrap::{place_by_lane, wrap};
use estampe_simd::{
    Bytes, Columns, Lanes as SimdLanes, Packet as Values, SimdBase, dispatch, f32x16, i32x16,
    mask32x16, u32x16,
};
use estampe_types::{AddressMode, Real, ViewDimension};

/// The words of a texel.
const WORDS: usize = 2;

/// The lanes that hold the places of columns, then of rows.
const PLACES: u16 = 0xFF;

/// The most taps that are sampled together.
pub(in crate::view) const MOST_TAPS: usize = 32;

impl SampledTexture {
    /// Samples the finest level at several places (u, v), as far as they are blocks; returns the
    /// others, of which nothing is stored: bit `i` is place `i`.
    pub(crate) fn sample_blocks(
        &self,
        lod: PacketLod,
        at: &[[Values<f32>; 2]],
        colors: &mut [Answers],
    ) -> u32 {
        let all = u32::MAX >> (32 - at.len().clamp(1, MOST_TAPS));
        let is_finest = self.ignores_lod
            || lod == PacketLod::Level
                && self.sampler.lod_bias == 0.0
                && self.sampler.lod_min_clamp <= 0.0;
        let has_blocks = self.packets.is_some_and(|format| format.kind() == RGBA16F);
        if !(is_finest && has_blocks && self.is_simple) || at.is_empty() || at.len() > MOST_TAPS {
            return all;
        }
        dispatch!(@specialized_move self.level, s => {
            let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                return all;
            };
            let mut others = 0;
            for (bit, ([u, v], colors)) in at.iter().zip(colors).enumerate() {
                let [u, v] = [f32x16::load_array_ref(s, &u.0), f32x16::load_array_ref(s, &v.0)];
                match level.sample(s, [u, v]) {
                    Some([r, g, b, a]) => {
                        *colors = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                    }
                    None => others |= 1 << bit,
                }
            }
            others
        }, others => all)
    }

    /// Returns true if the finest level is sampled as a block; tests see by it which way a request
    /// of the common case takes.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_a_block(&self, request: &PacketRequest<'_>) -> bool {
        let at = [[*request.at[0], *request.at[1]]];
        let mut colors = [Answers::default()];
        self.sample_blocks(PacketLod::Level, &at, &mut colors) == 0
    }
}

impl Packet<'_> {
    /// Samples the packet in one level, or between it and the next one, if it is a block in both.
    #[inline(always)]
    pub(super) fn block<S: SimdLanes>(
        &self,
        s: S,
        (at, fraction): (usize, Option<f32x16<S>>),
    ) -> Option<[f32x16<S>; 4]> {
        let planes = &self.of.view.planes;
        let last = planes.len() - 1;
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let uv = [
            load(zero, self.lanes.at[0], 0),
            load(zero, self.lanes.at[1], 0),
        ];
        let mut color = BlockLevel::new(s, self.of, &planes[at.min(last)])?.sample(s, uv)?;
        if let Some(fraction) = fraction {
            let coarse = BlockLevel::new(s, self.of, &planes[(at + 1).min(last)])?.sample(s, uv)?;
            for k in 0..4 {
                let mixed = color[k] + (coarse[k] - color[k]) * fraction;
                color[k] = Real::select(fraction.gt(zero), mixed, color[k]);
            }
        }
        Some(color)
    }
}

/// A level of a 2D view whose texels are four half floats, as blocks read it.
struct BlockLevel<'a, S: SimdLanes> {
    texels: &'a [u32],
    /// The image's first word.
    begin: usize,
    /// The words of a row.
    row_words: usize,
    mode: AddressMode,
    /// The numbers of columns, then of rows, in the order of
    /// [`columns_and_rows`](SimdLanes::columns_and_rows).
    lengths: f32x16<S>,
    /// One less: texels below these numbers have a neighbour.
    last: f32x16<S>,
}

impl<'a, S: SimdLanes> BlockLevel<'a, S> {
    /// Prepares a level; `None` if the view is not a 2D one, or its axes are wrapped differently.
    #[inline(always)]
    fn new(s: S, of: &'a SampledTexture, plane: &Plane) -> Option<Self> {
        let mode = of.sampler.address_mode_u;
        if of.view.dimension != ViewDimension::D2 || of.sampler.address_mode_v != mode {
            return None;
        }
        let [width, height] = [plane.size[0], plane.size[1]];
        let lengths = s.columns_and_rows(SimdBase::splat(s, width), SimdBase::splat(s, height));
        let [columns, rows, _] = plane.sides;
        let before = of.view.base_layer.cast_signed().wrapping_mul(rows);
        let before = usize::try_from(before.checked_mul(columns)?).ok()?;
        // A texel has two words.
        let begin = plane.begin_words(2);
        Some(Self {
            texels: &of.view.texture.texels[..],
            begin: usize::try_from(begin).ok()? + before * WORDS,
            row_words: usize::try_from(columns).ok()? * WORDS,
            mode,
            lengths,
            last: lengths - 1.0,
        })
    }

    /// The colour of each lane at (u, v), unwrapped; `None` if the samples do not stand in columns
    /// and rows, a texel is across a border, or texels are far apart.
    #[inline(always)]
    fn sample(&self, s: S, [u, v]: [f32x16<S>; 2]) -> Option<[f32x16<S>; 4]> {
        let is_block = u.eq(s.first_row(u)) & v.eq(s.first_column(v));
        if s.bits_of_mask(is_block) != u16::MAX {
            return None;
        }
        let wrapped = wrap(s.columns_and_rows(u, v), self.mode);
        let place = place_by_lane(wrapped, self.lengths, self.last, self.mode);
        let texel: i32x16<S> = place.texel;
        let last: i32x16<S> = self.last.to_int_within_range();
        let [at, end]: [u32x16<S>; 2] = [texel.bitcast(), last.bitcast()];
        let has_next: mask32x16<S> = at.simd_lt(end);
        if s.bits_of_mask(has_next) & PLACES != PLACES {
            return None;
        }
        let [first, _, _, fourth, rows @ ..] = texel.to_array();
        // Columns go to the right or, in a mirrored texture, to the left.
        let left = Ord::min(first, fourth);
        let window = Window {
            texels: self.texels,
            begin: self.begin + left.cast_unsigned() as usize * WORDS,
            row_words: self.row_words,
            columns: Columns::new(s, texel, left)?,
            weight: s.spread_columns(place.fraction),
        };
        let weights = place.fraction.to_array();
        let (mut upper, mut lower) = (window.weight, window.weight);
        let mut before = i32::MIN;
        let mut filtered = [window.weight; 4];
        let mut row = 0;
        while row < 4 {
            let at = rows[row];
            if at != before {
                upper = if at == before.wrapping_add(1) {
                    lower
                } else {
                    window.row(s, at)?
                };
                lower = window.row(s, at + 1)?;
                before = at;
            }
            let down: f32x16<S> = SimdBase::splat(s, weights[4 + row]);
            filtered[row] = upper + (lower - upper) * down;
            row += 1;
        }
        Some(s.channels_of_rows(filtered))
    }
}

/// Eight columns of a level, among which those of a block are.
struct Window<'a, S: SimdLanes> {
    texels: &'a [u32],
    /// The first word of the first row.
    begin: usize,
    row_words: usize,
    columns: Columns<S>,
    /// The weight of each column's right texel, four times.
    weight: f32x16<S>,
}

impl<S: SimdLanes> Window<'_, S> {
    /// A row's four texels between the left and the right ones; `None` if a part of the window is
    /// not in memory, which may be so at the end of the texture. The row is not negative.
    #[inline(always)]
    fn row(&self, s: S, y: i32) -> Option<f32x16<S>> {
        let at = self.begin + y.cast_unsigned() as usize * self.row_words;
        let window = self.texels.get(at..)?.first_chunk()?;
        let [left, right] = s.half_texels(window, &self.columns)?;
        Some(left + (right - left) * self.weight)
    }
}
