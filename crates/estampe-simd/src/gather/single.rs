//! Gathers and scatters of single elements.
#![expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]

use super::last_index;
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdBase, SimdCombine, SimdInto, SimdMask, SimdSplit, u32x8, u32x16};

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

/// Stores the lanes of a mask, lane by lane, so that of equal indices the last one counts. Lanes
/// whose index is beyond the table are left out.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "there are sixteen lanes")]
pub(crate) fn scatter_avx512(
    simd: Avx512,
    table: &mut [u32],
    index: u32x16<Avx512>,
    values: u32x16<Avx512>,
    lanes: u16,
) {
    let Some(last) = last_index(table) else {
        return;
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(
            simd: Avx512,
            table: &mut [u32],
            index: u32x16<Avx512>,
            values: u32x16<Avx512>,
            lanes: u16,
        ) {
            use core::arch::x86_64::*;
            let _ = simd;
            let base = table.as_mut_ptr().cast::<i32>();
            // SAFETY: the token proves AVX-512F. The caller's mask has no lane whose index is above
            // `last_index(table)`, so each lane that is stored writes four bytes inside `table`,
            // which is borrowed exclusively for the call.
            unsafe {
                _mm512_mask_i32scatter_epi32::<4>(base, lanes, index.into(), values.into());
            }
        }
    );
    let inside = index.simd_le(u32x16::splat(simd, last)).to_bitmask();
    kernel(simd, table, index, values, lanes & inside as u16);
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
