//! Bind groups: the resources that shaders find by group and binding number.

use crate::texture::{
    Sampler, StoredTextures, TextureError, TextureUsages, TextureView, sampled_texture,
};
use crate::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferError,
    BufferSlice, BufferUsages, Context, Limits, SampleType,
};
use estampe_types::bindings::{BoundResource, BoundResources, OtherResource};
use std::sync::Arc;

/// A resource of a bind group.
#[derive(Debug, Clone)]
pub enum BindingResource {
    /// A part of a buffer.
    Buffer(BufferSlice),
    /// A texture; also for [`BindingType::ShadowMap`].
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
}

/// The reason why a bind group or a layout was not created.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BindGroupError {
    /// Two entries of a layout have the same binding number.
    #[error("two entries of a bind group layout have the same binding number")]
    BindingTwice,
    /// Too many bindings, or too many with a dynamic offset.
    #[error("{count} {what} exceed the limit {limit_name} = {limit}")]
    TooMany {
        /// The number of them.
        count: usize,
        /// The kind of bindings.
        what: &'static str,
        /// The limit's name.
        limit_name: &'static str,
        /// The limit.
        limit: u32,
    },
    /// A layout entry without resource.
    #[error("binding {binding} of {group} is {expected}, and there is no resource for it")]
    Missing {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The kind of resource.
        expected: BindingType,
    },
    /// A resource that the layout does not name, or one that is given twice.
    #[error("binding {binding} of {group} is given twice, or is not in the layout")]
    Unexpected {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
    },
    /// A resource of another kind.
    #[error("binding {binding} of {group} is {expected}, and the resource is {actual}")]
    Kind {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The kind of resource in the layout.
        expected: BindingType,
        /// The resource.
        actual: String,
    },
    /// An offset or size that a buffer binding cannot have.
    #[error(
        "binding {binding} of {group} is {size} bytes at offset {offset} of a buffer: the offset must be a \
         multiple of {alignment}, the size {least} to {most} bytes"
    )]
    BufferRange {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The offset in bytes.
        offset: u64,
        /// The size in bytes.
        size: u64,
        /// The multiple that the offset must be of.
        alignment: u32,
        /// The least size.
        least: u64,
        /// The greatest size.
        most: u64,
    },
    /// A buffer cannot be bound.
    #[error("binding {binding} of {group}: {error}")]
    Buffer {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The reason.
        error: BufferError,
    },
    /// A texture or its sampler cannot be bound.
    #[error("binding {binding} of {group}: {error}")]
    Texture {
        /// The bind group.
        group: String,
        /// The binding number.
        binding: u32,
        /// The reason.
        error: TextureError,
    },
}

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

    /// A number that tells groups apart.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.inner).addr()
    }

    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    /// The resources as they are now, as programs read them. Textures that shaders store to are
    /// shared through `stores`.
    pub(crate) fn resources(
        &self,
        context: &Context,
        stores: &mut StoredTextures,
    ) -> Result<Arc<BoundResources>, TextureError> {
        let layout = &self.inner.layout;
        let entries = self.inner.entries.iter().map(|(binding, resource)| {
            let kind = layout.entry(*binding).map(|entry| entry.ty);
            let bound = match resource {
                BindingResource::Buffer(slice) => {
                    let index = layout.dynamic_offset_index(*binding);
                    bound_buffer(slice, index)
                }
                BindingResource::Texture(view) => match kind {
                    Some(BindingType::ShadowMap) => shadow_map(context, view)?,
                    Some(BindingType::StorageTexture { .. }) => {
                        BoundResource::StorageTexture(stores.get(context, view)?)
                    }
                    _ => BoundResource::Other(OtherResource(Arc::new(view.texels(context)?))),
                },
                BindingResource::Sampler(sampler) => BoundResource::Sampler(*sampler.descriptor()),
                BindingResource::SampledTexture(view, sampler) => {
                    let sampled = sampled_texture(context, view, sampler)?;
                    BoundResource::Other(OtherResource(Arc::new(sampled)))
                }
            };
            Ok((*binding, bound))
        });
        let entries: Result<Vec<_>, TextureError> = entries.collect();
        Ok(Arc::new(BoundResources { entries: entries? }))
    }
}

fn bound_buffer(slice: &BufferSlice, dynamic_offset: Option<usize>) -> BoundResource {
    let data = slice.buffer.data();
    let end = usize::try_from(slice.offset + slice.size).unwrap_or(usize::MAX);
    let dynamic_offset = dynamic_offset.and_then(|index| u8::try_from(index).ok());
    BoundResource::Buffer {
        // What follows a dynamic binding is checked with the offset of the draw.
        buffer: if dynamic_offset.is_some() {
            data
        } else {
            data.slice(0, end)
        },
        offset: u32::try_from(slice.offset).unwrap_or(u32::MAX),
        dynamic_offset,
    }
}

fn shadow_map(context: &Context, view: &TextureView) -> Result<BoundResource, TextureError> {
    let texture = view.texture();
    let map = match view.image_key(None) {
        Some(key) => texture.lock().shadow_map(texture, context, key)?,
        None => None,
    };
    Ok(BoundResource::ShadowMap(map.unwrap_or_default()))
}

fn name_of(label: Option<&str>) -> String {
    label.map_or("a bind group".to_owned(), |label| {
        format!("the bind group `{label}`")
    })
}

fn check_entry(
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
    let of_buffer = |error| BindGroupError::Buffer {
        group: group.to_owned(),
        binding,
        error,
    };
    slice.buffer.require(usage).map_err(of_buffer)?;
    let range = slice.buffer.range(slice.offset, slice.size);
    range.map_err(of_buffer)?;
    let alignment = limits.min_buffer_offset_alignment.max(4);
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
