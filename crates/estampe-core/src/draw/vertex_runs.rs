//! The vertices of a group of sub-draws, off whose front workers take runs.
//!
//! Runs have so many vertices, wherever a sub-draw ends: a list of them, made by one thread while
//! all others wait, took a twentieth of a frame of 2,000 draws on sixteen cores.

use crate::bounds::chunk::number;
use crate::geometry::shaded_vertices::{GroupVertices, ShadedSlice, VertexSpan};
use crate::plan::chunk_plan::ChunkPlan;
use crate::schedule::Jobs;
use crate::segments::Segments;
use std::ops::Range;

/// The jobs of the first half of geometry.
#[derive(Debug)]
pub(super) struct VertexJobs<'a, S> {
    /// A job that divides the primitives of the group among chunks.
    pub(super) plan: Option<&'a mut ChunkPlan>,
    pub(super) runs: VertexRuns<'a, S>,
}

/// Vertices that follow one another, and the memory that they are shaded into.
#[derive(Debug)]
pub(super) struct VertexRuns<'a, S> {
    /// The sub-draws of the batch, and the numbers of those of the group.
    sub_draws: &'a Segments<S>,
    group: (usize, usize),
    /// The vertices that are left, counted in the group.
    vertices: Range<usize>,
    /// Vertices of a run.
    size: usize,
    /// Scalars of each vertex's varyings, if all sub-draws have as many.
    varying_scalars: Option<usize>,
    out: ShadedSlice<'a>,
}

/// Vertices of one sub-draw.
#[derive(Debug)]
pub(super) struct VertexPart<'a, S> {
    pub(super) sub_draw: &'a S,
    /// The first vertex, counted in the sub-draw.
    pub(super) first: u32,
    pub(super) out: ShadedSlice<'a>,
}

impl<'a, S: AsRef<VertexSpan>> VertexRuns<'a, S> {
    /// All vertices of the sub-draws of a group, in runs of `size`.
    pub(super) fn new(
        (group, (sub_draws, of_group)): (&GroupVertices, (&'a Segments<S>, Range<usize>)),
        size: usize,
        out: ShadedSlice<'a>,
    ) -> Self {
        Self {
            sub_draws,
            group: (of_group.start, of_group.end),
            vertices: 0..group.count,
            size: size.max(1),
            varying_scalars: group.varying_scalars(),
            out,
        }
    }

    /// The vertices, sub-draw by sub-draw.
    pub(super) fn parts(self) -> impl Iterator<Item = VertexPart<'a, S>> {
        let Range { mut start, end } = self.vertices;
        let mut sub_draws = self.sub_draws.range(self.starting_at(start));
        let mut out = self.out;
        std::iter::from_fn(move || {
            while start < end {
                let sub_draw = sub_draws.next()?;
                let span = sub_draw.as_ref();
                let first = start - span.first;
                let count = span.count.saturating_sub(first).min(end - start);
                start += count;
                if count > 0 {
                    return Some(VertexPart {
                        sub_draw,
                        first: number(first),
                        out: out.take(span, count),
                    });
                }
            }
            None
        })
    }

    /// The numbers of the sub-draws from that of a vertex on.
    fn starting_at(&self, vertex: usize) -> Range<usize> {
        let (first, end) = self.group;
        let begins_by = |sub_draw: &S| sub_draw.as_ref().first <= vertex;
        let begun = self.sub_draws.partition_point(first..end, begins_by);
        begun.saturating_sub(1).max(first)..end
    }

    /// Scalars of the varyings of the vertices before one.
    fn varyings_before(&self, vertex: usize) -> usize {
        if let Some(scalars) = self.varying_scalars {
            return vertex * scalars;
        }
        let mut sub_draws = self.sub_draws.range(self.starting_at(vertex));
        let span = sub_draws.next().map(AsRef::as_ref);
        span.map_or(0, |span| {
            span.first_varying + (vertex - span.first) * span.varying_scalars
        })
    }
}

impl<S: AsRef<VertexSpan> + Sync> Jobs for VertexJobs<'_, S> {
    type Taken = Self;

