//! Least and greatest depth of each 4×4 texels of a depth texture, and of windows of 8×8.
//!
//! In: a block of 64×64 depths, all in 0..=1, in storage order.\
//! Out: sixteen rows of sixteen words in the format of [`ShadowMap::windows`].\
//! Precision: minimum and maximum do not depend on the order of comparisons, so the bits are the
//! same at every SIMD level.

use crate::ShadowMap;
use crate::morton::{compact, spread};
use crate::texture::BLOCK;
use estampe_simd::{
    LANES, Lanes, Level, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, dispatch, f32x16, i32x16,
    u32x16,
};

/// Packets of 4×4 texels along a side of a block.
pub(crate) const SIDE: usize = BLOCK / 4;

/// The bounds of a block.
pub(crate) fn of_block(level: Level, depths: &[f32]) -> [[u32; SIDE]; SIDE] {
    let mut bounds = [[0; SIDE]; SIDE];
    dispatch!(level, s => wide(s, depths, &mut bounds));
    bounds
}

/// Reduces sixteen packets at a time, a square of four by four. Each step halves the number of
/// values of each packet, so that after four steps each packet occupies one lane.
#[inline(always)]
fn wide<S: Lanes>(simd: S, depths: &[f32], bounds: &mut [[u32; SIDE]; SIDE]) {
    let (packets, _) = depths.as_chunks::<LANES>();
    let (squares, _) = packets.as_chunks::<LANES>();
    // Sixteen squares make a block; inside it they are in Morton order too.
    for (square, packets) in (0_u32..).zip(squares.iter().take(LANES)) {
        let mut words = [0; LANES];
        bounds_of(simd, packets).store_array(&mut words);
        let (x, y) = (compact(square) * 4, compact(square >> 1) * 4);
        for (row, out) in (0..4).zip(&mut bounds[y as usize..]) {
            for (column, word) in (0..4).zip(&mut out[x as usize..]) {
                let lane = spread(column) | spread(row) << 1;
                *word = words[lane as usize].cast_unsigned();
            }
        }
    }
}

/// The word of each of sixteen packets: the least depth rounded down in the low half, the greatest
/// rounded up in the high half.
#[inline(always)]
fn bounds_of<S: Lanes>(simd: S, packets: &[[f32; LANES]; LANES]) -> i32x16<S> {
    let mut least = [f32x16::splat(simd, 0.0); 8];
    let mut greatest = least;
    for half in 0..8 {
        let a = f32x16::load_array_ref(simd, &packets[half * 2]);
        let b = f32x16::load_array_ref(simd, &packets[half * 2 + 1]);
        let (even, odd) = (a.unzip_low(b), a.unzip_high(b));
        least[half] = simd.min_f32(even, odd);
        greatest[half] = simd.max_f32(even, odd);
    }
    let mut count = 4;
    while count > 0 {
        for half in 0..count {
            let (a, b) = (least[half * 2], least[half * 2 + 1]);
            least[half] = simd.min_f32(a.unzip_low(b), a.unzip_high(b));
            let (a, b) = (greatest[half * 2], greatest[half * 2 + 1]);
            greatest[half] = simd.max_f32(a.unzip_low(b), a.unzip_high(b));
        }
        count /= 2;
    }
    // In 0..=32768, so that truncation rounds down and loses nothing else.
    let scale = f32x16::splat(simd, ShadowMap::BOUND_SCALE);
    let low = i32x16::truncate_from(least[0] * scale);
    let scaled = greatest[0] * scale;
    let high = i32x16::truncate_from(scaled);
    let above = f32x16::float_from(high).simd_lt(scaled);
    let one = i32x16::splat(simd, 1);
    let high = above.select(high + one, high);
    low | (high << 16)
}

/// The bounds of texels of one depth.
pub(crate) fn of_depth(depth: f32) -> u32 {
    let scaled = depth.clamp(0.0, 1.0) * ShadowMap::BOUND_SCALE;
    // In 0..=32768.
    let [low, high]: [i32; 2] = [scaled.floor(), scaled.ceil()].map(crate::Real::to_int);
    (low | high << 16).cast_unsigned()
}

