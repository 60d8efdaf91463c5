//! Squares of four elements, by gathers of pairs: a gather of eight bytes for each lane and row.
#![expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]

use super::last_square;
use super::registers::divide_256;
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdInto, SimdSplit, u32x4, u32x8, u32x16};

/// The table from its second row on, and the indices, of which none is beyond `last_square`.
#[inline(always)]
fn rows<S: Simd>(
    simd: S,
    table: &[u32],
    index: u32x16<S>,
    stride: u32,
) -> Option<([&[u32]; 2], u32x16<S>)> {
    let last = last_square(table, stride)?;
    let lower = table.get(stride as usize..)?;
    Some(([table, lower], index.min(u32x16::splat(simd, last))))
}

/// [`Lanes::gather_square`](crate::Lanes::gather_square) by four gathers of eight pairs.
#[inline(always)]
pub(crate) fn square_avx512(
    simd: Avx512,
    table: &[u32],
    index: u32x16<Avx512>,
    stride: u32,
) -> [u32x16<Avx512>; 4] {
    let Some((rows, index)) = rows(simd, table, index, stride) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let [upper, lower] = rows;
    let [left, right] = pairs_of_row(simd, upper, index);
    let [lower_left, lower_right] = pairs_of_row(simd, lower, index);
    [left, right, lower_left, lower_right]
}

/// [`Lanes::gather_pair`](crate::Lanes::gather_pair) by two gathers of eight pairs.
#[inline(always)]
pub(crate) fn pair_avx512(
    simd: Avx512,
    table: &[u32],
    index: u32x16<Avx512>,
) -> [u32x16<Avx512>; 2] {
    match last_square(table, 0) {
        Some(last) => pairs_of_row(simd, table, index.min(u32x16::splat(simd, last))),
        None => [u32x16::splat(simd, 0); 2],
    }
}

/// The elements at each index, which is at most `last_square`, and the next ones.
#[inline(always)]
fn pairs_of_row(simd: Avx512, row: &[u32], index: u32x16<Avx512>) -> [u32x16<Avx512>; 2] {
    fearless_simd::kernel!(
        #[inline(always)]
        fn pairs(simd: Avx512, row: &[u32], index: u32x8<Avx512>) -> u32x16<Avx512> {
            use core::arch::x86_64::*;
            let base = row.as_ptr().cast::<i64>();
            // SAFETY: the token proves AVX-512F. Every index is at most `last_square`, so `index`
            // and `index + 1` are in the row, which is borrowed for the call: each lane reads eight
            // bytes inside. Indices are below 2³¹.
            let pairs = unsafe { _mm512_i32gather_epi64::<4>(index.into(), base) };
            pairs.simd_into(simd)
        }
    );
    fearless_simd::kernel!(
        #[inline(always)]
        fn divide(simd: Avx512, low: u32x16<Avx512>, high: u32x16<Avx512>) -> [u32x16<Avx512>; 2] {
            use core::arch::x86_64::*;
            let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
            let (low, high) = (low.into(), high.into());
            [
                _mm512_permutex2var_epi32(low, even, high).simd_into(simd),
                _mm512_permutex2var_epi32(low, odd, high).simd_into(simd),
            ]
        }
    );
    let (low, high) = index.split();
    divide(simd, pairs(simd, row, low), pairs(simd, row, high))
}

/// [`Lanes::gather_square`](crate::Lanes::gather_square) by eight gathers of four pairs.
#[inline(always)]
pub(crate) fn square_avx2(
    simd: Avx2,
    table: &[u32],
    index: u32x16<Avx2>,
    stride: u32,
) -> [u32x16<Avx2>; 4] {
    let Some((rows, index)) = rows(simd, table, index, stride) else {
        return [u32x16::splat(simd, 0); 4];
    };
    fearless_simd::kernel!(
        #[inline(always)]
        fn pairs(simd: Avx2, row: &[u32], index: u32x4<Avx2>) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            let base = row.as_ptr().cast::<i64>();
            // SAFETY: the token proves AVX2. Every index is at most `last_square`, so `index` and
            // `index + 1` are in the row, which is borrowed for the call: each lane reads eight
            // bytes inside. Indices are below 2³¹.
            let pairs = unsafe { _mm256_i32gather_epi64::<4>(base, index.into()) };
            pairs.simd_into(simd)
        }
    );
    fearless_simd::kernel!(
        // Lanes 0, 1, 4, 5, then 2, 3, 6, 7: pairs in this order are divided inside 128 bits.
        #[inline(always)]
        fn ordered(simd: Avx2, index: u32x8<Avx2>) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            _mm256_permute4x64_epi64::<0b11_01_10_00>(index.into()).simd_into(simd)
        }
    );
    let (low, high) = index.split();
    let (a, b) = ordered(simd, low).split();
    let (c, d) = ordered(simd, high).split();
    let mut four = [u32x16::splat(simd, 0); 4];
    let mut row = 0;
    while row < 2 {
        let from = rows[row];
        let [left, right] = divide_256(simd, pairs(simd, from, a), pairs(simd, from, b));
        let [left_2, right_2] = divide_256(simd, pairs(simd, from, c), pairs(simd, from, d));
        four[2 * row] = left.combine(left_2);
        four[2 * row + 1] = right.combine(right_2);
        row += 1;
    }
    four
}
