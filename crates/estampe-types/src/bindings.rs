//! Bindings: the uniforms, buffers and textures of a draw, found by group and binding number as in
//! WebGPU, and its immediates.
//!
//! A draw names up to [`Limits::max_bind_groups`](crate::Limits) groups. Text shaders read all
//! their resources through bindings. A Rust shader may own its uniforms and textures instead, and
//! use bindings for values that change from draw to draw. A resource that is not bound reads as
//! zeros.

use crate::{BufferData, SamplerDescriptor, ShadowMap, StorageBuffer, StorageTexture};
use std::any::Any;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// One resource.
#[derive(Debug, Clone)]
pub enum BoundResource {
    /// Bytes of a uniform or storage buffer that is only read.
    Buffer {
        /// The bytes; the binding starts at `offset`.
        buffer: BufferData,
        /// Start of the binding, in bytes from the start of the buffer.
        offset: u32,
        /// Length of the binding in bytes. What lies beyond the buffer's end is no part of it.
        size: u32,
        /// If set, the index of the dynamic offset of this group that is added to `offset`.
        dynamic_offset: Option<u8>,
    },
    /// Bytes of a storage buffer that shaders write; the fields are those of `Buffer`.
    StorageBuffer {
        /// The bytes.
        buffer: StorageBuffer,
        /// Start of the binding, in bytes from the start of the buffer.
        offset: u32,
        /// Length of the binding in bytes.
        size: u32,
        /// If set, the index of the dynamic offset of this group that is added to `offset`.
        dynamic_offset: Option<u8>,
    },
    /// A shadow map.
    ShadowMap(ShadowMap),
    /// A texture that fragment shaders store to.
    StorageTexture(StorageTexture),
    /// The state by which a texture is sampled.
    Sampler(SamplerDescriptor),
    /// A value of a crate above this one, such as a texture with its sampler.
    Other(OtherResource),
}

/// A resource of any type: see [`Bindings::other`].
#[derive(Clone)]
pub struct OtherResource(pub Arc<dyn Any + Send + Sync>);

impl std::fmt::Debug for OtherResource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("OtherResource")
    }
}

/// Resources that are bound together, as pairs of binding number and resource.
#[derive(Debug, Clone, Default)]
pub struct BoundResources {
    /// The entries, in any order.
    pub entries: Vec<(u32, BoundResource)>,
}

/// The most dynamic offsets of a bind group: WebGPU's 8 uniform and 4 storage buffers.
pub const MAX_DYNAMIC_OFFSETS: usize = 12;

/// A bind group as a draw binds it.
#[derive(Debug, Clone, Default)]
pub struct BoundGroup {
    /// The resources.
    pub group: Arc<BoundResources>,
    /// Offsets in bytes, which are added to those of the buffers that name them.
    pub dynamic_offsets: [u32; MAX_DYNAMIC_OFFSETS],
}

/// The resources that one draw binds.
#[derive(Debug, Clone, Default)]
pub struct Bindings {
    /// By group number.
    pub groups: Vec<BoundGroup>,
    /// The words of the immediates (Vulkan's push constants): few bytes that are part of the draw
    /// or dispatch itself. Words beyond the end read as zeros.
    pub immediates: Vec<u32>,
    /// What a shader's dry run reads, where nothing is bound.
    #[doc(hidden)]
    pub unbound: Option<Arc<Unbound>>,
}

/// What a dry run reads, and whether it asked for a resource that is not there.
#[doc(hidden)]
#[derive(Debug, Default)]
pub struct Unbound {
    /// Every word, as an integer; as a float it has the same value.
    word: u16,
    /// Every shadow map: of as many texels along a side, none if the word is 0.
    shadow_map: OnceLock<ShadowMap>,
    is_missed: AtomicBool,
    reads_words: AtomicBool,
}

impl Unbound {
    pub(crate) fn new(word: u16) -> Self {
        Self {
            word,
            ..Self::default()
        }
    }

    /// True if a resource was asked for that may be there in a draw.
    pub(crate) fn is_missed(&self) -> bool {
        self.is_missed.load(Ordering::Relaxed)
    }

    /// True if something was read that differs between words.
    pub(crate) fn reads_words(&self) -> bool {
        self.reads_words.load(Ordering::Relaxed)
    }
}

