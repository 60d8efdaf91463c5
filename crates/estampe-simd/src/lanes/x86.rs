//! The levels of x86-64: SSE2, AVX2 and AVX-512.

use super::Lanes;
use crate::{ByteTable, Columns, LANES, Level, Packing, Stream, Window};
use fearless_simd::x86::{Avx2, Avx512, Sse2};
use fearless_simd::{
    Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, f32x16, i32x16, mask32x16, u32x16,
};

impl Lanes for Sse2 {
    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Sse2(self)
    }

    #[inline(never)]
    fn outline<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
    #[inline(always)]
    fn prefetch<T>(self, value: &T) {
        crate::prefetch::sse2(self, value);
    }
    #[inline(always)]
    fn prefetch_address(self, address: usize) {
        crate::prefetch::address_sse2(self, address);
    }
    #[inline(always)]
    fn prefetch_elements(self, table: &[u32], index: u32x16<Self>) {
        crate::prefetch::elements_sse2(self, table, index);
    }
    #[inline(always)]
    fn stream<'m>(self, stream: &Stream<'m>, from: &[[u32; LANES]], to: &'m mut [[u32; LANES]]) {
        crate::streaming::sse2(self, stream, from, to);
    }
    #[inline(always)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.min(b)
    }
    #[inline(always)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.max(b)
    }
    /// SSE2 has no rounding instruction, and a call per lane is slow. So: truncate, subtract 1
    /// where that rounded up, keep values without a fraction, and restore the sign of zeros.
    #[inline(never)]
    fn floor_f32(self, a: f32x16<Self>) -> f32x16<Self> {
        let int = i32x16::truncate_from(a);
        let truncated = f32x16::float_from(int);
        let one = f32x16::splat(self, 1.0);
        let zero = f32x16::splat(self, 0.0);
        let floored = truncated - truncated.simd_gt(a).select(one, zero);
        let small = a.abs().simd_lt(f32x16::splat(self, 8_388_608.0));
        small.select(floored.copysign(a), a)
    }

    #[inline(never)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::by_lane(self, table, index)
    }

    #[inline(never)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_sse2(self, table, index, stride)
    }

    #[inline(never)]
    fn gather_four(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 4] {
        crate::gather::four_sse2(self, table, index)
    }

    #[inline(never)]
    fn permute(self, value: u32x16<Self>, order: u32x16<Self>) -> u32x16<Self> {
        crate::permute::by_lane(self, value, order)
    }
}

