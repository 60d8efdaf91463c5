//! The commands that a caller records: draws, and the pass that they belong to.

use crate::pipeline::RenderPipeline;
use estampe_types::state::{ScissorRect, Viewport};
use estampe_types::{Bindings, BufferData, IndexFormat};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// One draw: a pipeline, the data that it reads, and how much of it.
#[derive(Debug, Clone)]
pub struct Draw<'a> {
    /// The validated state.
    pub pipeline: &'a RenderPipeline,
    /// The vertex buffers, as the pipeline's layouts name them; a missing or short one reads zeros.
    pub vertex_buffers: &'a [BufferData],
    /// The index buffer and the width of its indices, if vertices are to be found by index.
    pub indices: Option<(&'a BufferData, IndexFormat)>,
    /// The range of indices to draw, or of vertices if there is no index buffer. Indices beyond the
    /// buffer's end read zero.
    pub elements: Range<u32>,
    /// The range of instances to draw. Default one.
    pub instances: Range<u32>,
    /// Added to every index. Default 0.
    pub base_vertex: i32,
    /// The resources that shaders find by number.
    pub bindings: Option<&'a Bindings>,
    /// The rectangle that NDC is mapped to, and the range of depths. Default the whole target,
    /// depth 0..1.
    pub viewport: Option<Viewport>,
    /// The rectangle of pixels that may change. Default all.
    pub scissor: Option<ScissorRect>,
    /// The viewports and scissors that a geometry shader's viewport index selects: 0 is that of
    /// `viewport` and `scissor`, i is number i − 1 of these. Default none.
    pub more_viewports: &'a [ViewportScissor],
    /// The constant of blending. Default zeros.
    pub blend_constant: [f32; 4],
    /// The stencil references of front-facing and back-facing primitives. Default zeros.
    pub stencil_reference: [u8; 2],
    /// The range, both ends included, in which the *stored* depth must lie for a sample to be drawn
    /// (Vulkan's depth-bounds test). Default none.
    pub depth_bounds: Option<[f32; 2]>,
    /// The index of the pass's [`OcclusionQueries`] counter to which the samples that pass all
    /// tests are added. Default none.
    pub occlusion_query: Option<u32>,
}

impl<'a> Draw<'a> {
    /// A draw of one instance without buffers, over the whole target.
    #[must_use]
    pub fn new(pipeline: &'a RenderPipeline, elements: Range<u32>) -> Self {
        Self {
            pipeline,
            vertex_buffers: &[],
            indices: None,
            elements,
            instances: 0..1,
            base_vertex: 0,
            bindings: None,
            viewport: None,
            scissor: None,
            more_viewports: &[],
            blend_constant: [0.0; 4],
            stencil_reference: [0; 2],
            depth_bounds: None,
            occlusion_query: None,
        }
    }

    /// Vertices or indices of an indirect draw, times its instances, at most: 2²⁷.
    pub const INDIRECT_LIMIT: u32 = 1 << 27;

    /// A draw of so many elements and instances, cut at [`Draw::INDIRECT_LIMIT`].
    #[must_use]
    pub fn limited(
        pipeline: &'a RenderPipeline,
        [first, count]: [u32; 2],
        [first_instance, instances]: [u32; 2],
    ) -> Self {
        let count = count.min(Self::INDIRECT_LIMIT);
        let instances = instances.min(Self::INDIRECT_LIMIT / count.max(1));
        Self {
            instances: first_instance..first_instance.saturating_add(instances),
            ..Self::new(pipeline, first..first.saturating_add(count))
        }
    }
}

/// The draws of a pass, in order: one list, or several that follow each other.
#[derive(Debug, Clone, Copy)]
pub enum DrawList<'a> {
    /// One list.
    Whole(&'a [Draw<'a>]),
    /// Several lists, which threads made each for themselves.
    Parts(&'a [Vec<Draw<'a>>]),
}

impl<'a> DrawList<'a> {
    /// Returns the number of draws.
    #[must_use]
    pub fn len(self) -> usize {
        match self {
            Self::Whole(draws) => draws.len(),
            Self::Parts(parts) => parts.iter().map(Vec::len).sum(),
        }
    }

    /// Returns true if there are no draws.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Returns true if the draws have few elements, of all instances: as many as two rectangles,
    /// as those of filters do.
    pub(crate) fn has_few_elements(self) -> bool {
        const FEW_DRAWS: usize = 4;
        const FEW_ELEMENTS: u64 = 12;
        let len = |range: &Range<u32>| u64::from(range.end.saturating_sub(range.start));
        let elements = |draw: &Draw<'_>| len(&draw.elements).saturating_mul(len(&draw.instances));
        self.len() <= FEW_DRAWS
            && self.iter().map(elements).fold(0, u64::saturating_add) <= FEW_ELEMENTS
    }

