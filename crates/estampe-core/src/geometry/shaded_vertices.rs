//! The shaded vertices of a draw batch: one list for all sub-draws, filled by workers in slices.
//!
//! Positions are read by geometry alone, so their memory serves one group of sub-draws after the
//! other; tiles read varyings, which are kept for the whole batch, in a list for each group: one
//! list would be copied to more memory with each group.
//!
//! *Space* window; clip where positions are kept.

use crate::bounds::primitives::{VertexRef, WindowVertex};
use estampe_simd::advise_huge_pages;

/// A window x that says "this vertex must be clipped"; no snapped coordinate reaches it.
pub(crate) const NEEDS_CLIPPING: i32 = i32::MIN;

/// A vertex in the window, as bits: x and y in 1/256 pixel, depth, 1/w.
pub(crate) type PackedVertex = [u32; 4];

/// Vertices after the shader and the viewport transform, one after the other.
#[derive(Debug, Default)]
pub(crate) struct ShadedVertices {
    window: Vec<PackedVertex>,
    /// Clip-space positions as bits: of points, lines and outlines, which all need them.
    clip: Vec<[u32; 4]>,
    /// By group of the batch: the varyings' scalars of each vertex.
    varyings: Vec<Vec<f32>>,
    /// Point sizes in pixels, where points are drawn.
    point_size: Vec<f32>,
}

/// The place of a sub-draw's vertices in those of its batch, and what is kept of them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VertexSpan {
    /// The number of the group of sub-draws whose geometry is done together, counted in the batch.
    pub(crate) group: usize,
    /// The first vertex, counted in the group.
    pub(crate) first: usize,
    /// Vertices of all instances.
    pub(crate) count: usize,
    /// The first scalar of the varyings, counted in the group.
    pub(crate) first_varying: usize,
    /// Scalars of a vertex's varyings.
    pub(crate) varying_scalars: usize,
    /// True if clip-space positions are kept.
    pub(crate) keeps_clip_positions: bool,
    /// True if the shader sets point sizes.
    pub(crate) has_point_sizes: bool,
}

impl VertexSpan {
    /// The span that follows this one in its group, of no vertices.
    pub(crate) fn following(&self) -> Self {
        Self {
            group: self.group,
            first: self.first + self.count,
            first_varying: self.first_varying + self.count * self.varying_scalars,
            ..Self::default()
        }
    }
}

/// The part of [`ShadedVertices`] that one job fills.
#[derive(Debug)]
pub(crate) struct ShadedSlice<'a> {
    pub(crate) window: &'a mut [PackedVertex],
    /// Empty where clip-space positions are not kept.
    pub(crate) clip: &'a mut [[u32; 4]],
    pub(crate) varyings: &'a mut [f32],
    /// Empty where the shader sets no sizes.
    pub(crate) point_size: &'a mut [f32],
}

/// A run of a sub-draw's vertices for one worker.
#[derive(Debug)]
pub(crate) struct VertexJob<'a> {
    /// The sub-draw's number in the batch.
    pub(crate) sub_draw: usize,
    /// The first vertex, counted in the sub-draw.
    pub(crate) first: u32,
    pub(crate) out: ShadedSlice<'a>,
}

/// The shaded vertices of one sub-draw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SubDrawVertices<'a> {
    pub(crate) window: &'a [PackedVertex],
    /// Those of the whole group in the window.
    pub(crate) of_group: &'a [PackedVertex],
    /// The number of this sub-draw's first one in the group.
    pub(crate) first_in_group: u32,
    /// Empty where clip-space positions are not kept.
    clip: &'a [[u32; 4]],
    pub(crate) varyings: &'a [f32],
    pub(crate) varying_scalars: usize,
    /// Empty where the shader sets no size.
    point_size: &'a [f32],
}

