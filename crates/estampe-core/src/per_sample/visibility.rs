//! Visibility: which triangle each sample of a tile shows (Burns and Hunt, The Visibility Buffer, 2013).
//!
//! *In* coverage and depth of triangles · *Out* their numbers at the samples that they won · *Space* window.
//!
//! Where a shader neither discards nor writes depth and colours replace what was there, only the last
//! triangle that passes the depth test at a sample matters. So depth is tested first, for all
//! triangles of a run, and each writes its number where it passes; then every sample is shaded once.
//! The numbers lie in the first colour attachment, whose samples they stand for: a tile's working set stays
//! two lines a packet.
//!
//! The order of triangles decides only between equal depths, so where the comparison orders depths they may
//! be seen in any order, numbers breaking ties: large triangles front to back.

use super::depth::{DepthTest, compare, line_mut};
use super::owners::Owners;
use crate::fragment::interpolate::{DepthPlane, evaluate};
use crate::fragment::queue::{clamp_depth, sample_offsets};
use crate::raster::small::{PIXELS, SmallTriangles};
use crate::raster::{CoverageList, Covered, MAX_PACKETS, TileShape, packet_origin};
use crate::tiles::BinEntry;
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes, Level, Select, SimdBase, dispatch, f32x16, i32x16,
    mask32x16, u32x16,
};
use estampe_types::state::CompareFunction;

/// Why there is no scalar form: sixteen scalar lanes of these kernels took the compiler many minutes. At the
/// scalar level everything is drawn in order, which gives the same bits.
pub(crate) const ONLY_WIDE: &str = "shading is put off at SIMD levels only";

/// How a triangle's samples are decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Decision {
    /// By the depth test, in the order of submission.
    InOrder,
    /// By the depth test, in any order: numbers break ties.
    Sorted,
}

/// The bit of numbers that are not a triangle's but a shaded fragment's.
pub(crate) const SHADED: u32 = 1 << 31;

/// Where a triangle of a run lies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slot {
    /// Number of the chunk in the pass.
    pub(crate) chunk: u32,
    /// Number of the packet in the chunk.
    pub(crate) packet: u32,
    pub(crate) lane: u8,
}

/// A run of triangles whose shading is put off, in one tile. A triangle's number is that of its slot.
#[derive(Debug)]
pub(crate) struct Visibility<const N: usize> {
    pub(crate) slots: Vec<Slot>,
    /// By packet and sample: the lanes that hold a number in place of a colour.
    pub(crate) pending: Box<[[u16; N]; MAX_PACKETS]>,
    /// The blocks that show one triangle, whose numbers are not written.
    pub(crate) owners: Owners,
}

impl<const N: usize> Default for Visibility<N> {
    fn default() -> Self {
        Self {
            slots: Vec::new(),
            pending: Box::new([[0; N]; MAX_PACKETS]),
            owners: Owners::default(),
        }
    }
}

impl<const N: usize> Visibility<N> {
    /// Numbers a chunk's triangles, in the order of submission; gives the first number.
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    pub(crate) fn add(&mut self, chunk: u32, entries: &[BinEntry]) -> u32 {
        // A run has at most as many triangles as a wave and clipping's pieces: far below 2³².
        let first = u32::try_from(self.slots.len()).unwrap_or(u32::MAX);
        for entry in entries {
            if let BinEntry::Triangles { packet, mut lanes } = *entry {
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as u8;
                    lanes &= lanes - 1;
                    self.slots.push(Slot {
                        chunk,
                        packet,
                        lane,
                    });
                }
            }
        }
        first
    }
}

/// A triangle's depth, and its number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenTriangle {
    pub(crate) plane: DepthPlane,
    pub(crate) number: u32,
}

