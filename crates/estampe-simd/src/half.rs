//! Conversion between binary16 and binary32 by instructions (F16C, which AVX2 levels have;
//! AVX-512).
//!
//! The bits are those of [`Lanes`](crate::Lanes)' functions without these instructions: to nearest
//! with ties to even, denormals kept; a NaN that is decoded becomes quiet.

use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdCombine, SimdInto, SimdSplit, f32x8, f32x16, u32x8, u32x16};

/// Half floats, which are decoded from, or encoded to, the low and the high halves of words.
pub(crate) type HalfPair<S> = [f32x16<S>; 2];

#[inline(always)]
pub(crate) fn decode_avx512(simd: Avx512, half: u32x16<Avx512>) -> f32x16<Avx512> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx512, half: u32x16<Avx512>) -> f32x16<Avx512> {
            use core::arch::x86_64::*;
            _mm512_cvtph_ps(_mm512_cvtepi32_epi16(half.into())).simd_into(simd)
        }
    );
    kernel(simd, half)
}

#[inline(always)]
pub(crate) fn encode_avx512(simd: Avx512, value: f32x16<Avx512>) -> u32x16<Avx512> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx512, value: f32x16<Avx512>) -> u32x16<Avx512> {
            use core::arch::x86_64::*;
            const ROUNDING: i32 = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
            let codes = _mm512_cvtps_ph::<ROUNDING>(value.into());
            _mm512_cvtepu16_epi32(codes).simd_into(simd)
        }
    );
    kernel(simd, value)
}

#[inline(always)]
pub(crate) fn decode_avx2(simd: Avx2, half: u32x16<Avx2>) -> f32x16<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, half: u32x8<Avx2>) -> f32x8<Avx2> {
            use core::arch::x86_64::*;
            let all: __m256i = half.into();
            // The low halves of each 32 bits, side by side; then the eight of both lanes.
            let order = _mm256_setr_epi8(
                0, 1, 4, 5, 8, 9, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1, //
                0, 1, 4, 5, 8, 9, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1,
            );
            let low = _mm256_shuffle_epi8(all, order);
            let codes = _mm256_castsi256_si128(_mm256_permute4x64_epi64::<0b1000>(low));
            _mm256_cvtph_ps(codes).simd_into(simd)
        }
    );
    let (low, high) = half.split();
    kernel(simd, low).combine(kernel(simd, high))
}

#[inline(always)]
pub(crate) fn encode_avx2(simd: Avx2, value: f32x16<Avx2>) -> u32x16<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, value: f32x8<Avx2>) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            let codes = _mm256_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(value.into());
            _mm256_cvtepu16_epi32(codes).simd_into(simd)
        }
    );
    let (low, high) = value.split();
    kernel(simd, low).combine(kernel(simd, high))
}

/// The halves of eight words are put side by side once, for both conversions.
#[inline(always)]
pub(crate) fn decode_pair_avx2(simd: Avx2, words: u32x16<Avx2>) -> HalfPair<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx2, words: u32x8<Avx2>) -> [f32x8<Avx2>; 2] {
            use core::arch::x86_64::*;
            // Of each four words the low halves, then the high ones.
            let order = _mm256_setr_epi8(
                0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15, //
                0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15,
            );
            let halves = _mm256_shuffle_epi8(words.into(), order);
            let halves = _mm256_permute4x64_epi64::<0b11_01_10_00>(halves);
            let low = _mm256_castsi256_si128(halves);
            let high = _mm256_extracti128_si256::<1>(halves);
            [
                _mm256_cvtph_ps(low).simd_into(simd),
                _mm256_cvtph_ps(high).simd_into(simd),
            ]
        }
    );
    let (first, second) = words.split();
    let ([low, high], [low_2, high_2]) = (kernel(simd, first), kernel(simd, second));
    [low.combine(low_2), high.combine(high_2)]
}

/// Codes of both are interleaved as they are: no word of one code is made. Numbers are tested for
/// NaN in pairs, and replaced only if there is one.
#[inline(always)]
pub(crate) fn encode_pair_avx2(simd: Avx2, [low, high]: HalfPair<Avx2>) -> u32x16<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn are_numbers(simd: Avx2, numbers: [f32x8<Avx2>; 4]) -> bool {
            use core::arch::x86_64::*;
            let [a, b, c, d] = numbers;
            let first = _mm256_cmp_ps::<_CMP_ORD_Q>(a.into(), b.into());
            let second = _mm256_cmp_ps::<_CMP_ORD_Q>(c.into(), d.into());
            let _ = simd;
            _mm256_movemask_ps(_mm256_and_ps(first, second)) == 0xFF
        }
    );
    fearless_simd::kernel!(
        #[inline(always)]
        fn with_quiet_nan(simd: Avx2, value: f32x8<Avx2>) -> f32x8<Avx2> {
            use core::arch::x86_64::*;
            let value: __m256 = value.into();
            let is_number = _mm256_cmp_ps::<_CMP_ORD_Q>(value, value);
            let nan = _mm256_castsi256_ps(_mm256_set1_epi32(0x7FC0_0000));
            _mm256_blendv_ps(nan, value, is_number).simd_into(simd)
        }
    );
    fearless_simd::kernel!(
        #[inline(always)]
        fn encode(simd: Avx2, low: f32x8<Avx2>, high: f32x8<Avx2>) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            let low = _mm256_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(low.into());
            let high = _mm256_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(high.into());
            let first = _mm_unpacklo_epi16(low, high);
            let second = _mm_unpackhi_epi16(low, high);
            _mm256_set_m128i(second, first).simd_into(simd)
        }
    );
    let ((mut low, mut low_2), (mut high, mut high_2)) = (low.split(), high.split());
    if !are_numbers(simd, [low, high, low_2, high_2]) {
        low = with_quiet_nan(simd, low);
        high = with_quiet_nan(simd, high);
        low_2 = with_quiet_nan(simd, low_2);
        high_2 = with_quiet_nan(simd, high_2);
    }
    encode(simd, low, high).combine(encode(simd, low_2, high_2))
}
