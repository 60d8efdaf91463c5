//! Reading ahead: the primitives that come next are brought to the cache.
//!
//! The triangles of a tile lie anywhere in a chunk, and so do the varyings of their vertices. The
//! processor would wait for each of them in turn, because the work on one triangle is longer than
//! what it looks ahead. Here they are prefetched while others are drawn:
//!
//! ```text
//!     drawn ─▶ 32 whose varyings are on their way ─▶ 16 that are on their way themselves
//! ```
//!
//! This goes on from run to run of a tile, of which each has a few primitives only if a mesh lies
//! all over the picture: run by run, `particles` took a tenth longer. A few primitives at a time,
//! while those before are drawn, were no faster than sixteen.

use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::{LinePrimitive, PackedTriangle, VertexRef};
use crate::fragment::interpolate::VaryingSource;
use crate::tile_pass::TilePass;
use crate::tile_pass::upcoming_runs::{UpcomingRun, UpcomingRuns};
use estampe_simd::{LANES, Lane, Lanes, Level, dispatch};

/// The primitives of a tile that come next, of those that are drawn in order.
#[derive(Debug)]
pub(in crate::tile_pass) struct Ahead<'a> {
    /// Those that are prefetched next.
    primitives: Upcoming<'a>,
    /// Those whose varyings are prefetched next.
    varyings: Upcoming<'a>,
    /// How many may be drawn until more are prefetched; `None` before the first one.
    ready: Option<usize>,
}

impl<'a> Ahead<'a> {
    /// The primitives of a tile, of which none is drawn.
    pub(in crate::tile_pass) fn new(pass: &'a TilePass<'a>, tile: u32) -> Self {
        let all = Upcoming {
            runs: UpcomingRuns::new(pass, tile),
            run: None,
            lanes: 0,
            packet: 0,
        };
        Self {
            primitives: all.clone(),
            varyings: all,
            ready: None,
        }
    }

    /// Notes that one more primitive is drawn next, and prefetches others if it is time.
    #[inline(always)]
    pub(super) fn step(&mut self, level: Level) {
        let ready = match self.ready {
            Some(ready @ 1..) => ready,
            Some(0) => {
                self.prefetch(level, [1, 1]);
                LANES
            }
            None => {
                self.prefetch(level, [3, 2]);
                LANES
            }
        };
        self.ready = Some(ready - 1);
    }

    /// Prefetches so many times sixteen primitives, and so many times the varyings of sixteen.
    #[inline(never)]
    fn prefetch(&mut self, level: Level, counts: [usize; 2]) {
        dispatch!(level, s => self.prefetch_lanes(s, counts));
    }

    #[inline(always)]
    fn prefetch_lanes<S: Lanes>(&mut self, s: S, [primitives, varyings]: [usize; 2]) {
        for _ in 0..primitives * LANES {
            match self.primitives.next() {
                Some((Primitive::Triangle(triangle), _)) => s.prefetch(triangle),
                Some((Primitive::Line(line), _)) => s.prefetch(line),
                None => break,
            }
        }
        for _ in 0..varyings * LANES {
            match self.varyings.next() {
                Some((Primitive::Triangle(triangle), source)) => {
                    for vertex in triangle.vertex {
                        prefetch_varyings(s, &source, vertex);
                    }
                }
                Some((Primitive::Line(line), source)) => {
                    for end in &line.ends {
                        prefetch_varyings(s, &source, end.vertex);
                    }
                }
                None => break,
            }
        }
    }
}

/// Prefetches a vertex's varyings, which may lie in two cache lines.
#[inline(always)]
fn prefetch_varyings<S: Lanes>(s: S, source: &VaryingSource<'_>, vertex: VertexRef) {
    if let [first, .., last] | [first @ last] = source.of(vertex) {
        s.prefetch(first);
        s.prefetch(last);
    }
}

/// A primitive that is prefetched.
enum Primitive<'a> {
    Triangle(&'a PackedTriangle),
    Line(&'a LinePrimitive),
}

/// A tile's primitives from one on.
#[derive(Debug, Clone)]
struct Upcoming<'a> {
    runs: UpcomingRuns<'a>,
    run: Option<UpcomingRun<'a>>,
    /// The triangles that are left of the packet at hand.
    lanes: u16,
    packet: u32,
}

impl<'a> Upcoming<'a> {
    /// The next triangle or line; points are left out.
    #[inline(always)]
    fn next(&mut self) -> Option<(Primitive<'a>, VaryingSource<'a>)> {
        while self.lanes == 0 {
            let entry = self.run.as_mut().and_then(UpcomingRun::next_entry);
            let (Some(run), Some(entry)) = (&self.run, entry) else {
                let next = self.runs.next(|path| !path.is_visibility())?;
                self.run = Some(next);
                continue;
            };
            match entry {
                BinEntry::Triangles { packet, lanes } => {
                    (self.packet, self.lanes) = (packet, lanes);
                }
                BinEntry::Line(number) => {
                    let line = &run.chunk.lines[number as usize];
                    return Some((Primitive::Line(line), run.source));
                }
                BinEntry::Point(_) => {}
            }
        }
        let lane = Lane::all_of(self.lanes).next()?;
        self.lanes &= self.lanes - 1;
        let run = self.run.as_ref()?;
        let triangle = &run.chunk.taken_apart(self.packet)[lane.get()];
        Some((Primitive::Triangle(triangle), run.source))
    }
}
