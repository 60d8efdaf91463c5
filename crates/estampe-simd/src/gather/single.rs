//! Gathers of single elements.
#![expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]

use super::last_index;
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdBase, SimdCombine, SimdInto, SimdSplit, u32x8, u32x16};

#[inline(always)]
pub(crate) fn avx512(simd: Avx512, table: &[u32], index: u32x16<Avx512>) -> u32x16<Avx512> {
    let Some(last) = last_index(table) else {
        return u32x16::splat(simd, 0);
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx512, table: &[u32], index: u32x16<Avx512>) -> u32x16<Avx512> {
            use core::arch::x86_64::*;
            let base = table.as_ptr().cast::<i32>();
            // SAFETY: the token proves AVX-512F. Every index is at most `last_index(table)`, so
            // each lane reads four bytes inside `table`, which is borrowed for the call.
            let values: __m512i = unsafe { _mm512_i32gather_epi32::<4>(index.into(), base) };
            values.simd_into(simd)
        }
    );
    kernel(simd, table, index.min(u32x16::splat(simd, last)))
}

#[inline(always)]
pub(crate) fn avx2(simd: Avx2, table: &[u32], index: u32x16<Avx2>) -> u32x16<Avx2> {
    let Some(last) = last_index(table) else {
        return u32x16::splat(simd, 0);
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, table: &[u32], index: u32x8<Avx2>) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            let base = table.as_ptr().cast::<i32>();
            // SAFETY: the token proves AVX2. Every index is at most `last_index(table)`, so
            // each lane reads four bytes inside `table`, which is borrowed for the call.
            let values: __m256i = unsafe { _mm256_i32gather_epi32::<4>(base, index.into()) };
            values.simd_into(simd)
        }
    );
    let (low, high) = index.min(u32x16::splat(simd, last)).split();
    kernel(simd, table, low).combine(kernel(simd, table, high))
}
