//! From rows of texels to packets: the inverse of `detile`.
//!
//! A row of four texels is two pairs of lanes, so the lanes of two packet rows are the zips of two
//! registers whose elements are pairs of 64 bits.

use super::texels::ImageSize;
use estampe_format::depth::FixedDepth;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Select, SimdBase, SimdCvtFloat, dispatch, f32x4, f64x2, outline,
    u8x16, u16x8, u32x4,
};
use estampe_types::TextureFormat;
use estampe_types::morton::compact;

/// Texels of a packet's row.
const SIDE: usize = 4;

/// Packets of a square of 16×16 pixels, which lie one after the other.
pub(super) const PACKETS: usize = 16;

/// An image of one sample in row order, and the square of 16×16 pixels that is stored.
#[derive(Debug, Clone, Copy)]
pub(super) struct SquareRows<'a> {
    /// All rows of the image.
    pub(super) rows: &'a [u32],
    pub(super) size: ImageSize,
    /// The first pixel of the square.
    pub(super) origin: [u32; 2],
}

impl<'a> SquareRows<'a> {
    /// The first pixel of a packet of the square, by its number.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "less than sixteen")]
    pub(super) fn first_pixel(self, packet: usize) -> [u32; 2] {
        let ([x, y], packet) = (self.origin, packet as u32);
        [x + compact(packet) * 4, y + compact(packet >> 1) * 4]
    }

    /// True if the image has all of the sixteen columns, and the four rows from a pixel row on.
    #[inline(always)]
    pub(super) fn has_whole_band(self, y: u32) -> bool {
        self.origin[0] + 16 <= self.size.width && y + 4 <= self.size.height
    }

    /// The four rows of a band, sixteen texels each; `None` if the image does not have all of them.
    #[inline(always)]
    fn band<const WORDS: usize>(self, band: usize) -> Option<[&'a [u32]; SIDE]> {
        let [x, y] = self.first_pixel(BAND_PACKETS[band]);
        if !self.has_whole_band(y) {
            return None;
        }
        let stride = self.size.width as usize * WORDS;
        let first = y as usize * stride + x as usize * WORDS;
        let rows = &self.rows[first..][..stride * 3 + 16 * WORDS];
        Some([
            &rows[..16 * WORDS],
            &rows[stride..][..16 * WORDS],
            &rows[stride * 2..][..16 * WORDS],
            &rows[stride * 3..][..16 * WORDS],
        ])
    }
}

/// The first packet of each band of four rows. The others of it are 1, 4 and 5 further.
const BAND_PACKETS: [usize; 4] = [0, 2, 8, 10];

/// The packets of a band from the left to the right.
const COLUMN_PACKETS: [usize; 4] = [0, 1, 4, 5];

/// The words of the texels of the packet at a column of a band, word by word and in the order of
/// lanes.
#[inline(always)]
fn packet_of_band<S: Lanes, const WORDS: usize>(
    s: S,
    band: [&[u32]; SIDE],
    column: usize,
) -> [[u32x4<S>; SIDE]; WORDS] {
    let mut rows = [[u32x4::splat(s, 0); SIDE]; WORDS];
    let mut row = 0;
    while row < SIDE {
        let from = &band[row][column * SIDE * WORDS..][..SIDE * WORDS];
        let words = words_of_row::<S, WORDS>(s, from);
        let mut word = 0;
        while word < WORDS {
            rows[word][row] = words[word];
            word += 1;
        }
        row += 1;
    }
    let mut word = 0;
    while word < WORDS {
        rows[word] = lanes_of_rows(rows[word]);
        word += 1;
    }
    rows
}

/// Fills the bands of a square that the image has whole with texels of 1, 2 or 4 words.
pub(super) fn color(level: Level, from: SquareRows<'_>, swaps_red_and_blue: bool, to: &mut [u32]) {
    match to.len() / (PACKETS * LANES) {
        1 => dispatch!(level, s => color_words::<_, 1>(s, from, swaps_red_and_blue, to)),
        2 => dispatch!(level, s => color_words::<_, 2>(s, from, false, to)),
        4 => dispatch!(level, s => color_words::<_, 4>(s, from, false, to)),
        words => unreachable!("a texel has 1, 2 or 4 words, not {words}"),
    }
}

#[inline(always)]
fn color_words<S: Lanes, const WORDS: usize>(
    s: S,
    from: SquareRows<'_>,
    swaps_red_and_blue: bool,
    to: &mut [u32],
) {
    outline!(s, {
        let to = &mut to[..PACKETS * LANES * WORDS];
        let mut band = 0;
        while band < 4 {
            if let Some(rows) = from.band::<WORDS>(band) {
                let mut column = 0;
                while column < 4 {
                    let planes = packet_of_band::<S, WORDS>(s, rows, column);
                    let packet = BAND_PACKETS[band] + COLUMN_PACKETS[column];
                    let to = &mut to[packet * LANES * WORDS..][..LANES * WORDS];
                    let mut word = 0;
                    while word < WORDS {
                        let mut quarter = 0;
                        while quarter < SIDE {
                            let mut lanes = planes[word][quarter];
                            if swaps_red_and_blue {
                                lanes = swap_red_and_blue(s, lanes);
                            }
                            lanes.store_slice(&mut to[word * LANES + quarter * SIDE..][..SIDE]);
                            quarter += 1;
                        }
                        word += 1;
                    }
                    column += 1;
                }
            }
            band += 1;
        }
    });
}

