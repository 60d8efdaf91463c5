//! Squares of texels of one byte: the four that linear filtering reads, in one word.

use crate::Lines;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// The squares of a texture's texels, in the order of the texels: of each, from the lowest byte on,
/// itself, the next one of its row, and those of the next row below. After the last column and row
/// come the first.
///
/// They take as much memory as the texels, and the time of one pass over them. So they are made
/// when the texels are sampled again after a pass that has sampled them, and not for a texture that
/// changes from pass to pass.
#[derive(Debug, Default)]
pub struct ByteSquares {
    words: OnceLock<Lines<u32>>,
    was_sampled: AtomicBool,
}

impl ByteSquares {
    /// Notes that a pass that ends has sampled the texels.
    pub fn note_sampled(&self) {
        // Nothing else is read by this flag.
        if !self.was_sampled.load(Ordering::Relaxed) {
            self.was_sampled.store(true, Ordering::Relaxed);
        }
    }

    /// Makes the squares if a pass before has sampled the texels, unless they are made.
    pub fn make(&self, make: impl FnOnce() -> Lines<u32>) {
        if self.was_sampled.load(Ordering::Relaxed) {
            self.words.get_or_init(make);
        }
    }

    /// The squares, if they are made.
    #[inline]
    #[must_use]
    pub fn get(&self) -> Option<&[u32]> {
        self.words.get().map(|words| &words[..])
    }
}
