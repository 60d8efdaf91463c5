//! Large triangles nearest first, where the order does not matter: they wait, over all draws in a
//! row whose depth test is the same, and are then rasterized by depth.

use super::packet_depths::PacketDepths;
use crate::bounds::bins::BinEntry;
use crate::per_sample::compare::{orders, prefers_less};
use crate::raster::SampleSet;
use crate::tile_pass::TileWork;
use crate::tile_path::TilePath;
use estampe_simd::LANES;
use estampe_types::state::{CompareFunction, DepthState};

/// Triangles that wait at most: to sort more costs more than it saves.
const MAX_WAITING: usize = 256;

/// In which order triangles are rasterized.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::tile_pass::visibility) enum OrderKind {
    /// The order of submission.
    Submission,
    /// The order of submission, and each triangle is large; most of them may be hidden.
    SubmissionOfLarge,
    /// Each triangle is large; nearest first.
    NearestFirst,
}

/// A triangle that waits.
#[derive(Debug, Clone, Copy)]
pub(in crate::tile_pass::visibility) struct WaitingTriangle {
    /// What they are sorted by: its depth at the tile's middle, or the negative of it.
    key: f32,
    /// Its nearest depth in the tile.
    pub(in crate::tile_pass::visibility) nearest: f32,
    /// Its visibility id.
    pub(in crate::tile_pass::visibility) id: u32,
}

/// Large triangles that wait to be rasterized.
#[derive(Debug)]
pub(in crate::tile_pass::visibility) struct WaitingTriangles {
    triangles: Vec<WaitingTriangle>,
    /// The depth test of all of them.
    compare: CompareFunction,
}

impl Default for WaitingTriangles {
    fn default() -> Self {
        Self {
            triangles: Vec::new(),
            compare: CompareFunction::Less,
        }
    }
}

impl WaitingTriangles {
    /// Returns true if no triangles wait.
    pub(in crate::tile_pass::visibility) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The depth test of those that wait.
    pub(in crate::tile_pass::visibility) fn compare(&self) -> CompareFunction {
        self.compare
    }

    /// Adds the triangles of a bin, if they fit those that wait; `first` is the first one's id.
    /// Returns false, and adds nothing, if they do not.
    pub(in crate::tile_pass::visibility) fn add<const N: usize>(
        &mut self,
        work: &TileWork<'_>,
        entries: &[BinEntry],
        first: u32,
        samples: SampleSet<N>,
    ) -> bool {
        let Some(DepthState { compare, .. }) = work.plan.tests.depth else {
            return false;
        };
        let is_full = self.triangles.len() + entries.len() > MAX_WAITING;
        if is_full || !self.is_empty() && self.compare != compare {
            return false;
        }
        self.compare = compare;
        let nearer_is_less = prefers_less(compare);
        let tile = (work.shape, samples);
        let test = (work.plan.tests.stored, compare);
        let mut of_packet: Option<(u32, PacketDepths)> = None;
        self.triangles.reserve(entries.len());
        for (id, entry) in (first..).zip(entries) {
            let (packet, lanes) = triangles_of(entry);
            let depths = match &of_packet {
                Some((number, depths)) if *number == packet => depths,
                _ => {
                    let triangles = &work.packets.triangles[packet as usize];
                    let depths = PacketDepths::new(work.level, triangles, tile, test);
                    &of_packet.insert((packet, depths)).1
                }
            };
            let lane = lanes.trailing_zeros() as usize % LANES;
            let depth = depths.middle[lane];
            self.triangles.push(WaitingTriangle {
                key: if nearer_is_less { depth } else { -depth },
                nearest: depths.nearest[lane],
                id,
            });
        }
        true
    }

    /// Sorts the triangles and returns the order that they are in now.
    pub(in crate::tile_pass::visibility) fn sort(&mut self) -> OrderKind {
        if self.triangles.is_sorted_by(|a, b| a.key <= b.key) {
            return OrderKind::SubmissionOfLarge;
        }
        // A stable sort, so NaN and equal depths change nothing but time.
        self.triangles.sort_by(|a, b| a.key.total_cmp(&b.key));
        OrderKind::NearestFirst
    }

    /// The triangles, in their order.
    pub(in crate::tile_pass::visibility) fn triangles(
        &self,
    ) -> impl Iterator<Item = &WaitingTriangle> {
        self.triangles.iter()
    }

    /// Forgets the triangles.
    pub(in crate::tile_pass::visibility) fn clear(&mut self) {
        self.triangles.clear();
    }
}

/// Returns true if the triangles of a bin may be rasterized in another order: they are tested by
/// depth alone, write it, and each entry is one large triangle.
pub(in crate::tile_pass::visibility) fn may_wait(
    work: &TileWork<'_>,
    entries: &[BinEntry],
) -> bool {
    let tests = |state: &DepthState| state.write_enabled && orders(state.compare);
    // A draw without colours hides draws after it, but it does not bring back what they have hidden
    // before it: among draws with colours it keeps its place.
    let is_among_colors = work.plan.path == TilePath::VisibilityDepthOnly
        && !work.plan.pipeline.color_targets().is_empty();
    !is_among_colors
        && work.plan.tests.depth.as_ref().is_some_and(tests)
        && work.plan.tests_depth_alone()
        && entries.len() <= MAX_WAITING
        && entries.iter().all(|entry| {
            let (packet, lanes) = triangles_of(entry);
            lanes.is_power_of_two() && work.packets.triangles[packet as usize].large & lanes != 0
        })
}

/// The packet and the lanes of an entry.
#[inline(always)]
fn triangles_of(entry: &BinEntry) -> (u32, u16) {
    let BinEntry::Triangles { packet, lanes } = *entry else {
        unreachable!("lines and points are drawn in order");
    };
    (packet, lanes)
}
