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
use crate::bounds::lines::LinePacket;
use crate::bounds::primitives::{PackedTriangle, VertexRef};
use crate::fragment::interpolate::VaryingSource;
use crate::tile_pass::TilePass;
use crate::tile_pass::upcoming_runs::{UpcomingRun, UpcomingRuns};
use estampe_simd::{LANES, Lane, Lanes, Level, Select, SimdBase, bits_of, dispatch, u32x16};

/// Primitives that are prefetched before they are drawn.
const PRIMITIVES: usize = 3 * LANES;
/// Of these, the primitives whose varyings are prefetched.
const VARYINGS: usize = 2 * LANES;

/// The primitives of a tile that come next, of those that are drawn in order.
#[derive(Debug)]
pub(in crate::tile_pass) struct Ahead<'a> {
    primitives: Upcoming<'a>,
    varyings: Upcoming<'a>,
    /// How many were drawn, or are drawn now.
    drawn: usize,
    /// How many may be drawn until more are prefetched.
    ready: usize,
}

impl<'a> Ahead<'a> {
    /// The primitives of a tile, of which none is drawn.
    pub(in crate::tile_pass) fn new(pass: &'a TilePass<'a>, tile: u32) -> Self {
        let all = Upcoming {
            runs: UpcomingRuns::new(pass, tile),
            run: None,
            lanes: 0,
            packet: 0,
            taken: 0,
        };
        Self {
            primitives: all.clone(),
            varyings: all,
            drawn: 0,
            ready: 0,
        }
    }

    /// Notes that so many more primitives are drawn next, and prefetches others if it is time.
    #[inline(always)]
    pub(super) fn step(&mut self, level: Level, primitives: usize) {
        if self.drawn >= self.ready {
            self.prefetch(level);
            self.ready = self.drawn + LANES;
        }
        self.drawn += primitives;
    }

    #[inline(never)]
    fn prefetch(&mut self, level: Level) {
        dispatch!(level, s => self.prefetch_lanes(s));
    }

    #[inline(always)]
    fn prefetch_lanes<S: Lanes>(&mut self, s: S) {
        while self.primitives.taken < self.drawn + PRIMITIVES {
            match self.primitives.next() {
                Some((Primitive::Triangle(triangle), _)) => s.prefetch(triangle),
                Some((Primitive::Lines(packet, _), _)) => prefetch_lines(s, packet),
                None => break,
            }
        }
        while self.varyings.taken < self.drawn + VARYINGS {
            match self.varyings.next() {
                Some((Primitive::Triangle(triangle), source)) => {
                    for vertex in triangle.vertex {
                        prefetch_varyings(s, &source, vertex);
                    }
                }
                Some((Primitive::Lines(packet, lanes), source)) => {
                    prefetch_varyings_of_lines(s, &source, packet, lanes);
                }
                None => break,
            }
        }
    }
}

/// Prefetches what is read of a packet of lines: flat varyings and patterns are rare.
#[inline(always)]
fn prefetch_lines<S: Lanes>(s: S, packet: &LinePacket) {
    s.prefetch(&packet.x);
    s.prefetch(&packet.y);
    s.prefetch(&packet.z);
    s.prefetch(&packet.iw);
    s.prefetch(&packet.vertex);
    s.prefetch(&packet.front);
}

/// Prefetches the varyings of a packet's lines in some lanes.
#[inline(always)]
fn prefetch_varyings_of_lines<S: Lanes>(
    s: S,
    source: &VaryingSource<'_>,
    packet: &LinePacket,
    lanes: u16,
) {
    let scalars = u32::try_from(source.modes.len()).unwrap_or(0);
    let scalars = <u32x16<S> as SimdBase<S>>::splat(s, scalars);
    let is_in = s.mask_from_bits(lanes);
    let first = Lane::first_of(lanes).unwrap_or(Lane::new(0));
    for vertices in &packet.vertex {
        let one = <u32x16<S> as SimdBase<S>>::splat(s, first.of(vertices).0);
        let vertices = u32x16::load_array(s, vertices.map(|VertexRef(vertex)| vertex));
        let vertices = is_in.select(vertices, one);
        s.prefetch_elements(bits_of(source.shaded), vertices * scalars);
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

/// Primitives that are prefetched together.
enum Primitive<'a> {
    Triangle(&'a PackedTriangle),
    /// Those lines of a packet whose lanes are in the mask.
    Lines(&'a LinePacket, u16),
}

/// A tile's primitives from one on.
#[derive(Debug, Clone)]
struct Upcoming<'a> {
    runs: UpcomingRuns<'a>,
    run: Option<UpcomingRun<'a>>,
    /// The triangles that are left of the packet at hand.
    lanes: u16,
    packet: u32,
    /// How many primitives were taken.
    taken: usize,
}

impl<'a> Upcoming<'a> {
    /// The next triangle, or the next lines; points are left out.
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
                BinEntry::Lines { packet, lanes } => {
                    self.taken += entry.count() as usize;
                    let packet = &run.packets.lines[packet as usize];
                    return Some((Primitive::Lines(packet, lanes), run.source));
                }
                BinEntry::Point(_) => {}
            }
        }
        let lane = Lane::all_of(self.lanes).next()?;
        self.lanes &= self.lanes - 1;
        self.taken += 1;
        let run = self.run.as_ref()?;
        let triangle = &run.packets.one_by_one[self.packet as usize].0[lane.get()];
        Some((Primitive::Triangle(triangle), run.source))
    }
}
