//! The draw cursor: cuts a pass's draws into batches of sub-draws.

use super::draw_batch::DrawBatch;
use super::index_extremes::KnownExtremes;
use super::index_range::{
    MAX_WHOLE_ELEMENTS, element_count, is_splittable, is_stippled_strip, list_vertices, part_of,
    restart_source, vertex_range, visible_elements,
};
use super::sub_draw::{Cut, Instances, SubDraw};
use crate::attachment::RenderTarget;
use crate::commands::{Draw, DrawIter, DrawList};
use crate::geometry::assembly::primitive_count;
use crate::geometry::restart::{RestartCursor, RestartSource};
use crate::schedule::Executor;
use estampe_simd::Level;
use std::ops::Range;

/// Vertices or primitives that a batch holds before it is drawn.
const BATCH_BUDGET: usize = 2_000_000;

/// Vertices or primitives for each thread whose geometry is done together: their indices, and their
/// vertices in the window, stay in a core's second-level cache from the first use to the last. A
/// frame of a million triangles read 12 MB of indices twice, and wrote and read 8 MB of positions,
/// when it was one group.
const GROUP_BUDGET: usize = 1 << 16;

/// Primitives of a sub-draw at most: a larger draw becomes several. Even, so that a strip's parts
/// begin on triangles that are not turned.
const SUB_DRAW_PRIMITIVES: u32 = 1 << 16;

/// Primitives of a sub-draw at most, where fewer could have too many vertices in common with
/// others.
const INCOHERENT_PRIMITIVES: u32 = 1_000_000;

/// The position in a pass's draws up to which they are cut into batches.
#[derive(Debug)]
pub(crate) struct DrawCursor<'a> {
    draws: DrawIter<'a>,
    /// The draw that is being cut.
    current: Option<OpenDraw<'a>>,
    known: KnownExtremes,
}

/// A draw, and which of its primitives and instances are left.
#[derive(Debug)]
struct OpenDraw<'a> {
    draw: &'a Draw<'a>,
    /// The elements of an instance that can show anything.
    elements: u32,
    /// The primitives of the others.
    invisible_primitives: u32,
    /// The primitives that are left in the instance at hand.
    primitives: Range<u32>,
    instances: Range<u32>,
    /// The position in the current instance at which the search for the next primitive begins,
    /// where indices may restart primitives.
    restart: RestartCursor,
}

impl<'a> DrawCursor<'a> {
    pub(crate) fn new(draws: DrawList<'a>, level: Level) -> Self {
        Self {
            draws: draws.iter(),
            current: None,
            known: KnownExtremes::new(level),
        }
    }

    /// Returns the number of draws that no batch has begun.
    pub(crate) fn draws_left(&self) -> usize {
        self.draws.len()
    }

    /// Returns true if all draws are cut.
    pub(crate) fn is_at_end(&self) -> bool {
        self.current.is_none() && self.draws.len() == 0
    }

    /// Cuts the next group of a batch's sub-draws, whose vertices lie together; none when the batch
    /// is full or no draws are left.
    pub(crate) fn next_group(
        &mut self,
        executor: &Executor,
        target: &RenderTarget,
        batch: &mut DrawBatch<'a>,
    ) -> Option<Range<usize>> {
        let first = batch.begin_group();
        let (mut vertices, mut primitives) = (0, 0);
        // More threads have more work at once, and wait for each other as rarely as few.
        let budget = GROUP_BUDGET.saturating_mul(executor.threads());
        while vertices < budget
            && primitives < budget
            && batch.vertices < BATCH_BUDGET
            && batch.primitives < BATCH_BUDGET
        {
            let Some(mut open) = self.current.take().or_else(|| self.next_draw()) else {
                break;
            };
            let Some(state) = batch.state_of(open.draw, target) else {
                continue;
            };
            batch.invisible_primitives += open.take_invisible();
            let (mut sub_draw, listed) = open.take(executor, &mut self.known);
            sub_draw.state = state;
            if sub_draw.total_primitives() > 0 {
                vertices += sub_draw.total_vertices();
                primitives += sub_draw.total_primitives();
                batch.push(sub_draw, listed);
            }
            if !open.is_done() {
                self.current = Some(open);
            }
        }
        let end = batch.sub_draws.len();
        (end > first).then_some(first..end)
    }

    /// The next draw of at least one primitive.
    fn next_draw(&mut self) -> Option<OpenDraw<'a>> {
        loop {
            let draw = self.draws.next()?;
            let topology = draw.pipeline.descriptor().primitive.topology;
            let all = primitive_count(topology, element_count(draw));
            let elements = visible_elements(draw);
            let primitives = 0..primitive_count(topology, elements);
            if all == 0 || draw.instances.is_empty() {
                continue;
            }
            return Some(OpenDraw {
                draw,
                elements,
                invisible_primitives: all - primitives.end,
                primitives,
                instances: draw.instances.clone(),
                restart: RestartCursor::default(),
            });
        }
    }
}