impl Bindings {
    /// Notes, in a dry run, that a resource was asked for that is not bound.
    #[doc(hidden)]
    #[cold]
    pub fn miss(&self) {
        if let Some(unbound) = &self.unbound {
            unbound.is_missed.store(true, Ordering::Relaxed);
        }
    }

    /// The word that is read where nothing is bound.
    #[cold]
    fn unbound_word(&self) -> u32 {
        self.unbound.as_ref().map_or(0, |unbound| {
            unbound.reads_words.store(true, Ordering::Relaxed);
            u32::from(unbound.word)
        })
    }

    /// The shadow map where none is bound. A dry run tries some, as it does with words: a body that
    /// compares with one may take no derivatives all the same.
    #[cold]
    fn unbound_shadow_map(&self) -> Option<&ShadowMap> {
        let unbound = self.unbound.as_ref()?;
        unbound.reads_words.store(true, Ordering::Relaxed);
        let side = unbound.word;
        let map = || {
            let depths = vec![0.5; usize::from(side) * usize::from(side)];
            ShadowMap::from_rows(side.into(), side.into(), &depths)
        };
        (side > 0).then(|| unbound.shadow_map.get_or_init(map))
    }

    /// A resource, or nothing, which a dry run notes.
    #[inline]
    fn found<T>(&self, resource: Option<T>) -> Option<T> {
        if resource.is_none() {
            self.miss();
        }
        resource
    }

    /// The resource at a group and binding number; `None` if nothing is bound there.
    #[inline]
    #[must_use]
    pub fn get(&self, group: u32, binding: u32) -> Option<&BoundResource> {
        let bound = self.groups.get(group as usize)?;
        bound
            .group
            .entries
            .iter()
            .find(|(number, _)| *number == binding)
            .map(|(_, entry)| entry)
    }

    /// `N` consecutive 32-bit words of the bound buffer, starting at a byte offset. Words beyond
    /// the buffer's end, and all words if no buffer is bound, are zero.
    #[inline]
    #[must_use]
    pub fn u32s<const N: usize>(&self, group: u32, binding: u32, offset_bytes: u32) -> [u32; N] {
        let Some(BoundResource::Buffer {
            buffer,
            offset,
            dynamic_offset,
            ..
        }) = self.get(group, binding)
        else {
            return self.stored_words(group, binding, offset_bytes);
        };
        let start = self.start(group, *offset, *dynamic_offset) + offset_bytes as usize;
        // Fast path for aligned offsets inside the buffer: programs read their uniforms once per
        // packet.
        if let Some(words) = buffer.words().get(start / 4..)
            && let Some(words) = words.first_chunk::<N>()
            && start.is_multiple_of(4)
        {
            return *words;
        }
        let mut values = [0; N];
        for (index, value) in values.iter_mut().enumerate() {
            *value = buffer.word_at(start + index * 4);
        }
        values
    }

    /// Words of a storage buffer that shaders write.
    #[cold]
    fn stored_words<const N: usize>(
        &self,
        group: u32,
        binding: u32,
        offset_bytes: u32,
    ) -> [u32; N] {
        let Some((buffer, range)) = self.stored(group, binding) else {
            return [self.unbound_word(); N];
        };
        let first = (range.start + offset_bytes as usize) / 4;
        std::array::from_fn(|at| buffer.load(first + at))
    }

    /// The first byte of a binding.
    #[inline(always)]
    fn start(&self, group: u32, offset: u32, dynamic_offset: Option<u8>) -> usize {
        let offsets = &self.groups[group as usize].dynamic_offsets;
        let dynamic = dynamic_offset.and_then(|index| offsets.get(usize::from(index)));
        offset as usize + dynamic.copied().unwrap_or_default() as usize
    }

    /// The buffer that is only read at a group and binding number, and the bytes of the binding.
    #[must_use]
    pub fn buffer(&self, group: u32, binding: u32) -> Option<(&BufferData, Range<usize>)> {
        let bound = match self.get(group, binding) {
            Some(BoundResource::Buffer {
                buffer,
                offset,
                size,
                dynamic_offset,
            }) => {
                let start = self.start(group, *offset, *dynamic_offset);
                Some((buffer, range(start, *size, buffer.len_bytes())))
            }
            _ => None,
        };
        self.found(bound)
    }

