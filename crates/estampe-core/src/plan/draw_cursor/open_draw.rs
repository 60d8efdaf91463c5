//! One draw that is being cut into sub-draws.

use super::BATCH_BUDGET;
use crate::commands::Draw;
use crate::geometry::assembly::primitive_count;
use crate::geometry::restart::{RestartCursor, RestartSource};
use crate::plan::index_extremes::KnownExtremes;
use crate::plan::index_range::{
    MAX_WHOLE_ELEMENTS, element_count, is_splittable, is_stippled_strip, list_vertices, part_of,
    restart_source, vertex_range, visible_elements,
};
use crate::plan::sub_draw::{Cut, Instances, SubDraw};
use crate::schedule::Executor;
use std::ops::Range;

/// Primitives of a sub-draw at most: a larger draw becomes several. Even, so that a strip's parts
/// begin on triangles that are not turned.
pub(super) const SUB_DRAW_PRIMITIVES: u32 = 1 << 16;

/// Primitives of a sub-draw at most, where fewer could have too many vertices in common with
/// others.
const INCOHERENT_PRIMITIVES: u32 = 1_000_000;

/// Primitives of all instances of a small draw at most.
const SMALL_DRAW: u64 = 1 << 14;

/// A draw, and which of its primitives and instances are left.
#[derive(Debug)]
pub(super) struct OpenDraw<'a> {
    pub(super) draw: &'a Draw<'a>,
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

impl<'a> OpenDraw<'a> {
    /// A draw of which nothing is cut; `None` if it has no primitive.
    pub(super) fn new(draw: &'a Draw<'a>) -> Option<Self> {
        let topology = draw.pipeline.descriptor().primitive.topology;
        let all = primitive_count(topology, element_count(draw));
        let elements = visible_elements(draw);
        let primitives = 0..primitive_count(topology, elements);
        if all == 0 || draw.instances.is_empty() {
            return None;
        }
        Some(Self {
            draw,
            elements,
            invisible_primitives: all - primitives.end,
            primitives,
            instances: draw.instances.clone(),
            restart: RestartCursor::default(),
        })
    }

    /// Returns true if the draw becomes one sub-draw, of few primitives.
    pub(super) fn is_small(&self) -> bool {
        let instances = u64::from(self.instances.end - self.instances.start);
        let primitives = u64::from(self.primitives.end) * instances;
        primitives <= SMALL_DRAW && restart_source(self.draw).is_none()
    }

    /// Returns true if nothing is left.
    pub(super) fn is_done(&self) -> bool {
        self.instances.is_empty()
    }

    /// The primitives of all instances that cannot show anything; 0 when asked again.
    pub(super) fn take_invisible(&mut self) -> u64 {
        let instances = u64::from(self.instances.end - self.instances.start);
        u64::from(std::mem::take(&mut self.invisible_primitives)) * instances
    }

    /// Takes the next sub-draw off: many instances of a small draw, or part of one instance of a
    /// large one.
    pub(super) fn take(&mut self, (executor, known): (&Executor, &mut KnownExtremes)) -> Cut<'a> {
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
