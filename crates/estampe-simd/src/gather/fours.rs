//! Four neighbours, by loads of sixteen bytes.
#![expect(unsafe_code, reason = "a check of each lane's index costs too much")]

use super::last_four;
use super::registers::{join_256, join_512, scalars};
use crate::LANES;
use core::arch::x86_64::{__m128i, _mm_loadu_si128, _mm_setzero_si128};
use fearless_simd::x86::{Avx2, Avx512, Sse2};
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdInto, u32x4, u32x8, u32x16};

/// Four neighbours for each of sixteen lanes. Unsafe, because a check of each lane costs too much,
/// as in `squares.rs`.
#[inline(always)]
fn fours<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> Option<[__m128i; LANES]> {
    let last = last_four(table)?;
    let index = scalars(index.min(u32x16::splat(simd, last)));
    let base = table.as_ptr();
    // SAFETY: SSE2 is x86-64's baseline.
    let mut fours = [unsafe { _mm_setzero_si128() }; LANES];
    let mut lane = 0;
    while lane < LANES {
        let at = base.wrapping_add(index[lane] as usize);
        // SAFETY: the index is at most `last`, so the next three are in the table, too, and all
        // sixteen bytes are inside.
        fours[lane] = unsafe { _mm_loadu_si128(at.cast()) };
        lane += 1;
    }
    Some(fours)
}

#[inline(always)]
pub(crate) fn four_avx512(
    simd: Avx512,
    table: &[u32],
    index: u32x16<Avx512>,
) -> [u32x16<Avx512>; 4] {
    let Some(fours) = fours(simd, table, index) else {
        return [u32x16::splat(simd, 0); 4];
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn transpose(simd: Avx512, rows: [u32x16<Avx512>; 4]) -> [u32x16<Avx512>; 4] {
            use core::arch::x86_64::*;
            let [a, b, c, d] = rows;
            let [a, b, c, d] = [a.into(), b.into(), c.into(), d.into()];
            let upper = [_mm512_unpacklo_epi32(a, b), _mm512_unpacklo_epi32(c, d)];
            let lower = [_mm512_unpackhi_epi32(a, b), _mm512_unpackhi_epi32(c, d)];
            [
                _mm512_unpacklo_epi64(upper[0], upper[1]).simd_into(simd),
                _mm512_unpackhi_epi64(upper[0], upper[1]).simd_into(simd),
                _mm512_unpacklo_epi64(lower[0], lower[1]).simd_into(simd),
                _mm512_unpackhi_epi64(lower[0], lower[1]).simd_into(simd),
            ]
        }
    );
    let mut rows = [u32x16::splat(simd, 0); 4];
    let mut k = 0;
    while k < 4 {
        rows[k] = join_512(simd, fours[k], fours[k + 4], fours[k + 8], fours[k + 12]);
        k += 1;
    }
    transpose(simd, rows)
}

#[inline(always)]
pub(crate) fn four_avx2(simd: Avx2, table: &[u32], index: u32x16<Avx2>) -> [u32x16<Avx2>; 4] {
    let Some(fours) = fours(simd, table, index) else {
        return [u32x16::splat(simd, 0); 4];
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn transpose(simd: Avx2, rows: [u32x8<Avx2>; 4]) -> [u32x8<Avx2>; 4] {
            use core::arch::x86_64::*;
            let [a, b, c, d] = rows;
            let [a, b, c, d] = [a.into(), b.into(), c.into(), d.into()];
            let upper = [_mm256_unpacklo_epi32(a, b), _mm256_unpacklo_epi32(c, d)];
            let lower = [_mm256_unpackhi_epi32(a, b), _mm256_unpackhi_epi32(c, d)];
            [
                _mm256_unpacklo_epi64(upper[0], upper[1]).simd_into(simd),
                _mm256_unpackhi_epi64(upper[0], upper[1]).simd_into(simd),
                _mm256_unpacklo_epi64(lower[0], lower[1]).simd_into(simd),
                _mm256_unpackhi_epi64(lower[0], lower[1]).simd_into(simd),
            ]
        }
    );
    let mut rows = [[u32x8::splat(simd, 0); 4]; 2];
    let mut k = 0;
    while k < 4 {
        rows[0][k] = join_256(simd, fours[k], fours[k + 4]);
        rows[1][k] = join_256(simd, fours[k + 8], fours[k + 12]);
        k += 1;
    }
    let [a, b, c, d] = transpose(simd, rows[0]);
    let [e, f, g, h] = transpose(simd, rows[1]);
    [a.combine(e), b.combine(f), c.combine(g), d.combine(h)]
}

#[inline(always)]
pub(crate) fn four_sse2(simd: Sse2, table: &[u32], index: u32x16<Sse2>) -> [u32x16<Sse2>; 4] {
    let Some(fours) = fours(simd, table, index) else {
        return [u32x16::splat(simd, 0); 4];
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn transpose(simd: Sse2, rows: [__m128i; 4]) -> [u32x4<Sse2>; 4] {
            use core::arch::x86_64::*;
            let [a, b, c, d] = rows;
            let upper = [_mm_unpacklo_epi32(a, b), _mm_unpacklo_epi32(c, d)];
            let lower = [_mm_unpackhi_epi32(a, b), _mm_unpackhi_epi32(c, d)];
            [
                _mm_unpacklo_epi64(upper[0], upper[1]).simd_into(simd),
                _mm_unpackhi_epi64(upper[0], upper[1]).simd_into(simd),
                _mm_unpacklo_epi64(lower[0], lower[1]).simd_into(simd),
                _mm_unpackhi_epi64(lower[0], lower[1]).simd_into(simd),
            ]
        }
    );
    let mut parts = [[u32x4::splat(simd, 0); 4]; 4];
    let (rows, _) = fours.as_chunks::<4>();
    let mut k = 0;
    while k < 4 {
        parts[k] = transpose(simd, rows[k]);
        k += 1;
    }
    let mut four = [u32x16::splat(simd, 0); 4];
    k = 0;
    while k < 4 {
        let low = parts[0][k].combine(parts[1][k]);
        four[k] = low.combine(parts[2][k].combine(parts[3][k]));
        k += 1;
    }
    four
}
