//! The extension trait of level tokens: operations beyond the methods of the vector types.
//!
//! Each method has a form that is right at every level; a level replaces what it does faster.

#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(scalar_level)]
mod scalar;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
#[cfg(target_arch = "x86_64")]
mod x86;

use crate::{ByteTable, Columns, LANES, Level, Packing, Stream, Window};
use fearless_simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x16, i32x16, mask32x16, u32x16,
};

/// A level token for lane code. Every operation gives the same bits at every SIMD level.
pub trait Lanes: Simd {
    /// True if lanes are plain scalars, so that code for sixteen lanes is long.
    const IS_SCALAR: bool = false;

    /// How many registers hold sixteen lanes.
    const REGISTERS: usize = 4;

    /// True if permutations from a [`Window`] take less time than others.
    const HAS_WINDOWS: bool = false;

    /// True if [`gather_pair`](Self::gather_pair) loads pairs lane by lane, in about the time of
    /// one gather of single elements.
    const LOADS_PAIRS: bool = false;

    /// The SIMD level of the token.
    fn as_level(self) -> Level;

    /// Runs `work`; at the scalar level as a function of its own. See
    /// [`outline!`](crate::outline!).
    #[doc(hidden)]
    #[inline(always)]
    fn outline<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }

    /// Begins to bring a value to the cache, where the level has an instruction for that; waits for
    /// nothing and changes nothing.
    #[inline(always)]
    fn prefetch<T>(self, _value: &T) {}

    /// [`prefetch`](Self::prefetch) of the cache line at an address, for memory that others may
    /// write to meanwhile. An address of no memory does no harm.
    #[inline(always)]
    fn prefetch_address(self, _address: usize) {}

    /// [`prefetch`](Self::prefetch) of an element of the table for each lane. An index beyond the
    /// end does no harm.
    #[inline(always)]
    fn prefetch_elements(self, _table: &[u32], _index: u32x16<Self>) {}

    /// Copies lines past the caches where the level has an instruction for that: see
    /// [`Stream::copy`].
    #[doc(hidden)]
    #[inline(always)]
    fn stream<'m>(self, _: &Stream<'m>, from: &[[u32; LANES]], to: &'m mut [[u32; LANES]]) {
        to.copy_from_slice(from);
    }

    /// `a < b ? a : b` in each lane: `b` if either is NaN, and of two zeros `b`.
    #[inline(always)]
    fn min_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.simd_lt(b).select(a, b)
    }

    /// `a > b ? a : b` in each lane: `b` if either is NaN, and of two zeros `b`.
    #[inline(always)]
    fn max_f32(self, a: f32x16<Self>, b: f32x16<Self>) -> f32x16<Self> {
        a.simd_gt(b).select(a, b)
    }

    /// The greatest integer that is not above `a`. −0, NaN and infinities are returned unchanged.
    #[inline(always)]
    fn floor_f32(self, a: f32x16<Self>) -> f32x16<Self> {
        a.floor()
    }

    /// The nearest integer, ties to even, for values within ±2²². The result for other values is
    /// unspecified but safe.
    #[inline(always)]
    fn round_to_i32(self, a: f32x16<Self>) -> i32x16<Self> {
        // Adding 1.5·2²³ leaves the integer in the low bits of the mantissa, rounded as every
        // addition is: to nearest, ties to even. These are the same two instructions at every SIMD
        // level.
        let magic = f32x16::splat(self, 12_582_912.0);
        let bits: i32x16<Self> = i32x16::from_bytes_of(a + magic);
        bits - i32x16::splat(self, 0x4B40_0000)
    }

    /// `table[index]` in each lane. An index at or beyond the end reads the last element; an empty
    /// table reads as zeros.
    fn gather(self, table: &[u32], index: u32x16<Self>) -> u32x16<Self>;

    /// `table[index]`, and the words that are [`LANES`](crate::LANES) elements further, up to `N`
    /// words of each lane. If any of them is beyond the end, others are read; a table that is too
    /// short for any reads as zeros.
    #[inline(always)]
    fn gather_lines<const N: usize>(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; N] {
        let mut words = [u32x16::splat(self, 0); N];
        let mut line = 0;
        while line < N {
            if let Some(table) = table.get(line * crate::LANES..) {
                words[line] = self.gather(table, index);
            }
            line += 1;
        }
        words
    }

    /// Stores the lanes of a mask: `table[index] = value`, lane by lane, so that of equal indices
    /// the last one counts. Lanes whose index is beyond the table are left out; elements from 2³¹
    /// on are not reachable.
    #[inline(always)]
    fn scatter(self, table: &mut [u32], index: u32x16<Self>, values: u32x16<Self>, lanes: u16) {
        crate::gather::scatter_by_lane(table, index, values, lanes);
    }

    /// [`scatter`](Self::scatter) of `N` words of each lane, which are [`LANES`](crate::LANES)
    /// elements apart.
    #[inline(always)]
    fn scatter_lines<const N: usize>(
        self,
        table: &mut [u32],
        index: u32x16<Self>,
        values: [u32x16<Self>; N],
        lanes: u16,
    ) {
        let mut line = 0;
        while line < N {
            if let Some(table) = table.get_mut(line * crate::LANES..) {
                self.scatter(table, index, values[line], lanes);
            }
            line += 1;
        }
    }

    /// [`scatter`](Self::scatter) of the same word of each lane to four lines, which are
    /// [`LANES`](crate::LANES) elements apart, each with a mask of its own. Lanes of which a line is
    /// beyond the table are left out.
    #[inline(always)]
    fn scatter_to_four_lines(
        self,
        table: &mut [u32],
        index: u32x16<Self>,
        values: u32x16<Self>,
        lanes: [u16; 4],
    ) {
        let Some(last) = table.len().checked_sub(3 * crate::LANES) else {
            return;
        };
        let mut line = 0;
        while line < 4 {
            let first = line * crate::LANES;
            self.scatter(&mut table[first..][..last], index, values, lanes[line]);
            line += 1;
        }
    }

    /// `table[index]` in each lane, for an index below 256; for any other index, some element.
    #[inline(always)]
    fn lookup(self, table: &[u32; 256], index: u32x16<Self>) -> u32x16<Self> {
        self.gather(table, index)
    }

    /// `table[index]` in each lane, for an index below 16; for any other index, some element.
    #[inline(always)]
    fn lookup_sixteen(self, table: &[u32; 16], index: u32x16<Self>) -> u32x16<Self> {
        self.gather(table, index)
    }

    /// `table[index]`, `table[index + 1]`, `table[index + stride]` and `table[index + stride + 1]`
    /// in each lane: two neighbours in one row and the two below them. If any of the four is beyond
    /// the end, the last square is read; a table with fewer than `stride + 2` elements reads as
    /// zeros.
    #[inline(always)]
    fn gather_square(self, table: &[u32], index: u32x16<Self>, stride: u32) -> [u32x16<Self>; 4] {
        crate::gather::square_by_lane(self, table, index, stride)
    }

    /// True if [`gather_pair`](Self::gather_pair) is an instruction that takes less time than loads
    /// lane by lane, on this processor.
    #[inline(always)]
    fn gathers_pairs(self) -> bool {
        false
    }

    /// `table[index]` and `table[index + 1]` in each lane. If either is beyond the end, the last
    /// two are read; a table with fewer than two elements reads as zeros. Pairs from 2³¹ on are
    /// not reachable.
    #[inline(always)]
    fn gather_pair(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 2] {
        crate::gather::pair_by_lane(self, table, index)
    }

    /// `table[index]` and the next three elements in each lane. If any of the four is beyond the
    /// end, the last four are read; a table with fewer than four elements reads as zeros.
    #[inline(always)]
    fn gather_four(self, table: &[u32], index: u32x16<Self>) -> [u32x16<Self>; 4] {
        crate::gather::four_by_lane(self, table, index)
    }

    /// The table's elements for the lowest three bytes of each lane.
    #[inline(always)]
    fn lookup_three(self, table: &ByteTable, words: u32x16<Self>) -> [u32x16<Self>; 3] {
        let byte = u32x16::splat(self, 0xFF);
        [
            self.gather(&table.elements, words & byte),
            self.gather(&table.elements, (words >> 8) & byte),
            self.gather(&table.elements, (words >> 16) & byte),
        ]
    }

    /// `value[order]` in each lane: the lane of `value` that the low four bits of `order` name.
    #[inline(always)]
    fn permute(self, value: u32x16<Self>, order: u32x16<Self>) -> u32x16<Self> {
        crate::permute::by_lane(self, value, order)
    }

    /// [`permute`](Self::permute) of floats.
    #[inline(always)]
    fn permute_f32(self, value: f32x16<Self>, order: u32x16<Self>) -> f32x16<Self> {
        fearless_simd::Bytes::bitcast(self.permute(fearless_simd::Bytes::bitcast(value), order))
    }

    /// Lists the bits that are set, in ascending order, bit `i` as `first + i`; what lies behind
    /// them in `out` is unspecified. Returns how many there are. There is no branch on the bits.
    #[inline(always)]
    fn list_bits(self, bits: u16, first: u32, out: &mut [u32; 16]) -> usize {
        crate::permute::list_by_table(bits, first, out)
    }

    /// [`list_bits`](Self::list_bits) of 32 bits, as half words.
    #[inline(always)]
    fn list_bits_of_word(self, bits: u32, first: u16, out: &mut [u16; 32]) -> usize {
        crate::permute::list_word_by_table(bits, first, out)
    }

    /// The order of a [`Packing`] of these lanes.
    #[doc(hidden)]
    #[inline(always)]
    fn packing_order(self, lanes: u16) -> u32x16<Self> {
        let mut order = [0; 16];
        self.list_bits(lanes, 0, &mut order);
        u32x16::load_array(self, order)
    }

    /// [`Packing::store`].
    #[doc(hidden)]
    #[inline(always)]
    fn store_packed(self, values: u32x16<Self>, packing: &Packing<Self>, out: &mut [u32; 16]) {
        self.permute(values, packing.order).store_array(out);
    }

    /// Replaces some lanes of sixteen values.
    #[inline(always)]
    fn replace(self, to: &mut [u32; 16], lanes: u16, by: u32x16<Self>) {
        self.replace_masked(to, self.mask_from_bits(lanes), by);
    }

    /// [`replace`](Self::replace) of floats.
    #[inline(always)]
    fn replace_f32(self, to: &mut [f32; 16], lanes: u16, by: f32x16<Self>) {
        let to = crate::gather::bits_of_sixteen(to);
        self.replace(to, lanes, fearless_simd::Bytes::bitcast(by));
    }

    /// [`replace`](Self::replace) of the lanes of a mask.
    #[inline(always)]
    fn replace_masked(self, to: &mut [u32; 16], lanes: mask32x16<Self>, by: u32x16<Self>) {
        let before = u32x16::load_array_ref(self, to);
        lanes.select(by, before).store_array(to);
    }

    /// [`replace_masked`](Self::replace_masked) of floats.
    #[inline(always)]
    fn replace_masked_f32(self, to: &mut [f32; 16], lanes: mask32x16<Self>, by: f32x16<Self>) {
        let to = crate::gather::bits_of_sixteen(to);
        self.replace_masked(to, lanes, fearless_simd::Bytes::bitcast(by));
    }

    /// [`Window::new`].
    #[doc(hidden)]
    #[inline(always)]
    fn window(self, _order: u32x16<Self>) -> Option<Window<Self>> {
        None
    }

    /// [`Window::permute_f32`].
    #[doc(hidden)]
    #[inline(always)]
    fn permute_window(self, values: &[f32; 16], window: &Window<Self>) -> f32x16<Self> {
        self.permute_f32(f32x16::load_array_ref(self, values), window.order)
    }

    /// Half words as words.
    #[inline(always)]
    fn widen(self, values: &[u16; 16]) -> u32x16<Self> {
        crate::permute::widen_halves(self, values)
    }

    /// Those of some lanes whose value an earlier one of them has, if the level has an instruction
    /// for it.
    #[inline(always)]
    fn repeats(self, value: u32x16<Self>, lanes: u16) -> Option<u16> {
        let _ = (value, lanes);
        None
    }

    /// The numbers of half floats, the low 16 bits of each lane, if the level has an instruction
    /// for it: exact, with quiet NaNs.
    #[inline(always)]
    fn decode_half(self, half: u32x16<Self>) -> Option<f32x16<Self>> {
        let _ = half;
        None
    }

    /// The nearest half floats, ties to even, if the level has an instruction for it. Of a NaN some
    /// NaN.
    #[inline(always)]
    fn encode_half(self, value: f32x16<Self>) -> Option<u32x16<Self>> {
        let _ = value;
        None
    }

    /// [`decode_half`](Self::decode_half) of the low and the high half of each lane, if there is a
    /// shorter way than one after the other.
    #[inline(always)]
    fn decode_half_pair(self, words: u32x16<Self>) -> Option<[f32x16<Self>; 2]> {
        let _ = words;
        None
    }

    /// The nearest half floats of two numbers, in the low and the high half of each lane, if there
    /// is a shorter way than [one after the other](Self::encode_half). Of each NaN the one that is
    /// positive, quiet and else zero: 0x7E00.
    #[inline(always)]
    fn encode_half_pair(self, low_and_high: [f32x16<Self>; 2]) -> Option<u32x16<Self>> {
        let _ = low_and_high;
        None
    }

    /// The values of the first row of a packet that is a block of 4×4 pixels, in each lane that of
    /// its column.
    #[inline(always)]
    fn first_row(self, value: f32x16<Self>) -> f32x16<Self> {
        let order = [0, 1, 0, 1, 4, 5, 4, 5, 0, 1, 0, 1, 4, 5, 4, 5];
        crate::block::permuted(self, value, order)
    }

    /// The values of the first column of a packet that is a block, in each lane that of its row.
    #[inline(always)]
    fn first_column(self, value: f32x16<Self>) -> f32x16<Self> {
        let order = [0, 0, 2, 2, 0, 0, 2, 2, 8, 8, 10, 10, 8, 8, 10, 10];
        crate::block::permuted(self, value, order)
    }

    /// Of a packet that is a block the values of its columns in lanes 0 to 3, and of another one
    /// the values of its rows in lanes 4 to 7; the other lanes repeat them.
    #[inline(always)]
    fn columns_and_rows(self, columns: f32x16<Self>, rows: f32x16<Self>) -> f32x16<Self> {
        let (columns, rows) = (columns.to_array(), rows.to_array());
        let mut both = columns;
        let mut lane = 0;
        while lane < 16 {
            let at = crate::block::COLUMNS_AND_ROWS[lane % 8];
            both[lane] = if lane % 8 < 4 { columns[at] } else { rows[at] };
            lane += 1;
        }
        f32x16::load_array(self, both)
    }

    /// The values of lanes 0 to 3, each four times.
    #[inline(always)]
    fn spread_columns(self, value: f32x16<Self>) -> f32x16<Self> {
        let order = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3];
        crate::block::permuted(self, value, order)
    }

    /// What [`half_texels`](Self::half_texels) needs of the texels of columns in lanes 0 to 3, at
    /// the levels that use it.
    #[doc(hidden)]
    #[inline(always)]
    fn places_of_texels(self, texel: u32x16<Self>) -> u32x16<Self> {
        texel
    }

    /// The left texels of four columns, then the right ones, of a window of eight texels of four
    /// half floats; `None` if the level does not decode half floats.
    #[inline(always)]
    fn half_texels(self, window: &[u32; 16], columns: &Columns<Self>) -> Option<[f32x16<Self>; 2]> {
        let _ = (window, columns);
        None
    }

    /// [`half_texels`](Self::half_texels) of columns that are
    /// [among four](Columns::are_among_four) texels.
    #[inline(always)]
    fn half_texels_of_four(
        self,
        window: &[u32; 8],
        columns: &Columns<Self>,
    ) -> Option<[f32x16<Self>; 2]> {
        let _ = (window, columns);
        None
    }

    /// Four texels of four half floats; `None` if the level does not decode half floats.
    #[inline(always)]
    fn row_of_halves(self, words: &[u32; 8]) -> Option<f32x16<Self>> {
        let _ = words;
        None
    }

    /// Four channels of a packet that is a block, from its four rows of four texels.
    #[inline(always)]
    fn channels_of_rows(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::block::channels(self, rows)
    }

    /// A row of four texels of four channels, whose channels are brought into pairs for
    /// [`channels_of_paired`](Self::channels_of_paired). Rows can be filtered between.
    #[inline(always)]
    fn paired(self, row: f32x16<Self>) -> f32x16<Self> {
        crate::block::permuted(self, row, crate::paired::PAIRED)
    }

    /// [`channels_of_rows`](Self::channels_of_rows) of rows in [pairs](Self::paired).
    #[inline(always)]
    fn channels_of_paired(self, rows: [f32x16<Self>; 4]) -> [f32x16<Self>; 4] {
        crate::paired::channels(self, rows)
    }

    /// A mask from its low 16 bits: bit `i` is lane `i`.
    #[inline(always)]
    fn mask_from_bits(self, bits: u16) -> mask32x16<Self> {
        mask32x16::from_bitmask(self, u64::from(bits))
    }

    /// The mask as 16 bits: lane `i` is bit `i`.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a mask of 16 lanes has 16 bits"
    )]
    fn bits_of_mask(self, mask: mask32x16<Self>) -> u16 {
        mask.to_bitmask() as u16
    }

    /// Bit `i` is set if lane `i` is negative (its sign bit is set).
    #[inline(always)]
    fn sign_bits(self, a: i32x16<Self>) -> u16 {
        self.bits_of_mask(a.simd_lt(i32x16::splat(self, 0)))
    }
}

/// Reinterprets the bits of sixteen lanes.
pub(crate) trait FromBytesOf<S: Simd> {
    /// Reinterprets the 64 bytes of `value` as this type.
    fn from_bytes_of(value: f32x16<S>) -> Self;
}

impl<S: Simd> FromBytesOf<S> for i32x16<S> {
    #[inline(always)]
    fn from_bytes_of(value: f32x16<S>) -> Self {
        fearless_simd::Bytes::bitcast(value)
    }
}
