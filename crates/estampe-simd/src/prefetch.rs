//! Prefetching: memory that is read soon is brought to the cache, and nothing waits for it.
//!
//! A load that misses the cache keeps the processor from looking further ahead than a few hundred
//! instructions; a prefetch does not. The intrinsic is safe where its level's instructions are.

use crate::LANES;
use fearless_simd::x86::{Avx2, Avx512, Sse2};
use fearless_simd::{SimdBase, u32x16};

/// Bytes of a cache line.
const LINE: usize = 64;

/// Prefetches each cache line of a value by a level's kernel.
#[inline(always)]
fn each_line<T>(value: &T, prefetch: impl Fn(*const i8)) {
    let first = std::ptr::from_ref(value).cast::<i8>();
    let size = size_of::<T>();
    for offset in (0..size).step_by(LINE) {
        prefetch(first.wrapping_add(offset));
    }
    // A value that is longer than its alignment may end in one more.
    if align_of::<T>() < LINE && size > align_of::<T>() {
        prefetch(first.wrapping_add(size - 1));
    }
}

/// Prefetches some elements of a table, wherever the indices point to.
#[inline(always)]
fn each_element(table: &[u32], index: [u32; LANES], prefetch: impl Fn(*const i8)) {
    for at in index {
        prefetch(table.as_ptr().wrapping_add(at as usize).cast());
    }
}

#[inline(always)]
fn line_sse2(simd: Sse2, line: *const i8) {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Sse2, line: *const i8) {
            use core::arch::x86_64::*;
            _mm_prefetch::<_MM_HINT_T0>(line);
        }
    );
    kernel(simd, line);
}

#[inline(always)]
pub(crate) fn sse2<T>(simd: Sse2, value: &T) {
    each_line(value, |line| line_sse2(simd, line));
}

#[inline(always)]
pub(crate) fn address_sse2(simd: Sse2, address: usize) {
    line_sse2(simd, std::ptr::without_provenance(address));
}

#[inline(always)]
pub(crate) fn elements_sse2(simd: Sse2, table: &[u32], index: u32x16<Sse2>) {
    each_element(table, index.to_array(), |line| line_sse2(simd, line));
}

#[inline(always)]
fn line_avx2(simd: Avx2, line: *const i8) {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, line: *const i8) {
            use core::arch::x86_64::*;
            _mm_prefetch::<_MM_HINT_T0>(line);
        }
    );
    kernel(simd, line);
}

#[inline(always)]
pub(crate) fn avx2<T>(simd: Avx2, value: &T) {
    each_line(value, |line| line_avx2(simd, line));
}

#[inline(always)]
pub(crate) fn address_avx2(simd: Avx2, address: usize) {
    line_avx2(simd, std::ptr::without_provenance(address));
}

#[inline(always)]
pub(crate) fn elements_avx2(simd: Avx2, table: &[u32], index: u32x16<Avx2>) {
    each_element(table, index.to_array(), |line| line_avx2(simd, line));
}

#[inline(always)]
fn line_avx512(simd: Avx512, line: *const i8) {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx512, line: *const i8) {
            use core::arch::x86_64::*;
            _mm_prefetch::<_MM_HINT_T0>(line);
        }
    );
    kernel(simd, line);
}

#[inline(always)]
pub(crate) fn avx512<T>(simd: Avx512, value: &T) {
    each_line(value, |line| line_avx512(simd, line));
}

#[inline(always)]
pub(crate) fn address_avx512(simd: Avx512, address: usize) {
    line_avx512(simd, std::ptr::without_provenance(address));
}

#[inline(always)]
pub(crate) fn elements_avx512(simd: Avx512, table: &[u32], index: u32x16<Avx512>) {
    each_element(table, index.to_array(), |line| line_avx512(simd, line));
}
