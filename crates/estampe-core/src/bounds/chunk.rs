//! Chunks: what one worker of the geometry side gives to the tiles.
//!
//! *In* primitives that are set up · *Out* for each tile, its primitives in submission order ·
//! *Space* window.
//!
//! A [`Chunk`] holds *parts*: each is a sub-draw, or part of one, and its primitives. Several small
//! draws share a chunk, so that its fixed costs (sorting bins, indexing tiles) are paid once for
//! many draws. Parts whose triangles tiles rasterize alike are one *run*, whose triangles share
//! packets and entries of bins; primitives of two runs never do. Parts follow one another in
//! submission order, and so do the entries of a tile.

use super::bin_limits::{BinLimits, BinSizes};
use super::bins::{BinEntry, Bins};
use super::lines::{LinePacket, LinePackets};
use super::packets::{StalePackets, TrianglePackets};
use super::primitives::{PackedTriangle, PackedTriangles, PointPrimitive, TrianglePacket};
use super::slabs::{Expected, SharedSlabs, Slabs};
use crate::statistics::Statistics;
use estampe_simd::LANES;
use std::sync::atomic::AtomicU32;

/// The primitives of one sub-draw in a chunk, or of several that are rasterized alike: from these
/// first ones on up to those of the next run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ChunkRun {
    /// The number of its first sub-draw in the batch.
    pub(crate) sub_draw: u32,
    first_packet: u32,
    first_lines: u32,
    first_point: u32,
}

impl ChunkRun {
    /// Returns true if the run begins at or before the primitive of an entry.
    #[inline]
    fn begins_by(&self, entry: BinEntry) -> bool {
        match entry {
            BinEntry::Triangles { packet, .. } => self.first_packet <= packet,
            BinEntry::Lines { packet, .. } => self.first_lines <= packet,
            BinEntry::Point(point) => self.first_point <= point,
        }
    }
}

/// The triangles of one sub-draw in a chunk: from this first one on up to that of the next part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ChunkPart {
    /// Its place in the chunk's packets: 16 × the packet's number + the lane.
    first_triangle: u32,
    /// The sub-draw's number in its batch.
    sub_draw: u32,
}

/// Memory of the packets of all chunks.
#[derive(Debug, Default)]
pub(crate) struct ChunkSlabs {
    triangles: SharedSlabs<TrianglePacket>,
    one_by_one: SharedSlabs<PackedTriangles>,
    lines: SharedSlabs<LinePacket>,
}

impl ChunkSlabs {
    /// Forgets the packets of all chunks.
    pub(crate) fn clear(&mut self) {
        self.triangles.get_mut().clear();
        self.one_by_one.get_mut().clear();
        self.lines.get_mut().clear();
    }

    /// The packets of chunks that are not added to.
    pub(crate) fn packets(&mut self) -> ChunkPackets<'_> {
        ChunkPackets {
            triangles: self.triangles.get_mut(),
            one_by_one: self.one_by_one.get_mut(),
            lines: self.lines.get_mut(),
        }
    }
}

/// The packets of all chunks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkPackets<'a> {
    triangles: &'a Slabs<TrianglePacket>,
    one_by_one: &'a Slabs<PackedTriangles>,
    lines: &'a Slabs<LinePacket>,
}

impl<'a> ChunkPackets<'a> {
    /// The packets of a chunk.
    #[inline(always)]
    pub(crate) fn of(self, chunk: &Chunk) -> Packets<'a> {
        Packets {
            triangles: chunk.triangles.packets(self.triangles),
            one_by_one: chunk.one_by_one.packets(self.one_by_one),
            lines: chunk.lines.packets(self.lines),
        }
    }
}

/// The packets of a chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packets<'a> {
    pub(crate) triangles: &'a [TrianglePacket],
    /// Of the packets that were [taken apart](Chunk::take_apart_last); of others anything.
    pub(crate) one_by_one: &'a [PackedTriangles],
    pub(crate) lines: &'a [LinePacket],
}

