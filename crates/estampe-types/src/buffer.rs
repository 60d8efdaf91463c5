//! Buffers: immutable memory that a draw reads, for vertices, indices, uniforms and storage.

use crate::IndexFormat;
use estampe_simd::advise_huge_pages;
use std::sync::{Arc, Mutex, PoisonError};

/// An immutable buffer, shared by reference. The bytes are kept as little-endian 32-bit words, so
/// that lanes can gather them.
#[derive(Clone, Default)]
pub struct BufferData {
    memory: Arc<Memory>,
    /// The first word that belongs to the buffer.
    first_word: usize,
    len_bytes: usize,
}

/// The memory of buffers.
#[derive(Default)]
struct Memory {
    // A vector, not a slice: a vector that several threads filled need not be copied.
    words: Vec<u32>,
    /// The extremes of ranges of indices, until the words change.
    extremes: Mutex<Vec<(IndexRange, [u32; 2])>>,
}

/// A range of indices: the buffer's first word, format, first and count.
type IndexRange = (usize, IndexFormat, [u32; 2]);

/// Ranges of indices that are remembered of a buffer's memory.
const KNOWN: usize = 16;

impl From<Vec<u32>> for Memory {
    fn from(words: Vec<u32>) -> Self {
        Self {
            words,
            extremes: Mutex::default(),
        }
    }
}

impl Clone for Memory {
    fn clone(&self) -> Self {
        self.words.clone().into()
    }
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
            memory: Arc::new(words.into()),
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
            memory: Arc::clone(&self.memory),
            first_word: self.first_word + first_byte / 4,
            len_bytes: len_bytes.min(self.len_bytes - first_byte),
        }
    }

    /// The words, to be changed; they are copied first if something else shares them. Little-endian
    /// bytes, as [`BufferData::words`].
    #[must_use]
    pub fn words_mut(&mut self) -> &mut [u32] {
        let count = self.len_bytes.div_ceil(4);
        let memory = Arc::make_mut(&mut self.memory);
        let extremes = memory.extremes.get_mut();
        extremes.unwrap_or_else(PoisonError::into_inner).clear();
        &mut memory.words[self.first_word..][..count]
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
            memory: Arc::new(words.into()),
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
            memory: Arc::new(words.into()),
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
        match Arc::try_unwrap(self.memory) {
            Ok(memory) if range == (0..memory.words.len()) => return Ok(memory.words),
            Ok(memory) => self.memory = Arc::new(memory),
            Err(shared) => self.memory = shared,
        }
        try_to_vec(&self.memory.words[range]).ok_or(self)
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
        &self.memory.words[self.first_word..][..count]
    }

    /// The least and the greatest index of a range (first, count), which `find` gives. They are
    /// remembered with the contents until these change, as programs draw the same mesh in each pass
    /// and its indices may be more than the caches hold. `None` is not remembered.
    pub fn index_extremes(
        &self,
        format: IndexFormat,
        range: [u32; 2],
        find: impl FnOnce() -> Option<[u32; 2]>,
    ) -> Option<[u32; 2]> {
        let key = (self.first_word, format, range);
        let lock = || {
            self.memory
                .extremes
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let known = lock().iter().find(|(known, _)| *known == key).copied();
        if let Some((_, extremes)) = known {
            return Some(extremes);
        }
        let extremes = find()?;
        let mut known = lock();
        if known.len() == KNOWN {
            known.remove(0);
        }
        known.push((key, extremes));
        Some(extremes)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_remembered_until_the_contents_change() {
        let mut buffer = BufferData::from_words([5, 2, 9, 4]);
        let find = |buffer: &BufferData, range, found| {
            buffer.index_extremes(IndexFormat::Uint32, range, || found)
        };
        assert_eq!(find(&buffer, [0, 4], None), None);
        assert_eq!(find(&buffer, [0, 4], Some([2, 9])), Some([2, 9]));
        assert_eq!(find(&buffer, [0, 4], None), Some([2, 9]));
        // Other ranges, formats and parts are others.
        assert_eq!(find(&buffer, [1, 3], None), None);
        assert_eq!(find(&buffer.slice(4, 12), [0, 4], None), None);
        let halves = buffer.index_extremes(IndexFormat::Uint16, [0, 4], || None);
        assert_eq!(halves, None);
        // A buffer that shares the memory keeps what it knows.
        let shared = buffer.clone();
        buffer.words_mut()[0] = 1;
        assert_eq!(find(&buffer, [0, 4], Some([1, 9])), Some([1, 9]));
        assert_eq!(find(&shared, [0, 4], None), Some([2, 9]));
        buffer.words_mut()[0] = 0;
        assert_eq!(find(&buffer, [0, 4], None), None);
        // Of many ranges the last ones are remembered.
        for first in 0..40 {
            find(&buffer, [first, 1], Some([first; 2]));
        }
        assert_eq!(find(&buffer, [39, 1], None), Some([39; 2]));
        assert_eq!(find(&buffer, [0, 1], None), None);
    }
}
