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

/// The vertices of a group of sub-draws, and what is kept of some.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GroupVertices {
    /// The number of the group in its batch.
    pub(crate) group: usize,
    pub(crate) count: usize,
    /// Scalars of all varyings.
    varyings: usize,
    /// Scalars of a vertex's varyings, at most.
    most_scalars: usize,
    keeps_clip_positions: bool,
    has_point_sizes: bool,
}

impl GroupVertices {
    /// The group that follows, of no vertices.
    pub(crate) fn following(&self) -> Self {
        Self {
            group: self.group + 1,
            ..Self::default()
        }
    }

    /// Adds a sub-draw's vertices; says where they are.
    pub(crate) fn place(&mut self, span: VertexSpan) -> VertexSpan {
        let placed = VertexSpan {
            group: self.group,
            first: self.count,
            first_varying: self.varyings,
            ..span
        };
        self.count += span.count;
        self.varyings += span.count * span.varying_scalars;
        self.most_scalars = self.most_scalars.max(span.varying_scalars);
        self.keeps_clip_positions |= span.keeps_clip_positions;
        self.has_point_sizes |= span.has_point_sizes;
        placed
    }

    /// Adds the vertices of sub-draws that are in another batch's first group.
    pub(crate) fn append(&mut self, other: &Self) {
        self.count += other.count;
        self.varyings += other.varyings;
        self.most_scalars = self.most_scalars.max(other.most_scalars);
        self.keeps_clip_positions |= other.keeps_clip_positions;
        self.has_point_sizes |= other.has_point_sizes;
    }

    /// Scalars of each vertex's varyings, if all have as many.
    pub(crate) fn varying_scalars(&self) -> Option<usize> {
        (self.varyings == self.count * self.most_scalars).then_some(self.most_scalars)
    }

    /// The place behind these vertices of a span that is in another batch's first group.
    pub(crate) fn moved(&self, span: VertexSpan) -> VertexSpan {
        VertexSpan {
            group: self.group,
            first: self.count + span.first,
            first_varying: self.varyings + span.first_varying,
            ..span
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

impl<'a> ShadedSlice<'a> {
    /// Takes the first vertices off with all that is kept of any of their group, of which there are
    /// so many scalars of varyings.
    pub(crate) fn take_first(&mut self, count: usize, varyings: usize) -> Self {
        let kept = |list: &[_]| if list.is_empty() { 0 } else { count };
        let clip = kept(self.clip);
        let sizes = if self.point_size.is_empty() { 0 } else { count };
        Self {
            window: take(&mut self.window, count),
            clip: take(&mut self.clip, clip),
            varyings: take(&mut self.varyings, varyings),
            point_size: take(&mut self.point_size, sizes),
        }
    }

    /// Takes the first vertices off, which are those of a span, with what is kept of them.
    pub(crate) fn take(&mut self, span: &VertexSpan, count: usize) -> Self {
        let mut taken = self.take_first(count, count * span.varying_scalars);
        if !span.keeps_clip_positions {
            taken.clip = &mut [];
        }
        if !span.has_point_sizes {
            taken.point_size = &mut [];
        }
        taken
    }
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
    /// Makes room for the vertices of a group. Those of the group before are overwritten, but for
    /// their varyings.
    pub(crate) fn resize_for(&mut self, group: &GroupVertices) {
        grow(&mut self.window, group.count, [0; 4]);
        if self.varyings.len() <= group.group {
            self.varyings.resize_with(group.group + 1, Vec::new);
        }
        grow(&mut self.varyings[group.group], group.varyings, 0.0);
        let kept = |is_kept: bool| if is_kept { group.count } else { 0 };
        grow(&mut self.clip, kept(group.keeps_clip_positions), [0; 4]);
        grow(&mut self.point_size, kept(group.has_point_sizes), 1.0);
    }

    /// The memory of a group's vertices, for which there [is room](Self::resize_for).
    pub(crate) fn of_group_mut(&mut self, group: &GroupVertices) -> ShadedSlice<'_> {
        let varyings = self.varyings.get_mut(group.group);
        let mut all = ShadedSlice {
            window: &mut self.window,
            clip: &mut self.clip,
            varyings: varyings.map_or(&mut [], |list| list),
            point_size: &mut self.point_size,
        };
        // Lists that are kept for no span may be of any length.
        if !group.keeps_clip_positions {
            all.clip = &mut [];
        }
        if !group.has_point_sizes {
            all.point_size = &mut [];
        }
        all
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
            let mut group = GroupVertices::default();
            let span = group.place(VertexSpan {
                count,
                keeps_clip_positions,
                has_point_sizes: keeps_clip_positions,
                ..VertexSpan::default()
            });
            vertices.resize_for(&group);
            let all = vertices.of_group_mut(&group).take(&span, count);
            assert_eq!(all.window.len(), count);
            let kept = if keeps_clip_positions { count } else { 0 };
            assert_eq!(all.clip.len(), kept);
            assert_eq!(all.point_size.len(), kept);
        }
    }

    #[test]
    fn varyings_of_the_groups_before_are_kept() {
        let mut vertices = ShadedVertices::default();
        let mut spans = Vec::new();
        let mut group = GroupVertices::default();
        for (number, count) in [3, 500, 40].into_iter().enumerate() {
            let span = group.place(VertexSpan {
                count,
                varying_scalars: 2,
                ..VertexSpan::default()
            });
            assert_eq!(span.group, number);
            vertices.resize_for(&group);
            let all = vertices.of_group_mut(&group).take(&span, count);
            all.varyings.fill(number as f32);
            spans.push((number, span));
            group = group.following();
        }
        for (group, span) in spans {
            for vertex in 0..u32::try_from(span.count).unwrap() {
                let varyings = vertices.of_span(&span);
                assert_eq!(varyings.varyings_of(vertex), [group as f32; 2]);
            }
        }
    }
}
