//! Buffers that shaders write.

use crate::BufferData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// A buffer that shaders load from and store to, word by word, on all threads at once. Clones share
/// the words. What a read may see is in `docs/NUMERICS.md`, *Shared memory*.
#[derive(Clone, Default)]
pub struct StorageBuffer {
    words: Arc<Vec<AtomicU32>>,
    len_bytes: usize,
}

impl StorageBuffer {
    /// The bytes of a buffer. Its memory is used if nothing else shares it, and copied otherwise.
    ///
    /// # Errors
    /// The buffer, if there is not enough memory for a copy.
    pub fn try_from_data(data: BufferData) -> Result<Self, BufferData> {
        let len_bytes = data.len_bytes();
        let words = data.try_into_words()?;
        Ok(Self {
            // In place: both have the same size, and the standard library keeps the memory.
            words: Arc::new(words.into_iter().map(AtomicU32::new).collect()),
            len_bytes,
        })
    }

    /// The bytes as they are now; without a copy if this is the last clone.
    #[must_use]
    pub fn into_data(self) -> BufferData {
        let words = match Arc::try_unwrap(self.words) {
            Ok(words) => words.into_iter().map(AtomicU32::into_inner).collect(),
            Err(shared) => {
                let load = |word: &AtomicU32| word.load(Ordering::Relaxed);
                shared.iter().map(load).collect::<Vec<_>>()
            }
        };
        BufferData::from_words(words).slice(0, self.len_bytes)
    }

    /// Returns true if both are clones that share their words.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.words, &other.words)
    }

    /// The length in bytes.
    #[must_use]
    pub fn len_bytes(&self) -> usize {
        self.len_bytes
    }

    /// The words, little-endian as those of [`BufferData`]; the last one is padded with zeros.
    #[inline]
    #[must_use]
    pub fn words(&self) -> &[AtomicU32] {
        &self.words
    }

    /// Loads the word at an index; 0 beyond the end.
    #[inline]
    #[must_use]
    pub fn load(&self, index: usize) -> u32 {
        let word = self.words.get(index);
        word.map_or(0, |word| word.load(Ordering::Relaxed))
    }

    /// Stores a word at an index; does nothing beyond the end.
    #[inline]
    pub fn store(&self, index: usize, word: u32) {
        if let Some(to) = self.words.get(index) {
            to.store(word, Ordering::Relaxed);
        }
    }
}

impl std::fmt::Debug for StorageBuffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "StorageBuffer({} bytes)", self.len_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_nothing_shares_stays_in_its_place() {
        let data = BufferData::from_bytes(&[1, 2, 3, 4, 5, 6]);
        let first = data.words().as_ptr().addr();
        let stored = StorageBuffer::try_from_data(data).expect("it is small");
        assert_eq!(stored.words().as_ptr().addr(), first);
        stored.store(0, 0x0A0B_0C0D);
        stored.store(2, 7);
        assert_eq!(
            [stored.load(0), stored.load(1), stored.load(2)],
            [0x0A0B_0C0D, 0x0605, 0]
        );
        let data = stored.into_data();
        assert_eq!(data.words(), [0x0A0B_0C0D, 0x0605]);
        assert_eq!((data.words().as_ptr().addr(), data.len_bytes()), (first, 6));
    }

    #[test]
    fn memory_that_others_share_is_copied() {
        let data = BufferData::from_words([1, 2, 3]);
        let stored = StorageBuffer::try_from_data(data.clone()).expect("it is small");
        stored.store(1, 9);
        assert_eq!(data.words(), [1, 2, 3]);
        let clone = stored.clone();
        assert_eq!(stored.into_data().words(), [1, 9, 3]);
        assert_eq!(clone.load(1), 9);
        // A part of a buffer.
        let part = StorageBuffer::try_from_data(data.slice(4, 4)).expect("it is small");
        assert_eq!((part.load(0), part.words().len()), (2, 1));
    }
}
