//! The limits of what a pipeline binds, counted over all of its bind group layouts: a shader sees
//! every binding in both stages. And the limit of the immediates that it reads.

use super::{PipelineError, RenderPipelineDescriptor};
use estampe_types::{BindGroupLayout, BindingType, BufferBindingType, Limits};

/// Checks the limits of bind groups, bindings, and bytes of colour per sample.
pub(super) fn check_bindings(
    descriptor: &RenderPipelineDescriptor,
    limits: &Limits,
) -> Result<(), PipelineError> {
    check_bind_group_layouts(&descriptor.bind_group_layouts, limits)?;
    check_immediates(descriptor.immediate_size(), limits)?;
    let both = descriptor.bind_group_layouts.len() + descriptor.vertex_buffers.len();
    let colors = descriptor.targets.iter().flatten();
    let color_bytes = colors
        .map(|target| target.format.block_bytes() as usize)
        .sum();
    check_counts(&[
        (
            "bind groups and vertex buffers",
            both,
            "max_bind_groups_plus_vertex_buffers",
            limits.max_bind_groups_plus_vertex_buffers,
        ),
        (
            "bytes of colour per sample",
            color_bytes,
            "max_color_attachment_bytes_per_sample",
            limits.max_color_attachment_bytes_per_sample,
        ),
    ])
}

/// Checks the limits of bind groups and of the bindings in them.
///
/// # Errors
/// [`PipelineError`] names the limit.
pub fn check_bind_group_layouts(
    layouts: &[BindGroupLayout],
    limits: &Limits,
) -> Result<(), PipelineError> {
    let groups = layouts.len();
    if groups > limits.max_bind_groups as usize {
        return Err(PipelineError::TooManyBindGroups {
            count: groups,
            limit: limits.max_bind_groups,
        });
    }
    let all = || {
        let entries = layouts.iter().flat_map(|layout| layout.entries());
        entries.map(|entry| entry.ty)
    };
    let count = |is_counted: fn(BindingType) -> bool| all().filter(|ty| is_counted(*ty)).count();
    check_counts(&[
        (
            "uniform buffers with a dynamic offset",
            count(|ty| is_buffer(ty, Some(true), is_uniform)),
            "max_dynamic_uniform_buffers_per_pipeline_layout",
            limits.max_dynamic_uniform_buffers_per_pipeline_layout,
        ),
        (
            "storage buffers with a dynamic offset",
            count(|ty| is_buffer(ty, Some(true), |ty| !is_uniform(ty))),
            "max_dynamic_storage_buffers_per_pipeline_layout",
            limits.max_dynamic_storage_buffers_per_pipeline_layout,
        ),
        (
            "uniform buffers",
            count(|ty| is_buffer(ty, None, is_uniform)),
            "max_uniform_buffers_per_shader_stage",
            limits.max_uniform_buffers_per_shader_stage,
        ),
        (
            "storage buffers",
            count(|ty| is_buffer(ty, None, |ty| !is_uniform(ty))),
            "max_storage_buffers_per_shader_stage",
            limits.max_storage_buffers_per_shader_stage,
        ),
        (
            "sampled textures",
            count(|ty| {
                matches!(
                    ty,
                    BindingType::Texture { .. }
                        | BindingType::SampledTexture { .. }
                        | BindingType::ShadowMap
                )
            }),
            "max_sampled_textures_per_shader_stage",
            limits.max_sampled_textures_per_shader_stage,
        ),
        (
            "samplers",
            count(|ty| {
                matches!(
                    ty,
                    BindingType::Sampler { .. } | BindingType::SampledTexture { .. }
                )
            }),
            "max_samplers_per_shader_stage",
            limits.max_samplers_per_shader_stage,
        ),
        (
            "storage textures",
            count(|ty| matches!(ty, BindingType::StorageTexture { .. })),
            "max_storage_textures_per_shader_stage",
            limits.max_storage_textures_per_shader_stage,
        ),
    ])
}

/// Checks the limit of the bytes of immediates that shaders read.
///
/// # Errors
/// [`PipelineError`] names the limit.
pub fn check_immediates(bytes: u32, limits: &Limits) -> Result<(), PipelineError> {
    check_counts(&[(
        "bytes of immediates",
        bytes as usize,
        "max_immediate_size",
        limits.max_immediate_size,
    )])
}

/// Rules: what is counted, the count, the limit's name and the limit.
fn check_counts(rules: &[(&'static str, usize, &'static str, u32)]) -> Result<(), PipelineError> {
    for &(what, count, limit_name, limit) in rules {
        if count > limit as usize {
            return Err(PipelineError::TooMany {
                what,
                count,
                limit_name,
                limit,
            });
        }
    }
    Ok(())
}

fn is_uniform(ty: BufferBindingType) -> bool {
    ty == BufferBindingType::Uniform
}

fn is_buffer(
    ty: BindingType,
    dynamic: Option<bool>,
    is_kind: fn(BufferBindingType) -> bool,
) -> bool {
    match ty {
        BindingType::Buffer {
            ty,
            has_dynamic_offset,
            ..
        } => is_kind(ty) && dynamic.is_none_or(|wanted| wanted == has_dynamic_offset),
        _ => false,
    }
}
