//! Half floats for a packet that is a block of pixels whose samples stand in columns and rows, as
//! those of a full-screen pass do.
//!
//! Rows of texels are loaded as they lie in memory, four channels side by side, and filtered along
//! x; a row that two rows of pixels need is filtered once. Only the results are put into the order
//! of lanes. The arithmetic of each channel is that of the other cases, in the same order, so the
//! bits are the same.

use super::Packet;
use super::inside::Square;
use super::places::Spots;
use crate::view::coordinates::load;
use crate::view::packet_texel::RGBA16F;
use crate::view::{PacketRequest, SampledTexture};
use estampe_simd::{Columns, Lanes as SimdLanes, SimdBase, dispatch, f32x16, i32x16};
use estampe_types::{Int, Real, ViewDimension};

/// The words of a texel.
const WORDS: i32 = 2;

impl Packet<'_> {
    /// The weighted mean of four texels of four half floats, in units; `None` if the samples do not
    /// stand in columns and rows, or their texels are far apart.
    #[inline(always)]
    pub(super) fn mean_of_block<S: SimdLanes>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        square: &Square<'_, f32x16<S>>,
    ) -> Option<[f32x16<S>; 4]> {
        let [u, v, _] = spots.at;
        let is_block = u.eq(s.first_row(u)) & v.eq(s.first_column(v));
        if f32x16::any(!is_block) {
            return None;
        }
        let slice = if self.of.view.dimension == ViewDimension::D2 {
            self.of.view.base_layer.cast_signed()
        } else {
            let first = Int::lane(spots.slice, 0);
            if f32x16::any(!spots.slice.eq(Int::splat(spots.slice, first))) {
                return None;
            }
            first
        };
        let x: i32x16<S> = square.x.texel;
        // Columns go to the right or, in a mirrored texture, to the left.
        let left = Ord::min(Int::lane(x, 0), Int::lane(x, 5));
        let columns = Columns::new(s, x, left)?;
        let [width, height, _] = square.plane.sides;
        let image = slice.wrapping_mul(height);
        let begin = square.plane.begin_words(WORDS);
        let texels = &self.of.view.texture.texels[..];
        let weight = s.spread_row(square.x.fraction);
        let rows = Rows {
            texels,
            begin: usize::try_from(begin).ok()?,
            first: usize::try_from(image).ok()?,
            left: usize::try_from(left).ok()?,
            width: usize::try_from(width).ok()?,
            columns,
            weight,
        };
        let (y, down) = (square.y.texel.to_array(), square.y.fraction.to_array());
        let (mut upper, mut lower) = (weight, weight);
        let mut before = i32::MIN;
        let mut filtered = [weight; 4];
        let mut row = 0;
        while row < 4 {
            let lane = [0, 2, 8, 10][row];
            let at = y[lane];
            if at != before {
                upper = if at == before.wrapping_add(1) {
                    lower
                } else {
                    rows.filtered(s, at)?
                };
                lower = rows.filtered(s, at + 1)?;
                before = at;
            }
            let down: f32x16<S> = SimdBase::splat(s, down[lane]);
            filtered[row] = upper + (lower - upper) * down;
            row += 1;
        }
        Some(s.channels_of_rows(filtered))
    }
}

impl SampledTexture {
    /// Returns true if the finest level is sampled as a block; tests see by it which way a request
    /// of the common case takes.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_a_block(&self, request: &PacketRequest<'_>) -> bool {
        let Some(format) = self.packets.filter(|format| format.kind() == RGBA16F) else {
            return false;
        };
        let packet = Packet {
            of: self,
            format,
            lanes: request,
            compares: None,
            is_simple: self.is_simple,
        };
        dispatch!(@wide_move self.level, s => packet.is_block(s), scalar => false)
    }
}

impl Packet<'_> {
    #[inline(always)]
    fn is_block<S: SimdLanes>(&self, s: S) -> bool {
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let [u, v] = [
            load(zero, self.lanes.at[0], 0),
            load(zero, self.lanes.at[1], 0),
        ];
        let spots = self.spots([u, v, zero]);
        match self.square(&spots, &self.of.view.planes[0]) {
            Some(square) => self.mean_of_block(s, &spots, &square).is_some(),
            None => false,
        }
    }
}

/// The rows of a level.
struct Rows<'a, S: SimdLanes> {
    texels: &'a [u32],
    /// The level's first word.
    begin: usize,
    /// The number of rows before the image.
    first: usize,
    /// The number of texels before the window of each row.
    left: usize,
    /// The number of texels of a row.
    width: usize,
    columns: Columns<S>,
    /// The weight of each column's right texel, four times.
    weight: f32x16<S>,
}

impl<S: SimdLanes> Rows<'_, S> {
    /// A row's four texels between the left and the right ones; `None` if a part of its window is
    /// not in memory, which may be so at the end of the texture.
    #[inline(always)]
    fn filtered(&self, s: S, y: i32) -> Option<f32x16<S>> {
        let row = self.first + usize::try_from(y).ok()?;
        let at = self.begin + (row * self.width + self.left) * WORDS.cast_unsigned() as usize;
        let window = self.texels.get(at..)?.first_chunk()?;
        let [left, right] = s.half_texels(window, &self.columns)?;
        Some(left + (right - left) * self.weight)
    }
}
