//! Permutations whose order is known at run time, and lists of the bits of a mask.

use crate::LANES;
use fearless_simd::{Simd, SimdBase, SimdCombine, u16x16, u32x16};

/// The numbers of the bits that are set in each byte, in ascending order.
pub(crate) static SET_BITS: [[u8; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let (mut bit, mut count) = (0, 0);
        while bit < 8 {
            if byte >> bit & 1 == 1 {
                table[byte][count] = bit;
                count += 1;
            }
            bit += 1;
        }
        byte += 1;
    }
    table
};

/// [`Lanes::permute`](crate::Lanes::permute) lane by lane.
#[inline(always)]
pub(crate) fn by_lane<S: Simd>(simd: S, value: u32x16<S>, order: u32x16<S>) -> u32x16<S> {
    let (of, order) = (value.to_array(), order.to_array());
    let mut permuted = of;
    let mut lane = 0;
    while lane < LANES {
        permuted[lane] = of[order[lane] as usize % LANES];
        lane += 1;
    }
    u32x16::load_array(simd, permuted)
}

/// [`Lanes::list_bits`](crate::Lanes::list_bits) by a table of bytes.
#[inline(always)]
pub(crate) fn list_by_table(bits: u16, first: u32, out: &mut [u32; LANES]) -> usize {
    let [low, high] = bits.to_le_bytes();
    let mut number = 0;
    while number < 8 {
        out[number] = first + u32::from(SET_BITS[usize::from(low)][number]);
        number += 1;
    }
    let from = low.count_ones() as usize;
    let Some(out) = out.get_mut(from..from + 8) else {
        unreachable!("a byte has eight bits");
    };
    number = 0;
    while number < 8 {
        out[number] = first + 8 + u32::from(SET_BITS[usize::from(high)][number]);
        number += 1;
    }
    bits.count_ones() as usize
}

/// [`Lanes::list_bits_of_word`](crate::Lanes::list_bits_of_word) by a table of bytes.
#[inline(always)]
pub(crate) fn list_word_by_table(bits: u32, first: u16, out: &mut [u16; 32]) -> usize {
    let (mut from, mut before) = (0, first);
    for byte in bits.to_le_bytes() {
        let Some(out) = out.get_mut(from..from + 8) else {
            unreachable!("a byte has eight bits");
        };
        let mut number = 0;
        while number < 8 {
            out[number] = before + u16::from(SET_BITS[usize::from(byte)][number]);
            number += 1;
        }
        from += byte.count_ones() as usize;
        before += 8;
    }
    from
}

