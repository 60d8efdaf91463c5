//! Between registers of sixteen lanes and what is loaded lane by lane.

use crate::LANES;
use core::arch::x86_64::__m128i;
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{Simd, SimdBase, SimdInto, u32x8, u32x16};

/// The indices as scalars, which go through memory on purpose: extracting lanes from registers
/// made AVX2's trilinear samples take a quarter longer, and AVX-512's no shorter.
#[inline(always)]
pub(super) fn scalars<S: Simd>(index: u32x16<S>) -> [u32; LANES] {
    std::hint::black_box(index.to_array())
}

fearless_simd::kernel!(
    #[inline(always)]
    pub(super) fn join_512(
        simd: Avx512,
        a: __m128i,
        b: __m128i,
        c: __m128i,
        d: __m128i,
    ) -> u32x16<Avx512> {
        use core::arch::x86_64::*;
        let low = _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(a), b);
        let high = _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(c), d);
        _mm512_inserti64x4::<1>(_mm512_castsi256_si512(low), high).simd_into(simd)
    }
);

fearless_simd::kernel!(
    #[inline(always)]
    pub(super) fn join_256(simd: Avx2, a: __m128i, b: __m128i) -> u32x8<Avx2> {
        use core::arch::x86_64::*;
        _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(a), b).simd_into(simd)
    }
);

fearless_simd::kernel!(
    /// The left and the right elements of pairs, inside 128 bits: of the first register, then of
    /// the second.
    #[inline(always)]
    pub(super) fn divide_256(
        simd: Avx2,
        first: u32x8<Avx2>,
        second: u32x8<Avx2>,
    ) -> [u32x8<Avx2>; 2] {
        use core::arch::x86_64::*;
        let a = _mm256_castsi256_ps(first.into());
        let b = _mm256_castsi256_ps(second.into());
        let left = _mm256_castps_si256(_mm256_shuffle_ps::<0x88>(a, b));
        let right = _mm256_castps_si256(_mm256_shuffle_ps::<0xDD>(a, b));
        [left.simd_into(simd), right.simd_into(simd)]
    }
);
