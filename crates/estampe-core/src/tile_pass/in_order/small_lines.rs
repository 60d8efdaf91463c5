//! Small lines in order, sixteen at a time.
//!
//! The lines of a wireframe are a few pixels long: drawn one by one, they leave most lanes idle. As
//! [small triangles](super::small), sixteen are covered together, and their pixels, or quads, are
//! listed, tested and fill packets sixteen by sixteen. A line of up to twelve pixels is two lanes.

use super::InOrder;
use super::listed::ListedValues;
use super::small::{Listing, SmallScratch};
use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::LinePrimitive;
use crate::fragment::cross_triangle::Row;
use crate::fragment::interpolate::VaryingSource;
use crate::raster::small_lines::lanes_of;
use estampe_simd::{LANES, Lanes, Packet, dispatch, f32x16, u32x16};

/// Fewer lanes than this are drawn line by line.
const LEAST: u32 = 3;

/// Lines that are drawn together, in order.
#[derive(Debug, Default)]
pub(super) struct LineBatch<'a> {
    /// By lane: a line, and which half of it, if it is divided.
    lanes: [Option<(&'a LinePrimitive, Option<usize>)>; LANES],
    len: usize,
}

impl<'a> LineBatch<'a> {
    /// Returns true if there is room for so many lanes.
    #[inline(always)]
    fn has_room(&self, lanes: usize) -> bool {
        self.len + lanes <= LANES
    }

    /// Adds a line that takes so many lanes, for which there must be room.
    #[inline(always)]
    fn add(&mut self, line: &'a LinePrimitive, lanes: usize) {
        for half in 0..lanes {
            let half = (lanes > 1).then_some(half);
            self.lanes[self.len % LANES] = Some((line, half));
            self.len += 1;
        }
    }

    /// The lanes: number, line, half.
    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = (usize, &'a LinePrimitive, Option<usize>)> {
        let lanes = self.lanes.iter().take(self.len).enumerate();
        lanes.filter_map(|(lane, of)| of.map(|(line, half)| (lane, line, half)))
    }
}

/// Values of listed pixels that are lines'.
struct OfLines;

impl ListedValues for OfLines {
    #[inline(always)]
    fn front<const N: usize>(of: &SmallScratch<N>) -> u16 {
        of.lines.front
    }

    #[inline(always)]
    fn has_depths_of_centers<const N: usize>(of: &SmallScratch<N>) -> bool {
        of.cross_lines.has_depths_of_centers()
    }

    #[inline(always)]
    fn depth<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        lane: u32x16<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        of.cross_lines.depth(s, lane, distances)
    }

    #[inline(always)]
    fn inverse_w<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        of.cross_lines.inverse_w(s, row.pixels.lane(), distances)
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
        of.cross_lines.varyings(s, row, source, distances, out);
    }
}

impl<'a, const N: usize> InOrder<'a, '_, '_, '_, N> {
    /// Draws a line with those of the batch, or alone.
    #[inline(always)]
    pub(super) fn add_line(&mut self, batch: &mut LineBatch<'a>, line: &'a LinePrimitive) {
        let lanes = if self.lists_lines() {
            let quads = self.listing == Listing::Quads;
            lanes_of::<N>(line, self.work.plan.line_style.shape, quads)
        } else {
            0
        };
        if lanes == 0 {
            self.draw_lines(batch);
            self.line(line);
            return;
        }
        if !batch.has_room(lanes) {
            self.draw_lines(batch);
        }
        batch.add(line, lanes);
    }

    /// Returns true if small lines of the run are listed.
    #[inline(always)]
    pub(super) fn lists_lines(&self) -> bool {
        let plan = self.work.plan;
        let are_lines = matches!(self.primitives, Some(BinEntry::Line(_)));
        are_lines && self.listing != Listing::None && plan.line_style.is_plain()
    }

    /// Draws the lines of a batch, and empties it.
    #[inline(never)]
    pub(super) fn draw_lines(&mut self, batch: &mut LineBatch<'a>) {
        if batch.len == 0 {
            return;
        }
        let small = self.cover_lines(batch);
        let mut next = 0;
        for (lane, line, half) in batch.iter() {
            // A line whose halves are not listed is drawn with the first of them.
            if lane < next || half == Some(1) {
                continue;
            }
            let run = (small >> lane).trailing_ones();
            if run == 0 {
                self.line(line);
                continue;
            }
            let lanes = ((1u32 << run) - 1) << lane;
            self.list_pixels::<OfLines>((lanes & 0xFFFF) as u16);
            next = lane + run as usize;
        }
        batch.len = 0;
    }

    /// Covers the lines of a batch. Returns the lanes that may be listed.
    #[inline(never)]
    fn cover_lines(&mut self, batch: &LineBatch<'_>) -> u32 {
        // Code for more samples is not needed, and that of the scalar level takes too long.
        if const { N > 4 } {
            return 0;
        }
        dispatch!(@wide self.work.level, s => self.cover_line_lanes(s, batch), scalar => 0)
    }

    #[inline(always)]
    fn cover_line_lanes<S: Lanes>(&mut self, s: S, batch: &LineBatch<'_>) -> u32 {
        if batch.len < LEAST as usize {
            return 0;
        }
        let scratch = &mut *self.scratch.in_order.small;
        for (lane, line, half) in batch.iter() {
            scratch.lines.set(lane, line, half);
        }
        let lanes = u16::MAX >> (LANES - batch.len.min(LANES));
        let shape = self.work.plan.line_style.shape;
        let lines = (&scratch.lines, lanes);
        let tile = (self.work.shape, &self.work.rect);
        let boxes = (shape, self.listing == Listing::Quads);
        let small = scratch
            .small
            .cover_lines(s, lines, boxes, (tile, self.samples));
        if small.count_ones() < LEAST {
            return 0;
        }
        scratch
            .cross_lines
            .set(s, (&scratch.lines, small), shape, &self.source);
        u32::from(small)
    }
}