/// [`Lanes::widen`](crate::Lanes::widen) by halves.
#[inline(always)]
pub(crate) fn widen_halves<S: Simd>(simd: S, values: &[u16; LANES]) -> u32x16<S> {
    let (low, high) = simd.widen_u16x16(u16x16::load_array_ref(simd, values));
    low.combine(high)
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::*;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{LANES, SET_BITS};
    use crate::packing::{packing_avx2, store_halves};
    use fearless_simd::x86::{Avx2, Avx512};
    use fearless_simd::{
        SimdBase, SimdCombine, SimdInto, SimdMask, SimdSplit, mask16x32, mask32x16, u16x8, u16x16,
        u16x32, u32x8, u32x16,
    };

    #[inline(always)]
    pub(crate) fn permute_avx512(
        simd: Avx512,
        value: u32x16<Avx512>,
        order: u32x16<Avx512>,
    ) -> u32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(
                simd: Avx512,
                value: u32x16<Avx512>,
                order: u32x16<Avx512>,
            ) -> u32x16<Avx512> {
                use core::arch::x86_64::*;
                _mm512_permutexvar_epi32(order.into(), value.into()).simd_into(simd)
            }
        );
        kernel(simd, value, order)
    }

    /// Both halves are permuted, and bit 3 of the order chooses.
    #[inline(always)]
    pub(crate) fn permute_avx2(
        simd: Avx2,
        value: u32x16<Avx2>,
        order: u32x16<Avx2>,
    ) -> u32x16<Avx2> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx2, value: [u32x8<Avx2>; 2], order: u32x8<Avx2>) -> u32x8<Avx2> {
                use core::arch::x86_64::*;
                let [low, high] = value;
                let order = order.into();
                let low = _mm256_permutevar8x32_epi32(low.into(), order);
                let high = _mm256_permutevar8x32_epi32(high.into(), order);
                let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(order));
                let (low, high) = (_mm256_castsi256_ps(low), _mm256_castsi256_ps(high));
                _mm256_castps_si256(_mm256_blendv_ps(low, high, is_high)).simd_into(simd)
            }
        );
        let (low, high) = value.split();
        let (first, second) = order.split();
        let first = kernel(simd, [low, high], first);
        first.combine(kernel(simd, [low, high], second))
    }

    #[inline(always)]
    pub(crate) fn list_avx2(simd: Avx2, bits: u16, first: u32, out: &mut [u32; LANES]) -> usize {
        const HALVES: [u32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 8, 8, 8, 8, 8, 8, 8, 8];
        let first = u32x16::load_array(simd, HALVES) + u32x16::splat(simd, first);
        store_halves(packing_avx2(simd, bits) + first, bits, out);
        bits.count_ones() as usize
    }

    /// [`list_avx2`] of 32 bits, as half words.
    #[inline(always)]
    pub(crate) fn list_word_avx2(simd: Avx2, bits: u32, first: u16, out: &mut [u16; 32]) -> usize {
        fearless_simd::kernel!(
            #[inline(always)]
            fn widen(simd: Avx2, numbers: u64) -> u16x8<Avx2> {
                use core::arch::x86_64::*;
                let numbers = _mm_cvtsi64_si128(numbers.cast_signed());
                _mm_cvtepu8_epi16(numbers).simd_into(simd)
            }
        );
        let mut before = u16x8::splat(simd, first);
        let mut from = 0;
        for byte in bits.to_le_bytes() {
            let numbers = widen(simd, u64::from_le_bytes(SET_BITS[usize::from(byte)]));
            let Some(out) = out.get_mut(from..from + 8) else {
                unreachable!("a byte has eight bits");
            };
            (numbers + before).store_slice(out);
            from += byte.count_ones() as usize;
            before += u16x8::splat(simd, 8);
        }
        from
    }

    #[inline(always)]
    pub(crate) fn repeats_avx512(simd: Avx512, value: u32x16<Avx512>, lanes: u16) -> u16 {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, value: u32x16<Avx512>, lanes: u16) -> u16 {
                use core::arch::x86_64::*;
                // By lane: the earlier lanes that are equal, one bit each.
                let earlier = _mm512_conflict_epi32(value.into());
                let among = _mm512_set1_epi32(i32::from(lanes));
                _mm512_mask_test_epi32_mask(lanes, earlier, among)
            }
        );
        kernel(simd, value, lanes)
    }

    #[inline(always)]
    pub(crate) fn list_avx512(
        simd: Avx512,
        bits: u16,
        first: u32,
        out: &mut [u32; LANES],
    ) -> usize {
        const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
        let mask = mask32x16::from_bitmask(simd, u64::from(bits));
        let numbers = u32x16::load_array(simd, NUMBERS).compress(mask);
        (numbers + u32x16::splat(simd, first)).store_array(out);
        bits.count_ones() as usize
    }

    #[inline(always)]
    pub(crate) fn list_word_avx512(
        simd: Avx512,
        bits: u32,
        first: u16,
        out: &mut [u16; 32],
    ) -> usize {
        const NUMBERS: [u16; 32] = {
            let mut numbers = [0; 32];
            let mut bit = 0;
            while bit < 32 {
                numbers[bit as usize] = bit;
                bit += 1;
            }
            numbers
        };
        let mask = mask16x32::from_bitmask(simd, u64::from(bits));
        let numbers = u16x32::load_array(simd, NUMBERS).compress(mask);
        (numbers + u16x32::splat(simd, first)).store_array(out);
        bits.count_ones() as usize
    }

    #[inline(always)]
    pub(crate) fn widen_avx512(simd: Avx512, values: &[u16; LANES]) -> u32x16<Avx512> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx512, values: u16x16<Avx512>) -> u32x16<Avx512> {
                use core::arch::x86_64::*;
                _mm512_cvtepu16_epi32(values.into()).simd_into(simd)
            }
        );
        kernel(simd, u16x16::load_array_ref(simd, values))
    }
}