    /// The draws, in order.
    #[must_use]
    pub fn iter(self) -> DrawIter<'a> {
        let (draws, parts) = match self {
            Self::Whole(draws) => (draws, &[][..]),
            Self::Parts(parts) => (&[][..], parts),
        };
        DrawIter {
            draws: draws.iter(),
            parts: parts.iter(),
            left: self.len(),
        }
    }
}

impl Default for DrawList<'_> {
    fn default() -> Self {
        Self::Whole(&[])
    }
}

impl<'a> From<&'a [Draw<'a>]> for DrawList<'a> {
    fn from(draws: &'a [Draw<'a>]) -> Self {
        Self::Whole(draws)
    }
}

impl<'a> IntoIterator for DrawList<'a> {
    type Item = &'a Draw<'a>;
    type IntoIter = DrawIter<'a>;

    fn into_iter(self) -> DrawIter<'a> {
        self.iter()
    }
}

/// The draws of a [`DrawList`] that are left.
#[derive(Debug, Clone)]
pub struct DrawIter<'a> {
    draws: std::slice::Iter<'a, Draw<'a>>,
    parts: std::slice::Iter<'a, Vec<Draw<'a>>>,
    left: usize,
}

impl<'a> Iterator for DrawIter<'a> {
    type Item = &'a Draw<'a>;

    fn next(&mut self) -> Option<&'a Draw<'a>> {
        loop {
            if let Some(draw) = self.draws.next() {
                self.left -= 1;
                return Some(draw);
            }
            self.draws = self.parts.next()?.iter();
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for DrawIter<'_> {}

impl DrawIter<'_> {
    /// Takes up to so many draws off, fewer where one of several lists ends; none if none are left.
    pub(crate) fn take_first(&mut self, count: usize) -> Self {
        while self.draws.len() == 0
            && let Some(list) = self.parts.next()
        {
            self.draws = list.iter();
        }
        let draws = self.draws.as_slice();
        let (first, others) = draws.split_at(count.min(draws.len()));
        self.draws = others.iter();
        self.left -= first.len();
        Self {
            draws: first.iter(),
            parts: [].iter(),
            left: first.len(),
        }
    }
}

/// A viewport of a draw that has several.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ViewportScissor {
    /// The rectangle that NDC is mapped to, and the range of depths. Default the whole target,
    /// depth 0..1.
    pub viewport: Option<Viewport>,
    /// The rectangle of pixels that may change. Default all.
    pub scissor: Option<ScissorRect>,
}

/// The operation on an attachment's old contents when a pass begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadOp<T> {
    /// Keeps the old contents.
    Load,
    /// Replaces them with this value.
    Clear(T),
}

/// Draws into one target, and the operations on its old contents.
#[derive(Debug, Clone)]
pub struct RenderPass<'a> {
    /// By colour attachment: linear RGBA, which the attachment's format stores as it stores a
    /// fragment's colour; of integer formats the integers. Attachments beyond the list's end are
    /// cleared to zeros.
    pub load_colors: Vec<LoadOp<[f64; 4]>>,
    /// Of the depth attachment: a number in 0..=1.
    pub load_depth: LoadOp<f32>,
    /// Of the stencil attachment.
    pub load_stencil: LoadOp<u8>,
    /// The attachments whose texels are not needed after the pass. Default none.
    pub discards: Discards,
    /// The counters of samples that pass all tests. Default none.
    pub occlusion_queries: Option<&'a OcclusionQueries>,
    /// Cancelling the pass, and watching its progress. Default neither.
    pub control: PassControl<'a>,
    /// The draws, in order.
    pub draws: DrawList<'a>,
}

/// Attachments whose texels are undefined after a pass. Those that are cleared first, in a pass of
/// one batch of draws, live in each worker's memory for one tile, and their images are not touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Discards {
    /// One bit for each colour attachment, the lowest for the first.
    pub colors: u8,
    /// Depth and stencil.
    pub depth_stencil: bool,
}

impl Discards {
    /// All attachments.
    pub(crate) const ALL: Self = Self {
        colors: u8::MAX,
        depth_stencil: true,
    };

    /// Those of both.
    pub(crate) fn with(self, others: Self) -> Self {
        Self {
            colors: self.colors | others.colors,
            depth_stencil: self.depth_stencil | others.depth_stencil,
        }
    }

