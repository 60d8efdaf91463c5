//! Streaming stores: cache lines that go to memory past the caches.
//!
//! A store to a line that is in no cache reads the line from memory before, and writes it back
//! later. A whole line that nobody reads soon is written in half the time without that.
//!
//! This module has `unsafe` code: the instructions store by address.

use crate::{LANES, Lanes, Level, dispatch};
#[cfg(target_arch = "x86_64")]
use fearless_simd::x86::{Avx2, Avx512, Sse2};
#[cfg(target_arch = "x86_64")]
use fearless_simd::{SimdBase, u32x4, u32x8, u32x16};
use std::cell::Cell;
use std::marker::PhantomData;

/// A cache line of words.
type Line = [u32; LANES];

/// Copies lines to memory past the caches, where the processor has an instruction for that.
///
/// The memory stays borrowed until all of it is written: other threads see it after
/// [`Stream::with`].
///
/// ```compile_fail
/// use estampe_simd::{Level, Stream};
///
/// let mut memory = [[0; 16]];
/// Stream::with(Level::best(), |stream| {
///     stream.copy(&[[1; 16]], &mut memory);
///     memory[0][0] = 2; // Not before the end of `with`.
/// });
/// ```
#[derive(Debug)]
pub struct Stream<'m> {
    level: Level,
    /// A cell, so that no shorter borrow will do.
    memory: PhantomData<Cell<&'m mut [Line]>>,
}

impl<'m> Stream<'m> {
    /// Runs work that copies, and waits until what it has copied is written.
    pub fn with<R>(level: Level, work: impl FnOnce(&mut Self) -> R) -> R {
        let _fence = Fence;
        work(&mut Self {
            level,
            memory: PhantomData,
        })
    }

    /// True if a level has the instructions; else lines are copied as usual.
    #[must_use]
    pub fn has_instructions(level: Level) -> bool {
        cfg!(target_arch = "x86_64") && !level.is_scalar()
    }

    /// Copies lines, which are quickest from the first-level or second-level cache. Those that do
    /// not begin at a multiple of 64 bytes are copied as usual.
    ///
    /// # Panics
    /// If there are more lines of one than of the other.
    pub fn copy(&mut self, from: &[Line], to: &'m mut [Line]) {
        assert_eq!(from.len(), to.len(), "as many lines");
        dispatch!(self.level, s => s.stream(self, from, to));
    }
}

/// Waits for streaming stores when it is dropped, also if work panics.
struct Fence;

impl Drop for Fence {
    #[expect(unsafe_code, reason = "the fence has no safe form")]
    fn drop(&mut self) {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: every processor of x86-64 has the instruction.
        unsafe {
            core::arch::x86_64::_mm_sfence();
        }
    }
}

/// True if lines begin at cache lines.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn are_aligned(lines: &[Line]) -> bool {
    lines.as_ptr().addr().is_multiple_of(size_of::<Line>())
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn sse2<'m>(simd: Sse2, _: &Stream<'m>, from: &[Line], to: &'m mut [Line]) {
    fearless_simd::kernel!(
        #[inline(always)]
        #[expect(unsafe_code, reason = "streaming stores have no safe form")]
        fn kernel(simd: Sse2, from: &[Line], to: &mut [Line]) {
            use core::arch::x86_64::*;
            let (from, _) = from.as_flattened().as_chunks::<4>();
            let (to, _) = to.as_flattened_mut().as_chunks_mut::<4>();
            for (from, to) in from.iter().zip(to) {
                let words = u32x4::load_array_ref(simd, from).into();
                // SAFETY: a fourth of a line that is borrowed until a fence; it begins at a
                // multiple of 16 bytes, as lines do at one of 64.
                unsafe { _mm_stream_si128(to.as_mut_ptr().cast(), words) };
            }
        }
    );
    if are_aligned(to) {
        kernel(simd, from, to);
    } else {
        to.copy_from_slice(from);
    }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn avx2<'m>(simd: Avx2, _: &Stream<'m>, from: &[Line], to: &'m mut [Line]) {
    fearless_simd::kernel!(
        #[inline(always)]
        #[expect(unsafe_code, reason = "streaming stores have no safe form")]
        fn kernel(simd: Avx2, from: &[Line], to: &mut [Line]) {
            use core::arch::x86_64::*;
            let (from, _) = from.as_flattened().as_chunks::<8>();
            let (to, _) = to.as_flattened_mut().as_chunks_mut::<8>();
            for (from, to) in from.iter().zip(to) {
                let words = u32x8::load_array_ref(simd, from).into();
                // SAFETY: a half of a line that is borrowed until a fence; it begins at a
                // multiple of 32 bytes, as lines do at one of 64.
                unsafe { _mm256_stream_si256(to.as_mut_ptr().cast(), words) };
            }
        }
    );
    if are_aligned(to) {
        kernel(simd, from, to);
    } else {
        to.copy_from_slice(from);
    }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn avx512<'m>(simd: Avx512, _: &Stream<'m>, from: &[Line], to: &'m mut [Line]) {
    fearless_simd::kernel!(
        #[inline(always)]
        #[expect(unsafe_code, reason = "streaming stores have no safe form")]
        fn kernel(simd: Avx512, from: &[Line], to: &mut [Line]) {
            use core::arch::x86_64::*;
            for (from, to) in from.iter().zip(to) {
                let words = u32x16::load_array_ref(simd, from).into();
                // SAFETY: a line that is borrowed until a fence; it begins at a multiple of 64
                // bytes.
                unsafe { _mm512_stream_si512(to.as_mut_ptr().cast(), words) };
            }
        }
    );
    if are_aligned(to) {
        kernel(simd, from, to);
    } else {
        to.copy_from_slice(from);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_copied_wherever_they_begin() {
        for level in Level::all_available() {
            for count in [0, 1, 2, 7, 300] {
                for shift in [0, 1, 4] {
                    let from: Vec<u32> = (1..).step_by(77).take(count * LANES).collect();
                    // Enough for a beginning at a cache line, and some words more.
                    let mut memory = vec![7; (count + 2) * LANES];
                    let bytes = memory.as_ptr().addr();
                    let first = (bytes.next_multiple_of(64) - bytes) / 4 + shift;
                    let to = &mut memory[first..][..count * LANES];
                    Stream::with(level, |stream| {
                        stream.copy(from.as_chunks().0, to.as_chunks_mut().0);
                    });
                    assert!(
                        memory[first..][..count * LANES] == from,
                        "{level:?} {count}"
                    );
                    let around = memory[..first].iter().chain(&memory[first + from.len()..]);
                    assert!(
                        around.into_iter().all(|word| *word == 7),
                        "{level:?} {count}"
                    );
                }
            }
        }
    }

    #[test]
    #[should_panic(expected = "as many lines")]
    fn fewer_lines_are_refused() {
        Stream::with(Level::best(), |stream| stream.copy(&[[0; LANES]], &mut []));
    }
}
