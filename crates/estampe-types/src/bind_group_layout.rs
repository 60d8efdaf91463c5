//! Bind group layouts: which kinds of resources a group has, by binding number.

use crate::{SampleType, TextureFormat, ViewDimension};
use std::fmt;
use std::sync::Arc;

/// One binding of a [`BindGroupLayout`]: WebGPU's `GPUBindGroupLayoutEntry`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BindGroupLayoutEntry {
    /// The number by which shaders name the binding.
    pub binding: u32,
    /// The kind of resource.
    pub ty: BindingType,
}

/// The kind of resource of a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BindingType {
    /// A buffer.
    Buffer {
        /// The use that shaders make of it.
        ty: BufferBindingType,
        /// If set, each draw adds an offset of its own. Dynamic offsets are given in the order of
        /// binding numbers.
        has_dynamic_offset: bool,
        /// The least size of the binding in bytes.
        min_binding_size: u64,
    },
    /// A texture.
    Texture {
        /// The kind of values that its texels have.
        sample_type: SampleType,
        /// The dimension of the view.
        view_dimension: ViewDimension,
        /// True if the texture has several samples per pixel.
        multisampled: bool,
    },
    /// A sampler.
    Sampler {
        /// True if it compares.
        comparison: bool,
    },
    /// A texture together with its sampler (Vulkan's combined image sampler): what shaders written
    /// in Rust sample.
    SampledTexture {
        /// The kind of values that its texels have.
        sample_type: SampleType,
        /// The dimension of the view.
        view_dimension: ViewDimension,
    },
    /// The depths of a 2D texture of one level, compared in the attachment's own memory: a shadow
    /// map.
    ShadowMap,
    /// A texture that shaders store to and load from.
    StorageTexture {
        /// The format of its texels.
        format: TextureFormat,
        /// The dimension of the view.
        view_dimension: ViewDimension,
    },
}

impl BindingType {
    /// A uniform buffer of at least so many bytes, without dynamic offset.
    #[must_use]
    pub const fn uniform(min_binding_size: u64) -> Self {
        Self::Buffer {
            ty: BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size,
        }
    }

    /// A 2D texture of numbers with its sampler.
    #[must_use]
    pub const fn sampled_2d() -> Self {
        Self::SampledTexture {
            sample_type: SampleType::Float,
            view_dimension: ViewDimension::D2,
        }
    }
}

/// The use that shaders make of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BufferBindingType {
    /// Read, the same for all invocations.
    Uniform,
    /// Read, and written unless it is read-only.
    Storage {
        /// True if shaders only read it.
        read_only: bool,
    },
}

/// The kinds of resources of a bind group. Cheap to clone; layouts with the same entries are
/// compatible.
#[derive(Clone, PartialEq, Eq)]
pub struct BindGroupLayout {
    /// Sorted by binding number.
    entries: Arc<[BindGroupLayoutEntry]>,
}

impl BindGroupLayout {
    /// A layout of these entries; `None` if two have the same binding number.
    #[must_use]
    pub fn new(entries: &[BindGroupLayoutEntry]) -> Option<Self> {
        let mut entries = entries.to_vec();
        entries.sort_by_key(|entry| entry.binding);
        let is_unique = entries
            .windows(2)
            .all(|pair| pair[0].binding != pair[1].binding);
        is_unique.then(|| Self {
            entries: entries.into(),
        })
    }

    /// The entries, sorted by binding number.
    #[must_use]
    pub fn entries(&self) -> &[BindGroupLayoutEntry] {
        &self.entries
    }

    /// The entry with a binding number.
    #[must_use]
    pub fn entry(&self, binding: u32) -> Option<&BindGroupLayoutEntry> {
        let at = self
            .entries
            .binary_search_by_key(&binding, |entry| entry.binding);
        self.entries.get(at.ok()?)
    }

    /// The number of bindings with a dynamic offset.
    #[must_use]
    pub fn dynamic_offset_count(&self) -> usize {
        self.entries
            .iter()
            .filter(|entry| entry.is_dynamic())
            .count()
    }

    /// The place of a binding's dynamic offset among those of the group; `None` if it has none.
    #[must_use]
    pub fn dynamic_offset_index(&self, binding: u32) -> Option<usize> {
        self.entry(binding).filter(|entry| entry.is_dynamic())?;
        let before = self.entries.iter().filter(|entry| entry.binding < binding);
        Some(before.filter(|entry| entry.is_dynamic()).count())
    }
}

impl BindGroupLayoutEntry {
    fn is_dynamic(&self) -> bool {
        matches!(
            self.ty,
            BindingType::Buffer {
                has_dynamic_offset: true,
                ..
            }
        )
    }
}

impl fmt::Debug for BindGroupLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&*self.entries).finish()
    }
}

/// The kind as an error names it.
impl fmt::Display for BindingType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Buffer { ty, .. } => write!(f, "{ty}"),
            Self::Texture {
                sample_type,
                view_dimension,
                multisampled,
            } => {
                let samples = if *multisampled { "multisampled " } else { "" };
                write!(
                    f,
                    "a {samples}{view_dimension:?} texture of {sample_type:?}"
                )
            }
            Self::Sampler { comparison: true } => f.write_str("a comparison sampler"),
            Self::Sampler { comparison: false } => f.write_str("a sampler"),
            Self::SampledTexture {
                sample_type,
                view_dimension,
            } => write!(
                f,
                "a {view_dimension:?} texture of {sample_type:?} with its sampler"
            ),
            Self::ShadowMap => f.write_str("a shadow map"),
            Self::StorageTexture {
                format,
                view_dimension,
            } => write!(
                f,
                "a {view_dimension:?} storage texture of {}",
                format.name()
            ),
        }
    }
}

impl fmt::Display for BufferBindingType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Uniform => "a uniform buffer",
            Self::Storage { read_only: true } => "a read-only storage buffer",
            Self::Storage { read_only: false } => "a storage buffer",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn buffer(binding: u32, has_dynamic_offset: bool) -> BindGroupLayoutEntry {
        BindGroupLayoutEntry {
            binding,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset,
                min_binding_size: 0,
            },
        }
    }

    #[test]
    fn dynamic_offsets_are_in_the_order_of_bindings() {
        let entries = [buffer(7, true), buffer(1, false), buffer(3, true)];
        let layout = BindGroupLayout::new(&entries).unwrap();
        assert_eq!(layout.dynamic_offset_count(), 2);
        assert_eq!(
            [1, 3, 7, 9].map(|binding| layout.dynamic_offset_index(binding)),
            [None, Some(0), Some(1), None]
        );
        assert!(BindGroupLayout::new(&[buffer(2, true), buffer(2, false)]).is_none());
    }
}
