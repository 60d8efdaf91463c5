//! Reading ahead: the packets of triangles that come next are brought to the cache.
//!
//! The packets of a mesh are more than the caches hold. A tile reads up to sixteen lines of each,
//! and of fragments that are shaded at once the varyings of the vertices.
//!
//! ```text
//!     drawn ─▶ one packet whose varyings are on their way ─▶ two that are on their way themselves
//! ```
//!
//! This goes on from run to run of a tile: a small draw has a few packets in each.

use super::ONLY_WIDE;
use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::{TrianglePacket, VertexRef};
use crate::fragment::interpolate::VaryingSource;
use crate::tile_pass::TilePass;
use crate::tile_pass::upcoming_runs::{UpcomingRun, UpcomingRuns};
use crate::tile_path::TilePath;
use estampe_simd::{Lanes, Level, SimdBase, bits_of, dispatch, u32x16};

/// The packets that are prefetched before they are drawn.
const PACKETS: usize = 3;
/// Of these, the packets whose varyings are prefetched.
const VARYINGS: usize = 1;

/// The packets of a tile that come next, of those that are drawn by visibility.
#[derive(Debug)]
pub(in crate::tile_pass) struct Ahead<'a> {
    packets: Upcoming<'a>,
    varyings: Upcoming<'a>,
    /// How many were drawn.
    drawn: usize,
}

impl<'a> Ahead<'a> {
    /// The packets of a tile, of which none is drawn.
    pub(in crate::tile_pass) fn new(pass: &'a TilePass<'a>, tile: u32) -> Self {
        let all = Upcoming {
            runs: UpcomingRuns::new(pass, tile),
            run: None,
            taken: 0,
        };
        Self {
            packets: all.clone(),
            varyings: all,
            drawn: 0,
        }
    }

    /// Notes that so many packets are passed over.
    pub(super) fn skip(&mut self, packets: usize) {
        self.drawn += packets;
    }

    /// Notes that one more packet is drawn next, and prefetches others.
    #[inline(always)]
    pub(super) fn step(&mut self, level: Level) {
        dispatch!(@wide level, s => self.prefetch(s), scalar => unreachable!("{ONLY_WIDE}"));
        self.drawn += 1;
    }

    #[inline(always)]
    fn prefetch<S: Lanes>(&mut self, s: S) {
        while self.packets.taken <= self.drawn + PACKETS {
            let number = self.packets.taken;
            let Some((packet, _, reads_varyings)) = self.packets.next() else {
                break;
            };
            if number > self.drawn {
                packet.prefetch(s, reads_varyings);
            }
        }
        while self.varyings.taken <= self.drawn + VARYINGS {
            let number = self.varyings.taken;
            let Some((packet, source, reads_varyings)) = self.varyings.next() else {
                break;
            };
            if number > self.drawn && reads_varyings {
                prefetch_varyings(s, packet, &source);
            }
        }
    }
}

/// Prefetches the varyings of a packet's vertices.
#[inline(always)]
fn prefetch_varyings<S: Lanes>(s: S, packet: &TrianglePacket, source: &VaryingSource<'_>) {
    let scalars = u32::try_from(source.modes.len()).unwrap_or(0);
    let scalars = <u32x16<S> as SimdBase<S>>::splat(s, scalars);
    // The middle vertices are those of neighbours, too.
    for vertices in [&packet.vertex[0], &packet.vertex[2]] {
        let vertices = u32x16::load_array(s, vertices.map(|VertexRef(vertex)| vertex));
        s.prefetch_elements(bits_of(source.shaded), vertices * scalars);
    }
}

/// A tile's packets from one on.
#[derive(Debug, Clone)]
struct Upcoming<'a> {
    runs: UpcomingRuns<'a>,
    run: Option<UpcomingRun<'a>>,
    /// How many entries were taken.
    taken: usize,
}

impl<'a> Upcoming<'a> {
    /// The next packet, the varyings of its run, and whether they are read as it is drawn.
    #[inline(always)]
    fn next(&mut self) -> Option<(&'a TrianglePacket, VaryingSource<'a>, bool)> {
        loop {
            if let Some(run) = &mut self.run
                && let Some(entry) = run.next_entry()
            {
                self.taken += 1;
                if let BinEntry::Triangles { packet, .. } = entry {
                    let packet = &run.packets.triangles[packet as usize];
                    let reads_varyings = run.path == TilePath::VisibilityCrossTriangle;
                    return Some((packet, run.source, reads_varyings));
                }
                continue;
            }
            self.run = Some(self.runs.next(TilePath::is_visibility)?);
        }
    }
}
