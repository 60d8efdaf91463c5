//! The checks of a pass's draws that need the objects: buffers, bind groups, uses of one image.

use super::attachments::Attachments;
use super::survey::{same_lists, vertices as vertices_of};
use super::{Draw, PassErrorKind};
use crate::bind_group::{BindingResource, BoundError, check_layouts, check_offsets};
use crate::buffer::check_conflicts;
use crate::immediates::check_immediates;
use crate::{
    BindGroup, BindGroupLayoutEntry, BindingType, BufferError, BufferSlice, BufferUsages, Limits,
};
use estampe_types::state::{ColorTargetState, DepthStencilState};

/// The rules of draws that are about objects, and what they are checked against.
#[derive(Debug)]
pub(super) struct DrawCheck<'a> {
    pub(super) attachments: &'a Attachments<'a>,
    pub(super) limits: &'a Limits,
}

impl DrawCheck<'_> {
    /// Checks a draw, but for what it shares with the one before, which was checked.
    pub(super) fn check(
        &self,
        number: usize,
        draw: &Draw<'_>,
        before: Option<&Draw<'_>>,
    ) -> Result<(), PassErrorKind> {
        let &Self {
            attachments,
            limits,
        } = self;
        let before = before.filter(|before| std::ptr::eq(before.pipeline, draw.pipeline));
        if before.is_none() {
            check_formats(number, draw, attachments)?;
            check_read_only(number, draw, attachments.read_only())?;
        }
        if !before.is_some_and(|before| same_buffers(before, draw)) {
            check_buffers(number, draw)?;
        }
        let same_groups = before.is_some_and(|before| same_lists(before, draw));
        check_groups(number, draw, same_groups, limits)?;
        if before.is_some_and(|before| before.immediates.len() == draw.immediates.len()) {
            return Ok(());
        }
        let needed = draw.pipeline.descriptor().immediate_size();
        check_immediates(draw.immediates, needed, limits).map_err(|error| {
            PassErrorKind::Immediates {
                draw: number,
                error,
            }
        })
    }
}

/// Returns true if the buffers that two draws fetch from are the same lists.
fn same_buffers(a: &Draw<'_>, b: &Draw<'_>) -> bool {
    let indices = |draw: &Draw<'_>| {
        draw.index_buffer
            .map(|(slice, _)| std::ptr::from_ref(slice))
    };
    std::ptr::eq(a.vertex_buffers, b.vertex_buffers) && indices(a) == indices(b)
}

