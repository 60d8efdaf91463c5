//! Bind groups: the resources that shaders find by group and binding number.

mod bound;
mod check;
mod error;
mod resources;

pub(crate) use bound::{BoundError, bound, check_layouts, check_offsets};
pub(crate) use check::create_layout;
pub use error::BindGroupError;

use crate::texture::{Sampler, TextureUse, TextureView};
use crate::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferSlice, Limits,
};
use check::check_entry;
use std::sync::Arc;

/// A resource of a bind group.
#[derive(Debug, Clone)]
pub enum BindingResource {
    /// A part of a buffer.
    Buffer(BufferSlice),
    /// A texture; also for [`BindingType::ShadowMap`](crate::BindingType).
    Texture(TextureView),
    /// A sampler.
    Sampler(Sampler),
    /// A texture with its sampler.
    SampledTexture(TextureView, Sampler),
}

/// Describes a bind group: WebGPU's `GPUBindGroupDescriptor`.
#[derive(Debug, Clone)]
pub struct BindGroupDescriptor<'a> {
    /// A name for error messages. Default none.
    pub label: Option<&'a str>,
    /// The kinds of resources.
    pub layout: &'a BindGroupLayout,
    /// The resources by binding number, in any order: one for each entry of the layout.
    pub entries: &'a [(u32, BindingResource)],
}

/// Resources that are bound together. Cheap to clone.
///
/// ```
/// use estampe::{BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType};
/// use estampe::{Device, DeviceDescriptor, bytes_of};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let layout = device.create_bind_group_layout(&[BindGroupLayoutEntry {
///     binding: 0,
///     ty: BindingType::uniform(16),
/// }])?;
/// let color = device.create_buffer_with_contents(bytes_of(&[1.0, 0.5, 0.0, 1.0]))?;
/// let group = device.create_bind_group(&BindGroupDescriptor {
///     label: Some("colour"),
///     layout: &layout,
///     entries: &[(0, BindingResource::Buffer(color.slice(..)))],
/// })?;
/// // Shaders read it by `input.bindings.f32s::<4>(0, 0, 0)`: group, binding, first byte.
/// assert_eq!(group.layout(), &layout);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct BindGroup {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    label: Option<String>,
    layout: BindGroupLayout,
    entries: Vec<(u32, BindingResource)>,
    /// Facts of the layout that each draw is checked by.
    dynamic_offset_count: usize,
    is_written: bool,
}

impl BindGroup {
    pub(crate) fn new(
        descriptor: &BindGroupDescriptor<'_>,
        limits: &Limits,
    ) -> Result<Self, BindGroupError> {
        let label = descriptor.label.map(str::to_owned);
        let group = name_of(label.as_deref());
        for (at, (binding, _)) in descriptor.entries.iter().enumerate() {
            let is_twice = descriptor.entries[..at].iter().any(|(b, _)| b == binding);
            if is_twice || descriptor.layout.entry(*binding).is_none() {
                return Err(BindGroupError::Unexpected {
                    group,
                    binding: *binding,
                });
            }
        }
        let mut entries = Vec::new();
        for entry in descriptor.layout.entries() {
            let given = descriptor.entries.iter();
            let found = given.clone().find(|(binding, _)| *binding == entry.binding);
            let Some((_, resource)) = found else {
                return Err(BindGroupError::Missing {
                    group,
                    binding: entry.binding,
                    expected: entry.ty,
                });
            };
            check_entry(&group, entry, resource, limits)?;
            entries.push((entry.binding, resource.clone()));
        }
        Ok(Self {
            inner: Arc::new(Inner {
                label,
                layout: descriptor.layout.clone(),
                entries,
                dynamic_offset_count: descriptor.layout.dynamic_offset_count(),
                is_written: descriptor.layout.entries().iter().any(writes),
            }),
        })
    }

    /// The layout.
    #[must_use]
    pub fn layout(&self) -> &BindGroupLayout {
        &self.inner.layout
    }

    pub(crate) fn name(&self) -> String {
        name_of(self.inner.label.as_deref())
    }

    pub(crate) fn entries(&self) -> &[(u32, BindingResource)] {
        &self.inner.entries
    }

    /// The textures, and whether shaders may store to them.
    pub(crate) fn texture_uses(&self) -> impl Iterator<Item = TextureUse<'_>> {
        self.entries().iter().filter_map(|(binding, resource)| {
            let (BindingResource::Texture(view) | BindingResource::SampledTexture(view, _)) =
                resource
            else {
                return None;
            };
            let kind = self.layout().entry(*binding).map(|entry| entry.ty);
            Some(TextureUse {
                texture: view.texture(),
                writes: matches!(kind, Some(BindingType::StorageTexture { .. })),
            })
        })
    }

    /// The number of dynamic offsets that a draw gives it.
    pub(crate) fn dynamic_offset_count(&self) -> usize {
        self.inner.dynamic_offset_count
    }

    /// Returns true if shaders may write to a resource.
    pub(crate) fn is_written(&self) -> bool {
        self.inner.is_written
    }

    /// A number that tells groups apart.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.inner).addr()
    }

    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }
}

fn writes(entry: &BindGroupLayoutEntry) -> bool {
    match entry.ty {
        BindingType::Buffer { ty, .. } => ty == BufferBindingType::Storage { read_only: false },
        BindingType::StorageTexture { .. } => true,
        _ => false,
    }
}

fn name_of(label: Option<&str>) -> String {
    label.map_or("a bind group".to_owned(), |label| {
        format!("the bind group `{label}`")
    })
}
