//! Indexed loads: `table[index]` for sixteen indices at once.
//!
//! A hardware gather reads any address; clamping the indices to the table first makes it sound for
//! any input, at the cost of one instruction. Squares of four elements are read by loads of eight
//! bytes instead: two gathers of pairs, or four of elements, were measured to take longer on Zen 4,
//! and half of the processors have no gather at all. For single elements the gather is faster. This
//! module has the crate's only `unsafe` code.

use crate::LANES;
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
pub(crate) use x86::{avx2, avx512, lookup_avx512, square_avx2, square_avx512, square_sse2};

#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "the gather intrinsics take a raw pointer")]
mod x86 {
    use super::{last_index, last_square};
    use crate::LANES;
    use core::arch::x86_64::{__m128i, _mm_castpd_si128, _mm_set_pd, _mm_setzero_si128};
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

    /// [`Lanes::lookup`](crate::Lanes::lookup) by permutations: eight of 32 elements each, from which the index's
    /// highest three bits choose. Sixteen loads of one element take two to three times as long.
    #[inline(always)]
    pub(crate) fn lookup_avx512(
        simd: Avx512,
        table: &[u32; 256],
        index: u32x16<Avx512>,
    ) -> u32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn of_32(
                simd: Avx512,
                low: u32x16<Avx512>,
                index: u32x16<Avx512>,
                high: u32x16<Avx512>,
            ) -> u32x16<Avx512> {
                use core::arch::x86_64::*;
                _mm512_permutex2var_epi32(low.into(), index.into(), high.into()).simd_into(simd)
            }
        );
        fearless_simd::kernel!(
            #[inline(always)]
            fn choose(
                simd: Avx512,
                clear: u32x16<Avx512>,
                set: u32x16<Avx512>,
                index: u32x16<Avx512>,
                bit: u32x16<Avx512>,
            ) -> u32x16<Avx512> {
                use core::arch::x86_64::*;
                let is_set = _mm512_test_epi32_mask(index.into(), bit.into());
                _mm512_mask_blend_epi32(is_set, clear.into(), set.into()).simd_into(simd)
            }
        );
        let mut found = [u32x16::splat(simd, 0); 8];
        let (rows, _) = table.as_chunks::<16>();
        let mut k = 0;
        while k < 8 {
            let low = u32x16::load_array_ref(simd, &rows[2 * k]);
            let high = u32x16::load_array_ref(simd, &rows[2 * k + 1]);
            found[k] = of_32(simd, low, index, high);
            k += 1;
        }
        let bit = |value| u32x16::splat(simd, value);
        let [a, b, c, d, e, f, g, h] = found;
        let a = choose(simd, a, b, index, bit(32));
        let c = choose(simd, c, d, index, bit(32));
        let e = choose(simd, e, f, index, bit(32));
        let g = choose(simd, g, h, index, bit(32));
        let a = choose(simd, a, c, index, bit(64));
        let e = choose(simd, e, g, index, bit(64));
        choose(simd, a, e, index, bit(128))
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

    /// The squares of sixteen lanes, each in 128 bits: left and right of the upper row, then of the
    /// lower.
    ///
    /// Unsafe, because checks cost too much: one per lane and row, of indices that were clamped
    /// just before, made the whole no faster than gathers.
    #[inline(always)]
    fn squares<S: Simd>(
        simd: S,
        table: &[u32],
        index: u32x16<S>,
        stride: u32,
    ) -> Option<[__m128i; LANES]> {
        let last = last_square(table, stride)?;
        // The indices go through memory on purpose: extracting lanes from registers made AVX2's
        // trilinear samples take a quarter longer, and AVX-512's no shorter.
        let index = index.min(u32x16::splat(simd, last)).to_array();
        let index = std::hint::black_box(index);
        let upper = table.as_ptr();
        let lower = upper.wrapping_add(stride as usize);
        // SAFETY: SSE2 is x86-64's baseline.
        let mut squares = [unsafe { _mm_setzero_si128() }; LANES];
        let mut lane = 0;
        while lane < LANES {
            let at = index[lane] as usize;
            let (upper, lower) = (upper.wrapping_add(at), lower.wrapping_add(at));
            // SAFETY: `at` is at most `last`, so `at + 1` is in the table, and all eight bytes are
            // inside.
            let upper = unsafe { upper.cast::<u64>().read_unaligned() };
            // SAFETY: `at` is at most `last`, so `at + stride + 1` is in the table, and all eight
            // bytes are inside.
            let lower = unsafe { lower.cast::<u64>().read_unaligned() };
            // As f64, because the compiler then emits a load and a load with insertion; moves keep
            // all bits. SAFETY: SSE2 is x86-64's baseline.
            let square = unsafe { _mm_set_pd(f64::from_bits(lower), f64::from_bits(upper)) };
            // SAFETY: as above.
            squares[lane] = unsafe { _mm_castpd_si128(square) };
            lane += 1;
        }
        Some(squares)
    }

    #[inline(always)]
    pub(crate) fn square_avx512(
        simd: Avx512,
        table: &[u32],
        index: u32x16<Avx512>,
        stride: u32,
    ) -> [u32x16<Avx512>; 4] {
        let Some(squares) = squares(simd, table, index, stride) else {
            return [u32x16::splat(simd, 0); 4];
        };
        // The functions are small, because a long one would not be inlined.
        fearless_simd::kernel!(
            #[inline(always)]
            fn join(
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
            let [a, b] = [squares[k], squares[k + 4]];
            rows[k] = join(simd, a, b, squares[k + 8], squares[k + 12]);
            k += 1;
        }
        transpose(simd, rows)
    }

    #[inline(always)]
    pub(crate) fn square_avx2(
        simd: Avx2,
        table: &[u32],
        index: u32x16<Avx2>,
        stride: u32,
    ) -> [u32x16<Avx2>; 4] {
        let Some(squares) = squares(simd, table, index, stride) else {
            return [u32x16::splat(simd, 0); 4];
        };
        fearless_simd::kernel!(
            #[inline(always)]
            fn join(simd: Avx2, a: __m128i, b: __m128i) -> u32x8<Avx2> {
                use core::arch::x86_64::*;
                _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(a), b).simd_into(simd)
            }
        );
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
            rows[0][k] = join(simd, squares[k], squares[k + 4]);
            rows[1][k] = join(simd, squares[k + 8], squares[k + 12]);
            k += 1;
        }
        let [a, b, c, d] = transpose(simd, rows[0]);
        let [e, f, g, h] = transpose(simd, rows[1]);
        [a.combine(e), b.combine(f), c.combine(g), d.combine(h)]
    }

    #[inline(always)]
    pub(crate) fn square_sse2(
        simd: Sse2,
        table: &[u32],
        index: u32x16<Sse2>,
        stride: u32,
    ) -> [u32x16<Sse2>; 4] {
        let Some(squares) = squares(simd, table, index, stride) else {
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
        let (rows, _) = squares.as_chunks::<4>();
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
