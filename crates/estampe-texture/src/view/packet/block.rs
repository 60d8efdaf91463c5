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
use crate::PacketPlaces;
use crate::view::coordinates::packet;
use crate::view::plane::Plane;
use crate::view::{PacketLod, PacketRequest, SampledTexture};
use crate::wrap::{Place, place_by_lane, wrap};
use estampe_simd::{
    Bytes, Columns, LANES, Lanes as SimdLanes, Packet as Values, SimdBase, dispatch, f32x16,
    i32x16, mask32x16, u32x16, words_of,
};
use estampe_types::{AddressMode, Real, ViewDimension};

/// The words of a texel.
const WORDS: usize = 2;

/// The most rows of texels of a block.
const MOST_LINES: usize = 9;

/// The words of a row of five texels.
const NEIGHBOURS: usize = 5 * WORDS;

/// Where columns and rows stand in a level, in the order of
/// [`columns_and_rows`](SimdLanes::columns_and_rows): the position of each between its texel and the
/// next, which is the weight of the next one; then the bits of the numbers of the texels.
pub(super) type Spot = [Values<f32>; 2];

impl SampledTexture {
    /// Returns true if the finest level is sampled as a block; tests see by it which way a request
    /// of the common case takes.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_a_block(&self, request: &PacketRequest<'_>) -> bool {
        let at = [[*request.at[0], *request.at[1]]];
        let places = PacketPlaces::of_pairs(&at);
        self.sample_blocks(PacketLod::Level, &places, &mut [Default::default()]) == 0
    }

    /// Returns true if the texels of a block are neighbours in the finest level.
    #[doc(hidden)]
    #[must_use]
    pub fn samples_neighbours(&self, request: &PacketRequest<'_>) -> bool {
        dispatch!(@specialized_move self.level, s => {
            let [u, v, _] = request.at;
            let Some(level) = BlockLevel::new(s, self, &self.view.planes[0]) else {
                return false;
            };
            let mut spot = Spot::default();
            level.find::<false>(s, [u, v], &mut spot)
                && Footprint::of(&spot).are_neighbours(s)
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
        let [u, v, _] = self.lanes.at;
        let uv = [u, v];
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
    /// The number of columns in lanes 0 to 3 and 8 to 11, of rows in the others: see
    /// [`columns_and_rows`](SimdLanes::columns_and_rows).
    pub(super) lengths: f32x16<S>,
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
    fn sample<const CLAMPS: bool>(&self, s: S, uv: [&Values<f32>; 2]) -> Option<[f32x16<S>; 4]> {
        let mut spot = Spot::default();
        if !self.find::<CLAMPS>(s, uv, &mut spot) {
            return None;
        }
        let footprint = Footprint::of(&spot);
        self.filter(s, footprint, footprint.are_neighbours(s))
    }

    /// Finds where the samples at (u, v), unwrapped, stand. True if they stand in columns and rows,
    /// and no texel is across a border. No branch depends on it, so that one place does not wait
    /// for another.
    #[inline(always)]
    pub(super) fn find<const CLAMPS: bool>(
        &self,
        s: S,
        uv: [&Values<f32>; 2],
        spot: &mut Spot,
    ) -> bool {
        let (both, stands) = columns_and_rows(s, uv);
        let ([fractions, texels], [has_next, _]) = self.place::<CLAMPS>(s, both);
        *spot = [packet(fractions, 0), packet(texels, 0)];
        s.bits_of_mask(stands) & has_next == u16::MAX
    }

    /// Finds where columns and rows stand whose coordinates, unwrapped, are given, of two spots:
    /// one in lanes 0 to 7, the other one in lanes 8 to 15. Returns what a [spot](Spot) has, and
    /// the lanes whose texel has a neighbour, and those that are as far from the first column, or
    /// row, as they would be if all were neighbours.
    #[inline(always)]
    pub(super) fn place<const CLAMPS: bool>(
        &self,
        s: S,
        both: f32x16<S>,
    ) -> ([f32x16<S>; 2], [u16; 2]) {
        let mode = if CLAMPS {
            AddressMode::ClampToEdge
        } else {
            self.mode
        };
        let Place { texel, fraction } =
            place_by_lane(wrap(both, mode), self.lengths, self.last, mode);
        let last: i32x16<S> = self.last.to_int_within_range();
        let [texel, end]: [u32x16<S>; 2] = [texel.bitcast(), last.bitcast()];
        let has_next: mask32x16<S> = texel.simd_lt(end);
        let lanes = [s.bits_of_mask(has_next), neighbours(s, texel)];
        ([fraction, texel.bitcast()], lanes)
    }

    /// The colours of a block.
    #[inline(always)]
    pub(super) fn filter(
        &self,
        s: S,
        footprint: Footprint<'_>,
        are_neighbours: bool,
    ) -> Option<[f32x16<S>; 4]> {
        let filtered = if are_neighbours {
            self.neighbours(s, footprint)?
        } else {
            self.apart(s, footprint)?
        };
        Some(s.channels_of_rows(filtered))
    }

    /// The four rows of texels of a block whose texels are neighbours, in five rows of five; `None`
    /// if the level does not decode half floats.
    #[inline(always)]
    fn neighbours(&self, s: S, footprint: Footprint<'_>) -> Option<[f32x16<S>; 4]> {
        let across = footprint.across(s);
        let mut left = self.texels_from(footprint.column(0), footprint.row(0))?;
        let mut upper = across;
        let mut filtered = [across; 4];
        let mut row = 0;
        while row < 5 {
            if row > 0 {
                left = left.get(self.row_words..)?;
            }
            let words: &[u32; NEIGHBOURS] = left.first_chunk()?;
            let lower = neighbours_across(s, words, across)?;
            if row > 0 {
                filtered[row - 1] = upper + (lower - upper) * footprint.down(s, row - 1);
            }
            upper = lower;
            row += 1;
        }
        Some(filtered)
    }

    /// The four rows of texels of any other block: the columns are among eight neighbours, and the
    /// rows, each filtered once, among a few.
    #[inline(always)]
    fn apart(&self, s: S, footprint: Footprint<'_>) -> Option<[f32x16<S>; 4]> {
        let mut lines = [Values([0.0; LANES]); MOST_LINES];
        // Rows go down or, in a mirrored texture, up.
        let [first, last] = [footprint.row(0), footprint.row(3)];
        let top = Ord::min(first, last);
        let bottom = Ord::max(first, last) + 1;
        let lines = lines.get_mut(..=(bottom - top).cast_unsigned() as usize)?;
        let columns = (footprint, footprint.columns_are_neighbours());
        self.lines::<false>(s, columns, top, lines)?;
        let mut filtered = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); 4];
        let mut row = 0;
        while row < 4 {
            // In a mirrored texture, a row between may be beyond the first and the last.
            let at = footprint.row(row).wrapping_sub(top).cast_unsigned() as usize;
            let [upper, lower] = lines.get(at..)?.first_chunk()?;
            let upper = f32x16::load_array_ref(s, &upper.0);
            let lower = f32x16::load_array_ref(s, &lower.0);
            filtered[row] = upper + (lower - upper) * footprint.down(s, row);
            row += 1;
        }
        Some(filtered)
    }

    /// Rows of texels from `top` on, filtered between the texels of a block's columns, which are
    /// neighbours, or not, and brought into [pairs](SimdLanes::paired) or not; `None` if the
    /// columns are not among eight, or not in memory.
    #[inline(always)]
    pub(super) fn lines<const PAIRS: bool>(
        &self,
        s: S,
        (footprint, are_neighbours): (Footprint<'_>, bool),
        top: i32,
        lines: &mut [Values<f32>],
    ) -> Option<()> {
        let across = footprint.across(s);
        // Columns go to the right or, in a mirrored texture, to the left.
        let left = Ord::min(footprint.column(0), footprint.column(3));
        let mut texels = self.texels_from(left, top)?;
        if are_neighbours {
            for (at, line) in lines.iter_mut().enumerate() {
                if at > 0 {
                    texels = texels.get(self.row_words..)?;
                }
                let filtered = neighbours_across(s, texels.first_chunk()?, across)?;
                *line = line_of::<S, PAIRS>(s, filtered);
            }
            return Some(());
        }
        let columns = Columns::new(s, footprint.columns_of(s), left)?;
        // At the end of the texture a part of a window may not be in memory.
        if columns.are_among_four() {
            for (at, line) in lines.iter_mut().enumerate() {
                if at > 0 {
                    texels = texels.get(self.row_words..)?;
                }
                let [left, right] = s.half_texels_of_four(texels.first_chunk()?, &columns)?;
                let filtered = left + (right - left) * across;
                *line = line_of::<S, PAIRS>(s, filtered);
            }
            return Some(());
        }
        for (at, line) in lines.iter_mut().enumerate() {
            if at > 0 {
                texels = texels.get(self.row_words..)?;
            }
            let [left, right] = s.half_texels(texels.first_chunk()?, &columns)?;
            let filtered = left + (right - left) * across;
            *line = line_of::<S, PAIRS>(s, filtered);
        }
        Some(())
    }

    /// The image's words, and how many a row has.
    #[inline(always)]
    pub(super) fn rows(&self) -> (&'a [u32], usize) {
        (
            self.texels.get(self.begin..).unwrap_or_default(),
            self.row_words,
        )
    }

    /// The words from a texel on; `None` if it is not in memory.
    #[inline(always)]
    pub(super) fn texels_from(&self, column: i32, row: i32) -> Option<&[u32]> {
        let before = row.cast_unsigned() as usize * self.row_words;
        let before = before + column.cast_unsigned() as usize * WORDS;
        self.texels.get(self.begin + before..)
    }
}

/// A row of five texels, filtered between each and the next.
#[inline(always)]
fn neighbours_across<S: SimdLanes>(
    s: S,
    words: &[u32; NEIGHBOURS],
    across: f32x16<S>,
) -> Option<f32x16<S>> {
    let right = s.row_of_halves(words.last_chunk()?)?;
    let left = s.row_of_halves(words.first_chunk()?)?;
    Some(left + (right - left) * across)
}

/// A row of texels in memory, in [pairs](SimdLanes::paired) or not.
#[inline(always)]
fn line_of<S: SimdLanes, const PAIRS: bool>(s: S, row: f32x16<S>) -> Values<f32> {
    packet(if PAIRS { s.paired(row) } else { row }, 0)
}

/// The coordinates of the columns and rows of the samples at (u, v), and the lanes that stand in
/// them.
#[inline(always)]
pub(super) fn columns_and_rows<S: SimdLanes>(
    s: S,
    [u, v]: [&Values<f32>; 2],
) -> (f32x16<S>, mask32x16<S>) {
    let (u, v) = (
        f32x16::load_array_ref(s, &u.0),
        f32x16::load_array_ref(s, &v.0),
    );
    let stands = u.simd_eq(s.first_row(u)) & v.simd_eq(s.first_column(v));
    (s.columns_and_rows(u, v), stands)
}

/// The columns, and the rows, that are as far from the first one as neighbours would be.
#[inline(always)]
fn neighbours<S: SimdLanes>(s: S, texel: u32x16<S>) -> u16 {
    let first = texel - u32x16::load_array(s, [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3]);
    let order = [0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12];
    let order = u32x16::load_array(s, order);
    let is_same: mask32x16<S> = first.simd_eq(s.permute(first, order));
    s.bits_of_mask(is_same)
}

/// Where the samples of a block stand in a level: in memory, so that numbers of texels are loaded
/// where addresses need them, and the weights of rows are operands in memory. Texels have a
/// neighbour.
#[derive(Clone, Copy)]
pub(super) struct Footprint<'a> {
    /// The spot of the columns.
    pub(super) columns: &'a Spot,
    /// The spot of the rows.
    pub(super) rows: &'a Spot,
}

