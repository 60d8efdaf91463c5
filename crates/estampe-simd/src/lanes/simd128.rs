//! The level of WebAssembly.

use super::Lanes;
use crate::Level;
use fearless_simd::u32x16;
use fearless_simd::wasm32::WasmSimd128;

impl Lanes for WasmSimd128 {
    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Simd128(self)
    }

    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }
}
