//! Bind groups of one resource, whose label messages name.

use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupError, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferBindingType, Device, SampleType, ViewDimension,
};

pub(crate) const UNIFORM: BindingType = BindingType::Buffer {
    ty: BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: 16,
};

pub(crate) const DYNAMIC: BindingType = BindingType::Buffer {
    ty: BufferBindingType::Uniform,
    has_dynamic_offset: true,
    min_binding_size: 16,
};

pub(crate) const SAMPLED: BindingType = BindingType::SampledTexture {
    sample_type: SampleType::Float,
    view_dimension: ViewDimension::D2,
};

pub(crate) fn entry(binding: u32, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, ty }
}

/// The bind group `material` of a layout that has binding 3 alone.
pub(crate) fn material(
    device: &Device,
    ty: BindingType,
    entries: &[(u32, BindingResource)],
) -> Result<BindGroup, BindGroupError> {
    device.create_bind_group(&BindGroupDescriptor {
        label: Some("material"),
        layout: &device.create_bind_group_layout(&[entry(3, ty)])?,
        entries,
    })
}
