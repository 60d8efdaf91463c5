//! Buffers as kernels see them: words.

use crate::op::Atomic;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// The bound range of a buffer. The default one is empty.
#[derive(Debug, Clone, Copy, Default)]
pub struct Buffer<'a> {
    words: Words<'a>,
    bytes: u32,
}

/// The words that are wholly inside of a bound range, for back ends.
#[derive(Debug, Clone, Copy)]
pub enum Words<'a> {
    /// Nobody changes them during a run.
    ReadOnly(&'a [u32]),
    /// Several threads may read and write them.
    Shared(&'a [AtomicU32]),
}

impl Default for Words<'_> {
    fn default() -> Self {
        Self::ReadOnly(&[])
    }
}

impl<'a> Buffer<'a> {
    /// A buffer that is only read: `bytes` from the first of these words on, at most all of them.
    #[must_use]
    pub fn read_only(words: &'a [u32], bytes: usize) -> Self {
        let (bytes, whole) = range(words.len(), bytes);
        Self {
            words: Words::ReadOnly(&words[..whole]),
            bytes,
        }
    }

    /// A buffer that several threads may read and write: `bytes` from the first of these words on,
    /// at most all of them.
    #[must_use]
    pub fn shared(words: &'a [AtomicU32], bytes: usize) -> Self {
        let (bytes, whole) = range(words.len(), bytes);
        Self {
            words: Words::Shared(&words[..whole]),
            bytes,
        }
    }

    /// The length of the bound range.
    #[must_use]
    pub fn bytes(&self) -> u32 {
        self.bytes
    }

    /// The words that are wholly inside of the bound range.
    #[must_use]
    pub fn words(&self) -> Words<'a> {
        self.words
    }

    /// The word at a byte offset; 0 outside.
    #[must_use]
    pub fn load(&self, offset: u32) -> u32 {
        let at = offset as usize / 4;
        match self.words {
            Words::ReadOnly(words) => words.get(at).copied().unwrap_or(0),
            Words::Shared(words) => words.get(at).map_or(0, |word| word.load(Relaxed)),
        }
    }

    /// The word at a byte offset, to change it; `None` outside.
    #[must_use]
    pub fn at(&self, offset: u32) -> Option<&'a AtomicU32> {
        match self.words {
            Words::ReadOnly(_) => None,
            Words::Shared(words) => words.get(offset as usize / 4),
        }
    }
}

/// The length in bytes and the number of whole words of a range of so many bytes at most.
fn range(words: usize, bytes: usize) -> (u32, usize) {
    let bytes = bytes.min(words.saturating_mul(4));
    let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
    (bytes, bytes as usize / 4)
}

/// Does an atomic operation; the word that was read.
pub fn atomic(kind: Atomic, word: &AtomicU32, operand: u32) -> u32 {
    match kind {
        Atomic::Add => word.fetch_add(operand, Relaxed),
        Atomic::Sub => word.fetch_sub(operand, Relaxed),
        Atomic::And => word.fetch_and(operand, Relaxed),
        Atomic::Or => word.fetch_or(operand, Relaxed),
        Atomic::Xor => word.fetch_xor(operand, Relaxed),
        Atomic::UMin => word.fetch_min(operand, Relaxed),
        Atomic::UMax => word.fetch_max(operand, Relaxed),
        Atomic::Exchange => word.swap(operand, Relaxed),
        Atomic::Load => word.load(Relaxed),
        Atomic::Store => {
            word.store(operand, Relaxed);
            0
        }
        Atomic::SMin | Atomic::SMax | Atomic::StoreHalf => {
            let changed = |before| Some(kind.evaluate([before, operand]));
            let (Ok(before) | Err(before)) = word.fetch_update(Relaxed, Relaxed, changed);
            before
        }
    }
}
