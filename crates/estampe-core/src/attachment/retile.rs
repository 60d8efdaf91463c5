//! From rows of texels to packets: the inverse of `detile`.
//!
//! A row of four texels is two pairs of lanes, so the lanes of two packet rows are the zips of two
//! registers whose elements are pairs of 64 bits.

use estampe_simd::{Bytes, Lanes, Level, SimdBase, dispatch, f64x2, outline, u32x4};

/// Texels of a packet's row.
const SIDE: usize = 4;

/// Makes a packet from four rows of four texels of 1, 2 or 4 words.
pub(super) fn packet(level: Level, rows: [&[u32]; SIDE], swaps_red_and_blue: bool, to: &mut [u32]) {
    match to.len() / 16 {
        1 => dispatch!(level, s => retile::<_, 1>(s, rows, swaps_red_and_blue, to)),
        2 => dispatch!(level, s => retile::<_, 2>(s, rows, false, to)),
        4 => dispatch!(level, s => retile::<_, 4>(s, rows, false, to)),
        words => unreachable!("a texel has 1, 2 or 4 words, not {words}"),
    }
}

#[inline(always)]
fn retile<S: Lanes, const WORDS: usize>(
    s: S,
    rows: [&[u32]; SIDE],
    swaps_red_and_blue: bool,
    to: &mut [u32],
) {
    outline!(s, {
        let mut planes = [[u32x4::splat(s, 0); SIDE]; WORDS];
        let mut row = 0;
        while row < SIDE {
            let words = words_of_row::<S, WORDS>(s, rows[row]);
            let mut word = 0;
            while word < WORDS {
                planes[word][row] = words[word];
                word += 1;
            }
            row += 1;
        }
        let mut word = 0;
        while word < WORDS {
            let [a, b, c, d] = planes[word];
            let (a, b) = (
                pairs(s, a, swaps_red_and_blue),
                pairs(s, b, swaps_red_and_blue),
            );
            let (c, d) = (
                pairs(s, c, swaps_red_and_blue),
                pairs(s, d, swaps_red_and_blue),
            );
            let lanes = &mut to[word * 16..][..16];
            store(a.zip_low(b).bitcast(), lanes, 0);
            store(a.zip_high(b).bitcast(), lanes, 1);
            store(c.zip_low(d).bitcast(), lanes, 2);
            store(c.zip_high(d).bitcast(), lanes, 3);
            word += 1;
        }
    });
}

/// The words of four texels, word by word.
#[inline(always)]
fn words_of_row<S: Lanes, const WORDS: usize>(s: S, row: &[u32]) -> [u32x4<S>; WORDS] {
    let mut words = [u32x4::splat(s, 0); WORDS];
    match &mut words[..] {
        [one] => *one = load(s, row, 0),
        [first, second] => {
            let (a, b) = (load(s, row, 0), load(s, row, 1));
            (*first, *second) = (a.unzip_low(b), a.unzip_high(b));
        }
        [w0, w1, w2, w3] => {
            let (a, b, c, d) = (
                load(s, row, 0),
                load(s, row, 1),
                load(s, row, 2),
                load(s, row, 3),
            );
            let even = [a.unzip_low(b), c.unzip_low(d)];
            let odd = [a.unzip_high(b), c.unzip_high(d)];
            (*w0, *w2) = (even[0].unzip_low(even[1]), even[0].unzip_high(even[1]));
            (*w1, *w3) = (odd[0].unzip_low(odd[1]), odd[0].unzip_high(odd[1]));
        }
        _ => unreachable!("a texel has 1, 2 or 4 words"),
    }
    words
}

#[inline(always)]
fn load<S: Lanes>(s: S, row: &[u32], quarter: usize) -> u32x4<S> {
    u32x4::from_slice(s, &row[quarter * SIDE..][..SIDE])
}

/// A row as pairs of lanes.
#[inline(always)]
fn pairs<S: Lanes>(s: S, row: u32x4<S>, swaps_red_and_blue: bool) -> f64x2<S> {
    if swaps_red_and_blue {
        swap_red_and_blue(s, row).bitcast()
    } else {
        row.bitcast()
    }
}

#[inline(always)]
fn swap_red_and_blue<S: Lanes>(s: S, words: u32x4<S>) -> u32x4<S> {
    let byte = u32x4::splat(s, 0xFF);
    let kept = words & u32x4::splat(s, 0xFF00_FF00);
    kept | ((words & byte) << 16) | ((words >> 16) & byte)
}

#[inline(always)]
fn store<S: Lanes>(words: u32x4<S>, to: &mut [u32], quarter: usize) {
    words.store_slice(&mut to[quarter * 4..][..4]);
}
