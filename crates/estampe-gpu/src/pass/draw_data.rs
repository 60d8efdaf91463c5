//! What the draws of a pass refer to, as the core sees it: plain data.

use super::{Draw, PassErrorKind};
use crate::bind_group::bound;
use crate::buffer::StoredBuffers;
use crate::immediates::immediate_words;
use crate::texture::StoredTextures;
use crate::{BindGroup, BufferSlice, Context, RenderPipeline};
use estampe_types::bindings::BoundResources;
use estampe_types::{Bindings, BufferData};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// The pipelines of a bind group that are told apart: of one with more, texels may be read.
const MOST_USES: usize = 16;

/// The bind groups of a pass, each once.
#[derive(Debug)]
pub(super) struct Groups<'a> {
    pub(super) distinct: Vec<&'a BindGroup>,
    /// The pipelines that each is used with, and its number there.
    uses: Vec<Vec<(&'a RenderPipeline, u32)>>,
    /// The index of each by its id.
    indices: BTreeMap<usize, usize>,
}

impl<'a> Groups<'a> {
    pub(super) fn of(draws: &[Draw<'a>]) -> Self {
        let mut groups = Self {
            distinct: Vec::new(),
            uses: Vec::new(),
            indices: BTreeMap::new(),
        };
        let mut before: Option<&Draw<'a>> = None;
        for draw in draws {
            let is_as_before = before.is_some_and(|before| {
                std::ptr::eq(draw.bind_groups, before.bind_groups)
                    && std::ptr::eq(draw.pipeline, before.pipeline)
            });
            if is_as_before {
                continue;
            }
            for (group, number) in draw.bind_groups.iter().zip(0..) {
                let index = groups.index_of(group).unwrap_or_else(|| {
                    let index = groups.distinct.len();
                    groups.indices.insert(group.id(), index);
                    groups.distinct.push(group);
                    groups.uses.push(Vec::new());
                    index
                });
                let is_known = |used: &(&RenderPipeline, u32)| {
                    std::ptr::eq(used.0, draw.pipeline) && used.1 == number
                };
                // Draws with the same pipeline follow each other, mostly.
                let uses = &mut groups.uses[index];
                if uses.len() <= MOST_USES && !uses.iter().rev().any(is_known) {
                    uses.push((draw.pipeline, number));
                }
            }
            before = Some(draw);
        }
        groups
    }

    fn index_of(&self, group: &BindGroup) -> Option<usize> {
        self.indices.get(&group.id()).copied()
    }

    pub(super) fn resources(
        &self,
        context: &Context,
        (textures, buffers): (&mut StoredTextures, &StoredBuffers<'_>),
    ) -> Result<Vec<Arc<BoundResources>>, PassErrorKind> {
        let groups = self.distinct.iter().zip(&self.uses);
        let resources = groups.map(|(group, uses)| {
            let reads_texels = |binding| {
                let mut uses = uses.iter();
                uses.len() > MOST_USES
                    || uses.any(|(pipeline, number)| pipeline.reads_texels(*number, binding))
            };
            let stores = (&mut *textures, buffers);
            let resources = group.resources(context, stores, reads_texels);
            resources.map_err(|error| PassErrorKind::Texture {
                attachment: group.name(),
                error,
            })
        });
        resources.collect()
    }
}

/// Draws whose data one thread makes.
pub(super) const PART_DRAWS: usize = 512;

/// The plain data that the draws of a pass refer to, made on all threads.
#[derive(Debug, Default)]
pub(crate) struct DrawData {
    /// The data of each [`PART_DRAWS`] draws; more than there are draws for are empty.
    parts: Vec<PartData>,
}

/// The plain data of a part of a pass's draws.
#[derive(Debug, Default)]
struct PartData {
    buffers: Vec<BufferData>,
    bindings: Vec<Bindings>,
    /// For each draw: its vertex buffers, its index buffer, its bindings.
    of_draws: Vec<(Range<usize>, Option<usize>, Option<usize>)>,
}

/// Memory of a pass's draws, kept for the next pass.
#[derive(Debug, Default)]
pub(crate) struct DrawMemory {
    pub(super) data: DrawData,
    pub(super) draws: Vec<estampe_core::Draw<'static>>,
}

impl DrawMemory {
    /// Lets go of what the draws refer to, on all threads.
    pub(super) fn clear(&mut self, context: &Context) {
        self.draws.clear();
        context.for_each(&mut self.data.parts, PartData::clear);
    }
}

impl DrawData {
    pub(super) fn new(
        context: &Context,
        draws: &[Draw<'_>],
        groups: &Groups<'_>,
        resources: &[Arc<BoundResources>],
    ) -> Self {
        let mut data = Self::default();
        data.fill(context, draws, groups, resources);
        data
    }

    /// Makes the data of draws in memory that holds none.
    pub(super) fn fill(
        &mut self,
        context: &Context,
        draws: &[Draw<'_>],
        groups: &Groups<'_>,
        resources: &[Arc<BoundResources>],
    ) {
        let parts = draws.chunks(PART_DRAWS);
        if self.parts.len() < parts.len() {
            self.parts.resize_with(parts.len(), PartData::default);
        }
        let mut jobs: Vec<_> = self.parts.iter_mut().zip(parts).collect();
        context.for_each(&mut jobs, |(part, draws)| {
            part.fill(draws, groups, resources);
        });
    }

    /// The draws as the core sees them.
    pub(crate) fn draws<'a>(
        &'a self,
        context: &Context,
        draws: &[Draw<'a>],
    ) -> Vec<estampe_core::Draw<'a>> {
        let mut all = Vec::new();
        self.draws_into(context, draws, &mut all);
        all
    }

    /// The draws as the core sees them, in an empty list.
    pub(super) fn draws_into<'a>(
        &'a self,
        context: &Context,
        draws: &[Draw<'a>],
        into: &mut Vec<estampe_core::Draw<'a>>,
    ) {
        debug_assert!(into.is_empty(), "a list that was cleared");
        let Some(first) = draws.first() else {
            return;
        };
        // Each is replaced.
        into.resize(
            draws.len(),
            estampe_core::Draw::new(first.pipeline, first.elements.clone()),
        );
        let parts = self.parts.iter().zip(draws.chunks(PART_DRAWS));
        let mut jobs: Vec<_> = into.chunks_mut(PART_DRAWS).zip(parts).collect();
        context.for_each(&mut jobs, |(into, (part, draws))| {
            for ((into, draw), data) in into.iter_mut().zip(*draws).zip(&part.of_draws) {
                *into = part.draw(draw, data);
            }
        });
    }
}

impl PartData {
    fn clear(&mut self) {
        self.buffers.clear();
        self.bindings.clear();
        self.of_draws.clear();
    }

    /// Makes the data of draws.
    fn fill(&mut self, draws: &[Draw<'_>], groups: &Groups<'_>, resources: &[Arc<BoundResources>]) {
        let mut before: Option<&Draw<'_>> = None;
        let mut last = (0..0, None, None);
        for draw in draws {
            let is_same = |same: fn(&Draw<'_>, &Draw<'_>) -> bool| {
                before.is_some_and(|before| same(before, draw))
            };
            if !is_same(|a, b| same_slices(a.vertex_buffers, b.vertex_buffers)) {
                let first = self.buffers.len();
                self.buffers.extend(draw.vertex_buffers.iter().map(data_of));
                last.0 = first..self.buffers.len();
            }
            if !is_same(|a, b| match (a.index_buffer, b.index_buffer) {
                (Some((a, _)), Some((b, _))) => same_slice(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }) {
                last.1 = draw.index_buffer.map(|(slice, _)| {
                    self.buffers.push(data_of(slice));
                    self.buffers.len() - 1
                });
            }
            if !is_same(|a, b| a.immediates == b.immediates && same_groups(a, b)) {
                let is_bound = !draw.bind_groups.is_empty() || !draw.immediates.is_empty();
                last.2 = is_bound.then(|| {
                    let groups = bound(draw.bind_groups, draw.dynamic_offsets, |group| {
                        let index = groups.index_of(group);
                        index.map_or_else(Arc::default, |index| Arc::clone(&resources[index]))
                    });
                    self.bindings.push(Bindings {
                        groups,
                        immediates: immediate_words(draw.immediates),
                        ..Bindings::default()
                    });
                    self.bindings.len() - 1
                });
            }
            self.of_draws.push(last.clone());
            before = Some(draw);
        }
    }

    /// A draw as the core sees it.
    fn draw<'a>(
        &'a self,
        draw: &Draw<'a>,
        (vertices, indices, bindings): &(Range<usize>, Option<usize>, Option<usize>),
    ) -> estampe_core::Draw<'a> {
        let format = draw.index_buffer.map(|(_, format)| format);
        estampe_core::Draw {
            pipeline: draw.pipeline,
            vertex_buffers: &self.buffers[vertices.clone()],
            indices: indices.map(|at| &self.buffers[at]).zip(format),
            elements: draw.elements.clone(),
            instances: draw.instances.clone(),
            base_vertex: draw.base_vertex,
            bindings: bindings.map(|at| &self.bindings[at]),
            viewport: draw.viewport,
            scissor: draw.scissor,
            more_viewports: draw.more_viewports,
            blend_constant: draw.blend_constant,
            stencil_reference: draw.stencil_reference,
            depth_bounds: draw.depth_bounds,
            occlusion_query: draw.occlusion_query,
        }
    }
}

fn data_of(slice: &BufferSlice) -> BufferData {
    // The slice was checked: it lies in the buffer.
    let bytes = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
    slice
        .buffer
        .data()
        .slice(bytes(slice.offset), bytes(slice.size))
}

fn same_slice(a: &BufferSlice, b: &BufferSlice) -> bool {
    a.buffer.is_same(&b.buffer) && a.offset == b.offset && a.size == b.size
}

fn same_slices(a: &[BufferSlice], b: &[BufferSlice]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_slice(a, b))
}

fn same_groups(a: &Draw<'_>, b: &Draw<'_>) -> bool {
    let same = a.bind_groups.iter().zip(b.bind_groups);
    a.bind_groups.len() == b.bind_groups.len()
        && a.dynamic_offsets == b.dynamic_offsets
        && same.into_iter().all(|(a, b)| a.is_same(b))
}
