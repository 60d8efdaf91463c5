//! Squares of four elements, and pairs, by loads of eight bytes.
#![expect(unsafe_code, reason = "a check of each lane's index costs too much")]

use super::last_square;
use super::registers::{divide_256, join_256, join_512, scalars};
use crate::LANES;
use core::arch::x86_64::{__m128i, _mm_castpd_si128, _mm_set_pd, _mm_setzero_si128};
use fearless_simd::x86::{Avx2, Avx512, Sse2};
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdInto, u32x4, u32x16};

/// Pairs of neighbours: two lanes in each 128 bits.
type Pairs = [__m128i; LANES / 2];

/// The two rows of the squares of sixteen lanes.
///
/// Unsafe, because checks cost too much: one per lane and row, of indices that were clamped
/// just before, made the whole no faster than gathers.
#[inline(always)]
fn squares<S: Simd>(simd: S, table: &[u32], index: u32x16<S>, stride: u32) -> Option<[Pairs; 2]> {
    let last = last_square(table, stride)?;
    let index = scalars(index.min(u32x16::splat(simd, last)));
    let upper = table.as_ptr();
    let lower = upper.wrapping_add(stride as usize);
    // SAFETY: SSE2 is x86-64's baseline.
    let mut rows = [[unsafe { _mm_setzero_si128() }; LANES / 2]; 2];
    let mut pair = 0;
    while pair < LANES / 2 {
        let [a, b] = [index[2 * pair] as usize, index[2 * pair + 1] as usize];
        // SAFETY: `a` is at most `last`, so `a + 1` is in the table, and all eight bytes are
        // inside.
        let a_upper = unsafe { upper.wrapping_add(a).cast::<u64>().read_unaligned() };
        // SAFETY: the same of `b`.
        let b_upper = unsafe { upper.wrapping_add(b).cast::<u64>().read_unaligned() };
        // SAFETY: `a` is at most `last`, so `a + stride + 1` is in the table, and all eight
        // bytes are inside.
        let a_lower = unsafe { lower.wrapping_add(a).cast::<u64>().read_unaligned() };
        // SAFETY: the same of `b`.
        let b_lower = unsafe { lower.wrapping_add(b).cast::<u64>().read_unaligned() };
        rows[0][pair] = joined(a_upper, b_upper);
        rows[1][pair] = joined(a_lower, b_lower);
        pair += 1;
    }
    Some(rows)
}

/// Two times eight bytes side by side.
#[inline(always)]
fn joined(low: u64, high: u64) -> __m128i {
    // As f64, because the compiler then emits a load and a load with insertion; moves keep all
    // bits. SAFETY: SSE2 is x86-64's baseline.
    let both = unsafe { _mm_set_pd(f64::from_bits(high), f64::from_bits(low)) };
    // SAFETY: as above.
    unsafe { _mm_castpd_si128(both) }
}

#[inline(always)]
pub(crate) fn square_avx512(
    simd: Avx512,
    table: &[u32],
    index: u32x16<Avx512>,
    stride: u32,
) -> [u32x16<Avx512>; 4] {
    let Some(rows) = squares(simd, table, index, stride) else {
        return [u32x16::splat(simd, 0); 4];
    };
    // The functions are small, because a long one would not be inlined.
    fearless_simd::kernel!(
        #[inline(always)]
        fn divide(
            simd: Avx512,
            first: u32x16<Avx512>,
            second: u32x16<Avx512>,
        ) -> [u32x16<Avx512>; 2] {
            use core::arch::x86_64::*;
            let a = _mm512_castsi512_ps(first.into());
            let b = _mm512_castsi512_ps(second.into());
            let left = _mm512_castps_si512(_mm512_shuffle_ps::<0x88>(a, b));
            let right = _mm512_castps_si512(_mm512_shuffle_ps::<0xDD>(a, b));
            [left.simd_into(simd), right.simd_into(simd)]
        }
    );
    let [[a, b, c, d, e, f, g, h], [i, j, k, l, m, n, o, p]] = rows;
    let upper = [join_512(simd, a, c, e, g), join_512(simd, b, d, f, h)];
    let lower = [join_512(simd, i, k, m, o), join_512(simd, j, l, n, p)];
    let [left, right] = divide(simd, upper[0], upper[1]);
    let [lower_left, lower_right] = divide(simd, lower[0], lower[1]);
    [left, right, lower_left, lower_right]
}

