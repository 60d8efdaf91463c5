//! Buffers: immutable memory that a draw reads, for vertices, indices, uniforms and storage.

use estampe_simd::advise_huge_pages;
use std::sync::Arc;

/// An immutable buffer, shared by reference. The bytes are kept as little-endian 32-bit words, so
/// that lanes can gather them.
#[derive(Clone, Default)]
pub struct BufferData {
    // A vector, not `Arc<[u32]>`: a vector that several threads filled need not be copied.
    words: Arc<Vec<u32>>,
    /// The first word that belongs to the buffer.
    first_word: usize,
    len_bytes: usize,
}

impl BufferData {
    /// `len_bytes` zeros, or `None` if there is not enough memory.
    #[must_use]
    pub fn zeros(len_bytes: usize) -> Option<Self> {
        let count = len_bytes.div_ceil(4);
        let mut words = Vec::new();
        words.try_reserve_exact(count).ok()?;
        advise_huge_pages(words.spare_capacity_mut());
        words.resize(count, 0);
        Some(Self {
            words: Arc::new(words),
            first_word: 0,
            len_bytes,
        })
    }

    /// A part of the buffer, which shares its memory. The first byte is rounded down to a multiple
    /// of four; bytes beyond the buffer's end are left out.
    #[must_use]
    pub fn slice(&self, first_byte: usize, len_bytes: usize) -> Self {
        let first_byte = first_byte.min(self.len_bytes) & !3;
        Self {
            words: Arc::clone(&self.words),
            first_word: self.first_word + first_byte / 4,
            len_bytes: len_bytes.min(self.len_bytes - first_byte),
        }
    }

    /// The words, to be changed; they are copied first if something else shares them. Little-endian
    /// bytes, as [`BufferData::words`].
    #[must_use]
    pub fn words_mut(&mut self) -> &mut [u32] {
        let count = self.len_bytes.div_ceil(4);
        &mut Arc::make_mut(&mut self.words)[self.first_word..][..count]
    }

    /// A buffer with these bytes, or `None` if there is not enough memory.
    #[must_use]
    pub fn try_from_bytes(bytes: &[u8]) -> Option<Self> {
        let word = |chunk: &[u8]| {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            u32::from_le_bytes(word)
        };
        let mut words = Vec::new();
        words.try_reserve_exact(bytes.len().div_ceil(4)).ok()?;
        advise_huge_pages(words.spare_capacity_mut());
        words.extend(bytes.chunks(4).map(word));
        Some(Self {
            words: Arc::new(words),
            first_word: 0,
            len_bytes: bytes.len(),
        })
    }

    /// [`BufferData::try_from_bytes`] of few bytes.
    ///
    /// # Panics
    /// If there is not enough memory.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self::try_from_bytes(bytes).expect("not enough memory")
    }

    /// A buffer of 32-bit words.
    #[must_use]
    pub fn from_words(words: impl Into<Vec<u32>>) -> Self {
        let words: Vec<u32> = words.into();
        Self {
            len_bytes: words.len() * 4,
            first_word: 0,
            words: Arc::new(words),
        }
    }

    /// A buffer of 32-bit floats.
    #[must_use]
    pub fn from_f32s(values: &[f32]) -> Self {
        Self::from_words(
            values
                .iter()
                .map(|value| value.to_bits())
                .collect::<Vec<_>>(),
        )
    }

    /// The words; without a copy if nothing shares the memory. The buffer itself if there is not
    /// enough memory for a copy.
    pub(crate) fn try_into_words(mut self) -> Result<Vec<u32>, Self> {
        let count = self.len_bytes.div_ceil(4);
        let range = self.first_word..self.first_word + count;
        match Arc::try_unwrap(self.words) {
            Ok(words) if range == (0..words.len()) => return Ok(words),
            Ok(words) => self.words = Arc::new(words),
            Err(shared) => self.words = shared,
        }
        try_to_vec(&self.words[range]).ok_or(self)
    }

    /// The length in bytes.
    #[must_use]
    pub fn len_bytes(&self) -> usize {
        self.len_bytes
    }

    /// The contents as little-endian words; the last one is padded with zeros.
    #[must_use]
    #[inline]
    pub fn words(&self) -> &[u32] {
        let count = self.len_bytes.div_ceil(4);
        &self.words[self.first_word..][..count]
    }

    /// The byte at an offset; zero beyond the end.
    #[inline]
    #[must_use]
    pub fn byte(&self, offset: usize) -> u8 {
        let word = self.words().get(offset / 4).copied().unwrap_or_default();
        word.to_le_bytes()[offset % 4]
    }

    /// The little-endian word of the four bytes at an offset, which need not be aligned. Bytes
    /// beyond the end are zero.
    #[inline]
    #[must_use]
    pub fn word_at(&self, offset: usize) -> u32 {
        if offset.is_multiple_of(4) {
            return self.words().get(offset / 4).copied().unwrap_or_default();
        }
        u32::from_le_bytes([0, 1, 2, 3].map(|k| self.byte(offset.saturating_add(k))))
    }
}

fn try_to_vec(words: &[u32]) -> Option<Vec<u32>> {
    let mut copy = Vec::new();
    copy.try_reserve_exact(words.len()).ok()?;
    advise_huge_pages(copy.spare_capacity_mut());
    copy.extend_from_slice(words);
    Some(copy)
}

impl std::fmt::Debug for BufferData {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Buffer({} bytes)", self.len_bytes)
    }
}