/// A number of packets of each kind.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PacketCounts<T> {
    pub(crate) triangles: T,
    /// Of those triangles that are taken apart, with all that are numbered before them.
    pub(crate) one_by_one: T,
    pub(crate) lines: T,
}

impl<T> PacketCounts<T> {
    pub(crate) fn map<R>(self, each: impl Fn(T) -> R) -> PacketCounts<R> {
        PacketCounts {
            triangles: each(self.triangles),
            one_by_one: each(self.one_by_one),
            lines: each(self.lines),
        }
    }
}

/// Primitives of one or several sub-draws, set up and binned.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    runs: Vec<ChunkRun>,
    parts: Vec<ChunkPart>,
    pub(crate) triangles: TrianglePackets,
    /// The triangles of the packets up to the last one whose triangles are drawn one by one, in
    /// order; of other packets anything.
    one_by_one: StalePackets<PackedTriangles>,
    /// By packet: those of these that make a rectangle with the next one.
    rectangles: Vec<u16>,
    pub(crate) lines: LinePackets,
    pub(crate) points: Vec<PointPrimitive>,
    /// Varyings of the vertices that clipping made, one after the other. The numbers of a run's
    /// vertices count in vertices of that run's size: see [`Chunk::align_clipped_varyings`].
    pub(crate) clipped_varyings: Vec<f32>,
    pub(crate) bins: Bins,
    pub(crate) statistics: Statistics,
}

impl Chunk {
    /// Forgets the contents, keeps the memory, and borrows more for packets.
    pub(crate) fn open(&mut self, slabs: &ChunkSlabs, expected: PacketCounts<Expected>) {
        let PacketCounts {
            triangles,
            one_by_one,
            lines,
        } = expected;
        self.runs.clear();
        self.parts.clear();
        self.triangles.open(&slabs.triangles, triangles);
        self.one_by_one.open(&slabs.one_by_one, one_by_one);
        self.rectangles.clear();
        self.lines.open(&slabs.lines, lines);
        self.points.clear();
        self.clipped_varyings.clear();
        self.bins.clear();
        self.statistics = Statistics::default();
    }

    /// Gives back what was borrowed.
    pub(crate) fn close(&mut self, slabs: &ChunkSlabs) {
        self.triangles.close(&slabs.triangles);
        self.one_by_one.close(&slabs.one_by_one);
        self.lines.close(&slabs.lines);
    }

    /// Sorts the bins, if that takes little memory, notes the tiles that the chunk reaches in a
    /// list of bits, which are not set yet, and adds to what tiles cost.
    pub(crate) fn sort_bins(
        &mut self,
        limits: BinLimits,
        (reached, costs): (&mut [u64], &[AtomicU32]),
    ) -> BinSizes {
        self.bins.sort(limits.of_chunk);
        self.bins.note_reached(reached);
        if !costs.is_empty() {
            self.bins.add_costs(costs);
        }
        let packets = (self.triangles.len() + self.lines.len()) * LANES;
        let waiting = if self.bins.waits() {
            packets + self.points.len()
        } else {
            0
        };
        BinSizes {
            spans: self.bins.spans() as u64,
            waiting: waiting as u64,
        }
    }

    /// Notes that the triangles of the last packet are drawn one by one, and those of them that
    /// make a rectangle with the next one.
    pub(crate) fn take_apart_last(&mut self, rectangles: u16) {
        let Some((packet, number)) = self.triangles.last() else {
            return;
        };
        let PackedTriangles(triangles) = self.one_by_one.push_as(number);
        for (lane, triangle) in triangles.iter_mut().enumerate() {
            *triangle = PackedTriangle::of_lane(packet, lane);
        }
        self.rectangles.resize(number, 0);
        self.rectangles.push(rectangles);
    }

    /// The triangles of a packet that was [taken apart](Chunk::take_apart_last) that make a
    /// rectangle with the next one, which has no entries of its own.
    #[inline(always)]
    pub(crate) fn rectangles(&self, packet: u32) -> u16 {
        self.rectangles[packet as usize]
    }