impl SeenTriangle {
    /// Whether no depth in the tile needs clamping: the plane is monotone in x and in y, rounding
    /// included, so its extremes are at corners. A depth at an end of the range counts as outside, because
    /// of −0.
    #[inline(always)]
    pub(super) fn is_within(&self, tile: TileShape, [low, high]: [f32; 2]) -> bool {
        let DepthPlane { origin, z } = self.plane;
        let side = tile.side() as f32;
        let (x, y) = (tile.x as f32 - origin.x, tile.y as f32 - origin.y);
        // Samples lie between the pixel's edges, which are corners of a somewhat larger square.
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        corners.iter().all(|[right, lower]| {
            let (x, y) = (x + right * side, y + lower * side);
            let depth = z.origin + (x * z.dx + y * z.dy);
            depth > low && depth < high
        })
    }
}

/// What small triangles' samples are numbered by.
pub(crate) trait Numbering {
    /// The number of a lane's first sample.
    fn first_of(&mut self, lane: usize) -> u32;
    /// Notes that a pixel of the lane's box has the number, and gives the lane's next.
    fn next(&mut self, lane: usize, pixel: usize, number: u32) -> u32;
}

/// By triangle: each lane's triangle has a number.
pub(crate) struct ByTriangle {
    /// All lanes of the entry, and its first triangle's number.
    pub(crate) lanes: u16,
    pub(crate) first: u32,
}

impl Numbering for ByTriangle {
    #[inline(always)]
    fn first_of(&mut self, lane: usize) -> u32 {
        self.first + (self.lanes & ((1 << lane) - 1)).count_ones()
    }

    #[inline(always)]
    fn next(&mut self, _lane: usize, _pixel: usize, number: u32) -> u32 {
        number
    }
}

/// A tile's attachments while triangles are seen.
pub(crate) struct Sight<'a, const N: usize> {
    pub(crate) test: Option<DepthTest>,
    /// Empty where there is none.
    pub(crate) depth: &'a mut [f32],
    /// The first colour attachment; empty where there is none.
    pub(crate) numbers: &'a mut [u32],
    pub(crate) pending: &'a mut [[u16; N]; MAX_PACKETS],
    pub(crate) tile: TileShape,
    pub(crate) decision: Decision,
}

