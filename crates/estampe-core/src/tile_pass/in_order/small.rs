//! Small triangles in order, sixteen at a time.
//!
//! A sprite of 4×4 pixels is two triangles of ten pixels at most, which lie in three packets or
//! four: drawn one by one, they leave most lanes idle, and what a triangle costs beside its
//! fragments is most of the time. Here sixteen triangles are covered together, their pixels are
//! listed in the order of the triangles, and the list is tested and fills packets sixteen by
//! sixteen. Order is kept: a packet holds no pixel twice, and ends before one that comes again. If
//! the shader looks at the neighbours of a pixel, the list is one of quads. A triangle of up to
//! sixteen pixels across and down, as half of a glyph, is two lanes or four: the halves or quarters
//! of its box. Two triangles that make a [rectangle](crate::geometry::rectangles) are drawn as one box.
//!
//! ```text
//!   16 triangles ─▶ list of pixels ─▶ early tests ─▶ packets of different pixels ─▶ queue
//!        └─ a triangle that is large, or of one colour, is drawn alone, between two lists
//! ```

use super::InOrder;
use super::listed::ListedValues;
use crate::bounds::lane_order::AnyOrder;
use crate::bounds::lines::LinePacket;
use crate::bounds::plane::PlaneLanes;
use crate::bounds::primitives::{PackedTriangle, TrianglePacket};
use crate::fragment::alpha_test::AlphaPlaces;
use crate::fragment::cross_fragments::Row;
use crate::fragment::cross_line::CrossLines;
use crate::fragment::cross_triangle::CrossPlanes;
use crate::fragment::interpolate::VaryingSource;
use crate::plan::tile_plan::TilePlan;
use crate::raster::parts::{Part, Parts};
use crate::raster::pixel_list::PixelList;
use crate::raster::small::{Boxes, SIDE, SmallBoxes};
use crate::tile_path::TilePath;
use estampe_simd::{LANES, Lanes, Packet, dispatch, f32x16, u32x16};
use estampe_types::shader::AlphaTest;
use estampe_types::state::ConservativeMode;

/// Fewer triangles than this are drawn one by one.
const LEAST: usize = 3;

/// The extent in 1/256 pixel from which on triangles are divided.
const SMALL: i32 = SIDE * 256;

/// A triangle's width and height, in 1/256 pixel.
#[inline(always)]
fn extents(triangle: &PackedTriangle) -> [i32; 2] {
    let ([x0, x1, x2], y) = (triangle.x, triangle.y);
    [x0.max(x1).max(x2) - x0.min(x1).min(x2), y[2] - y[0]]
}

/// A lane of a batch.
#[derive(Debug, Clone, Copy)]
struct Member<'a> {
    triangle: &'a PackedTriangle,
    /// The triangle that makes a rectangle with it.
    second: Option<&'a PackedTriangle>,
    part: Part,
}

/// Triangles that are drawn together, in order, and what they are divided into.
#[derive(Debug, Default)]
pub(super) struct Batch<'a> {
    lanes: [Option<Member<'a>>; LANES],
    len: usize,
    /// How many lanes are small triangles or parts of larger ones.
    small: usize,
}

impl<'a> Batch<'a> {
    /// A triangle alone.
    pub(super) fn of(triangle: &'a PackedTriangle) -> Self {
        let mut batch = Self::default();
        batch.add(triangle, None);
        batch
    }

    /// Returns true if a triangle may be listed, and whether its box is then divided into columns
    /// and into rows of parts.
    #[inline(always)]
    fn division_of(triangle: &PackedTriangle) -> (bool, [bool; 2]) {
        // A box may have a column or a row more than the extent says: such a triangle is drawn
        // alone, if its box is not small.
        let [across, down] = extents(triangle);
        let is_small = across.max(down) < 2 * SMALL;
        let is_divided = [is_small && across >= SMALL, is_small && down >= SMALL];
        (is_small, is_divided)
    }

