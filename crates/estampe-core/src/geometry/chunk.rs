//! One worker's share of geometry: the primitives of a run, taken to set-up primitives in a chunk.

use super::clip_detour::ClipDetour;
use super::cull::TriangleGroup;
use super::gathered::Gathered;
use super::groups::PrimitiveGroups;
use super::lines::LineWalk;
use super::run::RunWork;
use super::setup::{Setup, SetupScratch};
use super::{filled, lines, points, polygon_mode};
use crate::bounds::bins::UnsortedEntries;
use crate::bounds::chunk::Chunk;
use crate::pipeline::primitive_kind::PrimitiveKind;
use crate::statistics::Statistics;
use estampe_simd::dispatch;

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct ChunkScratch {
    groups: [TriangleGroup; 2],
    gathered: Gathered,
    setup: SetupScratch,
    clip: ClipDetour,
    /// Memory that each chunk borrows.
    pub(crate) entries: UnsortedEntries,
    /// Counts of the chunks that the worker has made since they were last taken.
    pub(crate) statistics: Statistics,
}

/// True if the sub-draws before and after one in its chunk belong to the same run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Neighbours {
    pub(crate) joins_last: bool,
    pub(crate) joins_next: bool,
}

/// Adds the primitives of a sub-draw to a chunk: to the last run, or as a run of their own.
pub(crate) fn add_part(
    sub_draw: u32,
    work: &RunWork<'_>,
    neighbours: Neighbours,
    chunk: &mut Chunk,
    scratch: &mut ChunkScratch,
) {
    let ChunkScratch {
        groups,
        gathered,
        setup,
        clip,
        ..
    } = scratch;
    let [from, to] = work.primitives;
    if !neighbours.joins_last {
        debug_assert_eq!(setup.waiting(), 0, "the run before was not finished");
        chunk.begin_run(sub_draw);
    }
    chunk.statistics.primitives_in += u64::from(to - from);
    let Neighbours {
        joins_last,
        joins_next,
    } = neighbours;
    if (joins_last || joins_next) && gathered.add(sub_draw, work, chunk, setup) {
        if !joins_next {
            gathered.finish(work, chunk, setup);
            Setup::new(work, chunk, setup).finish(joins_next);
        }
        return;
    }
    gathered.finish(work, chunk, setup);
    chunk.begin_part(sub_draw, chunk.triangles.len(), setup.waiting());
    clip.begin();
    let mut setup = Setup::new(work, chunk, setup);
    if work.plan.fills_triangles() {
        dispatch!(work.level, s => filled::draw(s, work, &mut setup, groups, clip));
    } else {
        add_lines_and_points(work, &mut setup, &mut groups[0], clip);
    }
    setup.finish(neighbours.joins_next);
}

/// Adds lines, points, and triangles that are drawn as these.
fn add_lines_and_points(
    work: &RunWork<'_>,
    setup: &mut Setup<'_>,
    group: &mut TriangleGroup,
    clip: &mut ClipDetour,
) {
    if work.plan.kind == PrimitiveKind::Lines {
        return lines::draw(work, group, setup, clip);
    }
    let mut primitives = PrimitiveGroups::new(&work.elements, work.instance, work.primitives);
    let mut walk = LineWalk::default();
    while let Some(some) = primitives.next_of_instance(&mut group.vertices) {
        let corners = &group.vertices[..some.count];
        if work.plan.kind == PrimitiveKind::Triangles {
            polygon_mode::draw(work, corners, &mut walk, setup, clip);
        } else {
            points::draw(work, corners, setup, clip);
        }
    }
}
