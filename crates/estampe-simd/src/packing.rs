//! Orders of lanes for which AVX2 has a shorter way than by any permutation of sixteen lanes, which
//! is two permutations and a choice for each half: lanes that move together, and windows of eight
//! neighbours.

use crate::{LANES, Lanes};
use fearless_simd::{Bytes, SimdBase, f32x16, u32x16};

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

/// An order that takes each half of a packet from eight neighbouring lanes.
#[derive(Debug, Clone, Copy)]
pub struct Window<S: Lanes> {
    /// The order, counted from the first of the eight.
    pub(crate) order: u32x16<S>,
    /// The first lane of each half: 8 at most.
    pub(crate) first: [usize; 2],
}

impl<S: Lanes> Window<S> {
    /// The order's window, if it has one and the SIMD level [has windows](Lanes::HAS_WINDOWS).
    #[inline(always)]
    #[must_use]
    pub fn new(s: S, order: u32x16<S>) -> Option<Self> {
        s.window(order)
    }

    /// [`Lanes::permute_f32`] by the order.
    #[inline(always)]
    #[must_use]
    pub fn permute_f32(&self, s: S, values: &[f32; LANES]) -> f32x16<S> {
        s.permute_window(values, self)
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::*;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Packing, Window};
    use crate::LANES;
    use crate::permute::SET_BITS;
    use fearless_simd::x86::Avx2;
    use fearless_simd::{SimdBase, SimdCombine, SimdInto, SimdSplit, f32x8, f32x16, u32x8, u32x16};

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
    pub(crate) fn store_halves(halves: u32x16<Avx2>, lanes: u16, out: &mut [u32; LANES]) {
        let (first, second) = halves.split();
        first.store_slice(&mut out[..8]);
        let from = (lanes & 0xFF).count_ones() as usize;
        let Some(out) = out.get_mut(from..from + 8) else {
            unreachable!("half of a packet has eight lanes");
        };
        second.store_slice(out);
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

    #[inline(always)]
    pub(crate) fn window_avx2(simd: Avx2, order: u32x16<Avx2>) -> Option<Window<Avx2>> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn is_inside(simd: Avx2, low: u32x8<Avx2>, high: u32x8<Avx2>) -> bool {
                use core::arch::x86_64::*;
                let _ = simd;
                let both = _mm256_or_si256(low.into(), high.into());
                _mm256_testz_si256(both, _mm256_set1_epi32(!7)) != 0
            }
        );
        let (low, high) = order.split();
        let first = [low[0].min(8), high[0].min(8)];
        let low = low - u32x8::splat(simd, first[0]);
        let high = high - u32x8::splat(simd, first[1]);
        is_inside(simd, low, high).then(|| Window {
            order: low.combine(high),
            first: first.map(|first| first as usize),
        })
    }

    /// One permutation of each half, where any order takes two and a choice.
    #[inline(always)]
    pub(crate) fn permute_window_avx2(
        simd: Avx2,
        values: &[f32; LANES],
        window: &Window<Avx2>,
    ) -> f32x16<Avx2> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn kernel(simd: Avx2, values: f32x8<Avx2>, order: u32x8<Avx2>) -> f32x8<Avx2> {
                use core::arch::x86_64::*;
                _mm256_permutevar8x32_ps(values.into(), order.into()).simd_into(simd)
            }
        );
        let [first, second] = window.first;
        let (Some(low), Some(high)) =
            (values.get(first..first + 8), values.get(second..second + 8))
        else {
            unreachable!("a window begins at lane 8 at most");
        };
        let (of_low, of_high) = window.order.split();
        let low = kernel(simd, f32x8::from_slice(simd, low), of_low);
        low.combine(kernel(simd, f32x8::from_slice(simd, high), of_high))
    }
}
