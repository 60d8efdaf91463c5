//! Conversion between binary16 and binary32 by instructions (F16C, which AVX2 levels have;
//! AVX-512).
//!
//! The bits are those of [`Lanes`](crate::Lanes)' functions without these instructions: to nearest
//! with ties to even, denormals kept; a NaN that is decoded becomes quiet.

use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdCombine, SimdInto, SimdSplit, f32x8, f32x16, u32x8, u32x16};

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