impl ShadedVertices {
    /// Makes room for the spans, which are all of a group. The vertices of the group before are
    /// overwritten, but for their varyings.
    pub(crate) fn resize_for<'s>(&mut self, spans: impl Iterator<Item = &'s VertexSpan>) {
        let (mut end, mut has_positions, mut has_sizes) = (VertexSpan::default(), false, false);
        for span in spans {
            end = span.following();
            has_positions |= span.keeps_clip_positions;
            has_sizes |= span.has_point_sizes;
        }
        grow(&mut self.window, end.first, [0; 4]);
        if self.varyings.len() <= end.group {
            self.varyings.resize_with(end.group + 1, Vec::new);
        }
        grow(&mut self.varyings[end.group], end.first_varying, 0.0);
        let positions = if has_positions { end.first } else { 0 };
        grow(&mut self.clip, positions, [0; 4]);
        grow(
            &mut self.point_size,
            if has_sizes { end.first } else { 0 },
            1.0,
        );
    }

    /// Cuts the vertices of the spans, which are all of a group, into jobs of at most `size`.
    pub(crate) fn split<'a, 's>(
        &'a mut self,
        spans: impl Iterator<Item = &'s VertexSpan> + Clone,
        size: usize,
        jobs: &mut Vec<VertexJob<'a>>,
    ) {
        // Lists that are kept for no span may be of any length.
        let has_positions = spans.clone().any(|span| span.keeps_clip_positions);
        let has_sizes = spans.clone().any(|span| span.has_point_sizes);
        let group = spans.clone().next().map_or(0, |span| span.group);
        let mut rest = ShadedSlice {
            window: &mut self.window,
            clip: &mut self.clip,
            varyings: self.varyings.get_mut(group).map_or(&mut [], |list| list),
            point_size: &mut self.point_size,
        };
        for (sub_draw, span) in spans.enumerate() {
            for first in (0..span.count).step_by(size) {
                let count = size.min(span.count - first);
                let clip = take(&mut rest.clip, if has_positions { count } else { 0 });
                let point_size = take(&mut rest.point_size, if has_sizes { count } else { 0 });
                let out = ShadedSlice {
                    window: take(&mut rest.window, count),
                    clip: if span.keeps_clip_positions {
                        clip
                    } else {
                        &mut []
                    },
                    varyings: take(&mut rest.varyings, count * span.varying_scalars),
                    point_size: if span.has_point_sizes {
                        point_size
                    } else {
                        &mut []
                    },
                };
                debug_assert!(
                    u32::try_from(first).is_ok(),
                    "a sub-draw of {first} vertices"
                );
                jobs.push(VertexJob {
                    sub_draw,
                    first: u32::try_from(first).unwrap_or(u32::MAX),
                    out,
                });
            }
        }
    }

    /// The vertices of one sub-draw.
    pub(crate) fn of_span(&self, span: &VertexSpan) -> SubDrawVertices<'_> {
        let varyings = span.count * span.varying_scalars;
        SubDrawVertices {
            window: &self.window[span.first..][..span.count],
            of_group: &self.window,
            // A batch has few vertices more than its budget.
            first_in_group: u32::try_from(span.first).unwrap_or(u32::MAX),
            clip: if span.keeps_clip_positions {
                &self.clip[span.first..][..span.count]
            } else {
                &[]
            },
            varyings: &self.varyings[span.group][span.first_varying..][..varyings],
            varying_scalars: span.varying_scalars,
            point_size: if span.has_point_sizes {
                &self.point_size[span.first..][..span.count]
            } else {
                &[]
            },
        }
    }
}

impl SubDrawVertices<'_> {
    /// The scalars of a vertex's varyings.
    pub(crate) fn varyings_of(&self, vertex: u32) -> &[f32] {
        &self.varyings[vertex as usize * self.varying_scalars..][..self.varying_scalars]
    }

    /// A vertex's clip-space position, if positions are kept.
    pub(crate) fn clip_position(&self, vertex: u32) -> Option<[f32; 4]> {
        let position = self.clip.get(vertex as usize)?;
        Some(position.map(f32::from_bits))
    }

    /// A vertex in the window, or `None` when it needs clipping.
    pub(crate) fn window_vertex(&self, vertex: u32) -> Option<WindowVertex> {
        let [x, y, z, iw] = self.window[vertex as usize];
        let (x, y) = (x.cast_signed(), y.cast_signed());
        (x != NEEDS_CLIPPING).then_some(WindowVertex {
            x,
            y,
            z: f32::from_bits(z),
            iw: f32::from_bits(iw),
            vertex: VertexRef(vertex),
        })
    }

    /// A point's size in pixels: 1 where the shader sets none.
    pub(crate) fn point_size(&self, vertex: u32) -> f32 {
        let size = self.point_size.get(vertex as usize);
        size.copied().unwrap_or(1.0)
    }
}

