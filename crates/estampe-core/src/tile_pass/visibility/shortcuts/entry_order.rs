//! The order in which the large triangles of a bin are rasterized: nearest first, where the order
//! does not matter.

use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::compare::{orders, prefers_less};
use crate::tile_pass::TileWork;

/// Triangles of a bin that are worth sorting, at most.
const MAX_SORTED: usize = 256;

/// In which order the entries of a bin are rasterized.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::tile_pass::visibility) enum OrderKind {
    /// The order of submission.
    Submission,
    /// The order of submission, and each entry is one large triangle; most of them may be hidden.
    SubmissionOfLarge,
    /// Each entry is one large triangle; nearest first.
    NearestFirst,
}

/// Entries of a bin by depth.
#[derive(Debug, Default)]
pub(in crate::tile_pass::visibility) struct EntryOrder {
    by_depth: Vec<(f32, u32)>,
}

impl EntryOrder {
    /// Sorts entries by the depth of their triangles at the tile's middle, nearest first, if that
    /// is allowed and pays: depth alone must be tested, and all triangles must be large.
    pub(in crate::tile_pass::visibility) fn sort(
        &mut self,
        work: &TileWork<'_>,
        entries: &[BinEntry],
    ) -> OrderKind {
        let state = match work.plan.tests.depth {
            Some(state) if state.write_enabled && orders(state.compare) => state,
            _ => return OrderKind::Submission,
        };
        if !work.plan.tests_depth_alone() || !(2..=MAX_SORTED).contains(&entries.len()) {
            return OrderKind::Submission;
        }
        self.by_depth.clear();
        let half = work.shape.side() as f32 * 0.5;
        let middle = [work.shape.x as f32 + half, work.shape.y as f32 + half];
        for (number, entry) in (0..).zip(entries) {
            let BinEntry::Triangles { packet, lanes } = *entry else {
                return OrderKind::Submission;
            };
            let packet = &work.chunk.triangles[packet as usize];
            let lane = lanes.trailing_zeros() as usize;
            if !lanes.is_power_of_two() || !is_large(packet, lane) {
                return OrderKind::Submission;
            }
            let DepthPlane { origin, z } = DepthPlane::new(packet, lane);
            let depth = z.origin + ((middle[0] - origin.x) * z.dx + (middle[1] - origin.y) * z.dy);
            let key = if prefers_less(state.compare) {
                depth
            } else {
                -depth
            };
            self.by_depth.push((key, number));
        }
        if self.by_depth.is_sorted_by(|a, b| a.0 <= b.0) {
            return OrderKind::SubmissionOfLarge;
        }
        // A stable sort, so NaN and equal depths change nothing but time.
        self.by_depth.sort_by(|a, b| a.0.total_cmp(&b.0));
        OrderKind::NearestFirst
    }

    /// The sorted entries' numbers.
    pub(in crate::tile_pass::visibility) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.by_depth.iter().map(|(_, number)| *number)
    }
}

/// Returns true if a triangle is wider and higher than a 16×16 block.
fn is_large(packet: &TrianglePacket, lane: usize) -> bool {
    const BLOCK_SUBPIXELS: i32 = 16 * 256;
    let x = [packet.x[0][lane], packet.x[1][lane], packet.x[2][lane]];
    let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    high - low > BLOCK_SUBPIXELS && packet.y[2][lane] - packet.y[0][lane] > BLOCK_SUBPIXELS
}
