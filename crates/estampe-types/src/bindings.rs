//! Bindings: the uniforms, buffers and textures of a draw, found by group and binding number as in
//! WebGPU.
//!
//! A draw names up to [`Limits::max_bind_groups`](crate::Limits) groups. Text shaders read all
//! their resources through bindings. A Rust shader may own its uniforms and textures instead, and
//! use bindings for values that change from draw to draw. A resource that is not bound reads as
//! zeros.

use crate::{Buffer, DepthTexture, SamplerDescriptor, StorageTexture, Texture};
use std::sync::Arc;

/// One resource.
#[derive(Debug, Clone)]
pub enum Binding {
    /// Bytes of a uniform or storage buffer.
    Buffer {
        /// The whole buffer; the binding starts at `offset`.
        buffer: Buffer,
        /// Start of the binding, in bytes from the start of the buffer.
        offset: u32,
        /// If set, the draw's dynamic offset of this group is added to `offset`.
        has_dynamic_offset: bool,
    },
    /// A texture.
    Texture(Arc<Texture>),
    /// A depth texture, such as a shadow map.
    DepthTexture(DepthTexture),
    /// A texture that fragment shaders store to.
    StorageTexture(StorageTexture),
    /// The state by which a texture is sampled.
    Sampler(SamplerDescriptor),
}

/// Resources that are bound together, as pairs of binding number and resource.
#[derive(Debug, Clone, Default)]
pub struct BindGroup {
    /// The entries, in any order.
    pub entries: Vec<(u32, Binding)>,
}

/// The resources that one draw binds.
#[derive(Debug, Clone, Default)]
pub struct Bindings {
    /// By group number: the group, and the dynamic offset in bytes, which applies to its buffers
    /// with `has_dynamic_offset`.
    pub groups: Vec<(Arc<BindGroup>, u32)>,
}

impl Bindings {
    /// The resource at a group and binding number; `None` if nothing is bound there.
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

    /// `N` consecutive 32-bit floats of the bound buffer, starting at a byte offset. Floats beyond
    /// the buffer's end, and all floats if no buffer is bound, are zero.
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
        // Fast path for aligned offsets inside the buffer: programs read their uniforms once per
        // packet.
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

    /// A 4×4 matrix of the bound buffer, stored by columns.
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

    /// The depth texture at a group and binding number.
    #[inline]
    #[must_use]
    pub fn depth_texture(&self, group: u32, binding: u32) -> Option<&DepthTexture> {
        match self.get(group, binding)? {
            Binding::DepthTexture(texture) => Some(texture),
            _ => None,
        }
    }
}