impl Lanes for Avx2 {
    const REGISTERS: usize = 2;
    const HAS_WINDOWS: bool = true;
    const LOADS_PAIRS: bool = true;

    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Avx2(self)
    }
    #[inline(always)]
    fn prefetch<T>(self, value: &T) {
        crate::prefetch::avx2(self, value);
    }
    #[inline(always)]
    fn prefetch_address(self, address: usize) {
        crate::prefetch::address_avx2(self, address);
    }
    #[inline(always)]
    fn prefetch_elements(self, table: &[u32], index: u32x16<Self>) {
        crate::prefetch::elements_avx2(self, table, index);
    }
    #[inline(always)]
    fn stream<'m>(self, stream: &Stream<'m>, from: &[[u32; LANES]], to: &'m mut [[u32; LANES]]) {
        crate::streaming::avx2(self, stream, from, to);
    }
    #[inline(always)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.min(b)
    }
    #[inline(always)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.max(b)
    }
    #[inline(always)]
    fn decode_half(self, half: u32x16<Self>) -> Option<f32x16<Self>> {
        Some(crate::half::decode_avx2(self, half))
    }
    #[inline(always)]
    fn encode_half(self, value: f32x16<Self>) -> Option<u32x16<Self>> {
        Some(crate::half::encode_avx2(self, value))
    }
    #[inline(always)]
    fn decode_half_pair(self, words: u32x16<Self>) -> Option<[f32x16<Self>; 2]> {
        Some(crate::half::decode_pair_avx2(self, words))
    }
    #[inline(always)]
    fn encode_half_pair(self, low_and_high: [f32x16<Self>; 2]) -> Option<u32x16<Self>> {
        Some(crate::half::encode_pair_avx2(self, low_and_high))
    }
    #[inline(always)]
    fn first_row(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::first_row_avx2(self, value)
    }
    #[inline(always)]
    fn first_column(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::first_column_avx2(self, value)
    }
    #[inline(always)]
    fn columns_and_rows(self, columns: f32x16<Self>, rows: f32x16<Self>) -> f32x16<Self> {
        crate::block::columns_and_rows_avx2(self, columns, rows)
    }
    #[inline(always)]
    fn spread_columns(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::spread_avx2(self, value)
    }
    #[inline(always)]
    fn half_texels(self, window: &[u32; 16], columns: &Columns<Self>) -> Option<[f32x16<Self>; 2]> {
        Some(crate::block::halves_avx2(self, window, columns))
    }
    #[inline(always)]
    fn half_texels_of_four(
        self,
        window: &[u32; 8],
        columns: &Columns<Self>,
    ) -> Option<[f32x16<Self>; 2]> {
        Some(crate::block::halves_avx2(self, window, columns))
    }
    #[inline(always)]
    fn row_of_halves(self, words: &[u32; 8]) -> Option<f32x16<Self>> {
        Some(crate::block::row_avx2(self, words))
    }
    #[inline(always)]
    fn channels_of_rows(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::block::channels_avx2(self, rows)
    }
    #[inline(always)]
    fn paired(self, row: f32x16<Self>) -> f32x16<Self> {
        crate::paired::paired_avx2(self, row)
    }
    #[inline(always)]
    fn channels_of_paired(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::paired::channels_of_paired_avx2(self, rows)
    }
    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::avx2(self, table, index)
    }
    #[inline(always)]
    fn gather_lines<const N: usize>(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; N] {
        crate::gather::gather_lines_avx2(self, table, index)
    }
    #[inline(always)]
    fn lookup_sixteen(self, table: &[u32; 16], index: u32x16<Self>) -> u32x16<Self> {
        crate::lookup::sixteen_avx2(self, table, index)
    }
    #[inline(always)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_avx2(self, table, index, stride)
    }
    #[inline(always)]
    fn gather_pair(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 2] {
        crate::gather::pair_avx2(self, table, index)
    }
    #[inline(always)]
    fn gather_four(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 4] {
        crate::gather::four_avx2(self, table, index)
    }
    #[inline(always)]
    fn permute(self, value: u32x16<Self>, order: u32x16<Self>) -> u32x16<Self> {
        crate::permute::permute_avx2(self, value, order)
    }
    #[inline(always)]
    fn list_bits(self, bits: u16, first: u32, out: &mut [u32; 16]) -> usize {
        crate::permute::list_avx2(self, bits, first, out)
    }
    #[inline(always)]
    fn list_bits_of_word(self, bits: u32, first: u16, out: &mut [u16; 32]) -> usize {
        crate::permute::list_word_avx2(self, bits, first, out)
    }
    #[inline(always)]
    fn packing_order(self, lanes: u16) -> u32x16<Self> {
        crate::packing::packing_avx2(self, lanes)
    }
    #[inline(always)]
    fn store_packed(self, values: u32x16<Self>, packing: &Packing<Self>, out: &mut [u32; 16]) {
        crate::packing::store_packed_avx2(self, values, packing, out);
    }
    #[inline(always)]
    fn replace_masked(self, to: &mut [u32; 16], lanes: mask32x16<Self>, by: u32x16<Self>) {
        crate::masks::replace_masked_avx2(self, to, lanes, by);
    }
    #[inline(always)]
    fn window(self, order: u32x16<Self>) -> Option<Window<Self>> {
        crate::packing::window_avx2(self, order)
    }
    #[inline(always)]
    fn permute_window(self, values: &[f32; 16], window: &Window<Self>) -> f32x16<Self> {
        crate::packing::permute_window_avx2(self, values, window)
    }
    #[inline(always)]
    fn bits_of_mask(self, mask: mask32x16<Self>) -> u16 {
        crate::masks::bits_of_mask_avx2(self, mask)
    }
    #[inline(always)]
    fn sign_bits(self, a: i32x16<Self>) -> u16 {
        crate::masks::sign_bits_avx2(self, a)
    }
    #[inline(always)]
    fn scatter(self, table: &mut [u32], index: u32x16<Self>, values: u32x16<Self>, lanes: u16) {
        crate::gather::scatter_lines_avx2(self, table, index, [values], lanes);
    }
    #[inline(always)]
    fn scatter_lines<const N: usize>(
        self,
        table: &mut [u32],
        index: u32x16<Self>,
        values: [u32x16<Self>; N],
        lanes: u16,
    ) {
        crate::gather::scatter_lines_avx2(self, table, index, values, lanes);
    }
    #[inline(always)]
    fn scatter_to_four_lines(
        self,
        table: &mut [u32],
        index: u32x16<Self>,
        values: u32x16<Self>,
        lanes: [u16; 4],
    ) {
        crate::gather::scatter_to_four_lines_avx2(self, table, index, values, lanes);
    }
}

impl Lanes for Avx512 {
    const REGISTERS: usize = 1;

