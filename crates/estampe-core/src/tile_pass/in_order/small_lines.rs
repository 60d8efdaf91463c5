//! Small lines in order, sixteen at a time.
//!
//! The lines of a wireframe are a few pixels long: drawn one by one, they leave most lanes idle. As
//! [small triangles](super::small), sixteen are covered together, and their pixels, or quads, are
//! listed, tested and fill packets sixteen by sixteen. A line of up to twelve pixels is two lanes.

use super::InOrder;
use super::listed::ListedValues;
use super::small::{Listing, SmallScratch};
use crate::bounds::bins::BinEntry;
use crate::bounds::lane_order::AnyOrder;
use crate::bounds::lines::LinePacket;
use crate::fragment::cross_fragments::Row;
use crate::fragment::cross_line::CrossLines;
use crate::fragment::fill::lanes_between;
use crate::fragment::interpolate::VaryingSource;
use crate::raster::small_lines::{LineHalves, LineSizes};
use estampe_simd::{LANES, Lane, Lanes, Packet, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::Interpolation;

/// Fewer lanes than this are drawn line by line.
const LEAST: usize = 3;

/// Lines that are drawn together, in order: from one packet or from several.
#[derive(Debug)]
pub(super) struct LineBatch<'a> {
    /// The packets, each with the lanes of the batch that it fills.
    packets: [Option<(&'a LinePacket, u16)>; LANES],
    packet_count: usize,
    /// By lane: the line's lane in its packet. Lists are written sixteen lanes at a time.
    from: [u32; 2 * LANES],
    len: usize,
    halves: LineHalves,
}

impl Default for LineBatch<'_> {
    fn default() -> Self {
        Self {
            packets: [None; LANES],
            packet_count: 0,
            from: [0; 2 * LANES],
            len: 0,
            halves: LineHalves::default(),
        }
    }
}

impl<'a> LineBatch<'a> {
    /// Returns true if there is room for so many lanes.
    #[inline(always)]
    fn has_room(&self, lanes: usize) -> bool {
        self.len + lanes <= LANES
    }

    /// Adds a line that takes so many lanes, for which there must be room.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    fn add(&mut self, packet: &'a LinePacket, lane: Lane, lanes: usize) {
        let first = self.len;
        for at in first..first + lanes {
            self.from[at % LANES] = lane.get() as u32;
        }
        if lanes > 1 {
            self.halves.any |= 0b11 << first;
            self.halves.seconds |= 0b10 << first;
        }
        self.fill(packet, lanes);
    }

    /// Adds lines that take one lane each, for which there must be room.
    #[inline(always)]
    fn add_all<S: Lanes>(&mut self, s: S, packet: &'a LinePacket, lanes: u16) {
        if let Some(from) = self.from[self.len % LANES..].first_chunk_mut() {
            let count = s.list_bits(lanes, 0, from);
            self.fill(packet, count);
        }
    }

    /// Notes that a packet's lines are in the next lanes.
    #[inline(always)]
    fn fill(&mut self, packet: &'a LinePacket, lanes: usize) {
        let filled = lanes_between(self.len, self.len + lanes);
        self.len += lanes;
        if let Some((last, of_last)) = &mut self.packets[self.packet_count.saturating_sub(1)]
            && std::ptr::eq(*last, packet)
        {
            *of_last |= filled;
        } else {
            self.packets[self.packet_count % LANES] = Some((packet, filled));
            self.packet_count += 1;
        }
    }

    /// The lanes in use.
    #[inline(always)]
    fn lanes(&self) -> u16 {
        u16::MAX >> (LANES - self.len.clamp(1, LANES))
    }

    /// Writes the lines, which have no pattern, to a packet.
    #[inline(always)]
    fn gather<S: Lanes>(&self, s: S, has_flat_varyings: bool, to: &mut LinePacket) {
        let from = self.from.first_chunk().unwrap_or(&[0; LANES]);
        let from = u32x16::load_array_ref(s, from);
        for &(packet, lanes) in self.packets[..self.packet_count].iter().flatten() {
            to.set_lanes(s, lanes, (packet, from), has_flat_varyings);
        }
    }

    fn clear(&mut self) {
        self.packets = [None; LANES];
        (self.packet_count, self.len) = (0, 0);
        self.halves = LineHalves::default();
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

    type Depths<'a, S: Lanes> = (&'a CrossLines, u32x16<S>);

    #[inline(always)]
    fn depths<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        _s: S,
        _order: AnyOrder<S>,
        lane: u32x16<S>,
    ) -> (&CrossLines, u32x16<S>) {
        (&of.cross_lines, lane)
    }

    #[inline(always)]
    fn depth<S: Lanes>(
        (lines, lane): &(&CrossLines, u32x16<S>),
        s: S,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        lines.depth(s, *lane, distances)
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
    /// Draws lines of a packet with those of the batch, or alone.
    #[inline(never)]
    pub(super) fn add_lines(
        &mut self,
        batch: &mut LineBatch<'a>,
        packet: &'a LinePacket,
        lanes: u16,
    ) {
        let sizes = if self.lists_lines() {
            self.sizes_of(packet)
        } else {
            LineSizes::default()
        };
        if lanes & !sizes.one == 0 {
            // Most often all fit. They stay together: a packet's lines are read once.
            let count = lanes.count_ones() as usize;
            if !batch.has_room(count) {
                self.draw_lines(batch);
            }
            dispatch!(@wide self.work.level, s => batch.add_all(s, packet, lanes),
                scalar => unreachable!("the scalar level lists no lines"));
            return;
        }
        for lane in Lane::all_of(lanes) {
            let needed = if lane.is_in(sizes.one) {
                1
            } else if lane.is_in(sizes.two) {
                2
            } else {
                self.draw_lines(batch);
                self.line(packet.line(lane));
                continue;
            };
            if !batch.has_room(needed) {
                self.draw_lines(batch);
            }
            batch.add(packet, lane, needed);
        }
    }

    /// How many lanes the lines of a packet take.
    #[inline(always)]
    fn sizes_of(&self, packet: &LinePacket) -> LineSizes {
        let shape = self.work.plan.line_style.shape;
        let quads = self.listing == Listing::Quads;
        dispatch!(@wide self.work.level, s => LineSizes::new::<_, N>(s, packet, shape, quads),
            scalar => LineSizes::default())
    }

    /// Returns true if small lines of the run are listed.
    #[inline(always)]
    pub(super) fn lists_lines(&self) -> bool {
        let plan = self.work.plan;
        let are_lines = matches!(self.primitives, Some(BinEntry::Lines { .. }));
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
        for lane in Lane::all_of(batch.lanes() & !batch.halves.seconds) {
            // A line whose halves are not listed is drawn with the first of them.
            if lane.get() < next {
                continue;
            }
            let run = (small >> lane.get()).trailing_ones();
            if run == 0 {
                let line = self.scratch.in_order.small.lines.line(lane);
                self.line(line);
                continue;
            }
            let lanes = ((1u32 << run) - 1) << lane.get();
            self.list_pixels::<OfLines>((lanes & 0xFFFF) as u16);
            next = lane.get() + run as usize;
        }
        batch.clear();
    }

    /// Gathers and covers the lines of a batch. Returns the lanes that may be listed.
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
        let scratch = &mut *self.scratch.in_order.small;
        let has_flat_varyings = self.source.modes.contains(&Interpolation::Flat);
        batch.gather(s, has_flat_varyings, &mut scratch.lines);
        if batch.len < LEAST {
            return 0;
        }
        let shape = self.work.plan.line_style.shape;
        let lines = (&scratch.lines, batch.lanes(), batch.halves);
        let tile = (self.work.shape, &self.work.rect);
        let boxes = (shape, self.listing == Listing::Quads);
        let small = scratch
            .small
            .cover_lines(s, lines, boxes, (tile, self.samples));
        if (small.count_ones() as usize) < LEAST {
            return 0;
        }
        scratch
            .cross_lines
            .set(s, (&scratch.lines, small), shape, &self.source);
        u32::from(small)
    }
}