    /// Adds a triangle, and with it the one that makes a rectangle with it, if there are lanes for
    /// them; otherwise false.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        triangle: &'a PackedTriangle,
        second: Option<&'a PackedTriangle>,
    ) -> bool {
        let (is_small, is_divided) = Self::division_of(triangle);
        let [columns, rows] = is_divided.map(usize::from);
        let count = 1 << columns << rows;
        if self.len + count > LANES {
            return false;
        }
        for below in 0..=i32::from(is_divided[1]) {
            for right in 0..=i32::from(is_divided[0]) {
                let part = Part {
                    from: [right * SIDE, below * SIDE],
                    is_divided,
                    is_rectangle: second.is_some(),
                };
                self.lanes[self.len % LANES] = Some(Member {
                    triangle,
                    second,
                    part,
                });
                self.len += 1;
            }
        }
        self.small += if is_small { count } else { 0 };
        true
    }

    /// Forgets the triangles.
    #[inline(always)]
    fn clear(&mut self) {
        (self.len, self.small) = (0, 0);
    }

    /// The lanes and their numbers.
    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = (usize, &Member<'a>)> {
        let lanes = self.lanes.iter().take(self.len).enumerate();
        lanes.filter_map(|(lane, of)| of.as_ref().map(|member| (lane, member)))
    }
}

/// Lanes of a batch that was set up.
#[derive(Debug, Clone, Copy, Default)]
struct BatchLanes {
    /// Those that may be listed.
    small: u16,
    /// Those whose planes were made.
    with_planes: u16,
}

/// Memory of one worker.
#[derive(Debug)]
pub(super) struct SmallScratch<const N: usize> {
    /// The batch at hand.
    packet: TrianglePacket,
    parts: Parts,
    pub(super) small: SmallBoxes<N>,
    pub(super) planes: CrossPlanes,
    /// Lines, and their values.
    pub(super) lines: LinePacket,
    pub(super) cross_lines: CrossLines,
    pub(super) listed: PixelList,
}

impl<const N: usize> Default for SmallScratch<N> {
    fn default() -> Self {
        Self {
            packet: TrianglePacket::EMPTY,
            parts: Parts::WHOLE,
            small: SmallBoxes::default(),
            planes: CrossPlanes::default(),
            lines: LinePacket::default(),
            cross_lines: CrossLines::default(),
            listed: PixelList::default(),
        }
    }
}

/// Values of listed pixels that are triangles'.
struct OfTriangles;

impl ListedValues for OfTriangles {
    #[inline(always)]
    fn front<const N: usize>(of: &SmallScratch<N>) -> u16 {
        of.packet.front
    }

    #[inline(always)]
    fn has_depths_of_centers<const N: usize>(_of: &SmallScratch<N>) -> bool {
        false
    }

    type Depths<'a, S: Lanes> = PlaneLanes<S>;

    #[inline(always)]
    fn depths<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        order: AnyOrder<S>,
        _lane: u32x16<S>,
    ) -> PlaneLanes<S> {
        of.packet.z.of_lanes(s, order)
    }

    #[inline(always)]
    fn depth<S: Lanes>(of: &PlaneLanes<S>, _s: S, distances: [f32x16<S>; 2]) -> f32x16<S> {
        of.at(distances)
    }

    #[inline(always)]
    fn inverse_w<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        of.planes.inverse_w(s, row, &of.packet, distances)
    }

    #[inline(always)]
    fn alpha_places<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        order: AnyOrder<S>,
        test: &AlphaTest,
        distances: [f32x16<S>; 2],
    ) -> Option<AlphaPlaces<S>> {
        Some(of.planes.alpha_places(s, order, test, distances))
    }

    #[inline(always)]
    fn varyings<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        source: &VaryingSource<'_>,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        of.planes.varyings(s, row, source, distances, out);
    }
}

/// What is listed of small triangles and lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Listing {
    /// Nothing: they are drawn one by one.
    None,
    /// Their pixels.
    Pixels,
    /// Their quads, because the shader looks at neighbours.
    Quads,
}

impl Listing {
    /// The listing of a draw.
    pub(super) fn of(plan: &TilePlan<'_>) -> Self {
        let key = plan.pipeline.key();
        let primitive = &plan.pipeline.descriptor().primitive;
        let is_common = plan.path != TilePath::InOrderPackets
            && key.sample_mask.is_none()
            && plan.cut_samples.is_none()
            && primitive.conservative == ConservativeMode::Disabled;
        match is_common {
            true if key.needs_no_quads => Self::Pixels,
            true => Self::Quads,
            false => Self::None,
        }
    }
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Draws a batch, and empties it.
    #[inline(never)]
    pub(super) fn batch(&mut self, batch: &mut Batch<'_>) {
        dispatch_samples!(N, self.work.level, s => self.batch_lanes(s, batch));
        batch.clear();
    }

