//! Permutations whose order is known at run time, and lists of the bits of a mask.

use crate::{LANES, Lanes};
use fearless_simd::{Bytes, Simd, SimdBase, SimdCombine, f32x16, u16x16, u32x16};

/// Some lanes of a packet that are moved together: they keep their order.
///
/// ```text
///   a·bc ··d· ···· e·f·   ─▶   abcdef
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Packing<S: Lanes> {
    /// The order to permute by; where a register holds half of a packet, that of each half.
    pub(crate) order: u32x16<S>,
    pub(crate) lanes: u16,
}

impl<S: Lanes> Packing<S> {
    /// Moves the lanes of a mask.
    #[inline(always)]
    #[must_use]
    pub fn new(s: S, lanes: u16) -> Self {
        let order = s.packing_order(lanes);
        Self { order, lanes }
    }

    /// A packing of the same lanes whose order was [stored](Self::store_order).
    #[inline(always)]
    #[must_use]
    pub fn load(s: S, order: &[u32; LANES], lanes: u16) -> Self {
        let order = u32x16::load_array_ref(s, order);
        Self { order, lanes }
    }

    /// Stores the order, for [`Packing::load`] at this SIMD level.
    #[inline(always)]
    pub fn store_order(&self, order: &mut [u32; LANES]) {
        self.order.store_array(order);
    }

    /// The number of lanes that are moved.
    #[inline(always)]
    #[must_use]
    pub fn count(&self) -> usize {
        self.lanes.count_ones() as usize
    }

    /// Stores their values; what lies behind these in `out` is unspecified.
    #[inline(always)]
    pub fn store(&self, s: S, values: u32x16<S>, out: &mut [u32; LANES]) {
        s.store_packed(values, self, out);
    }

    /// [`Packing::store`] of floats.
    #[inline(always)]
    pub fn store_f32(&self, s: S, values: f32x16<S>, out: &mut [f32; LANES]) {
        let out = crate::gather::bits_of_sixteen(out);
        s.store_packed(values.bitcast(), self, out);
    }
}

/// The numbers of the bits that are set in each byte, in ascending order.
static SET_BITS: [[u8; 8]; 256] = {
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
    use super::{LANES, Packing, SET_BITS};
    use fearless_simd::x86::{Avx2, Avx512};
    use fearless_simd::{
        Simd, SimdBase, SimdCombine, SimdInto, SimdMask, SimdSplit, i32x8, i32x16, mask16x32,
        mask32x8, mask32x16, u16x8, u16x16, u16x32, u32x8, u32x16,
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

    /// The table's bytes of the bits that are set in each byte, as words.
    #[inline(always)]
    pub(crate) fn packing_avx2(simd: Avx2, bits: u16) -> u32x16<Avx2> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn widen(simd: Avx2, numbers: u64) -> u32x8<Avx2> {
                use core::arch::x86_64::*;
                let numbers = _mm_cvtsi64_si128(numbers.cast_signed());
                _mm256_cvtepu8_epi32(numbers).simd_into(simd)
            }
        );
        let [low, high] = bits.to_le_bytes();
        let low = widen(simd, u64::from_le_bytes(SET_BITS[usize::from(low)]));
        let high = widen(simd, u64::from_le_bytes(SET_BITS[usize::from(high)]));
        low.combine(high)
    }

    /// Stores the lanes of the first half, then those of the second behind them.
    #[inline(always)]
    fn store_halves(halves: u32x16<Avx2>, lanes: u16, out: &mut [u32; LANES]) {
        let (first, second) = halves.split();
        first.store_slice(&mut out[..8]);
        let from = (lanes & 0xFF).count_ones() as usize;
        let Some(out) = out.get_mut(from..from + 8) else {
            unreachable!("half of a packet has eight lanes");
        };
        second.store_slice(out);
    }

    #[inline(always)]
    pub(crate) fn list_avx2(simd: Avx2, bits: u16, first: u32, out: &mut [u32; LANES]) -> usize {
        const HALVES: [u32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 8, 8, 8, 8, 8, 8, 8, 8];
        let first = u32x16::load_array(simd, HALVES) + u32x16::splat(simd, first);
        store_halves(packing_avx2(simd, bits) + first, bits, out);
        bits.count_ones() as usize
    }

    #[inline(always)]
    pub(crate) fn store_packed_avx2(
        simd: Avx2,
        values: u32x16<Avx2>,
        packing: &Packing<Avx2>,
        out: &mut [u32; LANES],
    ) {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx2, values: u32x8<Avx2>, order: u32x8<Avx2>) -> u32x8<Avx2> {
                use core::arch::x86_64::*;
                _mm256_permutevar8x32_epi32(values.into(), order.into()).simd_into(simd)
            }
        );
        let ((low, high), (of_low, of_high)) = (values.split(), packing.order.split());
        let halves = kernel(simd, low, of_low).combine(kernel(simd, high, of_high));
        store_halves(halves, packing.lanes, out);
    }

    /// The sign bits, by two packs that saturate. As two moves of eight bits each, the compiler
    /// joins them before: it then compares with zero, and packs these masks.
    #[inline(always)]
    pub(crate) fn sign_bits_avx2(simd: Avx2, a: i32x16<Avx2>) -> u16 {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx2, low: i32x8<Avx2>, high: i32x8<Avx2>) -> i32 {
                use core::arch::x86_64::*;
                let _ = simd;
                // In each 128 bits four lanes of the first half, then four of the second.
                let words = _mm256_packs_epi32(low.into(), high.into());
                let upper = _mm256_extracti128_si256::<1>(words);
                let bytes = _mm_packs_epi16(_mm256_castsi256_si128(words), upper);
                _mm_movemask_epi8(_mm_shuffle_epi32::<0b11_01_10_00>(bytes))
            }
        );
        let (low, high) = a.split();
        kernel(simd, low, high) as u16
    }

    /// [`sign_bits_avx2`] of a mask.
    #[inline(always)]
    pub(crate) fn bits_of_mask_avx2(simd: Avx2, mask: mask32x16<Avx2>) -> u16 {
        fearless_simd::kernel!(
            #[inline(always)]
            fn half(simd: Avx2, mask: mask32x8<Avx2>) -> i32x8<Avx2> {
                use core::arch::x86_64::*;
                let lanes: __m256i = mask.into();
                lanes.simd_into(simd)
            }
        );
        let (low, high) = simd.split_mask32x16(mask);
        sign_bits_avx2(simd, half(simd, low).combine(half(simd, high)))
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
