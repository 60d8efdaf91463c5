//! Rows of texels stored from a tile that was just drawn, while it is in the cache.
//!
//! An image that shaders sample next is needed in row order. Converted as a whole after the pass,
//! it is read from memory once more, as an image is larger than the caches.

use super::detile::{MAX_BYTES, PACKET_SIDE, SQUARE, write_rows};
use super::row_order::{swapped, swaps_red_and_blue};
use super::texels::ImageSize;
use crate::layout::{BLOCK, morton, texel_words};
use estampe_simd::{LANES, Lanes, Level, dispatch};
use estampe_types::TextureFormat;

/// The part of an image in row order that lies in one tile of a colour attachment of one sample.
#[derive(Debug)]
pub(crate) struct TileRows<'a> {
    /// The number of the attachment.
    pub(crate) color: usize,
    format: TextureFormat,
    /// Rows of whole texels, as many as the tile has in the image.
    pub(crate) rows: Vec<&'a mut [u32]>,
}

impl<'a> TileRows<'a> {
    /// Cuts an image of whole rows into its tiles, in the order of their numbers.
    pub(crate) fn of_image(
        (color, format): (usize, TextureFormat),
        size: ImageSize,
        image: &'a mut [u32],
    ) -> impl Iterator<Item = Self> {
        debug_assert_eq!(size.samples, 1, "tiles of one sample");
        let row_words = size.width as usize * texel_words(format);
        let tile_words = BLOCK as usize * texel_words(format);
        let bands = image.chunks_mut(row_words * BLOCK as usize);
        bands.flat_map(move |band| {
            let mut left: Vec<_> = band.chunks_mut(row_words).collect();
            (0..row_words).step_by(tile_words).map(move |_| {
                let rows = left.iter_mut().map(|left| {
                    let words = tile_words.min(left.len());
                    let (row, others) = std::mem::take(left).split_at_mut(words);
                    *left = others;
                    row
                });
                Self {
                    color,
                    format,
                    rows: rows.collect(),
                }
            })
        })
    }

    /// Stores the texels of the tile, which are in storage order.
    pub(crate) fn store(&mut self, level: Level, tile: &[u32]) {
        match texel_words(self.format) {
            1 => dispatch!(level, s => self.fill::<_, 1, 4>(s, tile)),
            2 => dispatch!(level, s => self.fill::<_, 2, 8>(s, tile)),
            4 => dispatch!(level, s => self.fill::<_, 4, 16>(s, tile)),
            words => unreachable!("a renderable texel has 1, 2 or 4 words, not {words}"),
        }
        let swaps = swaps_red_and_blue(self.format);
        if swaps || cfg!(target_endian = "big") {
            for word in self.rows.iter_mut().flat_map(|row| row.iter_mut()) {
                let stored = u32::from_le(*word);
                *word = if swaps { swapped(stored) } else { stored };
            }
        }
    }

    #[inline(always)]
    fn fill<S: Lanes, const WORDS: usize, const BYTES: usize>(&mut self, s: S, tile: &[u32]) {
        for (band, y) in self.rows.chunks_mut(PACKET_SIDE).zip(0..) {
            let width = band.first().map_or(0, |row| row.len() / WORDS);
            for (x, column) in (0..width).step_by(SQUARE).zip((0..).step_by(4)) {
                // Four packets beside each other, in Morton order.
                let first = morton(column, y) as usize * LANES * WORDS;
                let packet =
                    |number: usize| &tile[first + number * LANES * WORDS..][..LANES * WORDS];
                let packets = [packet(0), packet(1), packet(4), packet(5)];
                let columns = (width - x).min(SQUARE);
                if let ([a, b, c, d], SQUARE) = (&mut *band, columns) {
                    let to = [
                        bytes::<WORDS>(a, x, SQUARE),
                        bytes::<WORDS>(b, x, SQUARE),
                        bytes::<WORDS>(c, x, SQUARE),
                        bytes::<WORDS>(d, x, SQUARE),
                    ];
                    write_rows::<S, WORDS, BYTES>(s, packets, to);
                    continue;
                }
                let mut edge = [[0_u8; SQUARE * MAX_BYTES]; PACKET_SIDE];
                let to = edge.each_mut().map(|row| &mut row[..]);
                write_rows::<S, WORDS, BYTES>(s, packets, to);
                for (row, from) in band.iter_mut().zip(&edge) {
                    bytes::<WORDS>(row, x, columns).copy_from_slice(&from[..columns * BYTES]);
                }
            }
        }
    }
}

/// The bytes of some texels of a row, from a column on.
#[inline(always)]
fn bytes<const WORDS: usize>(row: &mut [u32], x: usize, columns: usize) -> &mut [u8] {
    bytemuck::cast_slice_mut(&mut row[x * WORDS..][..columns * WORDS])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{ColorTexels, row_order_words};

    /// Tile by tile, the rows are those of the conversion of the whole image.
    #[test]
    fn tiles_become_the_rows_of_their_image() {
        let colors = TextureFormat::ALL.iter();
        for &format in colors.filter(|format| format.is_renderable()) {
            for (width, height) in [(1, 1), (70, 66), (37, 5), (128, 64), (64, 131)] {
                let size = ImageSize {
                    width,
                    height,
                    samples: 1,
                };
                let mut texels = ColorTexels::zeros(format, size).unwrap();
                for (word, number) in texels.words.iter_mut().zip(0_u32..) {
                    *word = number.wrapping_mul(2_654_435_769);
                }
                let mut whole = vec![0; row_order_words(format, size)];
                for level in Level::all_available() {
                    texels
                        .row_jobs(&mut whole)
                        .for_each(|mut job| job.run(level));
                    let mut of_tiles = vec![0; whole.len()];
                    let jobs = TileRows::of_image((0, format), size, &mut of_tiles);
                    let tile_words = (BLOCK * BLOCK) as usize * texel_words(format);
                    let mut count = 0;
                    for (mut job, tile) in jobs.zip(texels.words.chunks(tile_words)) {
                        job.store(level, tile);
                        count += 1;
                    }
                    assert_eq!(count, texels.words.len() / tile_words);
                    assert!(whole == of_tiles, "{}, {size:?}, {level:?}", format.name());
                }
            }
        }
    }
}