    /// Begins a run with its first sub-draw.
    pub(crate) fn begin_run(&mut self, sub_draw: u32) {
        self.lines.end_run();
        let [first_packet, first_lines, first_point] =
            [self.triangles.len(), self.lines.len(), self.points.len()].map(number);
        self.runs.push(ChunkRun {
            sub_draw,
            first_packet,
            first_lines,
            first_point,
        });
    }

    /// Begins the primitives of a sub-draw in the last run, before whose first triangle so many
    /// packets come, and `waiting` triangles that were in no packet then.
    pub(crate) fn begin_part(&mut self, sub_draw: u32, packets: usize, waiting: usize) {
        self.parts.push(ChunkPart {
            first_triangle: number(packets * LANES + waiting),
            sub_draw,
        });
    }

    /// The sub-draws of triangles from a lane of a packet on.
    pub(crate) fn sub_draws_from(&self, packet: u32, lane: u32) -> SubDrawCursor<'_> {
        let triangle = triangle_number(packet, lane);
        let begun = self
            .parts
            .partition_point(|part| part.first_triangle <= triangle);
        let (before, later) = self.parts.split_at(begun);
        let part = before.last();
        SubDrawCursor {
            sub_draw: part.map_or(0, |part| part.sub_draw),
            later,
        }
    }

    /// Fills the clipped varyings up to a whole number of vertices of `stride` scalars, and says
    /// how many: the number of the first vertex that the run at hand makes by clipping.
    pub(crate) fn align_clipped_varyings(&mut self, stride: usize) -> u32 {
        let vertices = self.clipped_varyings.len().checked_div(stride).unwrap_or(0);
        if vertices * stride == self.clipped_varyings.len() || stride == 0 {
            return number(vertices);
        }
        let vertices = vertices + 1;
        self.clipped_varyings.resize(vertices * stride, 0.0);
        number(vertices)
    }

    /// The runs that have entries for a tile, in submission order, each with its sub-draw's number.
    #[inline]
    pub(crate) fn runs_of_tile(&self, tile: u32) -> RunsOfTile<'_> {
        RunsOfTile {
            runs: &self.runs,
            entries: self.bins.of_tile(tile),
        }
    }
}

/// Converts the length of a chunk's list. A chunk ends long before any of its lists has 2³²
/// elements.
#[inline(always)]
pub(crate) fn number(len: usize) -> u32 {
    debug_assert!(
        u32::try_from(len).is_ok(),
        "a chunk's list of {len} elements"
    );
    u32::try_from(len).unwrap_or(u32::MAX)
}

/// A triangle's place in the packets of a chunk.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen")]
fn triangle_number(packet: u32, lane: u32) -> u32 {
    packet.wrapping_mul(LANES as u32).wrapping_add(lane)
}

/// See [`Chunk::runs_of_tile`].
#[derive(Debug, Clone)]
pub(crate) struct RunsOfTile<'c> {
    /// The run of the first entry, or one before it; and all later ones.
    runs: &'c [ChunkRun],
    /// The tile's entries that are left.
    entries: &'c [BinEntry],
}

impl<'c> Iterator for RunsOfTile<'c> {
    type Item = (u32, &'c [BinEntry]);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let first = *self.entries.first()?;
        let begun = self.runs.partition_point(|run| run.begins_by(first));
        debug_assert!(begun > 0, "{first:?} belongs to no run");
        self.runs = &self.runs[begun.saturating_sub(1)..];
        let (run, later) = self.runs.split_first()?;
        let len = match later.first() {
            Some(next) => self
                .entries
                .partition_point(|entry| !next.begins_by(*entry)),
            None => self.entries.len(),
        };
        let (entries, rest) = self.entries.split_at(len);
        self.entries = rest;
        Some((run.sub_draw, entries))
    }
}

/// Finds the sub-draws of triangles in ascending order.
#[derive(Debug, Clone)]
pub(crate) struct SubDrawCursor<'c> {
    sub_draw: u32,
    /// The parts that begin after the last triangle.
    later: &'c [ChunkPart],
}

