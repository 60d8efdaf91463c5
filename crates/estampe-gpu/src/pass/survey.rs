//! The survey of a pass's draws: each is checked, and compared with the draw before, once.
//!
//! Draws and what they refer to are in no near cache when a pass of thousands begins. So threads
//! look through parts of them, and note all that the steps after need to know: where the data of
//! draws differ, and dynamic offsets. Groups, data and programs are then found without reading all
//! draws again.

use super::check::DrawCheck;
use super::{Draw, PassErrorKind};
use crate::BufferSlice;
use estampe_core::{DrawChecker, DrawNeeds, TargetShape};
use std::ops::Range;

/// Differences of a draw from the one before; of the first one of a part, vertices and indices are
/// set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Differs {
    pub(super) vertices: bool,
    pub(super) indices: bool,
    /// Bind groups, dynamic offsets or immediates.
    pub(super) bindings: bool,
}

/// The facts found of a part of a pass's draws.
#[derive(Debug, Default)]
pub(super) struct PartSurvey {
    /// For each draw.
    pub(super) differs: Vec<Differs>,
    /// Of the draws whose bindings differ, one after the other.
    pub(super) dynamic_offsets: Vec<u32>,
    /// The numbers in the pass of the first draw, and of those whose pipeline or list of bind
    /// groups is another one than that of the draw before.
    pub(super) changes: Vec<usize>,
    /// Vertices of all instances.
    pub(super) vertices: u64,
    pub(super) needs: DrawNeeds,
    /// The first broken rule about objects, after which nothing was looked at.
    pub(super) refused: Option<PassErrorKind>,
    /// The first broken rule of the core, which counts if no other one is broken.
    pub(super) misfit: Option<estampe_core::RenderPassError>,
}

impl PartSurvey {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        let Self {
            mut differs,
            mut dynamic_offsets,
            mut changes,
            ..
        } = std::mem::take(self);
        differs.clear();
        dynamic_offsets.clear();
        changes.clear();
        *self = Self {
            differs,
            dynamic_offsets,
            changes,
            ..Self::default()
        };
    }

    /// Looks through those of a pass's draws with some numbers.
    pub(super) fn look(
        &mut self,
        (draws, numbers): (&[Draw<'_>], Range<usize>),
        check: &DrawCheck<'_>,
        (target, queries): (&TargetShape<'_>, usize),
    ) {
        self.clear();
        let mut checker = DrawChecker::new(target, queries);
        let mut before: Option<&Draw<'_>> = None;
        let before_all = numbers.start.checked_sub(1).map(|number| &draws[number]);
        for (number, draw) in numbers.clone().zip(&draws[numbers]) {
            let checked = check.check(number, draw, before);
            if checked.is_err() {
                self.refused = checked.err();
                return;
            }
            if self.misfit.is_none() {
                let more = draw.more_viewports.iter().filter_map(|more| more.viewport);
                let viewports = draw.viewport.into_iter().chain(more);
                let query = draw.occlusion_query;
                let fits = checker.check(number, draw.pipeline, viewports, query);
                self.misfit = fits.err();
            }
            self.vertices = self.vertices.saturating_add(vertices(draw));
            if before.is_none_or(|before| !same_lists(before, draw)) {
                self.changes.push(number);
            }
            let differs = match (before, before_all) {
                (Some(before), _) => Differs::between(before, draw),
                (None, Some(before)) => Differs {
                    // Draws with the same bindings are shaded together, whatever part they are in.
                    bindings: Differs::between(before, draw).bindings,
                    ..Differs::ALL
                },
                (None, None) => Differs::ALL,
            };
            if differs.bindings {
                self.dynamic_offsets.extend(draw.dynamic_offsets);
            }
            self.differs.push(differs);
            before = Some(draw);
        }
        self.needs = checker.needs();
    }
}

impl Differs {
    const ALL: Self = Self {
        vertices: true,
        indices: true,
        bindings: true,
    };

    fn between(a: &Draw<'_>, b: &Draw<'_>) -> Self {
        let same_indices = match (a.index_buffer, b.index_buffer) {
            (Some((a, _)), Some((b, _))) => same_slice(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let same_bindings = a.dynamic_offsets == b.dynamic_offsets
            && a.immediates == b.immediates
            && same_groups(a, b);
        Self {
            vertices: !same_slices(a.vertex_buffers, b.vertex_buffers),
            indices: !same_indices,
            bindings: !same_bindings,
        }
    }
}

/// The vertices of all instances of a draw.
pub(super) fn vertices(draw: &Draw<'_>) -> u64 {
    let len = |range: &Range<u32>| u64::from(range.end.saturating_sub(range.start));
    len(&draw.elements) * len(&draw.instances)
}

/// Returns true if the pipeline and the list of bind groups of two draws are the same objects.
pub(super) fn same_lists(a: &Draw<'_>, b: &Draw<'_>) -> bool {
    std::ptr::eq(a.pipeline, b.pipeline) && std::ptr::eq(a.bind_groups, b.bind_groups)
}

fn same_slice(a: &BufferSlice, b: &BufferSlice) -> bool {
    std::ptr::eq(a, b) || (a.buffer.is_same(&b.buffer) && a.offset == b.offset && a.size == b.size)
}

fn same_slices(a: &[BufferSlice], b: &[BufferSlice]) -> bool {
    std::ptr::eq(a, b) || (a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_slice(a, b)))
}

fn same_groups(a: &Draw<'_>, b: &Draw<'_>) -> bool {
    let (a, b) = (a.bind_groups, b.bind_groups);
    std::ptr::eq(a, b) || (a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_same(b)))
}