/// Fills the bands of a square that the image has whole with depths and stencil values; either
/// may be empty. Depths are clamped to 0..=1, −0 stays, NaN becomes 0.
pub(super) fn depth_stencil(
    level: Level,
    from: SquareRows<'_>,
    format: TextureFormat,
    depth: &mut [f32],
    stencil: &mut [u8],
) {
    let fixed = FixedDepth::new(format);
    let shift = if fixed.is_some() { 24 } else { 0 };
    let has_two_words = format == TextureFormat::Depth32FloatStencil8;
    match (depth.is_empty(), has_two_words) {
        (true, _) => {}
        (false, false) => dispatch!(level, s => depth_words::<_, 1>(s, from, fixed, depth)),
        (false, true) => dispatch!(level, s => depth_words::<_, 2>(s, from, fixed, depth)),
    }
    match (stencil.is_empty(), has_two_words) {
        (true, _) => {}
        (false, false) => dispatch!(level, s => stencil_words::<_, 1>(s, from, shift, stencil)),
        (false, true) => dispatch!(level, s => stencil_words::<_, 2>(s, from, shift, stencil)),
    }
}

#[inline(always)]
fn depth_words<S: Lanes, const WORDS: usize>(
    s: S,
    from: SquareRows<'_>,
    fixed: Option<FixedDepth>,
    to: &mut [f32],
) {
    outline!(s, {
        let to = &mut to[..PACKETS * LANES];
        let mut band = 0;
        while band < 4 {
            if let Some(rows) = from.band::<WORDS>(band) {
                let mut column = 0;
                while column < 4 {
                    let planes = packet_of_band::<S, WORDS>(s, rows, column);
                    let packet = BAND_PACKETS[band] + COLUMN_PACKETS[column];
                    let to = &mut to[packet * LANES..][..LANES];
                    let mut quarter = 0;
                    while quarter < SIDE {
                        let depth = depth_of_words(s, planes[0][quarter], fixed);
                        depth.store_slice(&mut to[quarter * SIDE..][..SIDE]);
                        quarter += 1;
                    }
                    column += 1;
                }
            }
            band += 1;
        }
    });
}

/// The depths that words of row order stand for.
#[inline(always)]
fn depth_of_words<S: Lanes>(s: S, words: u32x4<S>, fixed: Option<FixedDepth>) -> f32x4<S> {
    match fixed {
        Some(fixed) => {
            let code = words & u32x4::splat(s, fixed.greatest_code());
            f32x4::float_from(code) / fixed.greatest_code() as f32
        }
        None => {
            let (zero, one) = (f32x4::splat(s, 0.0), f32x4::splat(s, 1.0));
            let depth: f32x4<S> = words.bitcast();
            let not_above_one = depth.simd_lt(one).select(depth, one);
            // −0 is a depth that passes store: it stays.
            depth.simd_ge(zero).select(not_above_one, zero)
        }
    }
}

#[inline(always)]
fn stencil_words<S: Lanes, const WORDS: usize>(
    s: S,
    from: SquareRows<'_>,
    shift: u32,
    to: &mut [u8],
) {
    outline!(s, {
        let to = &mut to[..PACKETS * LANES];
        let mut band = 0;
        while band < 4 {
            if let Some(rows) = from.band::<WORDS>(band) {
                let mut column = 0;
                while column < 4 {
                    let planes = packet_of_band::<S, WORDS>(s, rows, column);
                    let packet = BAND_PACKETS[band] + COLUMN_PACKETS[column];
                    let to = &mut to[packet * LANES..][..LANES];
                    let [a, b, c, d] = planes[WORDS - 1];
                    let words = [a >> shift, b >> shift, c >> shift, d >> shift];
                    low_bytes(words).store_slice(to);
                    column += 1;
                }
            }
            band += 1;
        }
    });
}

/// The low bytes of sixteen words.
#[inline(always)]
fn low_bytes<S: Lanes>(words: [u32x4<S>; SIDE]) -> u8x16<S> {
    let [a, b, c, d] = words;
    let (left, right) = (low_halves(a, b), low_halves(c, d));
    left.unzip_low(right)
}

/// The low halves of eight words.
#[inline(always)]
fn low_halves<S: Lanes>(a: u32x4<S>, b: u32x4<S>) -> u8x16<S> {
    let (a, b): (u16x8<S>, u16x8<S>) = (a.bitcast(), b.bitcast());
    a.unzip_low(b).bitcast()
}

/// A packet's lanes from its four rows.
#[inline(always)]
fn lanes_of_rows<S: Lanes>(rows: [u32x4<S>; SIDE]) -> [u32x4<S>; SIDE] {
    let [a, b, c, d] = rows;
    let (a, b): (f64x2<S>, f64x2<S>) = (a.bitcast(), b.bitcast());
    let (c, d): (f64x2<S>, f64x2<S>) = (c.bitcast(), d.bitcast());
    [
        a.zip_low(b).bitcast(),
        a.zip_high(b).bitcast(),
        c.zip_low(d).bitcast(),
        c.zip_high(d).bitcast(),
    ]
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

#[inline(always)]
fn swap_red_and_blue<S: Lanes>(s: S, words: u32x4<S>) -> u32x4<S> {
    let byte = u32x4::splat(s, 0xFF);
    let kept = words & u32x4::splat(s, 0xFF00_FF00);
    kept | ((words & byte) << 16) | ((words >> 16) & byte)
}