    #[inline(always)]
    fn batch_lanes<S: Lanes>(&mut self, s: S, batch: &Batch<'_>) {
        let mut set_up = BatchLanes::default();
        let is_enough = batch.small >= LEAST || self.sets_planes() && batch.len >= LEAST;
        if self.listing != Listing::None && is_enough {
            set_up = self.set_up_batch(batch);
        }
        let mut next = 0;
        for (lane, member) in batch.iter() {
            // A triangle whose parts are not listed is drawn with the first of them.
            if lane < next || member.part.from != [0; 2] {
                continue;
            }
            let run = (set_up.small >> lane).trailing_ones() as usize;
            if run >= LEAST {
                self.end_fan();
                let lanes = ((1u32 << run) - 1) << lane;
                self.list_pixels::<OfTriangles>((lanes & 0xFFFF) as u16);
                next = lane + run;
            } else if member.second.is_none() && self.join_fan(member.triangle) {
                next = lane + 1;
            } else {
                self.end_fan();
                // Blocks are blended triangle by triangle.
                let second = member.second.filter(|_| self.blends_blocks);
                let is_box = member.second.is_some() && second.is_none();
                let has_planes = set_up.with_planes >> lane & 1 == 1;
                let mut planes_of = has_planes.then_some(lane);
                // A loop, so that the code of a triangle is here once.
                for triangle in [Some(member.triangle), second].into_iter().flatten() {
                    self.triangle(s, &triangle.unpack(), (is_box, planes_of.take()));
                }
                next = lane + 1;
            }
        }
    }

    /// Returns true if planes are made of all triangles of a batch together: also of those that are
    /// drawn alone.
    #[inline(always)]
    fn sets_planes(&self) -> bool {
        // Fans need none, and planes are the least of what a layer costs: with them made here
        // `blend` took 1.03 of its time.
        !self.joins_triangles && !self.blends_blocks && !self.source.modes.is_empty()
    }

    /// Covers the small triangles of a batch, and makes planes.
    #[inline(never)]
    fn set_up_batch(&mut self, batch: &Batch<'_>) -> BatchLanes {
        // Code for more samples is not needed, and that of the scalar level takes too long.
        if const { N > 4 } {
            return BatchLanes::default();
        }
        dispatch!(@wide self.work.level, s => self.set_up_lanes(s, batch),
            scalar => BatchLanes::default())
    }

    #[inline(always)]
    fn set_up_lanes<S: Lanes>(&mut self, s: S, batch: &Batch<'_>) -> BatchLanes {
        let sets_planes = self.sets_planes();
        let scratch = &mut *self.scratch.in_order.small;
        for (lane, member) in batch.iter() {
            scratch.packet.set(lane, member.triangle);
            scratch.parts.set(lane, member.part);
        }
        scratch.packet.complete_small(s);
        let lanes = u16::MAX >> (LANES - batch.len.clamp(1, LANES));
        let packet = &scratch.packet;
        let mut small = 0;
        if batch.small >= LEAST {
            let tile = (self.work.shape, &self.work.rect);
            let boxes = Boxes {
                side: SIDE,
                quads: self.listing == Listing::Quads,
            };
            let (of_lanes, of_tile) = ((packet, lanes), (tile, self.samples));
            let covered = &mut scratch.small;
            small = covered.cover_boxes(s, boxes, &scratch.parts, of_lanes, of_tile);
            if (small.count_ones() as usize) < LEAST {
                small = 0;
            }
        }
        let with_planes = if sets_planes { lanes } else { small };
        if with_planes != 0 {
            scratch.planes.set(s, packet, with_planes, &self.source);
        }
        if self.gathers && small != 0 {
            small &= !scratch.planes.constant(s, small, self.source.modes);
        }
        BatchLanes { small, with_planes }
    }
}
