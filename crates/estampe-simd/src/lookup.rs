//! Tables of 256 elements and of sixteen, read by permutations of registers.
//!
//! A permutation reads two registers of a table at once, so all sixteen lanes are served by eight
//! of them, where a gather loads lane by lane.

use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdBase, SimdCombine, SimdInto, SimdSplit, u8x64, u32x8, u32x16};

use crate::ByteTable;

/// [`Lanes::lookup`](crate::Lanes::lookup) by permutations: eight of 32 elements each, from which
/// the index's highest three bits choose. Sixteen loads of one element take two to three times as
/// long.
#[inline(always)]
pub(crate) fn avx512(simd: Avx512, table: &[u32; 256], index: u32x16<Avx512>) -> u32x16<Avx512> {
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

/// [`Lanes::lookup_three`](crate::Lanes::lookup_three) by permutations of bytes, which look 64
/// bytes up at once: for each of the values' four bytes, two permutations of 128 elements each,
/// from which the index's highest bit chooses. The bytes of a value are then brought together,
/// sixteen channels side by side.
#[inline(always)]
pub(crate) fn three_avx512(
    simd: Avx512,
    table: &ByteTable,
    words: u32x16<Avx512>,
) -> [u32x16<Avx512>; 3] {
    fearless_simd::kernel!(
        #[inline(always)]
        fn by_channel(simd: Avx512, words: u32x16<Avx512>) -> u8x64<Avx512> {
            use core::arch::x86_64::*;
            // In each 128 bits four words: all first bytes, then all second ones, and so on.
            let order = _mm_setr_epi8(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
            _mm512_shuffle_epi8(words.into(), _mm512_broadcast_i32x4(order)).simd_into(simd)
        }
    );
    fearless_simd::kernel!(
        #[inline(always)]
        fn of_256(simd: Avx512, plane: [u8x64<Avx512>; 4], index: u8x64<Avx512>) -> u8x64<Avx512> {
            use core::arch::x86_64::*;
            let [a, b, c, d] = plane;
            let low = _mm512_permutex2var_epi8(a.into(), index.into(), b.into());
            let high = _mm512_permutex2var_epi8(c.into(), index.into(), d.into());
            let is_high = _mm512_movepi8_mask(index.into());
            _mm512_mask_blend_epi8(is_high, low, high).simd_into(simd)
        }
    );
    fearless_simd::kernel!(
        #[inline(always)]
        fn together(simd: Avx512, bytes: [u8x64<Avx512>; 4]) -> [u32x16<Avx512>; 3] {
            use core::arch::x86_64::*;
            let [a, b, c, d] = bytes;
            let [a, b, c, d] = [a.into(), b.into(), c.into(), d.into()];
            let low = [_mm512_unpacklo_epi8(a, b), _mm512_unpacklo_epi8(c, d)];
            let high = [_mm512_unpackhi_epi8(a, b), _mm512_unpackhi_epi8(c, d)];
            [
                _mm512_unpacklo_epi16(low[0], low[1]).simd_into(simd),
                _mm512_unpackhi_epi16(low[0], low[1]).simd_into(simd),
                _mm512_unpacklo_epi16(high[0], high[1]).simd_into(simd),
            ]
        }
    );
    let index = by_channel(simd, words);
    let mut bytes = [index; 4];
    let mut k = 0;
    while k < 4 {
        let (parts, _) = table.bytes[k].0.as_chunks::<64>();
        let plane = [
            u8x64::load_array_ref(simd, &parts[0]),
            u8x64::load_array_ref(simd, &parts[1]),
            u8x64::load_array_ref(simd, &parts[2]),
            u8x64::load_array_ref(simd, &parts[3]),
        ];
        bytes[k] = of_256(simd, plane, index);
        k += 1;
    }
    together(simd, bytes)
}

/// [`Lanes::lookup_sixteen`](crate::Lanes::lookup_sixteen) by one permutation.
#[inline(always)]
pub(crate) fn sixteen_avx512(
    simd: Avx512,
    table: &[u32; 16],
    index: u32x16<Avx512>,
) -> u32x16<Avx512> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(simd: Avx512, table: u32x16<Avx512>, index: u32x16<Avx512>) -> u32x16<Avx512> {
            use core::arch::x86_64::*;
            _mm512_permutexvar_epi32(index.into(), table.into()).simd_into(simd)
        }
    );
    kernel(simd, u32x16::load_array_ref(simd, table), index)
}

/// [`Lanes::lookup_sixteen`](crate::Lanes::lookup_sixteen) by permutations of eight elements, from
/// which the index's fourth bit chooses.
#[inline(always)]
pub(crate) fn sixteen_avx2(simd: Avx2, table: &[u32; 16], index: u32x16<Avx2>) -> u32x16<Avx2> {
    fearless_simd::kernel!(
        #[inline(always)]
        fn kernel(
            simd: Avx2,
            low: u32x8<Avx2>,
            high: u32x8<Avx2>,
            index: u32x8<Avx2>,
        ) -> u32x8<Avx2> {
            use core::arch::x86_64::*;
            let index = index.into();
            let low = _mm256_permutevar8x32_epi32(low.into(), index);
            let high = _mm256_permutevar8x32_epi32(high.into(), index);
            let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
            let [low, high] = [_mm256_castsi256_ps(low), _mm256_castsi256_ps(high)];
            _mm256_castps_si256(_mm256_blendv_ps(low, high, is_high)).simd_into(simd)
        }
    );
    let (low, high) = u32x16::load_array_ref(simd, table).split();
    let (first, second) = index.split();
    kernel(simd, low, high, first).combine(kernel(simd, low, high, second))
}