impl SubDrawCursor<'_> {
    /// The number of a triangle's sub-draw in its batch. The triangle is at or after the last one
    /// that was asked for.
    #[inline(always)]
    pub(crate) fn of(&mut self, packet: u32, lane: u32) -> u32 {
        let triangle = triangle_number(packet, lane);
        while let Some((part, later)) = self.later.split_first()
            && part.first_triangle <= triangle
        {
            (self.sub_draw, self.later) = (part.sub_draw, later);
        }
        self.sub_draw
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::bins::TileSpan;

    #[test]
    fn a_tiles_entries_come_run_by_run() {
        let mut chunk = Chunk::default();
        let triangles = |packet| BinEntry::Triangles { packet, lanes: 1 };
        chunk.begin_run(7);
        for packet in 0..3 {
            chunk.triangles.push_stale();
            chunk
                .bins
                .push(TileSpan::of_tile(packet % 2), triangles(packet));
        }
        // A run of which nothing is left.
        chunk.begin_run(8);
        chunk.begin_run(9);
        chunk.triangles.push_stale();
        chunk.bins.push(TileSpan::of_tile(0), triangles(3));
        chunk.begin_run(10);
        chunk.points.push(PointPrimitive::default());
        chunk.bins.push(TileSpan::of_tile(0), BinEntry::Point(0));
        chunk.begin_run(11);
        chunk.points.push(PointPrimitive::default());
        chunk.bins.push(TileSpan::of_tile(0), BinEntry::Point(1));
        chunk.triangles.push_stale();
        chunk.bins.push(TileSpan::of_tile(1), triangles(4));
        chunk.bins.sort(u64::MAX);
        let runs = |tile| -> Vec<(u32, Vec<BinEntry>)> {
            let runs = chunk.runs_of_tile(tile);
            runs.map(|(sub_draw, entries)| (sub_draw, entries.to_vec()))
                .collect()
        };
        let expected = vec![
            (7, vec![triangles(0), triangles(2)]),
            (9, vec![triangles(3)]),
            (10, vec![BinEntry::Point(0)]),
            (11, vec![BinEntry::Point(1)]),
        ];
        assert_eq!(runs(0), expected);
        assert_eq!(runs(1), [(7, vec![triangles(1)]), (11, vec![triangles(4)])]);
        assert!(runs(2).is_empty());
    }

    #[test]
    fn triangles_of_a_packet_know_their_sub_draws() {
        let mut chunk = Chunk::default();
        chunk.begin_run(5);
        // Two triangles of 5, none of 6, one of 7; 8 begins in this packet and fills the next.
        for (sub_draw, waiting) in [(5, 0), (6, 2), (7, 2), (8, 3)] {
            chunk.begin_part(sub_draw, 0, waiting);
        }
        chunk.triangles.push_stale();
        chunk.triangles.push_stale();
        chunk.begin_run(9);
        chunk.begin_part(9, 2, 0);
        chunk.triangles.push_stale();
        let expected = |packet, lane| match (packet, lane) {
            (0, 0..2) => 5,
            (0, 2) => 7,
            (0 | 1, _) => 8,
            _ => 9,
        };
        let all = (0..3).flat_map(|packet| (0..16).map(move |lane| (packet, lane)));
        let mut cursor = chunk.sub_draws_from(0, 0);
        for (packet, lane) in all {
            assert_eq!(cursor.of(packet, lane), expected(packet, lane));
            let mut from_here = chunk.sub_draws_from(packet, lane);
            assert_eq!(from_here.of(packet, lane), expected(packet, lane));
        }
    }

    #[test]
    fn clipped_vertices_are_numbered_in_their_runs_size() {
        let mut chunk = Chunk::default();
        assert_eq!(chunk.align_clipped_varyings(3), 0);
        chunk.clipped_varyings.extend([1.0; 9]);
        assert_eq!(chunk.align_clipped_varyings(3), 3);
        assert_eq!(chunk.align_clipped_varyings(0), 0);
        assert_eq!(chunk.align_clipped_varyings(4), 3);
        assert_eq!(chunk.clipped_varyings.len(), 12);
    }
}
