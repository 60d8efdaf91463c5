//! What the draws of a pass refer to, as the core sees it: plain data.

use super::check::DrawCheck;
use super::survey::{PartSurvey, same_lists};
use super::{Draw, PassErrorKind};
use crate::bind_group::bound;
use crate::buffer::StoredBuffers;
use crate::immediates::immediate_words;
use crate::texture::StoredTextures;
use crate::{BindGroup, BufferSlice, Context, RenderPipeline};
use estampe_core::DrawNeeds;
use estampe_types::bindings::BoundResources;
use estampe_types::shader::TextureReads;
use estampe_types::{Bindings, BufferData};
use std::collections::BTreeMap;
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
    /// The groups of draws, of which those with some numbers bind all.
    pub(super) fn of(draws: &[Draw<'a>], changes: impl Iterator<Item = usize>) -> Self {
        let mut groups = Self {
            distinct: Vec::new(),
            uses: Vec::new(),
            indices: BTreeMap::new(),
        };
        let mut before: Option<&Draw<'a>> = None;
        for draw in changes.map(|number| &draws[number]) {
            if before.is_some_and(|before| same_lists(before, draw)) {
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
            let reads = |binding| {
                if uses.len() > MOST_USES {
                    return TextureReads::ALL;
                }
                let uses = uses.iter();
                let reads = uses.map(|(pipeline, number)| pipeline.texture_reads(*number, binding));
                reads.fold(TextureReads::default(), |all, reads| all | reads)
            };
            let stores = (&mut *textures, buffers);
            let resources = group.resources(context, stores, reads);
            resources.map_err(|error| PassErrorKind::Texture {
                attachment: group.name(),
                error,
            })
        });
        resources.collect()
    }
}

/// Draws whose data one thread makes at once, at most and at least.
const PART_DRAWS: [usize; 2] = [512, 16];

/// Parts for each thread, if there are enough draws.
const PARTS_PER_THREAD: usize = 2;

/// The plain data that the draws of a pass refer to, made on all threads.
#[derive(Debug, Default)]
pub(crate) struct DrawData {
    /// The data of as many draws each as a part has; more than there are draws for are empty.
    parts: Vec<PartData>,
    /// Draws of a part, but for the last one.
    part_draws: usize,
}

/// The plain data of a part of a pass's draws: that of a draw, unless it is that of the one before,
/// after that of the draws before.
#[derive(Debug, Default)]
struct PartData {
    survey: PartSurvey,
    /// Of each draw its vertex buffers, then its index buffer.
    buffers: Vec<BufferData>,
    /// Those in use, then others, whose memory is kept.
    bindings: Vec<Bindings>,
    bound: usize,
    /// True if the last draw has bindings: the last ones, or, if there are none, those of the draw
    /// before the part.
    is_bound_at_end: bool,
}

/// Memory of a pass's draws, kept for the next pass.
#[derive(Debug, Default)]
pub(crate) struct DrawMemory {
    pub(super) data: DrawData,
    /// The draws of each part.
    pub(super) draws: Vec<Vec<estampe_core::Draw<'static>>>,
}

impl DrawMemory {
    /// Lets go of what the draws refer to, on all threads.
    pub(super) fn clear(&mut self, context: &Context) {
        context.for_each(&mut self.data.parts, PartData::clear);
    }
}

