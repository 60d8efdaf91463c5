//! Half floats for packets that are blocks of pixels whose samples stand in columns and rows, as
//! those of a full-screen pass do.
//!
//! Places are computed for four columns and four rows, all in one register. Rows of texels are
//! loaded as they lie in memory, four channels side by side, and filtered along x; a row that two
//! rows of pixels need is filtered once. Only the results are put into the order of lanes. The
//! arithmetic of each channel is that of the other cases, in the same order, so the bits are the
//! same.
//!
//! At a scale of one texel a pixel, as in a blur, the left texels of four columns lie side by side,
//! and the right ones too: each is a load that converts, without a permutation.

use super::Packet;
use crate::view::coordinates::load;
use crate::view::plane::Plane;
use crate::view::{PacketLod, PacketRequest, SampledTexture};
use crate::wrap::{Place, place_by_lane, wrap};
use estampe_simd::{
    Bytes, Columns, Lanes as SimdLanes, SimdBase, dispatch, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_types::{AddressMode, Real, ViewDimension};

/// The words of a texel.
pub(super) const WORDS: usize = 2;

/// The most rows of texels of a block.
const MOST_LINES: usize = 9;

/// The words of a row of five texels.
pub(super) const NEIGHBOURS: usize = 5 * WORDS;

/// The lanes that hold the places of columns, then of rows.
const PLACES: u16 = 0xFF;

impl SampledTexture {
    /// Returns true if the finest level is sampled as a block; tests see by it which way a request
    /// of the common case takes.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_a_block(&self, request: &PacketRequest<'_>) -> bool {
        let at = [[*request.at[0], *request.at[1]]];
        self.sample_blocks(PacketLod::Level, &at, &mut [Default::default()]) == 0
    }

    /// Returns true if the texels of a block are neighbours in the finest level.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_neighbours(&self, request: &PacketRequest<'_>) -> bool {
        dispatch!(@specialized_move self.level, s => {
            let [u, v, _] = request.at;
            let uv = [f32x16::load_array_ref(s, &u.0), f32x16::load_array_ref(s, &v.0)];
            let level = BlockLevel::new(s, self, &self.view.planes[0]);
            let footprint = level.and_then(|level| level.footprint::<false>(s, uv));
            footprint.is_some_and(|footprint| footprint.are_neighbours)
        }, others => false)
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
        let mut color =
            BlockLevel::new(s, self.of, &planes[at.min(last)])?.sample::<false>(s, uv)?;
        if let Some(fraction) = fraction {
            let coarse =
                BlockLevel::new(s, self.of, &planes[(at + 1).min(last)])?.sample::<false>(s, uv)?;
            for k in 0..4 {
                let mixed = color[k] + (coarse[k] - color[k]) * fraction;
                color[k] = Real::select(fraction.gt(zero), mixed, color[k]);
            }
        }
        Some(color)
    }
}

/// A level of a 2D view whose texels are four half floats, as blocks read it.
pub(super) struct BlockLevel<'a, S: SimdLanes> {
    pub(super) texels: &'a [u32],
    /// The image's first word.
    pub(super) begin: usize,
    /// The words of a row.
    pub(super) row_words: usize,
    pub(super) mode: AddressMode,
    /// The number of columns in lanes 0 to 3, of rows in the others: see
    /// [`columns_and_three_rows`](SimdLanes::columns_and_three_rows).
    lengths: f32x16<S>,
    /// One less: texels below these numbers have a neighbour.
    last: f32x16<S>,
}

