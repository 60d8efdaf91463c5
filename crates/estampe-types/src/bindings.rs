//! How a shader finds its uniforms, buffers and textures: by group and binding number, as in WebGPU.
//!
//! A draw names up to [`Limits::max_bind_groups`](crate::Limits) groups. Text shaders read all their
//! resources this way; a Rust shader may own its uniforms instead, and use bindings for what changes
//! from draw to draw. What is not bound reads as zeros.

use crate::{Buffer, DepthTexture, SamplerDescriptor, StorageTexture, Texture};
use std::sync::Arc;

/// One resource.
#[derive(Debug, Clone)]
pub enum Binding {
    /// Bytes of a uniform or storage buffer.
    Buffer {
        /// The whole buffer.
        buffer: Buffer,
        /// Where the binding begins, in bytes.
        offset: u32,
        /// Whether the draw adds its dynamic offset.
        has_dynamic_offset: bool,
    },
    /// A texture.
    Texture(Arc<Texture>),
    /// A depth image.
    DepthTexture(DepthTexture),
    /// A texture that shaders store to.
    StorageTexture(StorageTexture),
    /// How a texture is sampled.
    Sampler(SamplerDescriptor),
}

/// Resources that are bound together: (binding number, resource).
#[derive(Debug, Clone, Default)]
pub struct BindGroup {
    /// The entries, in any order.
    pub entries: Vec<(u32, Binding)>,
}

/// What one draw binds.
#[derive(Debug, Clone, Default)]
pub struct Bindings {
    /// Each group and the dynamic offset, in bytes, of those of its buffers that have one.
    pub groups: Vec<(Arc<BindGroup>, u32)>,
}

impl Bindings {
    /// The resource at a group and binding number.
    #[inline]
    #[must_use]
    pub fn get(&self, group: u32, binding: u32) -> Option<&Binding> {
        let (group, _) = self.groups.get(group as usize)?;
        group
            .entries
            .iter()
            .find(|(number, _)| *number == binding)
            .map(|(_, entry)| entry)
    }

    /// `N` consecutive 32-bit floats of a bound buffer from a byte offset on; zeros where there is
    /// no such buffer or it ends.
    #[inline]
    #[must_use]
    pub fn f32s<const N: usize>(&self, group: u32, binding: u32, offset_bytes: u32) -> [f32; N] {
        let Some(Binding::Buffer {
            buffer,
            offset,
            has_dynamic_offset,
        }) = self.get(group, binding)
        else {
            return [0.0; N];
        };
        let dynamic = if *has_dynamic_offset {
            self.groups[group as usize].1
        } else {
            0
        };
        let start = *offset as usize + dynamic as usize + offset_bytes as usize;
        // The common case, at one look: programs read their uniforms once a packet.
        if let Some(words) = buffer.words().get(start / 4..)
            && let Some(words) = words.first_chunk::<N>()
            && start.is_multiple_of(4)
        {
            return words.map(f32::from_bits);
        }
        let mut values = [0.0; N];
        for (index, value) in values.iter_mut().enumerate() {
            *value = f32::from_bits(buffer.word_at(start + index * 4));
        }
        values
    }

    /// A 4×4 matrix of a bound buffer, by columns.
    #[inline]
    #[must_use]
    pub fn mat4(&self, group: u32, binding: u32, offset_bytes: u32) -> crate::Mat4 {
        let v: [f32; 16] = self.f32s(group, binding, offset_bytes);
        let column = |c: usize| [v[c * 4], v[c * 4 + 1], v[c * 4 + 2], v[c * 4 + 3]];
        crate::Mat4([column(0), column(1), column(2), column(3)])
    }

    /// The texture at a group and binding number.
    #[must_use]
    pub fn texture(&self, group: u32, binding: u32) -> Option<&Arc<Texture>> {
        match self.get(group, binding)? {
            Binding::Texture(texture) => Some(texture),
            _ => None,
        }
    }

    /// The storage texture at a group and binding number.
    #[inline]
    #[must_use]
    pub fn storage_texture(&self, group: u32, binding: u32) -> Option<&StorageTexture> {
        match self.get(group, binding)? {
            Binding::StorageTexture(texture) => Some(texture),
            _ => None,
        }
    }

    /// The sampler at a group and binding number.
    #[must_use]
    pub fn sampler(&self, group: u32, binding: u32) -> Option<&SamplerDescriptor> {
        match self.get(group, binding)? {
            Binding::Sampler(sampler) => Some(sampler),
            _ => None,
        }
    }

    /// The depth image at a group and binding number.
    #[inline]
    #[must_use]
    pub fn depth_texture(&self, group: u32, binding: u32) -> Option<&DepthTexture> {
        match self.get(group, binding)? {
            Binding::DepthTexture(texture) => Some(texture),
            _ => None,
        }
    }
}
