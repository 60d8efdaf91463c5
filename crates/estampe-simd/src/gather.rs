//! Indexed loads: `table[index]` for sixteen indices at once.
//!
//! The hardware's gather reads wherever it is told to; clamping the indices to the table first makes
//! it sound for any input, at one instruction. This is the crate's only `unsafe` code.

use crate::LANES;
use fearless_simd::{Simd, SimdBase, u32x16};

/// The last valid index, or `None` for an empty table. Tables longer than 2³¹ elements are cut: the
/// hardware's indices are signed.
#[inline(always)]
fn last_index(table: &[u32]) -> Option<u32> {
    let last = table.len().checked_sub(1)?;
    Some(u32::try_from(last).map_or(i32::MAX as u32, |last| last.min(i32::MAX as u32)))
}

/// The bits of floats, to gather from.
#[must_use]
#[expect(
    unsafe_code,
    reason = "the crate's only unsafe file; safe transmutation is not stable"
)]
pub fn bits_of(table: &[f32]) -> &[u32] {
    // SAFETY: f32 and u32 have the same size and alignment, every bit pattern of either is valid, and the
    // result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(table.as_ptr().cast(), table.len()) }
}

/// One load per lane, for levels without a gather instruction.
#[inline(always)]
pub(crate) fn by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> u32x16<S> {
    let Some(last) = last_index(table) else {
        return u32x16::splat(simd, 0);
    };
    let index = index.min(u32x16::splat(simd, last));
    let mut out = [0; LANES];
    for (value, &at) in out.iter_mut().zip(index.as_slice()) {
        // The index is in range; `get` only tells the compiler so without a panic path.
        *value = table.get(at as usize).copied().unwrap_or_default();
    }
    u32x16::load_array(simd, out)
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{avx2, avx512};

#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]
mod x86 {
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
                // SAFETY: the token proves AVX2. Every index is at most `last_index(table)`, so each
                // lane reads four bytes inside `table`, which is borrowed for the call.
                let values: __m256i = unsafe { _mm256_i32gather_epi32::<4>(base, index.into()) };
                values.simd_into(simd)
            }
        );
        let (low, high) = index.min(u32x16::splat(simd, last)).split();
        kernel(simd, table, low).combine(kernel(simd, table, high))
    }
}