impl DrawData {
    /// Looks through draws, on all threads, before their data are made. Says which is the first
    /// that breaks a rule about objects.
    pub(super) fn survey(
        &mut self,
        context: &Context,
        draws: &[Draw<'_>],
        check: &DrawCheck<'_>,
        queries: usize,
    ) -> Result<(), PassErrorKind> {
        let [most, least] = PART_DRAWS;
        let parts = PARTS_PER_THREAD.saturating_mul(context.threads());
        self.part_draws = (draws.len() / parts).clamp(least, most);
        let parts = draws.chunks(self.part_draws);
        if self.parts.len() < parts.len() {
            self.parts.resize_with(parts.len(), PartData::default);
        }
        for rest in &mut self.parts[parts.len()..] {
            rest.survey.clear();
        }
        let firsts = (0..).step_by(self.part_draws);
        let jobs = self.parts.iter_mut().zip(firsts.zip(parts));
        let mut jobs: Vec<_> = jobs.collect();
        check.attachments.with_shape(|target| {
            context.for_each(&mut jobs, |(part, (first, of_part))| {
                let numbers = *first..*first + of_part.len();
                part.survey.look((draws, numbers), check, (target, queries));
            });
        });
        let refused = |part: &mut PartData| part.survey.refused.take();
        match self.parts.iter_mut().find_map(refused) {
            Some(refused) => Err(refused),
            None => Ok(()),
        }
    }

    /// The survey of each part.
    pub(super) fn surveys(&self) -> impl Iterator<Item = &PartSurvey> + Clone {
        self.parts.iter().map(|part| &part.survey)
    }

    /// The numbers of draws among which are the first of each pipeline and list of bind groups in a
    /// row.
    pub(super) fn changes(&self) -> impl Iterator<Item = usize> {
        self.surveys()
            .flat_map(|survey| survey.changes.iter().copied())
    }

    /// The needs of the draws, if they keep the core's rules.
    pub(super) fn needs(&self) -> Result<DrawNeeds, estampe_core::RenderPassError> {
        let mut needs = DrawNeeds::default();
        for survey in self.surveys() {
            if let Some(misfit) = &survey.misfit {
                return Err(misfit.clone());
            }
            needs |= survey.needs;
        }
        Ok(needs)
    }

    /// Makes the data of draws that were looked through, in memory that holds none.
    pub(super) fn fill(
        &mut self,
        context: &Context,
        draws: &[Draw<'_>],
        groups: &Groups<'_>,
        resources: &[Arc<BoundResources>],
    ) {
        let jobs = self.parts.iter_mut().zip(draws.chunks(self.part_draws));
        let mut jobs: Vec<_> = jobs.collect();
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
        let mut parts = Vec::new();
        self.draws_into(context, draws, &mut parts);
        parts.concat()
    }

    /// The draws of each part as the core sees them, in lists whose memory is used again.
    pub(super) fn draws_into<'a>(
        &'a self,
        context: &Context,
        draws: &[Draw<'a>],
        into: &mut Vec<Vec<estampe_core::Draw<'a>>>,
    ) {
        let parts = self.parts.iter().zip(draws.chunks(self.part_draws));
        if into.len() < parts.len() {
            into.resize_with(parts.len(), Vec::new);
        }
        let mut bound_before = None;
        let jobs = into.iter_mut().zip(parts).map(|(into, (part, draws))| {
            let before = bound_before;
            bound_before = part.bound_at_end(before);
            (into, (part, before), draws)
        });
        let mut jobs: Vec<_> = jobs.collect();
        context.for_each(&mut jobs, |(into, (part, before), draws)| {
            part.draws_into((draws, *before), into);
        });
    }
}

impl PartData {
    fn clear(&mut self) {
        self.buffers.clear();
        for bindings in &mut self.bindings[..self.bound] {
            bindings.groups.clear();
            bindings.immediates.clear();
        }
        (self.bound, self.is_bound_at_end) = (0, false);
    }

    /// The bindings of the last draw, given those of the draw before the part.
    fn bound_at_end<'a>(&'a self, before: Option<&'a Bindings>) -> Option<&'a Bindings> {
        let last = self.bindings[..self.bound].last().or(before);
        last.filter(|_| self.is_bound_at_end)
    }

    /// Makes the data of draws.
    fn fill(&mut self, draws: &[Draw<'_>], groups: &Groups<'_>, resources: &[Arc<BoundResources>]) {
        let mut offsets = &self.survey.dynamic_offsets[..];
        for (draw, differs) in draws.iter().zip(&self.survey.differs) {
            if differs.vertices {
                self.buffers.extend(draw.vertex_buffers.iter().map(data_of));
            }
            if differs.indices {
                let slice = draw.index_buffer.map(|(slice, _)| data_of(slice));
                self.buffers.extend(slice);
            }
            if !differs.bindings {
                continue;
            }
            let (of_draw, others) = offsets.split_at(draw.dynamic_offsets.len());
            offsets = others;
            if !is_bound(draw) {
                continue;
            }
            if self.bindings.len() == self.bound {
                self.bindings.push(Bindings::default());
            }
            let bindings = &mut self.bindings[self.bound];
            self.bound += 1;
            let found = bound(draw.bind_groups, of_draw, |group| {
                let index = groups.index_of(group);
                index.map_or_else(Arc::default, |index| Arc::clone(&resources[index]))
            });
            bindings.groups.extend(found);
            bindings.immediates.extend(immediate_words(draw.immediates));
        }
        self.is_bound_at_end = draws.last().is_some_and(is_bound);
    }

    /// The draws as the core sees them, in a list that is cleared first, given the bindings of the
    /// draw before them.
    fn draws_into<'a>(
        &'a self,
        (draws, mut bound): (&[Draw<'a>], Option<&'a Bindings>),
        into: &mut Vec<estampe_core::Draw<'a>>,
    ) {
        let mut buffers = &self.buffers[..];
        let mut bindings = self.bindings.iter();
        let (mut vertices, mut indices) = (&[][..], None);
        let draws = draws.iter().zip(&self.survey.differs);
        into.clear();
        into.extend(draws.map(|(draw, differs)| {
            if differs.vertices {
                (vertices, buffers) = buffers.split_at(draw.vertex_buffers.len());
            }
            if differs.indices {
                let count = usize::from(draw.index_buffer.is_some());
                let (buffer, others) = buffers.split_at(count);
                (indices, buffers) = (buffer.first(), others);
            }
            if differs.bindings {
                bound = is_bound(draw).then(|| bindings.next()).flatten();
            }
            let format = draw.index_buffer.map(|(_, format)| format);
            estampe_core::Draw {
                pipeline: draw.pipeline,
                vertex_buffers: vertices,
                indices: indices.zip(format),
                elements: draw.elements.clone(),
                instances: draw.instances.clone(),
                base_vertex: draw.base_vertex,
                bindings: bound,
                viewport: draw.viewport,
                scissor: draw.scissor,
                more_viewports: draw.more_viewports,
                blend_constant: draw.blend_constant,
                stencil_reference: draw.stencil_reference,
                depth_bounds: draw.depth_bounds,
                occlusion_query: draw.occlusion_query,
            }
        }));
    }
}

/// Returns true if a draw has bind groups or immediates.
fn is_bound(draw: &Draw<'_>) -> bool {
    !draw.bind_groups.is_empty() || !draw.immediates.is_empty()
}

fn data_of(slice: &BufferSlice) -> BufferData {
    // The slice was checked: it lies in the buffer.
    let bytes = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
    slice
        .buffer
        .data()
        .slice(bytes(slice.offset), bytes(slice.size))
}