/// Joins rows of bounds, of a multiple of sixteen words each, with the words to the right and those
/// below. At the right edge, and below the last row, there are no more.
pub(crate) fn windows(level: Level, stride: usize, bounds: &[u32], windows: &mut [u32]) {
    if stride == 0 {
        return;
    }
    dispatch!(level, s => {
        for (number, windows) in windows.chunks_exact_mut(stride).enumerate() {
            let Some(upper) = bounds.get(number * stride..).and_then(|row| row.get(..stride)) else {
                return;
            };
            let lower = bounds.get((number + 1) * stride..).and_then(|row| row.get(..stride));
            join_rows(s, [upper, lower.unwrap_or(upper)], windows);
        }
    });
}

/// Joins two rows of bounds to one of windows.
#[inline(always)]
fn join_rows<S: Lanes>(s: S, rows: [&[u32]; 2], windows: &mut [u32]) {
    let low_half = u32x16::splat(s, 0xFFFF);
    let (windows, _) = windows.as_chunks_mut::<LANES>();
    for (number, to) in windows.iter_mut().enumerate() {
        let mut least = low_half;
        // The half below does not matter: it is taken away at the end.
        let mut greatest = u32x16::splat(s, 0);
        for row in rows {
            let (here, right) = pair(s, &row[number * LANES..]);
            least = least.min(here & low_half).min(right & low_half);
            greatest = greatest.max(here).max(right);
        }
        (least | (greatest & !low_half)).store_array(to);
    }
}

/// Sixteen words, and those to their right; the last word of a row is its own neighbour.
#[inline(always)]
fn pair<S: Lanes>(s: S, row: &[u32]) -> (u32x16<S>, u32x16<S>) {
    let mut last = [0; LANES];
    let here = row.first_chunk().unwrap_or(&last);
    let here = u32x16::load_array_ref(s, here);
    if let Some(right) = row.get(1..).and_then(|row| row.first_chunk()) {
        return (here, u32x16::load_array_ref(s, right));
    }
    for (lane, to) in last.iter_mut().enumerate() {
        *to = row.get(lane + 1).or(row.last()).copied().unwrap_or(0);
    }
    (here, u32x16::load_array(s, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_of_one_depth_are_those_of_a_block_of_it() {
        for depth in [0.0, 0.25, 0.3, 0.999_99, 1.0, f32::MIN_POSITIVE] {
            for level in Level::all_available() {
                let bounds = of_block(level, &[depth; BLOCK * BLOCK]);
                assert_eq!(bounds, [[of_depth(depth); SIDE]; SIDE], "{depth}");
            }
        }
    }

    /// Each window is the union of the bounds that it holds, in images of one row or several.
    #[test]
    fn windows_join_four_bounds() {
        let mut number = 1_u32;
        let mut random = || {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (number >> 16) % 32_769
        };
        for (stride, rows) in [(16, 1), (16, 5), (48, 16)] {
            let bounds: Vec<u32> = (0..stride * rows)
                .map(|_| {
                    let (a, b) = (random(), random());
                    a.min(b) | a.max(b) << 16
                })
                .collect();
            for level in Level::all_available() {
                let mut found = vec![0; bounds.len()];
                windows(level, stride, &bounds, &mut found);
                for (at, found) in found.iter().enumerate() {
                    let (x, y) = (at % stride, at / stride);
                    let (right, below) = ((x + 1).min(stride - 1), (y + 1).min(rows - 1));
                    let all = [(x, y), (right, y), (x, below), (right, below)];
                    let all = all.map(|(x, y)| bounds[y * stride + x]);
                    let least = all.map(|word| word & 0xFFFF).into_iter().min().unwrap();
                    let greatest = all.map(|word| word >> 16).into_iter().max().unwrap();
                    assert_eq!(*found, least | greatest << 16, "{x} {y}");
                }
            }
        }
    }
}
