//! Least and greatest depth of each 4×4 texels of a depth texture.
//!
//! In: a block of 64×64 depths, all in 0..=1, in storage order.\
//! Out: sixteen rows of sixteen words in the format of [`ShadowMap::bounds`].\
//! Precision: minimum and maximum do not depend on the order of comparisons, so the bits are the
//! same at every SIMD level.

use crate::ShadowMap;
use crate::morton::{compact, spread};
use crate::texture::BLOCK;
use estampe_simd::{
    LANES, Lanes, Level, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, dispatch, f32x16, i32x16,
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
