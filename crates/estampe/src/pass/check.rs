//! The checks of a pass's draws that need the objects: buffers, bind groups, uses of one image.

use super::attachments::Attachments;
use super::{Draw, PassErrorKind};
use crate::bind_group::{BindingResource, offset_alignment};
use crate::{
    BindGroup, BindGroupLayoutEntry, BindingType, BufferError, BufferSlice, BufferUsages, Limits,
};
use estampe_types::state::{ColorTargetState, DepthStencilState};

/// Checks a draw.
pub(super) fn check_draw(
    number: usize,
    draw: &Draw<'_>,
    attachments: &Attachments<'_>,
    limits: &Limits,
) -> Result<(), PassErrorKind> {
    check_formats(number, draw, attachments)?;
    check_read_only(number, draw, attachments.read_only())?;
    check_buffers(number, draw)?;
    check_groups(number, draw, limits)
}

/// Checks that the vertices of all draws together keep the limit.
pub(super) fn check_vertices(draws: &[Draw<'_>], limits: &Limits) -> Result<(), PassErrorKind> {
    let limit = limits.max_pass_vertices;
    let mut vertices = 0_u64;
    for (number, draw) in draws.iter().enumerate() {
        let len = |range: &std::ops::Range<u32>| range.end.saturating_sub(range.start);
        let elements = u64::from(len(&draw.elements)) * u64::from(len(&draw.instances));
        vertices = vertices.saturating_add(elements);
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

fn check_groups(number: usize, draw: &Draw<'_>, limits: &Limits) -> Result<(), PassErrorKind> {
    let layouts = &draw.pipeline.descriptor().bind_group_layouts;
    let bad = |group: usize, rule: String| {
        Err(PassErrorKind::BindGroup {
            draw: number,
            group,
            rule,
        })
    };
    let most = limits.max_bind_groups as usize;
    if draw.bind_groups.len() > most {
        return bad(most, format!("the limit max_bind_groups is {most}"));
    }
    for (index, layout) in layouts.iter().enumerate() {
        let Some(bound) = draw.bind_groups.get(index) else {
            let rule = "the pipeline needs it, and the draw binds none".to_owned();
            return bad(index, rule);
        };
        if bound.layout() != layout {
            let rule = format!(
                "{} has the layout {:?}, and the pipeline needs {layout:?}",
                bound.name(),
                bound.layout()
            );
            return bad(index, rule);
        }
    }
    let mut offsets = draw.dynamic_offsets;
    for (index, group) in draw.bind_groups.iter().enumerate() {
        let is_storage =
            |entry: &BindGroupLayoutEntry| matches!(entry.ty, BindingType::StorageTexture { .. });
        if !draw.pipeline.stores() && group.layout().entries().iter().any(is_storage) {
            let name = group.name();
            let rule = format!(
                "{name} has a storage texture, and the shader declares no stores: set its constant \
                 `STORES`"
            );
            return bad(index, rule);
        }
        let count = group.layout().dynamic_offset_count();
        let Some((of_group, others)) = offsets.split_at_checked(count) else {
            let (name, given) = (group.name(), draw.dynamic_offsets.len());
            let rule = format!(
                "{name} has {count} dynamic offsets, and {} of the {given} that the draw gives are left for it",
                offsets.len()
            );
            return bad(index, rule);
        };
        offsets = others;
        if count > 0
            && let Err(rule) = check_dynamic_offsets(group, of_group, limits)
        {
            return bad(index, rule);
        }
    }
    if !offsets.is_empty() {
        let given = draw.dynamic_offsets.len();
        let rule = format!(
            "the draw gives {given} dynamic offsets, and its bind groups have {}",
            given - offsets.len()
        );
        return bad(draw.bind_groups.len().saturating_sub(1), rule);
    }
    Ok(())
}

fn check_dynamic_offsets(
    group: &BindGroup,
    offsets: &[u32],
    limits: &Limits,
) -> Result<(), String> {
    for (binding, resource) in group.entries() {
        let index = group.layout().dynamic_offset_index(*binding);
        let (Some(index), BindingResource::Buffer(slice)) = (index, resource) else {
            continue;
        };
        let alignment = match group.layout().entry(*binding).map(|entry| entry.ty) {
            Some(BindingType::Buffer { ty, .. }) => offset_alignment(ty, limits),
            _ => 4,
        };
        let offset = offsets.get(index).copied().unwrap_or_default();
        if !offset.is_multiple_of(alignment) {
            return Err(format!(
                "the dynamic offset {offset} of binding {binding} is not a multiple of {alignment}"
            ));
        }
        let end = slice.offset + slice.size + u64::from(offset);
        if end > slice.buffer.size() {
            return Err(format!(
                "binding {binding} with the dynamic offset {offset} ends at byte {end} of {}, which has {}",
                slice.buffer.name(),
                slice.buffer.size()
            ));
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
