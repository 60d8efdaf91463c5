//! The one boundary: primitives that geometry has set up, sorted by the tiles that they touch.
//!
//! *In* set-up primitives · *Out* for each tile, its primitives in submission order · *Space* window.
//!
//! A [`Chunk`] is the work of one worker: a run of primitives of one draw. Triangles lie in packets of
//! sixteen, structure of arrays, and a bin entry is a packet and a mask, so that small triangles,
//! which mostly share a tile with their neighbours, cost one entry for sixteen. Geometry writes chunks,
//! tiles read them in order, nothing flows back.

use estampe_simd::LANES;

/// A value that is linear in the window: `origin + ((X − x₀)·dx + (Y − y₀)·dy)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Plane {
    pub(crate) origin: f32,
    pub(crate) dx: f32,
    pub(crate) dy: f32,
}

/// Sixteen planes.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct PlanePacket {
    pub(crate) origin: [f32; LANES],
    pub(crate) dx: [f32; LANES],
    pub(crate) dy: [f32; LANES],
}

impl PlanePacket {
    const ZERO: Self = Self {
        origin: [0.0; LANES],
        dx: [0.0; LANES],
        dy: [0.0; LANES],
    };

    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Plane {
        Plane {
            origin: self.origin[lane],
            dx: self.dx[lane],
            dy: self.dy[lane],
        }
    }
}

/// A vertex of a draw: an index into its shaded vertices, or with [`VertexRef::CLIPPED`] set into the
/// chunk's own, made by clipping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct VertexRef(pub(crate) u32);

impl VertexRef {
    /// The bit that tells vertices made by clipping.
    pub(crate) const CLIPPED: u32 = 1 << 31;
}

/// Up to sixteen triangles, set up: vertices 0, 1, 2 sorted by (y, x).
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct TrianglePacket {
    /// Snapped positions in 1/256 pixel.
    pub(crate) x: [[i32; LANES]; 3],
    pub(crate) y: [[i32; LANES]; 3],
    /// Where the varyings are.
    pub(crate) vertex: [[VertexRef; LANES]; 3],
    /// The vertex that flat varyings come from.
    pub(crate) provoking: [VertexRef; LANES],
    /// 1/w at the three vertices.
    pub(crate) iw_at: [[f32; LANES]; 3],
    /// Depth.
    pub(crate) z: PlanePacket,
    /// 1/w.
    pub(crate) iw: PlanePacket,
    /// 65536 ÷ doubled signed area in 1/256 pixel².
    pub(crate) r: [f32; LANES],
    /// Bit by lane: the triangle is clockwise in sorted order (its doubled area is positive).
    pub(crate) clockwise: u16,
    /// Bit by lane: it faces the viewer.
    pub(crate) front: u16,
    /// Bit by lane: the three 1/w are equal in bits.
    pub(crate) equal_w: u16,
    /// How many lanes are used.
    pub(crate) len: u16,
}

impl TrianglePacket {
    pub(crate) const EMPTY: Self = Self {
        x: [[0; LANES]; 3],
        y: [[0; LANES]; 3],
        vertex: [[VertexRef(0); LANES]; 3],
        provoking: [VertexRef(0); LANES],
        iw_at: [[0.0; LANES]; 3],
        z: PlanePacket::ZERO,
        iw: PlanePacket::ZERO,
        r: [0.0; LANES],
        clockwise: 0,
        front: 0,
        equal_w: 0,
        len: 0,
    };
}

/// A line's or point's end: where it is in the window, and where its varyings are.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct WindowVertex {
    /// Snapped position in 1/256 pixel.
    pub(crate) x: i32,
    pub(crate) y: i32,
    pub(crate) z: f32,
    pub(crate) iw: f32,
    pub(crate) vertex: VertexRef,
}

/// A line, from its first to its second end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinePrimitive {
    pub(crate) ends: [WindowVertex; 2],
    pub(crate) provoking: VertexRef,
    pub(crate) front: bool,
    /// How many fragments of its strip lie before it, where a stipple pattern counts them.
    pub(crate) stipple: u32,
}

/// A point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointPrimitive {
    pub(crate) center: WindowVertex,
    /// The vertex that flat varyings come from: another one where the point is a triangle's corner.
    pub(crate) provoking: VertexRef,
    /// Half its side in 1/256 pixel.
    pub(crate) half: i32,
    pub(crate) front: bool,
}

