//! The scalar level: functions that are compiled once, and minima and maxima lane by lane.

use super::Lanes;
use crate::Level;
use fearless_simd::{Fallback, SimdBase, SimdFloat, SimdMask, f32x16, mask32x16, u32x16};

impl Lanes for Fallback {
    const IS_SCALAR: bool = true;

    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Scalar(self)
    }

    #[inline(never)]
    fn outline<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }

    // Lane by lane: the operations of sixteen lanes are made of those of four, and each step copies
    // its lanes, in dev builds by calls.
    #[inline(never)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        let mut least = b;
        for (least, a) in least.iter_mut().zip(a.as_slice()) {
            if *a < *least {
                *least = *a;
            }
        }
        least
    }

    #[inline(never)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        let mut greatest = b;
        for (greatest, a) in greatest.iter_mut().zip(a.as_slice()) {
            if *a > *greatest {
                *greatest = *a;
            }
        }
        greatest
    }

    #[inline(never)]
    fn floor_f32(self, a: f32x16<Self>) -> f32x16<Self> {
        a.floor()
    }

    #[inline(never)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }

    #[inline(never)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_by_lane(self, table, index, stride)
    }

    #[inline(never)]
    fn permute(self, value: u32x16<Self>, order: u32x16<Self>) -> u32x16<Self> {
        crate::permute::by_lane(self, value, order)
    }

    #[inline(never)]
    fn mask_from_bits(self, bits: u16) -> mask32x16<Self> {
        mask32x16::from_bitmask(self, u64::from(bits))
    }

    #[inline(never)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a mask of 16 lanes has 16 bits"
    )]
    fn bits_of_mask(self, mask: mask32x16<Self>) -> u16 {
        mask.to_bitmask() as u16
    }
}