    #[inline(always)]
    fn as_level(self) -> Level {
        Level::Avx512(self)
    }
    #[inline(always)]
    fn prefetch<T>(self, value: &T) {
        crate::prefetch::avx512(self, value);
    }
    #[inline(always)]
    fn prefetch_address(self, address: usize) {
        crate::prefetch::address_avx512(self, address);
    }
    #[inline(always)]
    fn prefetch_elements(self, table: &[u32], index: u32x16<Self>) {
        crate::prefetch::elements_avx512(self, table, index);
    }
    #[inline(always)]
    fn stream<'m>(self, stream: &Stream<'m>, from: &[[u32; LANES]], to: &'m mut [[u32; LANES]]) {
        crate::streaming::avx512(self, stream, from, to);
    }
    #[inline(always)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.min(b)
    }
    #[inline(always)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.max(b)
    }
    #[inline(always)]
    fn decode_half(self, half: u32x16<Self>) -> Option<f32x16<Self>> {
        Some(crate::half::decode_avx512(self, half))
    }
    #[inline(always)]
    fn encode_half(self, value: f32x16<Self>) -> Option<u32x16<Self>> {
        Some(crate::half::encode_avx512(self, value))
    }
    #[inline(always)]
    fn first_row(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::first_row_avx512(self, value)
    }
    #[inline(always)]
    fn first_column(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::first_column_avx512(self, value)
    }
    #[inline(always)]
    fn columns_and_rows(self, columns: f32x16<Self>, rows: f32x16<Self>) -> f32x16<Self> {
        crate::block::columns_and_rows_avx512(self, columns, rows)
    }
    #[inline(always)]
    fn spread_columns(self, value: f32x16<Self>) -> f32x16<Self> {
        crate::block::spread_avx512(self, value)
    }
    #[inline(always)]
    fn places_of_texels(self, texel: u32x16<Self>) -> u32x16<Self> {
        crate::block::places_avx512(self, texel)
    }
    #[inline(always)]
    fn half_texels(self, window: &[u32; 16], columns: &Columns<Self>) -> Option<[f32x16<Self>; 2]> {
        Some(crate::block::halves_avx512(self, window, columns))
    }
    #[inline(always)]
    fn half_texels_of_four(
        self,
        window: &[u32; 8],
        columns: &Columns<Self>,
    ) -> Option<[f32x16<Self>; 2]> {
        Some(crate::block::halves_of_four_avx512(self, window, columns))
    }
    #[inline(always)]
    fn row_of_halves(self, words: &[u32; 8]) -> Option<f32x16<Self>> {
        Some(crate::block::row_avx512(self, words))
    }
    #[inline(always)]
    fn channels_of_rows(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::block::channels_avx512(self, rows)
    }
    #[inline(always)]
    fn paired(self, row: f32x16<Self>) -> f32x16<Self> {
        crate::paired::paired_avx512(self, row)
    }
    #[inline(always)]
    fn channels_of_paired(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::paired::channels_of_paired_avx512(self, rows)
    }
    #[inline(always)]
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self> {
        crate::gather::avx512(self, table, index)
    }
    #[inline(always)]
    fn lookup_sixteen(self, table: &[u32; 16], index: u32x16<Self>) -> u32x16<Self> {
        crate::lookup::sixteen_avx512(self, table, index)
    }
    #[inline(always)]
    fn scatter(self, table: &mut [u32], index: u32x16<Self>, values: u32x16<Self>, lanes: u16) {
        crate::gather::scatter_avx512(self, table, index, values, lanes);
    }
    #[inline(always)]
    fn lookup(self, table: &[u32; 256], index: u32x16<Self>) -> u32x16<Self> {
        crate::lookup::avx512(self, table, index)
    }
    #[inline(always)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_avx512(self, table, index, stride)
    }
    #[inline(always)]
    fn gathers_pairs(self) -> bool {
        crate::gather::gathers_avx512()
    }
    #[inline(always)]
    fn gather_pair(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 2] {
        crate::gather::pair_avx512(self, table, index)
    }
    #[inline(always)]
    fn gather_four(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 4] {
        crate::gather::four_avx512(self, table, index)
    }
    #[inline(always)]
    fn permute(self, value: u32x16<Self>, order: u32x16<Self>) -> u32x16<Self> {
        crate::permute::permute_avx512(self, value, order)
    }
    #[inline(always)]
    fn list_bits(self, bits: u16, first: u32, out: &mut [u32; 16]) -> usize {
        crate::permute::list_avx512(self, bits, first, out)
    }
    #[inline(always)]
    fn list_bits_of_word(self, bits: u32, first: u16, out: &mut [u16; 32]) -> usize {
        crate::permute::list_word_avx512(self, bits, first, out)
    }
    #[inline(always)]
    fn widen(self, values: &[u16; 16]) -> u32x16<Self> {
        crate::permute::widen_avx512(self, values)
    }
    #[inline(always)]
    fn repeats(self, value: u32x16<Self>, lanes: u16) -> Option<u16> {
        Some(crate::permute::repeats_avx512(self, value, lanes))
    }
    #[inline(always)]
    fn lookup_three(self, table: &ByteTable, words: u32x16<Self>) -> [u32x16<Self>; 3] {
        crate::lookup::three_avx512(self, table, words)
    }
}