/// What a bin entry names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BinEntry {
    /// Those triangles of a packet whose lanes are in the mask, in lane order.
    Triangles { packet: u32, lanes: u16 },
    /// A line.
    Line(u32),
    /// A point.
    Point(u32),
}

/// Entries sorted by tile.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    /// As written: (tile, entry) in submission order.
    unsorted: Vec<(u32, BinEntry)>,
    /// The same by tile, each tile's in submission order.
    sorted: Vec<BinEntry>,
    /// Where the entries of tile `first_tile + i` begin in `sorted`; one more than there are tiles.
    starts: Vec<u32>,
    first_tile: u32,
    /// Where the present packet's entries begin.
    mergeable_from: usize,
}

impl Bins {
    pub(crate) fn clear(&mut self) {
        self.unsorted.clear();
        self.sorted.clear();
        self.starts.clear();
        self.mergeable_from = 0;
    }

    pub(crate) fn push(&mut self, tile: u32, entry: BinEntry) {
        self.unsorted.push((tile, entry));
    }

    /// Ends the run of entries into which [`Bins::push_lane`] merges.
    #[inline(always)]
    pub(crate) fn end_run(&mut self) {
        self.mergeable_from = self.unsorted.len();
    }

    /// Adds one triangle of a packet to a tile, merging it into the run's entry for that tile. All
    /// entries of a run are of one packet.
    #[inline(always)]
    pub(crate) fn push_lane(&mut self, tile: u32, packet: u32, lane: usize) {
        let bit = 1u16 << lane;
        for (at, entry) in self.unsorted[self.mergeable_from..].iter_mut().rev() {
            if let (true, BinEntry::Triangles { lanes, .. }) = (*at == tile, entry) {
                *lanes |= bit;
                return;
            }
        }
        self.unsorted
            .push((tile, BinEntry::Triangles { packet, lanes: bit }));
    }

    /// Sorts the entries by tile, stably, by counting: linear in entries and in touched tiles' span.
    pub(crate) fn sort(&mut self) {
        let tiles = self.unsorted.iter().map(|(tile, _)| *tile);
        let (Some(first), Some(last)) = (tiles.clone().min(), tiles.max()) else {
            return;
        };
        self.first_tile = first;
        self.starts.resize((last - first) as usize + 2, 0);
        for (tile, _) in &self.unsorted {
            self.starts[(tile - first) as usize + 1] += 1;
        }
        for at in 1..self.starts.len() {
            self.starts[at] += self.starts[at - 1];
        }
        self.sorted.resize(self.unsorted.len(), BinEntry::Point(0));
        // Each start is advanced while its tile is filled, then all are moved back by one tile.
        for (tile, entry) in &self.unsorted {
            let start = &mut self.starts[(tile - first) as usize];
            self.sorted[*start as usize] = *entry;
            *start += 1;
        }
        for at in (1..self.starts.len()).rev() {
            self.starts[at] = self.starts[at - 1];
        }
        self.starts[0] = 0;
    }

    /// The entries of a tile, in submission order.
    #[inline]
    pub(crate) fn of_tile(&self, tile: u32) -> &[BinEntry] {
        let Some(at) = tile.checked_sub(self.first_tile).map(|at| at as usize) else {
            return &[];
        };
        match (self.starts.get(at), self.starts.get(at + 1)) {
            (Some(&from), Some(&to)) => &self.sorted[from as usize..to as usize],
            _ => &[],
        }
    }

    /// The tiles that have entries.
    fn tiles(&self) -> impl Iterator<Item = u32> {
        let starts = self.starts.windows(2);
        let all = (self.first_tile..).zip(starts);
        all.filter(|(_, ends)| ends[0] < ends[1])
            .map(|(tile, _)| tile)
    }
}

/// For each tile the chunks that have entries for it, in order. A frame of two thousand draws has as many
/// chunks, and hardly any of them reaches a given tile: to ask each one took longer than to draw.
#[derive(Debug, Default)]
pub(crate) struct ChunkIndex {
    /// Where each tile's chunks begin; one more than there are tiles.
    starts: Vec<u32>,
    chunks: Vec<u32>,
}

