//! The rules of layouts and bind groups.

use super::{BindGroupError, BindingResource};
use crate::texture::{TextureError, TextureUsages, TextureView};
use crate::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferSlice,
    BufferUsages, Limits, SampleType,
};

pub(crate) fn create_layout(
    entries: &[BindGroupLayoutEntry],
    limits: &Limits,
) -> Result<BindGroupLayout, BindGroupError> {
    let layout = BindGroupLayout::new(entries).ok_or(BindGroupError::BindingTwice)?;
    let too_many = |count, what, limit_name, limit| BindGroupError::TooMany {
        count,
        what,
        limit_name,
        limit,
    };
    let limit = limits.max_bindings_per_bind_group;
    if entries.len() > limit as usize {
        let name = "max_bindings_per_bind_group";
        return Err(too_many(entries.len(), "bindings", name, limit));
    }
    let limit = limits.max_dynamic_offsets_per_bind_group;
    let limit = limit.min(u32::try_from(estampe_types::MAX_DYNAMIC_OFFSETS).unwrap_or(0));
    let count = layout.dynamic_offset_count();
    if count > limit as usize {
        let name = "max_dynamic_offsets_per_bind_group";
        return Err(too_many(count, "dynamic offsets", name, limit));
    }
    Ok(layout)
}
/// Checks that a resource fits its entry of the layout.
pub(super) fn check_entry(
    group: &str,
    entry: &BindGroupLayoutEntry,
    resource: &BindingResource,
    limits: &Limits,
) -> Result<(), BindGroupError> {
    let binding = entry.binding;
    let of_texture = |error| BindGroupError::Texture {
        group: group.to_owned(),
        binding,
        error,
    };
    let kind = || BindGroupError::Kind {
        group: group.to_owned(),
        binding,
        expected: entry.ty,
        actual: describe(resource),
    };
    match (entry.ty, resource) {
        (
            BindingType::Buffer {
                ty,
                min_binding_size,
                ..
            },
            BindingResource::Buffer(slice),
        ) => check_buffer((group, binding), ty, min_binding_size, slice, limits),
        (
            BindingType::Texture {
                sample_type,
                view_dimension,
                multisampled,
            },
            BindingResource::Texture(view),
        ) if view.dimension() == view_dimension
            && sample_type_of(view) == sample_type
            && (view.texture().sample_count() > 1) == multisampled =>
        {
            require_binding(view).map_err(of_texture)
        }
        (BindingType::Sampler { comparison }, BindingResource::Sampler(sampler))
            if sampler.descriptor().compare.is_some() == comparison =>
        {
            Ok(())
        }
        (
            BindingType::SampledTexture {
                sample_type,
                view_dimension,
            },
            BindingResource::SampledTexture(view, sampler),
        ) if view.dimension() == view_dimension && sample_type_of(view) == sample_type => {
            require_binding(view).map_err(of_texture)?;
            view.check_sampler(sampler).map_err(of_texture)
        }
        (BindingType::ShadowMap, BindingResource::Texture(view))
            if view.image_key(None).is_some()
                && view.format().has_depth()
                && view.texture().sample_count() == 1 =>
        {
            require_binding(view).map_err(of_texture)
        }
        (
            BindingType::StorageTexture {
                format,
                view_dimension,
            },
            BindingResource::Texture(view),
        ) if view.dimension() == view_dimension
            && view.format() == format
            && view.is_storable() =>
        {
            let needed = TextureUsages::STORAGE_BINDING;
            view.texture().require(needed).map_err(of_texture)
        }
        _ => Err(kind()),
    }
}

fn require_binding(view: &TextureView) -> Result<(), TextureError> {
    view.texture().require(TextureUsages::TEXTURE_BINDING)
}

fn sample_type_of(view: &TextureView) -> SampleType {
    let format = view.format();
    if view.aspect() == crate::TextureAspect::Stencil {
        SampleType::Uint
    } else {
        format.sample_type()
    }
}

/// The multiple that the offset of a buffer binding must be of, in bytes.
pub(super) fn offset_alignment(ty: BufferBindingType, limits: &Limits) -> u32 {
    let alignment = match ty {
        BufferBindingType::Uniform => limits.min_uniform_buffer_offset_alignment,
        BufferBindingType::Storage { .. } => limits.min_storage_buffer_offset_alignment,
    };
    alignment.max(4)
}

fn check_buffer(
    (group, binding): (&str, u32),
    ty: BufferBindingType,
    least: u64,
    slice: &BufferSlice,
    limits: &Limits,
) -> Result<(), BindGroupError> {
    let (usage, most) = match ty {
        BufferBindingType::Uniform => (
            BufferUsages::UNIFORM,
            limits.max_uniform_buffer_binding_size,
        ),
        BufferBindingType::Storage { .. } => (
            BufferUsages::STORAGE,
            limits.max_storage_buffer_binding_size,
        ),
    };
    let alignment = offset_alignment(ty, limits);
    let of_buffer = |error| BindGroupError::Buffer {
        group: group.to_owned(),
        binding,
        error,
    };
    slice.buffer.require(usage).map_err(of_buffer)?;
    let range = slice.buffer.range(slice.offset, slice.size);
    range.map_err(of_buffer)?;
    let is_aligned = slice.offset.is_multiple_of(u64::from(alignment));
    if !is_aligned || slice.size < least.max(1) || slice.size > most {
        return Err(BindGroupError::BufferRange {
            group: group.to_owned(),
            binding,
            offset: slice.offset,
            size: slice.size,
            alignment,
            least: least.max(1),
            most,
        });
    }
    Ok(())
}

/// The resource as an error names it.
fn describe(resource: &BindingResource) -> String {
    let texture = |view: &TextureView| {
        let samples = view.texture().sample_count();
        let format = view.format();
        let samples = if samples > 1 { "multisampled " } else { "" };
        format!(
            "a {samples}{:?} view of {:?} ({})",
            view.dimension(),
            sample_type_of(view),
            format.name()
        )
    };
    match resource {
        BindingResource::Buffer(_) => "a buffer".to_owned(),
        BindingResource::Texture(view) => texture(view),
        BindingResource::Sampler(sampler) if sampler.descriptor().compare.is_some() => {
            "a comparison sampler".to_owned()
        }
        BindingResource::Sampler(_) => "a sampler".to_owned(),
        BindingResource::SampledTexture(view, _) => format!("{} with its sampler", texture(view)),
    }
}