impl<const N: usize> Sight<'_, N> {
    /// Sees a triangle in whole blocks of 16×16 pixels and in a list of packets.
    ///
    /// *Less* in order with writes, which most draws use, has a copy of the loops of its own.
    pub(crate) fn triangle(
        &mut self,
        level: Level,
        triangle: &SeenTriangle,
        blocks: u16,
        list: &[Covered<N>],
    ) {
        let is_less = |test: &DepthTest| {
            test.state.write_enabled && test.state.compare == CompareFunction::Less
        };
        if self.decision == Decision::InOrder && self.test.as_ref().is_some_and(is_less) {
            dispatch!(@wide level, s => self.lanes::<_, true>(s, triangle, blocks, list),
                scalar => unreachable!("{ONLY_WIDE}"));
        } else {
            dispatch!(@wide level, s => self.lanes::<_, false>(s, triangle, blocks, list),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    #[inline(always)]
    fn lanes<S: Lanes, const LESS: bool>(
        &mut self,
        s: S,
        triangle: &SeenTriangle,
        blocks: u16,
        list: &[Covered<N>],
    ) {
        self.blocks::<S, LESS>(s, triangle, blocks);
        let range = self.range();
        let plane = &triangle.plane;
        let offsets = sample_offsets::<N>();
        for item in list {
            let (x, y) = packet_origin(u32::from(item.packet));
            let pixel = [self.tile.x + x, self.tile.y + y];
            for (sample, &offset) in offsets.iter().enumerate() {
                let [dx, dy] = plane.origin.distances(s, pixel, offset);
                let z = clamp_depth(s, evaluate(s, &plane.z, [dx, dy]), range);
                let mask = s.mask_from_bits(item.masks[sample]);
                let at = [usize::from(item.packet), sample];
                self.packet::<S, LESS>(s, at, z, mask, triangle.number);
            }
        }
    }

    /// Sees a triangle in blocks that it covers whole.
    #[inline(always)]
    fn blocks<S: Lanes, const LESS: bool>(
        &mut self,
        s: S,
        triangle: &SeenTriangle,
        mut blocks: u16,
    ) {
        if blocks == 0 {
            return;
        }
        let clamps = !triangle.is_within(self.tile, self.range());
        while blocks != 0 {
            let block = blocks.trailing_zeros();
            blocks &= blocks - 1;
            self.block::<S, LESS>(s, triangle, block, clamps);
        }
    }

    /// The range that depth is clamped to.
    pub(super) fn range(&self) -> [f32; 2] {
        self.test.as_ref().map_or([0.0, 1.0], |test| test.range)
    }

    /// A block that is covered whole: columns and rows of packets share their products.
    #[inline(always)]
    fn block<S: Lanes, const LESS: bool>(
        &mut self,
        s: S,
        triangle: &SeenTriangle,
        block: u32,
        clamps: bool,
    ) {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let (range, DepthPlane { origin, z: plane }) = (self.range(), triangle.plane);
        let (x, y) = packet_origin(block * 16);
        let (x, y) = (self.tile.x + x, self.tile.y + y);
        let all = s.mask_from_bits(u16::MAX);
        for (sample, &[sx, sy]) in sample_offsets::<N>().iter().enumerate() {
            let (mut by_x, mut by_y) = ([splat(0.0); 4], [splat(0.0); 4]);
            for (step, at) in [0, 4, 8, 12].into_iter().enumerate() {
                by_x[step] = origin.columns_from(s, x + at, sx) * plane.dx;
                by_y[step] = origin.rows_from(s, y + at, sy) * plane.dy;
            }
            for packet in 0..16 {
                let (column, row) = (LANE_X[packet] as usize, LANE_Y[packet] as usize);
                let mut z = splat(plane.origin) + (by_x[column] + by_y[row]);
                if clamps {
                    z = clamp_depth(s, z, range);
                }
                let at = [block as usize * 16 + packet, sample];
                self.packet::<S, LESS>(s, at, z, all, triangle.number);
            }
        }
    }

    /// Tests sixteen samples and notes who is seen there.
    #[inline(always)]
    fn packet<S: Lanes, const LESS: bool>(
        &mut self,
        s: S,
        [packet, sample]: [usize; 2],
        new: f32x16<S>,
        mask: mask32x16<S>,
        number: u32,
    ) {
        let at = packet * N + sample;
        let pending = &mut self.pending[packet % MAX_PACKETS][sample];
        let mut passes = mask;
        if let (Some(test), Some(line)) = (&self.test, line_mut(self.depth, at)) {
            let old = f32x16::load_array_ref(s, line);
            passes &= match self.decision {
                _ if LESS => new.simd_lt(old),
                Decision::InOrder => compare(s, test.state.compare, new, old),
                Decision::Sorted => {
                    let line = line_mut(self.numbers, at);
                    let seen = line.map_or([0; 16], |line| *line);
                    let seen = (u32x16::load_array(s, seen), *pending);
                    nearer_or_first(s, test.state.compare, [new, old], seen, number)
                }
            };
            if LESS || test.state.write_enabled {
                passes.select(new, old).store_array(line);
            }
        }
        if let Some(line) = line_mut(self.numbers, at) {
            let old = u32x16::load_array_ref(s, line);
            let new = <u32x16<S> as SimdBase<S>>::splat(s, number);
            passes.select(new, old).store_array(line);
            *pending |= s.bits_of_mask(passes);
        }
    }

    /// Sees small triangles of one packet, pixel by pixel in the order of lanes; one sample a pixel. Gives the
    /// blocks that were touched, one bit each.
    pub(crate) fn small(
        &mut self,
        small: &SmallTriangles,
        lanes: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        let is_less = |test: &DepthTest| {
            test.state.write_enabled && test.state.compare == CompareFunction::Less
        };
        if self.test.as_ref().is_some_and(is_less) && !self.numbers.is_empty() {
            self.small_pixels::<true>(small, lanes, numbering)
        } else {
            self.small_pixels::<false>(small, lanes, numbering)
        }
    }

    #[inline(always)]
    fn small_pixels<const LESS: bool>(
        &mut self,
        small: &SmallTriangles,
        lanes: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        let (mut blocks, mut lanes) = (0, lanes);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            let mut number = numbering.first_of(lane);
            let mut pixels = small.pixels_of(lane);
            while pixels != 0 {
                let pixel = pixels.trailing_zeros() as usize % PIXELS;
                pixels &= pixels - 1;
                let at = small.place_of(pixel, lane);
                let new = small.depth[pixel][lane];
                if let Some(stored) = self.depth.get_mut(at)
                    && let Some(test) = &self.test
                {
                    if LESS && new >= *stored || !LESS && !passes(test.state.compare, new, *stored)
                    {
                        continue;
                    }
                    if LESS || test.state.write_enabled {
                        *stored = new;
                    }
                }
                blocks |= 1u16 << ((at >> 8) & 15);
                if let Some(seen) = self.numbers.get_mut(at) {
                    *seen = number;
                    self.pending[at / 16 % MAX_PACKETS][0] |= 1 << (at % 16);
                    number = numbering.next(lane, pixel, number);
                }
            }
        }
        blocks
    }

    /// Blocks of a list and of whole ones, one bit each.
    #[inline(always)]
    pub(crate) fn blocks_of(blocks: u16, list: &CoverageList<N>) -> u16 {
        let of_list = list.items().iter();
        of_list.fold(blocks, |all, item| all | 1 << ((item.packet >> 4) & 15))
    }
}

/// Whether `new OP stored` holds.
#[inline(always)]
fn passes(function: CompareFunction, new: f32, stored: f32) -> bool {
    match function {
        CompareFunction::Never => false,
        CompareFunction::Less => new < stored,
        CompareFunction::Equal => new == stored,
        CompareFunction::LessEqual => new <= stored,
        CompareFunction::Greater => new > stored,
        CompareFunction::NotEqual => new != stored,
        CompareFunction::GreaterEqual => new >= stored,
        CompareFunction::Always => true,
    }
}

/// Whether a comparison orders depths, so that order of drawing decides between equal ones alone.
#[inline(always)]
pub(crate) fn orders(function: CompareFunction) -> bool {
    matches!(
        function,
        CompareFunction::Less
            | CompareFunction::LessEqual
            | CompareFunction::Greater
            | CompareFunction::GreaterEqual
    )
}

/// Whether smaller depths win.
#[inline(always)]
pub(crate) fn prefers_less(function: CompareFunction) -> bool {
    matches!(function, CompareFunction::Less | CompareFunction::LessEqual)
}

/// The lanes in which a triangle wins, whenever it is its turn: nearer, or as near and
/// submitted at the right time. With *less* the first of equal ones wins, with *less or equal* the last; what
/// no triangle of the run was seen in is older than all of them.
#[inline(always)]
fn nearer_or_first<S: Lanes>(
    s: S,
    function: CompareFunction,
    [new, old]: [f32x16<S>; 2],
    (seen, pending): (u32x16<S>, u16),
    number: u32,
) -> mask32x16<S> {
    let nearer = if prefers_less(function) {
        new.simd_lt(old)
    } else {
        new.simd_gt(old)
    };
    let pending = s.mask_from_bits(pending);
    // Signed, so that shaded fragments, which are of earlier chunks, count as older.
    let (mine, seen) = (
        <i32x16<S> as SimdBase<S>>::splat(s, number.cast_signed()),
        seen.bitcast::<i32x16<S>>(),
    );
    let wins_tie = match function {
        CompareFunction::Less | CompareFunction::Greater => pending & mine.simd_lt(seen),
        _ => !pending | mine.simd_gt(seen),
    };
    nearer | (new.simd_eq(old) & wins_tie)
}