/// Makes a list at least so long; what it held is overwritten. The list never shrinks, because
/// zeroing it anew for each batch would cost as much as writing it. Fresh memory comes from the
/// system as zeros: the threads that shade are then the first to touch it. Large lists are in huge
/// pages: tiles read the varyings of a mesh in any order, on more pages than the processor's tables
/// hold.
fn grow<T: Clone>(list: &mut Vec<T>, len: usize, zero: T) {
    if list.capacity() < len {
        *list = Vec::new();
        *list = vec![zero; len];
        advise_huge_pages(list);
    } else if list.len() < len {
        list.resize(len, zero);
    }
}

/// Takes the first `count` elements off a slice.
fn take<'a, T>(rest: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (first, others) = std::mem::take(rest).split_at_mut(count);
    *rest = others;
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_that_nobody_needs_may_be_shorter() {
        let mut vertices = ShadedVertices::default();
        for (count, keeps_clip_positions) in [(3, true), (9, false), (5, true)] {
            let span = VertexSpan {
                count,
                keeps_clip_positions,
                has_point_sizes: keeps_clip_positions,
                ..VertexSpan::default()
            };
            vertices.resize_for([span].iter());
            let mut jobs = Vec::new();
            vertices.split([span].iter(), 100, &mut jobs);
            assert_eq!(jobs[0].out.window.len(), count);
            let kept = if keeps_clip_positions { count } else { 0 };
            assert_eq!(jobs[0].out.clip.len(), kept);
            assert_eq!(jobs[0].out.point_size.len(), kept);
        }
    }

    #[test]
    fn varyings_of_the_groups_before_are_kept() {
        let mut vertices = ShadedVertices::default();
        let mut spans = Vec::new();
        for (group, count) in [3, 500, 40].into_iter().enumerate() {
            let span = VertexSpan {
                group,
                count,
                varying_scalars: 2,
                ..VertexSpan::default()
            };
            vertices.resize_for([span].iter());
            let mut jobs = Vec::new();
            vertices.split([span].iter(), count, &mut jobs);
            jobs[0].out.varyings.fill(group as f32);
            spans.push((group, span));
        }
        for (group, span) in spans {
            for vertex in 0..u32::try_from(span.count).unwrap() {
                let varyings = vertices.of_span(&span);
                assert_eq!(varyings.varyings_of(vertex), [group as f32; 2]);
            }
        }
    }

    #[test]
    fn jobs_and_spans_share_the_same_places() {
        let mut vertices = ShadedVertices::default();
        let mut spans = Vec::new();
        let mut span = VertexSpan::default();
        for (count, varying_scalars, has_point_sizes) in [(5, 2, false), (3, 0, true), (4, 3, true)]
        {
            span = VertexSpan {
                count,
                varying_scalars,
                keeps_clip_positions: has_point_sizes,
                has_point_sizes,
                ..span.following()
            };
            spans.push(span);
        }
        // Twice, because memory is used again.
        for turn in 0..2 {
            vertices.resize_for(spans.iter());
            let mut jobs = Vec::new();
            vertices.split(spans.iter(), 2, &mut jobs);
            let pieces = jobs.iter().map(|job| (job.sub_draw, job.first));
            let expected = [(0, 0), (0, 2), (0, 4), (1, 0), (1, 2), (2, 0), (2, 2)];
            assert!(pieces.eq(expected), "{jobs:?}");
            for job in &mut jobs {
                let stamp = u32::try_from(job.sub_draw).unwrap() * 100 + job.first + turn;
                job.out.window.fill([stamp; 4]);
                job.out.clip.fill([stamp; 4]);
                job.out.varyings.fill(stamp as f32);
                job.out.point_size.fill(stamp as f32);
            }
            for (number, span) in (0..).zip(&spans) {
                let found = vertices.of_span(span);
                let stamp = number * 100 + turn + 2;
                assert_eq!(found.window[2], [stamp; 4]);
                assert_eq!(found.window.len(), span.count);
                let varyings = vec![stamp as f32; span.varying_scalars];
                assert_eq!(found.varyings_of(2), varyings);
                let size = if span.has_point_sizes {
                    stamp as f32
                } else {
                    1.0
                };
                assert_eq!(found.point_size(2), size);
                assert_eq!(found.clip_position(2).is_some(), span.keeps_clip_positions);
            }
        }
    }
}