impl<'a, S: SimdLanes> BlockLevel<'a, S> {
    /// Prepares a level; `None` if the view is not a 2D one, or its axes are wrapped differently.
    #[inline(always)]
    pub(super) fn new(s: S, of: &'a SampledTexture, plane: &Plane) -> Option<Self> {
        let mode = of.sampler.address_mode_u;
        if of.view.dimension != ViewDimension::D2 || of.sampler.address_mode_v != mode {
            return None;
        }
        let [width, height] = [plane.size[0], plane.size[1]];
        let rows = SimdBase::splat(s, height);
        let lengths = s.columns_and_three_rows(SimdBase::splat(s, width), [rows; 3]);
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
    pub(super) fn sample<const CLAMPS: bool>(
        &self,
        s: S,
        uv: [f32x16<S>; 2],
    ) -> Option<[f32x16<S>; 4]> {
        let footprint = self.footprint::<CLAMPS>(s, uv)?;
        let filtered = if footprint.are_neighbours {
            self.neighbours(s, &footprint)?
        } else {
            self.apart(s, &footprint)?
        };
        Some(s.channels_of_rows(filtered))
    }

    /// Where the samples at (u, v) stand; `None` if they do not stand in columns and rows, or a
    /// texel is across a border.
    #[inline(always)]
    fn footprint<const CLAMPS: bool>(&self, s: S, [u, v]: [f32x16<S>; 2]) -> Option<Footprint<S>> {
        let is_block = u.eq(s.first_row(u)) & v.eq(s.first_column(v));
        if s.bits_of_mask(is_block) != u16::MAX {
            return None;
        }
        let both = s.columns_and_rows(u, v);
        let Place { texel, fraction } = self.place::<CLAMPS>(s, both, PLACES)?;
        Some(Footprint {
            texel,
            are_neighbours: are_neighbours(s, texel.bitcast()),
            across: s.spread_columns(fraction),
            down: s.spread_rows(fraction),
        })
    }

    /// The texels of unwrapped coordinates, of columns in lanes 0 to 3 and of rows in the others,
    /// and the positions after their centres; `None` if a texel of these lanes is across a border.
    #[inline(always)]
    pub(super) fn place<const CLAMPS: bool>(
        &self,
        s: S,
        at: f32x16<S>,
        lanes: u16,
    ) -> Option<Place<f32x16<S>>> {
        let mode = if CLAMPS {
            AddressMode::ClampToEdge
        } else {
            self.mode
        };
        let place = place_by_lane(wrap(at, mode), self.lengths, self.last, mode);
        let texel: i32x16<S> = place.texel;
        let last: i32x16<S> = self.last.to_int_within_range();
        let [at, end]: [u32x16<S>; 2] = [texel.bitcast(), last.bitcast()];
        let has_next: mask32x16<S> = at.simd_lt(end);
        (s.bits_of_mask(has_next) & lanes == lanes).then_some(place)
    }

    /// The four rows of texels of a block whose texels are neighbours, in five rows of five; `None`
    /// if the level does not decode half floats.
    #[inline(always)]
    fn neighbours(&self, s: S, footprint: &Footprint<S>) -> Option<[f32x16<S>; 4]> {
        let (across, down) = (footprint.across, footprint.down);
        let [column, _, _, _, row, ..] = footprint.texel.to_array();
        let first = row.cast_unsigned() as usize * self.row_words;
        let first = first + column.cast_unsigned() as usize * WORDS;
        let mut left = self.texels.get(self.begin + first..)?;
        let mut upper = across;
        let mut filtered = [across; 4];
        let mut row = 0;
        while row < 5 {
            if row > 0 {
                left = left.get(self.row_words..)?;
            }
            let words: &[u32; NEIGHBOURS] = left.first_chunk()?;
            let right = s.row_of_halves(words.last_chunk()?)?;
            let left = s.row_of_halves(words.first_chunk()?)?;
            let lower = left + (right - left) * across;
            if row > 0 {
                filtered[row - 1] = upper + (lower - upper) * down[row - 1];
            }
            upper = lower;
            row += 1;
        }
        Some(filtered)
    }

    /// The four rows of texels of any other block: the columns are among eight neighbours, and the
    /// rows, each filtered once, among a few.
    #[inline(always)]
    fn apart(&self, s: S, footprint: &Footprint<S>) -> Option<[f32x16<S>; 4]> {
        let (across, down) = (footprint.across, footprint.down);
        let [first, _, _, fourth, rows @ ..] = footprint.texel.to_array();
        // Columns go to the right or, in a mirrored texture, to the left; rows likewise.
        let left = Ord::min(first, fourth);
        let top = Ord::min(rows[0], rows[3]);
        let bottom = Ord::max(rows[0], rows[3]) + 1;
        let columns = Columns::new(s, footprint.texel, left)?;
        let before = top.cast_unsigned() as usize * self.row_words;
        let before = before + left.cast_unsigned() as usize * WORDS;
        let mut texels = self.texels.get(self.begin + before..)?;
        let mut lines = [across; MOST_LINES];
        let lines = lines.get_mut(..=(bottom - top).cast_unsigned() as usize)?;
        for (at, line) in lines.iter_mut().enumerate() {
            if at > 0 {
                texels = texels.get(self.row_words..)?;
            }
            // At the end of the texture a part of the window may not be in memory.
            let [left, right] = s.half_texels(texels.first_chunk()?, &columns)?;
            *line = left + (right - left) * across;
        }
        let mut filtered = [across; 4];
        let mut row = 0;
        while row < 4 {
            // In a mirrored texture, a row between may be beyond the first and the last.
            let at = rows[row].wrapping_sub(top).cast_unsigned() as usize;
            let &[upper, lower] = lines.get(at..)?.first_chunk()?;
            filtered[row] = upper + (lower - upper) * down[row];
            row += 1;
        }
        Some(filtered)
    }
}

/// Where the samples of a block stand in a level.
struct Footprint<S: SimdLanes> {
    /// The left texel of each column, then the upper one of each row, in the order of
    /// [`columns_and_rows`](SimdLanes::columns_and_rows). Texels have a neighbour.
    texel: i32x16<S>,
    /// True if columns and rows are each four neighbours.
    are_neighbours: bool,
    /// The weight of each column's right texel, four times.
    across: f32x16<S>,
    /// The weight of each row's lower texels.
    down: [f32x16<S>; 4],
}

/// True if columns and rows, in the order of [`columns_and_rows`](SimdLanes::columns_and_rows), are
/// each four neighbours.
#[inline(always)]
fn are_neighbours<S: SimdLanes>(s: S, at: u32x16<S>) -> bool {
    let first = at - u32x16::load_array(s, [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3]);
    let order = u32x16::load_array(s, [0, 0, 0, 0, 4, 4, 4, 4, 0, 0, 0, 0, 4, 4, 4, 4]);
    let is_same: mask32x16<S> = first.simd_eq(s.permute(first, order));
    s.bits_of_mask(is_same) & PLACES == PLACES
}
