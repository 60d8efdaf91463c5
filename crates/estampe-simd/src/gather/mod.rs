//! Indexed loads: `table[index]` for sixteen indices at once.
//!
//! A hardware gather reads any address; clamping the indices to the table first makes it sound for
//! any input, at the cost of one instruction. Squares of four elements are read by gathers of pairs
//! or by loads of eight bytes, whichever this processor does faster (`choice.rs`); four neighbours
//! by loads of sixteen bytes, and single elements by gathers, where the level has them. The modules
//! here have the crate's only `unsafe` code.

#[cfg(target_arch = "x86_64")]
mod choice;
#[cfg(target_arch = "x86_64")]
mod fours;
#[cfg(target_arch = "x86_64")]
mod lines;
#[cfg(target_arch = "x86_64")]
mod pairs;
#[cfg(target_arch = "x86_64")]
mod registers;
#[cfg(target_arch = "x86_64")]
mod single;
#[cfg(target_arch = "x86_64")]
mod squares;

use crate::{LANES, Packet};
use fearless_simd::{Simd, SimdBase, u32x16};
use std::hint::select_unpredictable;

/// The last valid index, or `None` for an empty table. Elements from 2³¹ on are not reachable,
/// because hardware indices are signed.
#[inline(always)]
fn last_index(table: &[u32]) -> Option<u32> {
    let last = table.len().checked_sub(1)?;
    Some(u32::try_from(last).map_or(i32::MAX as u32, |last| last.min(i32::MAX as u32)))
}

/// The bits of floats, to gather from.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn bits_of(table: &[f32]) -> &[u32] {
    // SAFETY: f32 and u32 have the same size and alignment, every bit pattern of either is valid,
    // and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(table.as_ptr().cast(), table.len()) }
}

/// [`bits_of`], to scatter floats.
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn bits_of_mut(table: &mut [f32]) -> &mut [u32] {
    // SAFETY: as in `bits_of`; the borrow is exclusive, as the argument's is.
    unsafe { std::slice::from_raw_parts_mut(table.as_mut_ptr().cast(), table.len()) }
}

/// [`bits_of_mut`] sixteen floats.
#[inline(always)]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub(crate) fn bits_of_sixteen(floats: &mut [f32; LANES]) -> &mut [u32; LANES] {
    // SAFETY: as in `bits_of_mut`, and both arrays have as many elements.
    unsafe { &mut *std::ptr::from_mut(floats).cast() }
}

/// Packets of words as packets of the floats that have these bits.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn floats_of(words: &[Packet<u32>]) -> &[Packet<f32>] {
    // SAFETY: packets of f32 and of u32 are arrays of as many values with the same alignment, every
    // bit pattern of either is valid, and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// Packets of floats as packets of their bits.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn words_of(floats: &[Packet<f32>]) -> &[Packet<u32>] {
    // SAFETY: as in `floats_of`, the other way round.
    unsafe { std::slice::from_raw_parts(floats.as_ptr().cast(), floats.len()) }
}

/// The bits of all values of packets, one after the other, to gather from.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn bits_of_packets(packets: &[Packet<f32>]) -> &[u32] {
    // SAFETY: as in `bits_of`: a packet is sixteen values of f32 without padding, and the result
    // borrows as many bytes as the argument.
    unsafe { std::slice::from_raw_parts(packets.as_ptr().cast(), packets.len() * LANES) }
}

/// Packets of words as packets of the signed integers that have these bits.
#[inline(always)]
#[must_use]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn ints_of(words: &[Packet<u32>]) -> &[Packet<i32>] {
    // SAFETY: as in `floats_of`: i32 and u32 have the same size, every bit pattern of either is
    // valid, and the result borrows what the argument borrows.
    unsafe { std::slice::from_raw_parts(words.as_ptr().cast(), words.len()) }
}

/// [`floats_of`], to store floats.
#[inline(always)]
#[expect(unsafe_code, reason = "safe transmutation is not stable")]
pub fn floats_of_mut(words: &mut [Packet<u32>]) -> &mut [Packet<f32>] {
    // SAFETY: as in `floats_of`; the borrow is exclusive, as the argument's is.
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), words.len()) }
}

