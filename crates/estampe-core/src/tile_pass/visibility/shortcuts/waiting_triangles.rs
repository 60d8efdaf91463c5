//! Large triangles nearest first, where the order does not matter: they wait, over all draws in a
//! row whose depth test is the same, and are then rasterized by depth.

use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::compare::{orders, prefers_less};
use crate::per_sample::hiz::HizQuery;
use crate::raster::SampleSet;
use crate::tile_pass::TileWork;
use crate::tile_path::TilePath;
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
        let half = work.shape.side() as f32 * 0.5;
        let middle = [work.shape.x as f32 + half, work.shape.y as f32 + half];
        for (id, entry) in (first..).zip(entries) {
            let (packet, lane) = triangle_of(work, entry);
            let query = HizQuery {
                tests: &work.plan.tests,
                plane: DepthPlane::of_lane(packet, lane),
                tile: work.shape,
                samples,
                passes_in_vain: false,
            };
            let DepthPlane { origin, z } = &query.plane;
            let depth = z.origin + ((middle[0] - origin.x) * z.dx + (middle[1] - origin.y) * z.dy);
            let nearer_is_less = prefers_less(compare);
            self.triangles.push(WaitingTriangle {
                key: if nearer_is_less { depth } else { -depth },
                nearest: query.nearest(compare),
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
        && entries.iter().all(|entry| match entry {
            BinEntry::Triangles { lanes, .. } if lanes.is_power_of_two() => {
                let (packet, lane) = triangle_of(work, entry);
                is_large(packet, lane)
            }
            _ => false,
        })
}

/// The triangle of an entry of one triangle.
fn triangle_of<'a>(work: &TileWork<'a>, entry: &BinEntry) -> (&'a TrianglePacket, usize) {
    let BinEntry::Triangles { packet, lanes } = *entry else {
        unreachable!("lines and points are drawn in order");
    };
    let packet = &work.chunk.triangles[packet as usize];
    (packet, lanes.trailing_zeros() as usize)
}

/// Returns true if a triangle is higher and wider than a block of 16×16 pixels.
fn is_large(packet: &TrianglePacket, lane: usize) -> bool {
    const BLOCK_SUBPIXELS: i32 = 16 * 256;
    let x = [packet.x[0][lane], packet.x[1][lane], packet.x[2][lane]];
    let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    high - low > BLOCK_SUBPIXELS && packet.y[2][lane] - packet.y[0][lane] > BLOCK_SUBPIXELS
}
