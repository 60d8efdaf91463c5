//! Running a pass: objects become plain data, the core draws, results go back into the objects.

use super::attachments::Attachments;
use super::check::{check_draw, check_uses, check_vertices};
use super::{Draw, PassErrorKind, RenderPass, RenderPassError};
use crate::bind_group::BindingResource;
use crate::texture::{StoredTextures, Texture};
use crate::{BindGroup, BufferSlice, Context, Limits, Statistics};
use estampe_types::bindings::BoundResources;
use estampe_types::{Bindings, BoundGroup, BufferData, MAX_DYNAMIC_OFFSETS};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// Draws a pass.
pub(crate) fn render(
    context: &Context,
    limits: &Limits,
    pass: &RenderPass<'_>,
) -> Result<Statistics, RenderPassError> {
    run(context, limits, pass).map_err(|kind| RenderPassError {
        pass: pass.label.map(str::to_owned),
        kind,
    })
}

fn run(
    context: &Context,
    limits: &Limits,
    pass: &RenderPass<'_>,
) -> Result<Statistics, PassErrorKind> {
    let attachments = Attachments::check(pass, limits)?;
    for (number, draw) in pass.draws.iter().enumerate() {
        check_draw(number, draw, &attachments, limits)?;
    }
    check_vertices(pass.draws, limits)?;
    let groups = Groups::of(pass.draws);
    for group in &groups.distinct {
        check_uses(group, &attachments)?;
    }
    let textures = reserved_order(&attachments, &groups);
    let reserved: Vec<_> = textures.iter().map(|texture| texture.reserve()).collect();
    let mut stores = StoredTextures::default();
    let resources = groups.resources(context, &mut stores)?;
    let data = DrawData::new(pass.draws, &groups, &resources);
    let (load_colors, load_depth, load_stencil) = attachments.loads();
    let draws = data.draws(pass.draws);
    let core_pass = estampe_core::RenderPass {
        load_colors,
        load_depth,
        load_stencil,
        occlusion_queries: pass.occlusion_queries,
        control: pass.control,
        draws: &draws,
    };
    // Before anything is taken, so that a pass that is refused changes nothing.
    attachments.with_shape(|shape| core_pass.check(shape))?;
    let (mut target, depth_newest) = attachments.target(attachments.take(context)?);
    let drawn = context.render(&mut target, &core_pass);
    attachments.finish(context, target, depth_newest)?;
    drop(draws);
    // Shared texels would be copied when they are written back.
    drop(data);
    drop(resources);
    stores
        .write_back(context)
        .map_err(|error| PassErrorKind::Texture {
            attachment: "a storage texture".to_owned(),
            error,
        })?;
    drop(reserved);
    // The pass was checked, but it may have been cancelled.
    Ok(drawn?)
}

/// All textures of a pass, in the order in which they are reserved.
fn reserved_order<'a>(attachments: &Attachments<'a>, groups: &Groups<'a>) -> Vec<&'a Texture> {
    let bound = groups.distinct.iter().flat_map(|group| group.entries());
    let bound = bound.filter_map(|(_, resource)| match resource {
        BindingResource::Texture(view) | BindingResource::SampledTexture(view, _) => {
            Some(view.texture())
        }
        BindingResource::Buffer(_) | BindingResource::Sampler(_) => None,
    });
    let mut textures: Vec<&Texture> = attachments.textures().chain(bound).collect();
    textures.sort_by_key(|texture| texture.id());
    textures.dedup_by_key(|texture| texture.id());
    textures
}

/// The bind groups of a pass, each once.
#[derive(Debug)]
struct Groups<'a> {
    distinct: Vec<&'a BindGroup>,
    /// The index of each by its id.
    indices: BTreeMap<usize, usize>,
}

