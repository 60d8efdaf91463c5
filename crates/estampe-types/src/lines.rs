//! Memory of images: elements that begin at a cache line.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line, and of sixteen lanes.
const LINE: usize = 64;

/// Elements whose first lies at a multiple of 64 bytes, so that every packet of sixteen is one cache line.
///
/// An allocation of this size begins 16 bytes behind a page's start, and then every packet's load and store
/// touches two lines.
#[derive(Debug, Default)]
pub struct Lines<T> {
    /// The elements, and before them up to a line of unused ones.
    memory: Vec<T>,
    start: usize,
    len: usize,
}

impl<T: Copy + Default> Lines<T> {
    /// Zeros, or `None` when memory is short.
    #[must_use]
    pub fn zeros(len: usize) -> Option<Self> {
        let spare = LINE / size_of::<T>();
        let memory: Vec<T> = zeros(len.checked_add(spare)?)?;
        // Where this cannot be told (it may be so in constant evaluation) alignment is given up.
        let start = memory.as_ptr().align_offset(LINE).min(spare);
        Some(Self { memory, start, len })
    }
}

impl<T> From<Vec<T>> for Lines<T> {
    /// The same elements where they are, at a line's begin or not.
    fn from(memory: Vec<T>) -> Self {
        let len = memory.len();
        Self {
            memory,
            start: 0,
            len,
        }
    }
}

impl<T: Copy + Default> Clone for Lines<T> {
    fn clone(&self) -> Self {
        // As `Vec::clone` does when memory is short.
        let mut copy = Self::zeros(self.len).expect("there is memory for a copy");
        copy.copy_from_slice(self);
        copy
    }
}

impl<T> Deref for Lines<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.memory[self.start..self.start + self.len]
    }
}

impl<T> DerefMut for Lines<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.memory[self.start..self.start + self.len]
    }
}

/// Zeros, or `None` when memory is short.
///
/// The system's fresh memory is zero already, and is then first touched by the threads that draw; writing
/// zeros here took a thread 16 ms for 1280×720 with four samples.
fn zeros<T: Clone + Default>(len: usize) -> Option<Vec<T>> {
    /// An allocator may keep smaller blocks that are given back, and would have to clear them.
    const LEAST_ROOM: usize = 64 << 20;
    // `vec!` asks for zeroed memory but cannot fail softly: whether there is room is asked before.
    let mut room: Vec<u8> = Vec::new();
    let bytes = len.checked_mul(size_of::<T>())?;
    if room.try_reserve_exact(bytes.max(LEAST_ROOM)).is_ok() {
        drop(std::hint::black_box(room));
        return Some(vec![T::default(); len]);
    }
    let mut values = Vec::new();
    values.try_reserve_exact(len).ok()?;
    values.resize(len, T::default());
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_begin_at_a_line_also_in_copies() {
        for len in [0, 1, 16, 4096, 1 << 20] {
            let mut lines: Lines<u32> = Lines::zeros(len).unwrap();
            assert_eq!(lines.len(), len);
            lines
                .iter_mut()
                .zip(7..)
                .for_each(|(to, value)| *to = value);
            let copy = lines.clone();
            for lines in [&lines, &copy] {
                assert_eq!(lines.as_ptr() as usize % LINE, 0);
                assert!(lines.iter().copied().eq((7..).take(len)));
            }
        }
        assert!(Lines::<u32>::zeros(usize::MAX).is_none());
    }
}