/// Checks that the vertices of all draws together keep the limit.
pub(super) fn check_vertices(draws: &[Draw<'_>], limits: &Limits) -> Result<(), PassErrorKind> {
    let limit = limits.max_pass_vertices;
    let mut vertices = 0_u64;
    for (number, draw) in draws.iter().enumerate() {
        vertices = vertices.saturating_add(vertices_of(draw));
        if vertices > limit {
            return Err(PassErrorKind::TooManyVertices {
                draw: number,
                vertices,
                limit,
            });
        }
    }
    Ok(())
}

fn check_formats(
    number: usize,
    draw: &Draw<'_>,
    attachments: &Attachments<'_>,
) -> Result<(), PassErrorKind> {
    let targets = &draw.pipeline.descriptor().targets;
    let format = |target: &Option<ColorTargetState>| target.map(|target| target.format);
    let is_same = attachments.formats.len() <= targets.len()
        && targets.iter().enumerate().all(|(index, target)| {
            format(target) == attachments.formats.get(index).copied().flatten()
        });
    if is_same {
        return Ok(());
    }
    Err(PassErrorKind::ColorFormats {
        draw: number,
        pipeline: targets.iter().map(format).collect(),
        attachments: attachments.formats.clone(),
    })
}

fn check_read_only(
    draw_number: usize,
    draw: &Draw<'_>,
    [depth, stencil]: [bool; 2],
) -> Result<(), PassErrorKind> {
    let descriptor = draw.pipeline.descriptor();
    let tests = descriptor.depth_stencil;
    let writes_stencil =
        |state: DepthStencilState| state.stencil.is_some_and(|stencil| stencil.writes());
    let writes_depth = tests.is_some_and(|state| state.depth_write_enabled);
    let aspect = if depth && writes_depth {
        "depth"
    } else if stencil && tests.is_some_and(writes_stencil) {
        "stencil"
    } else {
        return Ok(());
    };
    Err(PassErrorKind::ReadOnly {
        draw: draw_number,
        aspect,
    })
}

fn check_buffers(number: usize, draw: &Draw<'_>) -> Result<(), PassErrorKind> {
    let expected = draw.pipeline.descriptor().vertex_buffers.len();
    let given = draw.vertex_buffers.len();
    if given != expected {
        return Err(PassErrorKind::VertexBuffers {
            draw: number,
            given,
            expected,
        });
    }
    for (index, slice) in draw.vertex_buffers.iter().enumerate() {
        let name = || format!("vertex buffer {index}");
        check_slice(number, slice, BufferUsages::VERTEX, name)?;
    }
    match draw.index_buffer {
        Some((slice, _)) => check_slice(number, slice, BufferUsages::INDEX, || {
            "the index buffer".to_owned()
        }),
        None => Ok(()),
    }
}

fn check_slice(
    draw: usize,
    slice: &BufferSlice,
    usage: BufferUsages,
    name: impl Fn() -> String,
) -> Result<(), PassErrorKind> {
    let of_buffer = |error: BufferError| PassErrorKind::Buffer {
        draw,
        buffer: name(),
        error,
    };
    slice.buffer.require(usage).map_err(of_buffer)?;
    let range = slice.buffer.range(slice.offset, slice.size);
    range.map_err(of_buffer)?;
    if !slice.offset.is_multiple_of(4) {
        return Err(PassErrorKind::Offset {
            draw,
            buffer: name(),
            offset: slice.offset,
            alignment: 4,
        });
    }
    Ok(())
}

/// Checks the bind groups of a draw and their dynamic offsets; the offsets alone where the draw
/// before has the same groups and pipeline.
fn check_groups(
    number: usize,
    draw: &Draw<'_>,
    is_as_before: bool,
    limits: &Limits,
) -> Result<(), PassErrorKind> {
    let bad = |group: usize, rule: String| PassErrorKind::BindGroup {
        draw: number,
        group,
        rule,
    };
    let of_group = |BoundError { group, rule }| bad(group, rule);
    if !is_as_before {
        let layouts = &draw.pipeline.descriptor().bind_group_layouts;
        check_layouts(layouts, draw.bind_groups, limits).map_err(of_group)?;
    }
    check_offsets(draw.bind_groups, draw.dynamic_offsets, limits).map_err(of_group)?;
    if is_as_before {
        return Ok(());
    }
    let is_storage =
        |entry: &BindGroupLayoutEntry| matches!(entry.ty, BindingType::StorageTexture { .. });
    for (index, group) in draw.bind_groups.iter().enumerate() {
        if !draw.pipeline.stores() && group.layout().entries().iter().any(is_storage) {
            let name = group.name();
            let rule = format!(
                "{name} has a storage texture, and the shader declares no stores: set its constant \
                 `STORES`"
            );
            return Err(bad(index, rule));
        }
    }
    Ok(())
}

/// Checks that a bind group does not read or store to an image that the pass writes.
pub(super) fn check_uses(
    group: &BindGroup,
    attachments: &Attachments<'_>,
) -> Result<(), PassErrorKind> {
    for (binding, resource) in group.entries() {
        let view = match resource {
            BindingResource::Texture(view) | BindingResource::SampledTexture(view, _) => view,
            BindingResource::Buffer(_) | BindingResource::Sampler(_) => continue,
        };
        let entry = group.layout().entry(*binding);
        let stores =
            entry.is_some_and(|entry| matches!(entry.ty, BindingType::StorageTexture { .. }));
        let overlaps = |image: &&super::attachments::Use<'_>| {
            (image.is_written || stores)
                && image.view.texture().is_same(view.texture())
                && view.contains(image.key)
        };
        if let Some(image) = attachments.uses().find(overlaps) {
            return Err(PassErrorKind::UsedTwice {
                first: image.role.to_string(),
                second: format!("binding {binding} of {}", group.name()),
            });
        }
    }
    Ok(())
}

/// Checks that no buffer which shaders write is used otherwise in the pass.
pub(super) fn check_buffer_uses(
    draws: &[Draw<'_>],
    groups: &[&BindGroup],
) -> Result<(), PassErrorKind> {
    let fetched = draws.iter().enumerate().flat_map(|(number, draw)| {
        let vertices = draw.vertex_buffers.iter().enumerate();
        let vertices = vertices.map(|(at, slice)| (slice, Some(at)));
        let indices = draw.index_buffer.iter().map(|(slice, _)| (*slice, None));
        vertices.chain(indices).map(move |(slice, vertex_buffer)| {
            let name = move || match vertex_buffer {
                Some(at) => format!("vertex buffer {at} of draw {number}"),
                None => format!("index buffer of draw {number}"),
            };
            (&slice.buffer, name)
        })
    });
    Ok(check_conflicts(groups, fetched)?)
}
