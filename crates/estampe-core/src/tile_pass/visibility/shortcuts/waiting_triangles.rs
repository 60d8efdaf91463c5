//! Large triangles nearest first, where the order does not matter: they wait, over all draws in a
//! row whose depth test is the same, and are then rasterized by depth.

use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::compare::{orders, prefers_less};
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

/// Large triangles that wait to be rasterized.
#[derive(Debug, Default)]
pub(in crate::tile_pass::visibility) struct WaitingTriangles {
    /// For each: what they are sorted by, its depth at the tile's middle or the negative of it, and
    /// its visibility id.
    by_depth: Vec<(f32, u32)>,
    /// The depth test of all of them.
    compare: Option<CompareFunction>,
}

impl WaitingTriangles {
    /// Returns true if no triangles wait.
    pub(in crate::tile_pass::visibility) fn is_empty(&self) -> bool {
        self.by_depth.is_empty()
    }

    /// Adds the triangles of a bin, if they fit those that wait; `first` is the first one's id.
    /// Returns false, and adds nothing, if they do not.
    pub(in crate::tile_pass::visibility) fn add(
        &mut self,
        work: &TileWork<'_>,
        entries: &[BinEntry],
        first: u32,
    ) -> bool {
        let Some(DepthState { compare, .. }) = work.plan.tests.depth else {
            return false;
        };
        let is_full = self.by_depth.len() + entries.len() > MAX_WAITING;
        if is_full || !self.is_empty() && self.compare != Some(compare) {
            return false;
        }
        self.compare = Some(compare);
        let half = work.shape.side() as f32 * 0.5;
        let middle = [work.shape.x as f32 + half, work.shape.y as f32 + half];
        for (id, entry) in (first..).zip(entries) {
            let (packet, lane) = triangle_of(work, entry);
            let DepthPlane { origin, z } = DepthPlane::new(&packet.triangle(lane));
            let depth = z.origin + ((middle[0] - origin.x) * z.dx + (middle[1] - origin.y) * z.dy);
            let nearer_is_less = prefers_less(compare);
            let key = if nearer_is_less { depth } else { -depth };
            self.by_depth.push((key, id));
        }
        true
    }

    /// Sorts the triangles and returns the order that they are in now.
    pub(in crate::tile_pass::visibility) fn sort(&mut self) -> OrderKind {
        if self.by_depth.is_sorted_by(|a, b| a.0 <= b.0) {
            return OrderKind::SubmissionOfLarge;
        }
        // A stable sort, so NaN and equal depths change nothing but time.
        self.by_depth.sort_by(|a, b| a.0.total_cmp(&b.0));
        OrderKind::NearestFirst
    }

    /// The ids, in the order of the triangles.
    pub(in crate::tile_pass::visibility) fn ids(&self) -> impl Iterator<Item = u32> {
        self.by_depth.iter().map(|(_, id)| *id)
    }

    /// Forgets the triangles.
    pub(in crate::tile_pass::visibility) fn clear(&mut self) {
        self.by_depth.clear();
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