impl<'a> OpenDraw<'a> {
    fn is_done(&self) -> bool {
        self.instances.is_empty()
    }

    /// The primitives of all instances that cannot show anything; 0 when asked again.
    fn take_invisible(&mut self) -> u64 {
        let instances = u64::from(self.instances.end - self.instances.start);
        u64::from(std::mem::take(&mut self.invisible_primitives)) * instances
    }

    /// Takes the next sub-draw off: many instances of a small draw, or part of one instance of a
    /// large one.
    fn take(&mut self, executor: &Executor, known: &mut KnownExtremes) -> Cut<'a> {
        let draw = self.draw;
        if let Some(source) = restart_source(draw) {
            return self.take_restarted(&source);
        }
        let topology = draw.pipeline.descriptor().primitive.topology;
        let whole = self.elements;
        let all = primitive_count(topology, whole);
        if all > SUB_DRAW_PRIMITIVES && is_splittable(draw) {
            let left = self.primitives.end - self.primitives.start;
            let first = self.primitives.start;
            let mut part = |count: u32| {
                let elements = part_of(topology, first, count, whole);
                self.sub_draw((executor, &mut *known), elements, 1)
            };
            let mut count = left.min(SUB_DRAW_PRIMITIVES);
            let mut taken = part(count);
            // Parts of a mesh have half a vertex for each triangle, and few in common with others.
            // Of triangles in random order each part has many of the vertices, which would be
            // shaded again for each part.
            let is_coherent = draw.indices.is_none() || taken.0.vertices / 3 <= count / 4;
            if !is_coherent && count < left {
                count = left.min(INCOHERENT_PRIMITIVES);
                taken = part(count);
            }
            self.primitives.start += count;
            if self.primitives.is_empty() {
                self.primitives.start = 0;
                self.instances.start += 1;
            }
            return taken;
        }
        let left = self.instances.end - self.instances.start;
        let instances = (SUB_DRAW_PRIMITIVES / all.max(1)).clamp(1, left);
        let mut cut = self.sub_draw((executor, known), [0, whole], instances);
        cut.0.keep_within(BATCH_BUDGET);
        self.instances.start += cut.0.instances;
        cut
    }

    /// Takes the next sub-draw off where indices may restart primitives.
    fn take_restarted(&mut self, source: &RestartSource<'_>) -> Cut<'a> {
        let is_first = self.restart.is_at_start();
        let is_whole = is_stippled_strip(self.draw);
        let mut begins = Vec::new();
        let limit = if is_whole {
            MAX_WHOLE_ELEMENTS
        } else {
            INCOHERENT_PRIMITIVES
        };
        let mut corners = self.restart.take(source, limit, &mut begins);
        if !is_whole {
            begins.clear();
        }
        let is_done = self.restart.is_done(source);
        debug_assert!(
            corners.len() <= limit as usize + 1,
            "the limit, and a loop's last line"
        );
        let primitives = u32::try_from(corners.len()).unwrap_or(u32::MAX);
        let left = self.instances.end - self.instances.start;
        let count = if is_first && is_done {
            (INCOHERENT_PRIMITIVES / primitives.max(1)).clamp(1, left)
        } else {
            1
        };
        let instances = Instances {
            first: self.instances.start,
            count,
        };
        let range = list_vertices(&mut corners);
        let (mut sub_draw, listed) = SubDraw::cut(self.draw, [0, 0], primitives, instances, range);
        let mut listed = listed.unwrap_or_default();
        listed.restarted = Some(corners);
        listed.line_restarts = begins;
        sub_draw.keep_within(BATCH_BUDGET);
        if is_done {
            self.restart = RestartCursor::default();
            self.instances.start += sub_draw.instances;
        }
        (sub_draw, Some(listed))
    }

    /// The sub-draw of some elements (first and count, from the draw's first on) of the next
    /// instances.
    fn sub_draw(
        &self,
        indices: (&Executor, &mut KnownExtremes),
        [first, count]: [u32; 2],
        instances: u32,
    ) -> Cut<'a> {
        let first = self.draw.elements.start.saturating_add(first);
        let range = vertex_range(indices, self.draw, first, count);
        let topology = self.draw.pipeline.descriptor().primitive.topology;
        let instances = Instances {
            first: self.instances.start,
            count: instances,
        };
        let primitives = primitive_count(topology, count);
        SubDraw::cut(self.draw, [first, count], primitives, instances, range)
    }
}

#[cfg(test)]
mod tests;
