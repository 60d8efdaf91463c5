//! Indexed loads: `table[index]` for sixteen indices at once.
//!
//! A hardware gather reads any address; clamping the indices to the table first makes it sound for
//! any input, at the cost of one instruction. Squares of four elements are read by loads of eight
//! bytes instead, and four neighbours by loads of sixteen: two gathers of pairs, or four of
//! elements, were measured to take longer on Zen 4, and half of the processors have no gather at
//! all. For single elements the gather is faster. This module has the crate's only `unsafe` code.

use crate::{LANES, Packet};
use fearless_simd::{Simd, SimdBase, u32x16};

/// The last valid index, or `None` for an empty table. Elements from 2³¹ on are not reachable,
/// because hardware indices are signed.
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
    // SAFETY: f32 and u32 have the same size and alignment, every bit pattern of either is valid,
    // and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(table.as_ptr().cast(), table.len()) }
}

/// Packets of words as packets of the floats that have these bits.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn floats_of(words: &[Packet<u32>]) -> &[Packet<f32>] {
    // SAFETY: packets of f32 and of u32 are arrays of as many values with the same alignment, every
    // bit pattern of either is valid, and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// Packets of words as packets of the signed integers that have these bits.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn ints_of(words: &[Packet<u32>]) -> &[Packet<i32>] {
    // SAFETY: as in `floats_of`: i32 and u32 have the same size, every bit pattern of either is
    // valid, and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// [`floats_of`], to store floats.
#[inline(always)]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn floats_of_mut(words: &mut [Packet<u32>]) -> &mut [Packet<f32>] {
    // SAFETY: as in `floats_of`; the borrow is exclusive, as the argument's is.
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), words.len()) }
}

/// The last index for which all of `index`, `index + 1`, `index + stride` and `index + stride + 1`
/// are valid, or `None` if the table is too short. Elements beyond 32-bit indices are not
/// reachable.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "cut to 32 bits just before"
)]
fn last_square(table: &[u32], stride: u32) -> Option<u32> {
    let last = table.len().checked_sub(stride as usize + 2)?;
    Some(last.min(u32::MAX as usize) as u32)
}

/// [`Lanes::gather_square`](crate::Lanes::gather_square) by four gathers.
#[inline(always)]
pub(crate) fn square_by_lane<S: Simd>(
    simd: S,
    table: &[u32],
    index: u32x16<S>,
    stride: u32,
) -> [u32x16<S>; 4] {
    let Some((first, last)) = table.get(stride as usize..).zip(last_square(table, stride)) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let index = index.min(u32x16::splat(simd, last));
    let next = index + u32x16::splat(simd, 1);
    [
        by_lane(simd, table, index),
        by_lane(simd, table, next),
        by_lane(simd, first, index),
        by_lane(simd, first, next),
    ]
}

/// The last index for which it and the next three are valid, or `None` if the table is too short.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "cut to 32 bits just before"
)]
fn last_four(table: &[u32]) -> Option<u32> {
    let last = table.len().checked_sub(4)?;
    Some(last.min(u32::MAX as usize) as u32)
}

/// [`Lanes::gather_four`](crate::Lanes::gather_four) by four gathers.
#[inline(always)]
pub(crate) fn four_by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> [u32x16<S>; 4] {
    let Some(last) = last_four(table) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let index = index.min(u32x16::splat(simd, last));
    let mut four = [index; 4];
    let mut k = 0;
    while k < 4 {
        four[k] = by_lane(simd, &table[k..], index);
        k += 1;
    }
    four
}

/// One load per lane, for SIMD levels without a gather instruction.
#[inline(always)]
pub(crate) fn by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> u32x16<S> {
    let Some(last) = last_index(table) else {
        return u32x16::splat(simd, 0);
    };
    let index = index.min(u32x16::splat(simd, last));
    let mut out = [0; LANES];
    for (value, &at) in out.iter_mut().zip(index.as_slice()) {
        // The index is in range; `get` spares the compiler a panic path.
        *value = table.get(at as usize).copied().unwrap_or_default();
    }
    u32x16::load_array(simd, out)
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{
    avx2, avx512, four_avx2, four_avx512, four_sse2, square_avx2, square_avx512, square_sse2,
};

#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]
mod x86 {
    use super::{last_four, last_index, last_square};
    use crate::LANES;
    use core::arch::x86_64::{
        __m128i, _mm_castpd_si128, _mm_loadu_si128, _mm_set_pd, _mm_setzero_si128,
    };
    use fearless_simd::x86::{Avx2, Avx512, Sse2};
    use fearless_simd::{Simd, SimdBase, SimdCombine, SimdInto, SimdSplit, u32x4, u32x8, u32x16};

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

    /// The indices as scalars, which go through memory on purpose: extracting lanes from registers
    /// made AVX2's trilinear samples take a quarter longer, and AVX-512's no shorter.
    #[inline(always)]
    fn scalars<S: Simd>(index: u32x16<S>) -> [u32; LANES] {
        std::hint::black_box(index.to_array())
    }

    /// Pairs of neighbours: two lanes in each 128 bits.
    type Pairs = [__m128i; LANES / 2];

    /// The two rows of the squares of sixteen lanes.
    ///
    /// Unsafe, because checks cost too much: one per lane and row, of indices that were clamped
    /// just before, made the whole no faster than gathers.
    #[inline(always)]
    fn squares<S: Simd>(
        simd: S,
        table: &[u32],
        index: u32x16<S>,
        stride: u32,
    ) -> Option<[Pairs; 2]> {
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

    /// Four neighbours for each of sixteen lanes. Unsafe for the same reason as [`squares`].
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

    fearless_simd::kernel!(
        #[inline(always)]
        fn join_512(
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
        fn join_256(simd: Avx2, a: __m128i, b: __m128i) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(a), b).simd_into(simd)
        }
    );

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
        fearless_simd::kernel!(
            #[inline(always)]
            fn divide(simd: Avx2, first: u32x8<Avx2>, second: u32x8<Avx2>) -> [u32x8<Avx2>; 2] {
                use core::arch::x86_64::*;
                let a = _mm256_castsi256_ps(first.into());
                let b = _mm256_castsi256_ps(second.into());
                let left = _mm256_castps_si256(_mm256_shuffle_ps::<0x88>(a, b));
                let right = _mm256_castps_si256(_mm256_shuffle_ps::<0xDD>(a, b));
                [left.simd_into(simd), right.simd_into(simd)]
            }
        );
        let mut four = [u32x16::splat(simd, 0); 4];
        let mut row = 0;
        while row < 2 {
            let [a, b, c, d, e, f, g, h] = rows[row];
            let [left, right] = divide(simd, join_256(simd, a, c), join_256(simd, b, d));
            let [left_2, right_2] = divide(simd, join_256(simd, e, g), join_256(simd, f, h));
            four[2 * row] = left.combine(left_2);
            four[2 * row + 1] = right.combine(right_2);
            row += 1;
        }
        four
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
}
