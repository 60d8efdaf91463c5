//! Reading ahead: the primitives that come next are brought to the cache.
//!
//! The triangles of a tile lie anywhere in a chunk, and so do the varyings of their vertices. The
//! processor would wait for each of them in turn, because the work on one triangle is longer than
//! what it looks ahead. Here they are prefetched while others are drawn:
//!
//! ```text
//!     drawn ─▶ 16 whose varyings are on their way ─▶ 16 that are on their way themselves
//! ```

use crate::bounds::bins::BinEntry;
use crate::bounds::chunk::Chunk;
use crate::bounds::primitives::{LinePrimitive, Triangle, VertexRef};
use crate::fragment::interpolate::VaryingSource;
use estampe_simd::{LANES, Lane, Lanes, Level, dispatch};

/// The primitives of a tile that come next.
#[derive(Debug)]
pub(super) struct Ahead<'a> {
    chunk: &'a Chunk,
    source: VaryingSource<'a>,
    /// Those that are prefetched next.
    primitives: Upcoming<'a>,
    /// Those whose varyings are prefetched next.
    varyings: Upcoming<'a>,
    /// How many may be drawn until more are prefetched.
    ready: usize,
}

impl<'a> Ahead<'a> {
    /// The primitives of some entries, of which none is drawn.
    pub(super) fn new(
        chunk: &'a Chunk,
        source: VaryingSource<'a>,
        entries: &'a [BinEntry],
    ) -> Self {
        let all = Upcoming {
            entries,
            lanes: 0,
            packet: 0,
        };
        Self {
            chunk,
            source,
            primitives: all.clone(),
            varyings: all,
            ready: 0,
        }
    }

    /// Notes that one more primitive is drawn next, and prefetches others if it is time.
    #[inline(always)]
    pub(super) fn step(&mut self, level: Level) {
        if self.ready == 0 {
            self.ready = LANES;
            self.prefetch(level);
        }
        self.ready -= 1;
    }

    #[inline(never)]
    fn prefetch(&mut self, level: Level) {
        dispatch!(level, s => self.prefetch_lanes(s));
    }

    #[inline(always)]
    fn prefetch_lanes<S: Lanes>(&mut self, s: S) {
        for _ in 0..LANES {
            match self.primitives.next(self.chunk) {
                Some(Primitive::Triangle(triangle)) => s.prefetch(triangle),
                Some(Primitive::Line(line)) => s.prefetch(line),
                None => break,
            }
        }
        for _ in 0..LANES {
            match self.varyings.next(self.chunk) {
                Some(Primitive::Triangle(triangle)) => {
                    for vertex in triangle.vertex {
                        self.prefetch_varyings(s, vertex);
                    }
                }
                Some(Primitive::Line(line)) => {
                    for end in &line.ends {
                        self.prefetch_varyings(s, end.vertex);
                    }
                }
                None => break,
            }
        }
    }

    /// Prefetches a vertex's varyings, which may lie in two cache lines.
    #[inline(always)]
    fn prefetch_varyings<S: Lanes>(&self, s: S, vertex: VertexRef) {
        if let [first, .., last] | [first @ last] = self.source.of(vertex) {
            s.prefetch(first);
            s.prefetch(last);
        }
    }
}

/// A primitive that is prefetched.
enum Primitive<'a> {
    Triangle(&'a Triangle),
    Line(&'a LinePrimitive),
}

/// A tile's entries from one on.
#[derive(Debug, Clone)]
struct Upcoming<'a> {
    entries: &'a [BinEntry],
    /// The triangles that are left of the packet at hand.
    lanes: u16,
    packet: u32,
}

impl<'a> Upcoming<'a> {
    /// The next triangle or line; points are not prefetched.
    #[inline(always)]
    fn next(&mut self, chunk: &'a Chunk) -> Option<Primitive<'a>> {
        while self.lanes == 0 {
            let (first, rest) = self.entries.split_first()?;
            self.entries = rest;
            match *first {
                BinEntry::Triangles { packet, lanes } => {
                    (self.packet, self.lanes) = (packet, lanes);
                }
                BinEntry::Line(number) => {
                    return Some(Primitive::Line(&chunk.lines[number as usize]));
                }
                BinEntry::Point(_) => return None,
            }
        }
        let lane = Lane::all_of(self.lanes).next()?;
        self.lanes &= self.lanes - 1;
        let triangles = chunk.taken_apart(self.packet);
        Some(Primitive::Triangle(&triangles[lane.get()]))
    }
}
