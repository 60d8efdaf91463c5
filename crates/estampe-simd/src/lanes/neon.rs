//! The level of AArch64.

use super::Lanes;
use crate::Level;
use fearless_simd::aarch64::Neon;
use fearless_simd::u32x16;

impl Lanes for Neon {
    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Neon(self)
    }

    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }
}