impl<'a> Groups<'a> {
    fn of(draws: &[Draw<'a>]) -> Self {
        let mut groups = Self {
            distinct: Vec::new(),
            indices: BTreeMap::new(),
        };
        let mut before: &[BindGroup] = &[];
        for draw in draws {
            if !std::ptr::eq(draw.bind_groups, before) {
                for group in draw.bind_groups {
                    if groups.index_of(group).is_none() {
                        let index = groups.distinct.len();
                        groups.indices.insert(group.id(), index);
                        groups.distinct.push(group);
                    }
                }
                before = draw.bind_groups;
            }
        }
        groups
    }

    fn index_of(&self, group: &BindGroup) -> Option<usize> {
        self.indices.get(&group.id()).copied()
    }

    fn resources(
        &self,
        context: &Context,
        stores: &mut StoredTextures,
    ) -> Result<Vec<Arc<BoundResources>>, PassErrorKind> {
        let resources = self.distinct.iter().map(|group| {
            let resources = group.resources(context, stores);
            resources.map_err(|error| PassErrorKind::Texture {
                attachment: group.name(),
                error,
            })
        });
        resources.collect()
    }
}

/// The plain data that the draws of a pass refer to.
#[derive(Debug)]
struct DrawData {
    buffers: Vec<BufferData>,
    bindings: Vec<Bindings>,
    /// For each draw: its vertex buffers, its index buffer, its bindings.
    of_draws: Vec<(Range<usize>, Option<usize>, Option<usize>)>,
}

impl DrawData {
    fn new(draws: &[Draw<'_>], groups: &Groups<'_>, resources: &[Arc<BoundResources>]) -> Self {
        let mut data = Self {
            buffers: Vec::new(),
            bindings: Vec::new(),
            of_draws: Vec::with_capacity(draws.len()),
        };
        let mut before: Option<&Draw<'_>> = None;
        let mut last = (0..0, None, None);
        for draw in draws {
            let is_same = |same: fn(&Draw<'_>, &Draw<'_>) -> bool| {
                before.is_some_and(|before| same(before, draw))
            };
            if !is_same(|a, b| same_slices(a.vertex_buffers, b.vertex_buffers)) {
                let first = data.buffers.len();
                data.buffers.extend(draw.vertex_buffers.iter().map(data_of));
                last.0 = first..data.buffers.len();
            }
            if !is_same(|a, b| match (a.index_buffer, b.index_buffer) {
                (Some((a, _)), Some((b, _))) => same_slice(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }) {
                last.1 = draw.index_buffer.map(|(slice, _)| {
                    data.buffers.push(data_of(slice));
                    data.buffers.len() - 1
                });
            }
            if !is_same(same_groups) {
                last.2 = (!draw.bind_groups.is_empty()).then(|| {
                    let mut offsets = draw.dynamic_offsets;
                    let bound = draw.bind_groups.iter();
                    let bound = bound.map(|group| {
                        let count = group.layout().dynamic_offset_count();
                        let (of_group, others) = offsets.split_at(count.min(offsets.len()));
                        offsets = others;
                        bound_group(group, of_group, groups, resources)
                    });
                    data.bindings.push(Bindings {
                        groups: bound.collect(),
                    });
                    data.bindings.len() - 1
                });
            }
            data.of_draws.push(last.clone());
            before = Some(draw);
        }
        data
    }

    fn draws<'a>(&'a self, draws: &[Draw<'a>]) -> Vec<estampe_core::Draw<'a>> {
        let draws = draws.iter().zip(&self.of_draws);
        let draws = draws.map(|(draw, (vertices, indices, bindings))| {
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
                blend_constant: draw.blend_constant,
                stencil_reference: draw.stencil_reference,
                depth_bounds: draw.depth_bounds,
                occlusion_query: draw.occlusion_query,
            }
        });
        draws.collect()
    }
}

fn bound_group(
    group: &BindGroup,
    offsets: &[u32],
    groups: &Groups<'_>,
    resources: &[Arc<BoundResources>],
) -> BoundGroup {
    let index = groups.index_of(group);
    let mut dynamic_offsets = [0; MAX_DYNAMIC_OFFSETS];
    for (to, offset) in dynamic_offsets.iter_mut().zip(offsets) {
        *to = *offset;
    }
    BoundGroup {
        group: index.map_or_else(Arc::default, |index| Arc::clone(&resources[index])),
        dynamic_offsets,
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