impl ChunkIndex {
    /// Sorts a wave's chunks by the tiles of a target.
    pub(crate) fn build(&mut self, tiles: usize, chunks: &[Chunk]) {
        self.starts.clear();
        self.starts.resize(tiles + 2, 0);
        // Counted two places further on, so that after the sums place i + 1 is where tile i is filled next.
        for tile in chunks.iter().flat_map(|chunk| chunk.bins.tiles()) {
            self.starts[tile as usize + 2] += 1;
        }
        for at in 1..self.starts.len() {
            self.starts[at] += self.starts[at - 1];
        }
        let all = self.starts.last().map_or(0, |all| *all as usize);
        self.chunks.resize(all, 0);
        for (number, chunk) in (0..).zip(chunks) {
            for tile in chunk.bins.tiles() {
                let next = &mut self.starts[tile as usize + 1];
                self.chunks[*next as usize] = number;
                *next += 1;
            }
        }
    }

    /// The numbers of the chunks that have entries for a tile.
    pub(crate) fn of_tile(&self, tile: u32) -> &[u32] {
        let at = tile as usize;
        match (self.starts.get(at), self.starts.get(at + 1)) {
            (Some(&from), Some(&to)) => &self.chunks[from as usize..to as usize],
            _ => &[],
        }
    }
}

/// The primitives of a run of one draw, set up and binned.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    /// Which of the wave's items they belong to.
    pub(crate) item: usize,
    pub(crate) triangles: Vec<TrianglePacket>,
    pub(crate) lines: Vec<LinePrimitive>,
    pub(crate) points: Vec<PointPrimitive>,
    /// Varyings of the vertices that clipping made, one after the other.
    pub(crate) clipped_varyings: Vec<f32>,
    pub(crate) bins: Bins,
    pub(crate) statistics: crate::statistics::Statistics,
}

impl Chunk {
    pub(crate) fn reset(&mut self, item: usize) {
        self.item = item;
        self.triangles.clear();
        self.lines.clear();
        self.points.clear();
        self.clipped_varyings.clear();
        self.bins.clear();
        self.statistics = crate::statistics::Statistics::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_back_by_tile_in_order() {
        let mut bins = Bins::default();
        for (index, tile) in (0..).zip([7, 3, 7, 9, 3, 7]) {
            bins.push(tile, BinEntry::Line(index));
        }
        bins.sort();
        let lines = |tile| -> Vec<u32> {
            let line = |entry: &BinEntry| match entry {
                BinEntry::Line(line) => *line,
                other => panic!("{other:?} is not a line"),
            };
            bins.of_tile(tile).iter().map(line).collect()
        };
        assert_eq!(lines(3), [1, 4]);
        assert_eq!(lines(7), [0, 2, 5]);
        assert_eq!(lines(9), [3]);
        for tile in [0, 2, 4, 8, 10, u32::MAX] {
            assert!(bins.of_tile(tile).is_empty(), "tile {tile}");
        }
    }

    #[test]
    fn an_index_names_each_tiles_chunks_in_order() {
        let chunk = |tiles: &[u32]| {
            let mut chunk = Chunk::default();
            for &tile in tiles {
                chunk.bins.push(tile, BinEntry::Point(0));
            }
            chunk.bins.sort();
            chunk
        };
        let chunks = [chunk(&[3, 1]), chunk(&[]), chunk(&[0, 1, 1]), chunk(&[3])];
        let mut index = ChunkIndex::default();
        // Twice, because its memory is used again.
        for _ in 0..2 {
            index.build(4, &chunks);
            let found = [0, 1, 2, 3, 4].map(|tile| index.of_tile(tile).to_vec());
            assert_eq!(found, [vec![2], vec![0, 2], vec![], vec![0, 3], vec![]]);
        }
    }

    #[test]
    fn lanes_merge_only_inside_a_run() {
        let mut bins = Bins::default();
        bins.push_lane(1, 0, 0);
        bins.push_lane(2, 0, 1);
        bins.push_lane(1, 0, 2);
        bins.end_run();
        bins.push_lane(1, 0, 3);
        bins.sort();
        let expected = [
            BinEntry::Triangles {
                packet: 0,
                lanes: 0b101,
            },
            BinEntry::Triangles {
                packet: 0,
                lanes: 0b1000,
            },
        ];
        assert_eq!(bins.of_tile(1), expected);
    }
}