    fn job_type() -> &'static str {
        std::any::type_name::<VertexJobs<'_, ()>>()
    }

    fn left(&self) -> usize {
        let runs = self.runs.vertices.len().div_ceil(self.runs.size);
        usize::from(self.plan.is_some()) + runs
    }

    fn take_first(&mut self, count: usize) -> Self {
        let plan = self.plan.take();
        let runs = count - usize::from(plan.is_some()).min(count);
        let left = &mut self.runs;
        let count = runs.saturating_mul(left.size).min(left.vertices.len());
        let Range { start, .. } = left.vertices;
        let end = start + count;
        let varyings = left.varyings_before(end) - left.varyings_before(start);
        left.vertices.start = end;
        let runs = VertexRuns {
            vertices: start..end,
            out: left.out.take_first(count, varyings),
            ..*left
        };
        Self { plan, runs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shaded_vertices::ShadedVertices;

    impl AsRef<Self> for VertexSpan {
        fn as_ref(&self) -> &Self {
            self
        }
    }

    /// The spans of sub-draws of so many vertices, scalars of varyings, and whether clip-space
    /// positions and sizes are kept.
    fn spans(kinds: &[(usize, usize, bool)]) -> (GroupVertices, Segments<VertexSpan>) {
        let mut group = GroupVertices::default();
        let mut spans = Segments::default();
        // Those of another group come before.
        spans.push(VertexSpan::default());
        for &(count, varying_scalars, is_kept) in kinds {
            spans.push(group.place(VertexSpan {
                count,
                varying_scalars,
                keeps_clip_positions: is_kept,
                has_point_sizes: is_kept,
                ..VertexSpan::default()
            }));
        }
        (group, spans)
    }

    /// Stamps each vertex, in what is kept of it, with the number of its sub-draw and its own, by
    /// jobs that are taken so many at a time.
    fn stamp(
        vertices: &mut ShadedVertices,
        of: (&GroupVertices, &Segments<VertexSpan>),
        [size, taken]: [usize; 2],
    ) {
        let spans = (of.0, (of.1, 1..of.1.len()));
        vertices.resize_for(of.0);
        let mut jobs = VertexJobs {
            plan: None,
            runs: VertexRuns::new(spans, size, vertices.of_group_mut(of.0)),
        };
        let mut left = jobs.left();
        assert_eq!(left, of.0.count.div_ceil(size));
        while left > 0 {
            for part in jobs.take_first(taken).runs.parts() {
                let same = |span: &VertexSpan| std::ptr::eq(span, part.sub_draw);
                let number = of.1.iter().position(same).unwrap() - 1;
                let (scalars, out) = (part.sub_draw.varying_scalars, part.out);
                assert_eq!(out.varyings.len(), out.window.len() * scalars);
                for at in 0..out.window.len() {
                    let stamp = number * 1000 + part.first as usize + at;
                    out.window[at] = [u32::try_from(stamp).unwrap(); 4];
                    out.varyings[at * scalars..][..scalars].fill(stamp as f32);
                    if !out.clip.is_empty() {
                        out.clip[at] = [(stamp as f32).to_bits(); 4];
                    }
                    if !out.point_size.is_empty() {
                        out.point_size[at] = stamp as f32;
                    }
                }
            }
            left -= taken.min(left);
            assert_eq!(jobs.left(), left);
        }
    }

    #[test]
    fn runs_and_spans_share_the_same_places() {
        let mixed = [
            (5, 2, false),
            (0, 9, true),
            (3, 0, true),
            (0, 1, false),
            (40, 3, true),
        ];
        let alike = [(3, 2, false), (0, 2, false), (30, 2, false), (1, 2, false)];
        let mut vertices = ShadedVertices::default();
        for kinds in [&mixed[..], &alike, &mixed[..1], &[]] {
            let (group, spans) = spans(kinds);
            // Several times, because memory is used again.
            for by in [[1, 1], [2, 3], [7, 2], [100, 1]] {
                stamp(&mut vertices, (&group, &spans), by);
                for (number, span) in spans.range(1..spans.len()).enumerate() {
                    let found = vertices.of_span(span);
                    for at in 0..span.count {
                        let stamp = number * 1000 + at;
                        let vertex = u32::try_from(at).unwrap();
                        assert_eq!(found.window[at], [u32::try_from(stamp).unwrap(); 4]);
                        let varyings = vec![stamp as f32; span.varying_scalars];
                        assert_eq!(found.varyings_of(vertex), varyings);
                        let kept = span.keeps_clip_positions;
                        let size = if kept { stamp as f32 } else { 1.0 };
                        assert_eq!(found.point_size(vertex), size);
                        let clip = kept.then_some([stamp as f32; 4]);
                        assert_eq!(found.clip_position(vertex), clip);
                    }
                }
            }
        }
    }

    #[test]
    fn the_plan_is_the_first_job() {
        let (group, spans) = spans(&[(10, 0, false)]);
        let mut vertices = ShadedVertices::default();
        vertices.resize_for(&group);
        let mut plan = ChunkPlan::default();
        let mut jobs = VertexJobs {
            plan: Some(&mut plan),
            runs: VertexRuns::new((&group, (&spans, 1..2)), 4, vertices.of_group_mut(&group)),
        };
        assert_eq!(jobs.left(), 4);
        let first = jobs.take_first(2);
        assert!(first.plan.is_some() && first.runs.vertices == (0..4));
        assert_eq!(jobs.left(), 2);
        let second = jobs.take_first(usize::MAX);
        assert!(second.plan.is_none() && second.runs.vertices == (4..10));
        assert_eq!(jobs.left(), 0);
    }
}