/// The last index for which all of `index`, `index + 1`, `index + stride` and `index + stride + 1`
/// are valid, or `None` if the table is too short. Squares from 2³¹ on are not reachable, because
/// hardware indices are signed.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "cut to 31 bits just before"
)]
fn last_square(table: &[u32], stride: u32) -> Option<u32> {
    let last = table.len().checked_sub(stride as usize + 2)?;
    Some(last.min(i32::MAX as usize) as u32)
}

/// [`Lanes::gather_square`](crate::Lanes::gather_square) by four gathers.
#[inline(always)]
pub(crate) fn square_by_lane<S: Simd>(
    simd: S,
    table: &[u32],
    index: u32x16<S>,
    stride: u32,
) -> [u32x16<S>; 4] {
    let Some((first, last)) = table.get(stride as usize..).zip(last_square(table, stride)) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let index = index.min(u32x16::splat(simd, last));
    let next = index + u32x16::splat(simd, 1);
    [
        by_lane(simd, table, index),
        by_lane(simd, table, next),
        by_lane(simd, first, index),
        by_lane(simd, first, next),
    ]
}

/// [`Lanes::gather_pair`](crate::Lanes::gather_pair) by two gathers.
#[inline(always)]
pub(crate) fn pair_by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> [u32x16<S>; 2] {
    let Some((second, last)) = table.get(1..).zip(last_square(table, 0)) else {
        return [u32x16::splat(simd, 0); 2];
    };
    let index = index.min(u32x16::splat(simd, last));
    [by_lane(simd, table, index), by_lane(simd, second, index)]
}

/// The last index for which it and the next three are valid, or `None` if the table is too short.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "cut to 32 bits just before"
)]
fn last_four(table: &[u32]) -> Option<u32> {
    let last = table.len().checked_sub(4)?;
    Some(last.min(u32::MAX as usize) as u32)
}

/// [`Lanes::gather_four`](crate::Lanes::gather_four) by four gathers.
#[inline(always)]
pub(crate) fn four_by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> [u32x16<S>; 4] {
    let Some(last) = last_four(table) else {
        return [u32x16::splat(simd, 0); 4];
    };
    let index = index.min(u32x16::splat(simd, last));
    let mut four = [index; 4];
    let mut k = 0;
    while k < 4 {
        four[k] = by_lane(simd, &table[k..], index);
        k += 1;
    }
    four
}

/// One load per lane, for SIMD levels without a gather instruction.
#[inline(always)]
pub(crate) fn by_lane<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> u32x16<S> {
    let Some(last) = last_index(table) else {
        return u32x16::splat(simd, 0);
    };
    let index = index.min(u32x16::splat(simd, last));
    let mut out = [0; LANES];
    for (value, &at) in out.iter_mut().zip(index.as_slice()) {
        // The index is in range; `get` spares the compiler a panic path.
        *value = table.get(at as usize).copied().unwrap_or_default();
    }
    u32x16::load_array(simd, out)
}

/// [`Lanes::scatter`](crate::Lanes::scatter) lane by lane.
#[inline(always)]
pub(crate) fn scatter_by_lane<S: Simd>(
    table: &mut [u32],
    index: u32x16<S>,
    values: u32x16<S>,
    lanes: u16,
) {
    let pairs = index.as_slice().iter().zip(values.as_slice());
    for (lane, (&at, &value)) in pairs.enumerate() {
        // Lanes outside the mask keep what is there, so that there is no branch on it.
        if let Some(to) = table.get_mut(at as usize) {
            *to = select_unpredictable(lanes >> lane & 1 == 1, value, *to);
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub use choice::SquareLoads;
#[cfg(target_arch = "x86_64")]
pub(crate) use {
    choice::{decide, gathers_avx512, square_avx2, square_avx512},
    fours::{four_avx2, four_avx512, four_sse2},
    lines::{gather_lines_avx2, scatter_lines_avx2, scatter_to_four_lines_avx2},
    pairs::pair_avx512,
    single::{avx2, avx512, scatter_avx512},
    squares::{pair_avx2, square_sse2},
};