impl<'a> Footprint<'a> {
    /// The footprint whose columns and rows are of one spot.
    #[inline(always)]
    pub(super) fn of(spot: &'a Spot) -> Self {
        Self {
            columns: spot,
            rows: spot,
        }
    }

    /// The left texel of a column, 0 to 3.
    #[inline(always)]
    pub(super) fn column(&self, at: usize) -> i32 {
        words_of(self.columns)[1].0[at].cast_signed()
    }

    /// The upper texel of a row, 0 to 3.
    #[inline(always)]
    pub(super) fn row(&self, at: usize) -> i32 {
        words_of(self.rows)[1].0[4 + at].cast_signed()
    }

    /// True if columns and rows are each four neighbours, of a footprint that is [of](Self::of) one
    /// spot.
    #[inline(always)]
    pub(super) fn are_neighbours<S: SimdLanes>(&self, s: S) -> bool {
        let texel = u32x16::load_array_ref(s, &words_of(self.columns)[1].0);
        neighbours(s, texel) == u16::MAX
    }

    /// True if the columns are four neighbours.
    #[inline(always)]
    pub(super) fn columns_are_neighbours(&self) -> bool {
        let first = self.column(0);
        [self.column(1), self.column(2), self.column(3)] == [first + 1, first + 2, first + 3]
    }

    /// The left texel of each column in lanes 0 to 3.
    #[inline(always)]
    fn columns_of<S: SimdLanes>(&self, s: S) -> i32x16<S> {
        u32x16::load_array_ref(s, &words_of(self.columns)[1].0).bitcast()
    }

    /// The weight of each column's right texel, four times.
    #[inline(always)]
    fn across<S: SimdLanes>(&self, s: S) -> f32x16<S> {
        s.spread_columns(f32x16::load_array_ref(s, &self.columns[0].0))
    }

    /// The weight of a row's lower texels.
    #[inline(always)]
    pub(super) fn down<S: SimdLanes>(&self, s: S, row: usize) -> f32x16<S> {
        SimdBase::splat(s, self.rows[0].0[4 + row])
    }
}
