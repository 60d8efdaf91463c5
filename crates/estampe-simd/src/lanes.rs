//! The extension trait of level tokens: what lane code may use beyond the vector types' own methods.

use fearless_simd::{
    Fallback, Select, Simd, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdMask, f32x16,
    i32x16, mask32x16, u32x16,
};

/// A level token for lane code. Every operation gives the same bits at every level.
pub trait Lanes: Simd {
    /// Whether lanes are plain scalars, sixteen of which are long code.
    const IS_SCALAR: bool = false;

    /// `a < b ? a : b` lane by lane: `b` where either is NaN, and of two zeros `b`.
    #[inline(always)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.simd_lt(b).select(a, b)
    }

    /// `a > b ? a : b` lane by lane: `b` where either is NaN, and of two zeros `b`.
    #[inline(always)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.simd_gt(b).select(a, b)
    }

    /// The greatest integer not above `a`; −0 stays −0, NaN and infinities stay.
    #[inline(always)]
    fn floor_f32(self, a: f32x16<Self>) -> f32x16<Self> {
        a.floor()
    }

    /// Nearest integer, ties to even, of values within ±2²²; anything else is unspecified but safe.
    #[inline(always)]
    fn round_to_i32(self, a: f32x16<Self>) -> i32x16<Self> {
        // Adding 1.5·2²³ leaves the integer in the low bits of the mantissa, rounded as every
        // addition is: to nearest, ties to even. It is the same two instructions at every level.
        let magic = f32x16::splat(self, 12_582_912.0);
        let bits: i32x16<Self> = i32x16::from_bytes_of(a + magic);
        bits - i32x16::splat(self, 0x4B40_0000)
    }

    /// `table[index]` lane by lane; an index at or beyond the end reads the last element, and an
    /// empty table reads as zeros.
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self>;

    /// `table[index]`, `table[index + 1]`, `table[index + stride]`, `table[index + stride + 1]` lane by
    /// lane: two neighbours of one row and those below them. An index of which one of these is beyond the
    /// end reads the last square; a table with less than `stride + 2` elements reads as zeros.
    #[inline(always)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_by_lane(self, table, index, stride)
    }

    /// A mask from its low 16 bits: bit `i` is lane `i`.
    #[inline(always)]
    fn mask_from_bits(self, bits: u16) -> mask32x16<Self> {
        mask32x16::from_bitmask(self, u64::from(bits))
    }

    /// The mask's 16 bits: lane `i` is bit `i`.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a mask of 16 lanes has 16 bits"
    )]
    fn bits_of_mask(self, mask: mask32x16<Self>) -> u16 {
        mask.to_bitmask() as u16
    }

    /// The bits of the lanes that are negative (sign bit set).
    #[inline(always)]
    fn sign_bits(self, a: i32x16<Self>) -> u16 {
        self.bits_of_mask(a.simd_lt(i32x16::splat(self, 0)))
    }
}

/// Reinterprets the bits of sixteen lanes.
pub(crate) trait FromBytesOf<S: Simd> {
    /// The same 64 bytes as another type.
    fn from_bytes_of(value: f32x16<S>) -> Self;
}

impl<S: Simd> FromBytesOf<S> for i32x16<S> {
    #[inline(always)]
    fn from_bytes_of(value: f32x16<S>) -> Self {
        fearless_simd::Bytes::bitcast(value)
    }
}

impl Lanes for Fallback {
    const IS_SCALAR: bool = true;

    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use fearless_simd::x86::{Avx2, Avx512, Sse2};

    impl Lanes for Sse2 {
        #[inline(always)]
        fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.min(b)
        }
        #[inline(always)]
        fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.max(b)
        }
        /// SSE2 has no rounding instruction and a call per lane is slow: truncate, step down where
        /// that went up, keep what has no fraction, and give zeros back their sign.
        #[inline(always)]
        fn floor_f32(self, a: f32x16<Self>) -> f32x16<Self> {
            let int = i32x16::truncate_from(a);
            let truncated = f32x16::float_from(int);
            let one = f32x16::splat(self, 1.0);
            let zero = f32x16::splat(self, 0.0);
            let floored = truncated - truncated.simd_gt(a).select(one, zero);
            let small = a.abs().simd_lt(f32x16::splat(self, 8_388_608.0));
            small.select(floored.copysign(a), a)
        }
        #[inline(always)]
        fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
            crate::gather::by_lane(self, table, index)
        }
        #[inline(always)]
        fn gather_square(
            self,
            table: &[u32],
            index: u32x16<Self>,
            stride: u32,
        ) -> [u32x16<Self>; 4] {
            crate::gather::square_sse2(self, table, index, stride)
        }
    }

    impl Lanes for Avx2 {
        #[inline(always)]
        fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.min(b)
        }
        #[inline(always)]
        fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.max(b)
        }
        #[inline(always)]
        fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
            crate::gather::avx2(self, table, index)
        }
        #[inline(always)]
        fn gather_square(
            self,
            table: &[u32],
            index: u32x16<Self>,
            stride: u32,
        ) -> [u32x16<Self>; 4] {
            crate::gather::square_avx2(self, table, index, stride)
        }
    }

    impl Lanes for Avx512 {
        #[inline(always)]
        fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.min(b)
        }
        #[inline(always)]
        fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
            a.max(b)
        }
        #[inline(always)]
        fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
            crate::gather::avx512(self, table, index)
        }
        #[inline(always)]
        fn gather_square(
            self,
            table: &[u32],
            index: u32x16<Self>,
            stride: u32,
        ) -> [u32x16<Self>; 4] {
            crate::gather::square_avx512(self, table, index, stride)
        }
    }
}

#[cfg(target_arch = "aarch64")]
impl Lanes for fearless_simd::aarch64::Neon {
    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
impl Lanes for fearless_simd::wasm32::WasmSimd128 {
    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }
}