#[inline(always)]
pub(crate) fn square_avx2(
    simd: Avx2,
    table: &[u32],
    index: u32x16<Avx2>,
    stride: u32,
) -> [u32x16<Avx2>; 4] {
    let Some(rows) = squares(simd, table, index, stride) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let mut four = [u32x16::splat(simd, 0); 4];
    let mut row = 0;
    while row < 2 {
        let [a, b, c, d, e, f, g, h] = rows[row];
        let [left, right] = divide_256(simd, join_256(simd, a, c), join_256(simd, b, d));
        let [left_2, right_2] = divide_256(simd, join_256(simd, e, g), join_256(simd, f, h));
        four[2 * row] = left.combine(left_2);
        four[2 * row + 1] = right.combine(right_2);
        row += 1;
    }
    four
}

/// [`Lanes::gather_pair`](crate::Lanes::gather_pair) by loads of eight bytes.
#[inline(always)]
pub(crate) fn pair_avx2(simd: Avx2, table: &[u32], index: u32x16<Avx2>) -> [u32x16<Avx2>; 2] {
    let Some(last) = last_square(table, 0) else {
        return [u32x16::splat(simd, 0); 2];
    };
    let index = scalars(index.min(u32x16::splat(simd, last)));
    let base = table.as_ptr();
    // SAFETY: SSE2 is x86-64's baseline.
    let mut pairs = [unsafe { _mm_setzero_si128() }; LANES / 2];
    let mut pair = 0;
    while pair < LANES / 2 {
        let [a, b] = [index[2 * pair] as usize, index[2 * pair + 1] as usize];
        // SAFETY: `a` is at most `last`, so `a + 1` is in the table, and all eight bytes are
        // inside.
        let a = unsafe { base.wrapping_add(a).cast::<u64>().read_unaligned() };
        // SAFETY: the same of `b`.
        let b = unsafe { base.wrapping_add(b).cast::<u64>().read_unaligned() };
        pairs[pair] = joined(a, b);
        pair += 1;
    }
    let [a, b, c, d, e, f, g, h] = pairs;
    let [left, right] = divide_256(simd, join_256(simd, a, c), join_256(simd, b, d));
    let [left_2, right_2] = divide_256(simd, join_256(simd, e, g), join_256(simd, f, h));
    [left.combine(left_2), right.combine(right_2)]
}

#[inline(always)]
pub(crate) fn square_sse2(
    simd: Sse2,
    table: &[u32],
    index: u32x16<Sse2>,
    stride: u32,
) -> [u32x16<Sse2>; 4] {
    let Some(rows) = squares(simd, table, index, stride) else {
        return [u32x16::splat(simd, 0); 4];
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn divide(simd: Sse2, first: __m128i, second: __m128i) -> [u32x4<Sse2>; 2] {
            use core::arch::x86_64::*;
            let (a, b) = (_mm_castsi128_ps(first), _mm_castsi128_ps(second));
            let left = _mm_castps_si128(_mm_shuffle_ps::<0x88>(a, b));
            let right = _mm_castps_si128(_mm_shuffle_ps::<0xDD>(a, b));
            [left.simd_into(simd), right.simd_into(simd)]
        }
    );
    let mut four = [u32x16::splat(simd, 0); 4];
    let mut row = 0;
    while row < 2 {
        let [a, b, c, d, e, f, g, h] = rows[row];
        let [a, b] = divide(simd, a, b);
        let [c, d] = divide(simd, c, d);
        let [e, f] = divide(simd, e, f);
        let [g, h] = divide(simd, g, h);
        four[2 * row] = a.combine(c).combine(e.combine(g));
        four[2 * row + 1] = b.combine(d).combine(f.combine(h));
        row += 1;
    }
    four
}