    /// Those that are not among others.
    pub(crate) fn without(self, others: Self) -> Self {
        Self {
            colors: self.colors & !others.colors,
            depth_stencil: self.depth_stencil & !others.depth_stencil,
        }
    }
}

/// Cancelling a pass, and watching its progress, between batches of draws: about every two million
/// vertices.
#[derive(Clone, Copy, Default)]
pub struct PassControl<'a> {
    /// If another thread sets it, the pass ends with an error, and its attachments hold what was
    /// drawn until then. Default none.
    pub cancel: Option<&'a AtomicBool>,
    /// Called on the thread that draws with the number of draws that are drawn or begun, and of all
    /// draws. Default none.
    pub progress: Option<&'a (dyn Fn(usize, usize) + Sync)>,
}

impl PassControl<'_> {
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel
            .is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }

    pub(crate) fn report(&self, begun: usize, all: usize) {
        if let Some(progress) = self.progress {
            progress(begun, all);
        }
    }
}

impl std::fmt::Debug for PassControl<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PassControl")
            .field("cancel", &self.cancel)
            .field("has_progress", &self.progress.is_some())
            .finish()
    }
}

impl Default for RenderPass<'_> {
    /// Clears colour and stencil to zeros and depth to 1; draws nothing.
    fn default() -> Self {
        Self {
            load_colors: Vec::new(),
            load_depth: LoadOp::Clear(1.0),
            load_stencil: LoadOp::Clear(0),
            discards: Discards::default(),
            occlusion_queries: None,
            control: PassControl::default(),
            draws: DrawList::default(),
        }
    }
}

/// Counters of samples that pass all tests (O10); a draw names the one that it adds to. The counts
/// are exact and do not depend on threads or the SIMD level.
#[derive(Debug, Default)]
pub struct OcclusionQueries {
    counters: Vec<AtomicU64>,
}

impl OcclusionQueries {
    /// So many counters, at 0.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self {
            counters: (0..count).map(|_| AtomicU64::new(0)).collect(),
        }
    }

    /// Returns the number of counters.
    #[must_use]
    pub fn count(&self) -> usize {
        self.counters.len()
    }

    /// Returns the number of samples counted by a counter in the passes drawn so far; 0 if `query`
    /// is beyond the last one.
    #[must_use]
    pub fn samples_passed(&self, query: u32) -> u64 {
        let counter = self.counters.get(query as usize);
        counter.map_or(0, |counter| counter.load(Ordering::Relaxed))
    }

    /// Sets every counter to 0.
    pub fn reset(&mut self) {
        self.counters.fill_with(AtomicU64::default);
    }

    /// Adds to a counter, if there is such a one.
    pub(crate) fn add(&self, query: u32, samples: u64) {
        if let Some(counter) = self.counters.get(query as usize) {
            counter.fetch_add(samples, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::RenderPipelineDescriptor;
    use estampe_types::shader::VertexOut;
    use estampe_types::{FragmentIn, FragmentOut, Limits, Vec4, VertexIn};

    /// Draws nothing.
    struct Nothing;

    estampe_types::shader! {
        impl Shader for Nothing {
            type Attributes<R: Real> = ();
            type Varyings<R: Real> = ();

            fn vertex<R: Real>(&self, input: VertexIn<'_, R>, _: ()) -> VertexOut<R, ()> {
                let zero = input.real(0.0);
                VertexOut::new(Vec4::new(zero, zero, zero, zero), ())
            }

            fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
                let zero = input.real(0.0);
                FragmentOut::color(Vec4::new(zero, zero, zero, zero))
            }
        }
    }

    #[test]
    fn parts_follow_each_other() {
        let descriptor = RenderPipelineDescriptor::new(Nothing);
        let pipeline = RenderPipeline::new(&descriptor, &Limits::default()).unwrap();
        let draws: Vec<_> = (0..5).map(|end| Draw::new(&pipeline, 0..end)).collect();
        let parts = [&draws[..2], &[], &draws[2..], &[]].map(<[_]>::to_vec);
        for list in [DrawList::Parts(&parts), DrawList::from(&draws[..])] {
            let mut iter = list.iter();
            for end in 0..5 {
                assert_eq!(iter.len(), 5 - end as usize);
                assert_eq!(iter.next().map(|draw| draw.elements.end), Some(end));
            }
            assert!(iter.next().is_none());
            assert_eq!((list.len(), list.is_empty()), (5, false));
        }
        assert!(DrawList::default().is_empty() && DrawList::Parts(&[]).is_empty());
    }
}
