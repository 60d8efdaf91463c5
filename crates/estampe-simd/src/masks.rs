//! Masks at AVX2: their bits, and stores of some lanes.

use crate::LANES;
use fearless_simd::x86::Avx2;
use fearless_simd::{
    Bytes, Simd, SimdBase, SimdCombine, SimdInto, SimdSplit, i32x8, i32x16, mask32x8, mask32x16,
    u32x16,
};

/// The sign bits, by two packs that saturate. As two moves of eight bits each, the compiler
/// joins them before: it then compares with zero, and packs these masks.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen bits")]
pub(crate) fn sign_bits_avx2(simd: Avx2, a: i32x16<Avx2>) -> u16 {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, low: i32x8<Avx2>, high: i32x8<Avx2>) -> u32 {
            use core::arch::x86_64::*;
            let _ = simd;
            // In each 128 bits four lanes of the first half, then four of the second.
            let words = _mm256_packs_epi32(low.into(), high.into());
            let upper = _mm256_extracti128_si256::<1>(words);
            let bytes = _mm_packs_epi16(_mm256_castsi256_si128(words), upper);
            _mm_movemask_epi8(_mm_shuffle_epi32::<0b11_01_10_00>(bytes)).cast_unsigned()
        }
    );
    let (low, high) = a.split();
    kernel(simd, low, high) as u16
}

/// [`sign_bits_avx2`] of a mask.
#[inline(always)]
pub(crate) fn bits_of_mask_avx2(simd: Avx2, mask: mask32x16<Avx2>) -> u16 {
    sign_bits_avx2(simd, lanes_of(simd, mask))
}

/// All bits of the lanes of a mask.
#[inline(always)]
fn lanes_of(simd: Avx2, mask: mask32x16<Avx2>) -> i32x16<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn half(simd: Avx2, mask: mask32x8<Avx2>) -> i32x8<Avx2> {
            use core::arch::x86_64::*;
            let lanes: __m256i = mask.into();
            lanes.simd_into(simd)
        }
    );
    let (low, high) = simd.split_mask32x16(mask);
    half(simd, low).combine(half(simd, high))
}

/// [`Lanes::replace_masked`](crate::Lanes::replace_masked) bit by bit, which the compiler makes a
/// choice and a store of. A choice by the mask, between a value and the stored one that it
/// replaces, it makes a masked store, which is dozens of operations on Zen 3 and forwards nothing
/// to loads: two of them for each sample took 6 % of `msaa4`.
#[inline(always)]
pub(crate) fn replace_masked_avx2(
    simd: Avx2,
    to: &mut [u32; LANES],
    lanes: mask32x16<Avx2>,
    by: u32x16<Avx2>,
) {
    let before = u32x16::load_array_ref(simd, to);
    let lanes: u32x16<Avx2> = lanes_of(simd, lanes).bitcast();
    (before ^ ((before ^ by) & lanes)).store_array(to);
}