    /// The buffer that shaders write at a group and binding number, and the bytes of the binding.
    #[must_use]
    pub fn storage_buffer(
        &self,
        group: u32,
        binding: u32,
    ) -> Option<(&StorageBuffer, Range<usize>)> {
        self.found(self.stored(group, binding))
    }

    fn stored(&self, group: u32, binding: u32) -> Option<(&StorageBuffer, Range<usize>)> {
        match self.get(group, binding)? {
            BoundResource::StorageBuffer {
                buffer,
                offset,
                size,
                dynamic_offset,
            } => {
                let start = self.start(group, *offset, *dynamic_offset);
                Some((buffer, range(start, *size, buffer.len_bytes())))
            }
            _ => None,
        }
    }

    /// `N` consecutive 32-bit floats of the bound buffer, as [`Bindings::u32s`].
    #[inline]
    #[must_use]
    pub fn f32s<const N: usize>(&self, group: u32, binding: u32, offset_bytes: u32) -> [f32; N] {
        let words = self.u32s(group, binding, offset_bytes);
        if self.unbound.is_some() {
            return words.map(|word| word as f32);
        }
        words.map(f32::from_bits)
    }

    /// `N` consecutive 32-bit signed integers of the bound buffer, as [`Bindings::u32s`].
    #[inline]
    #[must_use]
    pub fn i32s<const N: usize>(&self, group: u32, binding: u32, offset_bytes: u32) -> [i32; N] {
        self.u32s(group, binding, offset_bytes)
            .map(u32::cast_signed)
    }

    /// A 4×4 matrix of the bound buffer, stored by columns.
    #[inline]
    #[must_use]
    pub fn mat4(&self, group: u32, binding: u32, offset_bytes: u32) -> crate::Mat4 {
        let v: [f32; 16] = self.f32s(group, binding, offset_bytes);
        let column = |c: usize| [v[c * 4], v[c * 4 + 1], v[c * 4 + 2], v[c * 4 + 3]];
        crate::Mat4([column(0), column(1), column(2), column(3)])
    }

    /// `N` consecutive words of the immediates, from a word on.
    ///
    /// ```
    /// let bindings = estampe_types::Bindings {
    ///     immediates: vec![7, 1.5_f32.to_bits()],
    ///     ..Default::default()
    /// };
    /// assert_eq!(bindings.immediate_words(0), [7]);
    /// assert_eq!(bindings.immediate_words(1).map(f32::from_bits), [1.5, 0.0]);
    /// ```
    #[inline]
    #[must_use]
    pub fn immediate_words<const N: usize>(&self, first_word: usize) -> [u32; N] {
        let word = |at: usize| self.immediates.get(first_word.saturating_add(at));
        std::array::from_fn(|at| word(at).copied().unwrap_or_else(|| self.unbound_word()))
    }

    /// The resource of a crate above this one at a group and binding number, if it is of this type.
    #[inline]
    #[must_use]
    pub fn other<T: Any>(&self, group: u32, binding: u32) -> Option<&T> {
        match self.get(group, binding)? {
            BoundResource::Other(OtherResource(resource)) => resource.downcast_ref(),
            _ => None,
        }
    }

    /// The storage texture at a group and binding number.
    #[inline]
    #[must_use]
    pub fn storage_texture(&self, group: u32, binding: u32) -> Option<&StorageTexture> {
        self.found(match self.get(group, binding) {
            Some(BoundResource::StorageTexture(texture)) => Some(texture),
            _ => None,
        })
    }

    /// The sampler at a group and binding number.
    #[must_use]
    pub fn sampler(&self, group: u32, binding: u32) -> Option<&SamplerDescriptor> {
        self.found(match self.get(group, binding) {
            Some(BoundResource::Sampler(sampler)) => Some(sampler),
            _ => None,
        })
    }

    /// The shadow map at a group and binding number.
    #[inline]
    #[must_use]
    pub fn shadow_map(&self, group: u32, binding: u32) -> Option<&ShadowMap> {
        match self.get(group, binding) {
            Some(BoundResource::ShadowMap(texture)) => Some(texture),
            _ => self.unbound_shadow_map(),
        }
    }
}

/// The part of a binding that lies in its buffer.
fn range(start: usize, size: u32, len_bytes: usize) -> Range<usize> {
    let start = start.min(len_bytes);
    start..start.saturating_add(size as usize).min(len_bytes)
}
