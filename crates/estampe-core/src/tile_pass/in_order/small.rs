//! Small triangles in order, sixteen at a time.
//!
//! A sprite of 4×4 pixels is two triangles of ten pixels at most, which lie in three packets or
//! four: drawn one by one, they leave most lanes idle, and what a triangle costs beside its
//! fragments is most of the time. Here sixteen triangles are covered together, their pixels are
//! listed in the order of the triangles, and the list is tested and fills packets sixteen by
//! sixteen. Order is kept: a packet holds no pixel twice, and ends before one that comes again. If
//! the shader looks at the neighbours of a pixel, the list is one of quads. A triangle of up to
//! sixteen pixels across and down, as half of a glyph, is four lanes: the quarters of its box.
//!
//! ```text
//!   16 triangles ─▶ list of pixels ─▶ early tests ─▶ packets of different pixels ─▶ queue
//!        └─ a triangle that is large, or of one colour, is drawn alone, between two lists
//! ```

use super::InOrder;
use super::listed::ListedValues;
use crate::bounds::primitives::{LinePacket, Triangle, TrianglePacket};
use crate::fragment::cross_line::CrossLines;
use crate::fragment::cross_triangle::{CrossPlanes, Row, bits_of_row};
use crate::fragment::interpolate::VaryingSource;
use crate::plan::tile_plan::TilePlan;
use crate::raster::pixel_list::PixelList;
use crate::raster::small::{Boxes, Parts, SIDE, SmallBoxes};
use crate::tile_path::TilePath;
use estampe_simd::{LANES, Lanes, Packet, Select, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::state::ConservativeMode;

/// Fewer triangles than this are drawn one by one.
const LEAST: u32 = 3;

/// The extent in 1/256 pixel from which on triangles are divided.
const SMALL: i32 = SIDE * 256;

/// The greater one of a triangle's width and height, in 1/256 pixel.
#[inline(always)]
fn extent(triangle: &Triangle) -> i32 {
    let ([x0, x1, x2], y) = (triangle.x, triangle.y);
    let across = x0.max(x1).max(x2) - x0.min(x1).min(x2);
    across.max(y[2] - y[0])
}

/// Triangles that are drawn together, in order, and what they are divided into.
#[derive(Debug, Default)]
pub(super) struct Batch<'a> {
    /// By lane: a triangle, and which quarter of it, if it is divided.
    lanes: [Option<(&'a Triangle, Option<usize>)>; LANES],
    len: usize,
    /// How many lanes are small triangles or quarters of larger ones.
    small: u32,
}

impl<'a> Batch<'a> {
    /// A triangle alone.
    pub(super) fn of(triangle: &'a Triangle) -> Self {
        let mut batch = Self::default();
        batch.add(triangle);
        batch
    }

    /// The lanes that a triangle takes.
    #[inline(always)]
    fn lanes_of(triangle: &Triangle) -> usize {
        // A box may have a column or a row more than the extent says: such a triangle is drawn
        // alone, if its box is not small.
        if (SMALL..2 * SMALL).contains(&extent(triangle)) {
            Parts::QUARTERS.len()
        } else {
            1
        }
    }

    /// Returns true if there are lanes for a triangle.
    #[inline(always)]
    pub(super) fn has_room(&self, triangle: &Triangle) -> bool {
        self.len + Self::lanes_of(triangle) <= LANES
    }

    /// Adds a triangle, for which there must be room.
    #[inline(always)]
    pub(super) fn add(&mut self, triangle: &'a Triangle) {
        let count = Self::lanes_of(triangle);
        for part in 0..count {
            let part = (count > 1).then_some(part);
            self.lanes[self.len % LANES] = Some((triangle, part));
            self.len += 1;
        }
        let is_small = extent(triangle) < 2 * SMALL;
        self.small += u32::from(is_small) * if count > 1 { 4 } else { 1 };
    }

    /// The lanes: number, triangle, quarter.
    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = (usize, &'a Triangle, Option<usize>)> {
        let lanes = self.lanes.iter().take(self.len).enumerate();
        lanes.filter_map(|(lane, of)| of.map(|(triangle, part)| (lane, triangle, part)))
    }
}

/// Memory of one worker.
#[derive(Debug)]
pub(super) struct SmallScratch<const N: usize> {
    /// The batch at hand.
    packet: TrianglePacket,
    parts: Parts,
    pub(super) small: SmallBoxes<N>,
    planes: CrossPlanes,
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
            lines: LinePacket::EMPTY,
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

    #[inline(always)]
    fn depth<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        lane: u32x16<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        of.packet.z.at(s, lane, distances)
    }

    #[inline(always)]
    fn inverse_w<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        let (iw, lane) = (&of.packet.iw, row.pixels.lane());
        let origin = s.permute_f32(f32x16::load_array_ref(s, &iw.origin), lane);
        let is_equal = s.mask_from_bits(bits_of_row(s, of.packet.equal_w, row));
        is_equal.select(origin, iw.at(s, lane, distances))
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

impl<const N: usize> InOrder<'_, '_, '_, N> {
    /// Draws a batch, and empties it.
    #[inline(never)]
    pub(super) fn batch(&mut self, batch: &mut Batch<'_>) {
        dispatch_samples!(N, self.work.level, s => self.batch_lanes(s, batch));
        (batch.len, batch.small) = (0, 0);
    }

    #[inline(always)]
    fn batch_lanes<S: Lanes>(&mut self, s: S, batch: &Batch<'_>) {
        let mut small = 0;
        if self.listing != Listing::None && batch.small >= LEAST {
            small = self.cover_batch(batch);
        }
        let mut next = 0;
        for (lane, triangle, part) in batch.iter() {
            // A triangle whose quarters are not listed is drawn with the first of them.
            if lane < next || part.is_some_and(|part| part > 0) {
                continue;
            }
            let run = (small >> lane).trailing_ones();
            if run >= LEAST {
                let lanes = ((1u32 << run) - 1) << lane;
                self.list_pixels::<OfTriangles>((lanes & 0xFFFF) as u16);
                next = lane + run as usize;
            } else {
                self.triangle(s, triangle);
                next = lane + 1;
            }
        }
    }

    /// Covers the triangles of a batch. Returns those that may be listed.
    #[inline(never)]
    fn cover_batch(&mut self, batch: &Batch<'_>) -> u16 {
        // Code for more samples is not needed, and that of the scalar level takes too long.
        if const { N > 4 } {
            return 0;
        }
        dispatch!(@wide self.work.level, s => self.cover_lanes(s, batch), scalar => 0)
    }

    #[inline(always)]
    fn cover_lanes<S: Lanes>(&mut self, s: S, batch: &Batch<'_>) -> u16 {
        let scratch = &mut *self.scratch.in_order.small;
        for (lane, triangle, part) in batch.iter() {
            scratch.packet.set(lane, triangle);
            let part = part.and_then(|part| Parts::QUARTERS.get(part));
            scratch.parts.set(lane, part.copied());
        }
        let lanes = u16::MAX >> (LANES - batch.len.clamp(1, LANES));
        let tile = (self.work.shape, &self.work.rect);
        let packet = &scratch.packet;
        let small = &mut scratch.small;
        let boxes = Boxes {
            side: SIDE,
            quads: self.listing == Listing::Quads,
        };
        let of_lanes = (packet, lanes);
        let small = small.cover_boxes(s, boxes, &scratch.parts, of_lanes, (tile, self.samples));
        if small.count_ones() < LEAST {
            return 0;
        }
        scratch.planes.set(s, packet, small, &self.source);
        if self.gathers {
            return small & !scratch.planes.constant(s, small, self.source.modes);
        }
        small
    }
}
