//! Words of lines of sixteen words, lane by lane.
//!
//! On Zen 3 gathers of sixteen words take 9.2 ns, loads with insertions 5.9, which share the
//! address of a lane among several lines. Of a single line they were slower where much else is
//! computed: with them in place of all gathers `ui` took 1.065 of its time. Stores go where lanes
//! are, without asking for each lane whether it is stored.
#![expect(unsafe_code, reason = "a check of each lane's index costs too much")]

use super::last_index;
use super::registers::{join_256, scalars};
use crate::{LANES, Lanes};
use core::arch::x86_64::{__m128i, _mm_set_epi32, _mm_setzero_si128};
use fearless_simd::x86::Avx2;
use fearless_simd::{Select, SimdBase, SimdCombine, u32x16};

/// [`Lanes::gather_lines`] by loads.
#[inline(always)]
pub(crate) fn gather_lines_avx2<const N: usize>(
    simd: Avx2,
    table: &[u32],
    index: u32x16<Avx2>,
) -> [u32x16<Avx2>; N] {
    let mut words = [u32x16::splat(simd, 0); N];
    if const { N == 1 } {
        words[0] = super::avx2(simd, table, index);
        return words;
    }
    let Some(last) = table.get((N - 1) * LANES..).and_then(last_index) else {
        return words;
    };
    let index = scalars(index.min(u32x16::splat(simd, last)));
    // SAFETY: SSE2 is x86-64's baseline.
    let mut fours = [[unsafe { _mm_setzero_si128() }; LANES / 4]; N];
    let mut four = 0;
    while four < LANES / 4 {
        let first = four * 4;
        let mut line = 0;
        while line < N {
            let base = table.as_ptr().wrapping_add(line * LANES);
            // SAFETY: each index is at most `last`, so with the lines before the last one, too, it
            // is in the table, which is borrowed for the call.
            fours[line][four] = unsafe {
                four_words([
                    base.wrapping_add(index[first] as usize),
                    base.wrapping_add(index[first + 1] as usize),
                    base.wrapping_add(index[first + 2] as usize),
                    base.wrapping_add(index[first + 3] as usize),
                ])
            };
            line += 1;
        }
        four += 1;
    }
    let mut line = 0;
    while line < N {
        let [a, b, c, d] = fours[line];
        words[line] = join_256(simd, a, b).combine(join_256(simd, c, d));
        line += 1;
    }
    words
}

/// Four words side by side.
///
/// # Safety
///
/// The words can be read.
#[inline(always)]
unsafe fn four_words([a, b, c, d]: [*const u32; 4]) -> __m128i {
    // SAFETY: the caller's duty.
    let a = unsafe { a.read() };
    // SAFETY: as above.
    let b = unsafe { b.read() };
    // SAFETY: as above.
    let c = unsafe { c.read() };
    // SAFETY: as above.
    let d = unsafe { d.read() };
    // SAFETY: SSE2 is x86-64's baseline.
    unsafe {
        _mm_set_epi32(
            d.cast_signed(),
            c.cast_signed(),
            b.cast_signed(),
            a.cast_signed(),
        )
    }
}

/// [`Lanes::scatter_lines`] without a choice of each lane's word: lanes outside the mask store what
/// its last lane stores, where that does.
#[inline(always)]
pub(crate) fn scatter_lines_avx2<const N: usize>(
    simd: Avx2,
    table: &mut [u32],
    index: u32x16<Avx2>,
    values: [u32x16<Avx2>; N],
    lanes: u16,
) {
    let Some(last) = (u16::BITS - 1).checked_sub(lanes.leading_zeros()) else {
        return;
    };
    let last = last as usize % LANES;
    let is_stored = simd.mask_from_bits(lanes);
    let index = is_stored
        .select(index, of_lane(simd, index, last))
        .to_array();
    let mut all = [[0; LANES]; N];
    let mut line = 0;
    while line < N {
        is_stored
            .select(values[line], of_lane(simd, values[line], last))
            .store_array(&mut all[line]);
        line += 1;
    }
    store_words(table, &index, &all);
}

/// Stores words where they belong, if that is in the table. The function is not inlined, as the
/// compiler would then take lane by lane out of registers, which is two operations each.
#[inline(never)]
fn store_words<const N: usize>(
    table: &mut [u32],
    index: &[u32; LANES],
    values: &[[u32; LANES]; N],
) {
    for (lane, &at) in index.iter().enumerate() {
        for (line, values) in values.iter().enumerate() {
            if let Some(to) = table.get_mut(at as usize + line * LANES) {
                *to = values[lane];
            }
        }
    }
}

/// [`Lanes::scatter_to_four_lines`]: lines outside a lane's masks store what another line of it
/// does, lanes outside all masks what the last lane does.
#[inline(always)]
pub(crate) fn scatter_to_four_lines_avx2(
    simd: Avx2,
    table: &mut [u32],
    index: u32x16<Avx2>,
    values: u32x16<Avx2>,
    lanes: [u16; 4],
) {
    let any = lanes[0] | lanes[1] | lanes[2] | lanes[3];
    let Some(last) = (u16::BITS - 1).checked_sub(any.leading_zeros()) else {
        return;
    };
    let last = last as usize % LANES;
    let mut lines = u32x16::splat(simd, 0);
    let mut line = 0;
    while line < 4 {
        let bit = u32x16::splat(simd, 1 << line);
        lines |= simd
            .mask_from_bits(lanes[line])
            .select(bit, u32x16::splat(simd, 0));
        line += 1;
    }
    let is_stored = simd.mask_from_bits(any);
    let index = is_stored.select(index, of_lane(simd, index, last));
    let values = is_stored.select(values, of_lane(simd, values, last));
    let lines = is_stored.select(lines, of_lane(simd, lines, last));
    store_to_four_lines(
        table,
        &index.to_array(),
        &values.to_array(),
        &lines.to_array(),
    );
}

/// The word of one lane in all.
#[inline(always)]
fn of_lane(simd: Avx2, words: u32x16<Avx2>, lane: usize) -> u32x16<Avx2> {
    u32x16::splat(simd, scalars(words)[lane])
}

/// For each mask of four lines, where they begin: those that it lacks where its first one does.
static FIRST_OF_LINES: [[usize; 4]; 16] = {
    let mut firsts = [[0; 4]; 16];
    let mut mask = 1;
    while mask < 16_usize {
        let mut line = 0;
        while line < 4 {
            let has_it = mask >> line & 1 == 1;
            let stored = if has_it {
                line
            } else {
                mask.trailing_zeros() as usize
            };
            firsts[mask][line] = stored * LANES;
            line += 1;
        }
        mask += 1;
    }
    firsts
};

/// Stores each word in those of four lines that a mask has, if all four are in the table. Not
/// inlined, as [`store_words`].
#[inline(never)]
fn store_to_four_lines(
    table: &mut [u32],
    index: &[u32; LANES],
    values: &[u32; LANES],
    lines: &[u32; LANES],
) {
    for lane in 0..LANES {
        let from = table.get_mut(index[lane] as usize..);
        let Some(four) = from.and_then(<[u32]>::first_chunk_mut::<{ 3 * LANES + 1 }>) else {
            continue;
        };
        for first in FIRST_OF_LINES[lines[lane] as usize % 16] {
            four[first & (3 * LANES)] = values[lane];
        }
    }
}
