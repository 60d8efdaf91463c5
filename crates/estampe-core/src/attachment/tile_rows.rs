//! Rows of texels stored from a tile that was just drawn, while it is in the cache.
//!
//! An image that shaders sample next is needed in row order. Converted as a whole after the pass,
//! it is read from memory once more, as an image is larger than the caches.

use super::bands::Bands;
use super::detile::{MAX_BYTES, PACKET_SIDE, SQUARE, rows_of_band, write_rows};
use super::row_order::{swapped, swaps_red_and_blue};
use super::texels::ImageSize;
use crate::layout::{TileGrid, morton, texel_words};
use estampe_simd::{LANES, Lanes, Level, dispatch};
use estampe_types::TextureFormat;

/// An image in row order that takes the texels of a colour attachment of one sample: each worker
/// stores the tiles that it draws.
#[derive(Debug)]
pub(crate) struct StoredRows<'a> {
    pub(crate) place: RowsPlace,
    format: TextureFormat,
    /// Four rows each, fewer at the end.
    bands: Bands<'a>,
}

/// Where the rows of an image lie, for those who only prefetch them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowsPlace {
    /// The number of the colour attachment.
    pub(crate) color: usize,
    /// The address of the first row.
    address: usize,
    /// Width and height of the image in pixels.
    size: [u32; 2],
    /// Pixels of a tile's side.
    tile_side: u32,
    /// Words of a texel.
    texel_words: usize,
}

impl<'a> StoredRows<'a> {
    /// The rows of an image, which has whole rows of the attachment's width; and the tiles of the
    /// attachment.
    pub(crate) fn of_image(
        (color, format): (usize, TextureFormat),
        (size, grid): (ImageSize, TileGrid),
        image: &'a mut [u32],
    ) -> Self {
        debug_assert_eq!(size.samples, 1, "tiles of one sample");
        let place = RowsPlace {
            color,
            address: image.as_ptr().addr(),
            size: [size.width, size.height],
            tile_side: 1 << grid.tile_log2(),
            texel_words: texel_words(format),
        };
        Self {
            place,
            format,
            bands: Bands::of(image, place.row_words() * PACKET_SIDE),
        }
    }

    /// Stores the texels of the tile with this left column and top row. They are in storage order.
    pub(crate) fn store(&self, level: Level, origin: (u32, u32), tile: &[u32]) {
        match self.place.texel_words {
            1 => dispatch!(level, s => self.fill::<_, 1, 4>(s, origin, tile)),
            2 => dispatch!(level, s => self.fill::<_, 2, 8>(s, origin, tile)),
            4 => dispatch!(level, s => self.fill::<_, 4, 16>(s, origin, tile)),
            words => unreachable!("a renderable texel has 1, 2 or 4 words, not {words}"),
        }
    }

    #[inline(always)]
    fn fill<S: Lanes, const WORDS: usize, const BYTES: usize>(
        &self,
        s: S,
        (left, top): (u32, u32),
        tile: &[u32],
    ) {
        let first = left as usize;
        let ([width, _], side) = (self.place.size, self.place.tile_side);
        let columns = width.saturating_sub(left).min(side) as usize;
        if columns == 0 {
            return;
        }
        let row_bytes = self.place.row_words() * 4;
        let swaps = swaps_red_and_blue(self.format);
        let first_band = top as usize / PACKET_SIDE;
        for (number, y) in (first_band..).zip(0..side / 4) {
            let Some(mut band) = self.bands.lock(number) else {
                return;
            };
            for (x, column) in (0..columns).step_by(SQUARE).zip((0..).step_by(4)) {
                // Four packets beside each other, in Morton order.
                let at = morton(column, y) as usize * LANES * WORDS;
                let packet = |number: usize| &tile[at + number * LANES * WORDS..][..LANES * WORDS];
                let packets = [packet(0), packet(1), packet(4), packet(5)];
                let (from, columns) = ((first + x) * BYTES, (columns - x).min(SQUARE));
                let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut band);
                if columns == SQUARE && bytes.len() == row_bytes * PACKET_SIDE {
                    let to = rows_of_band(bytes, row_bytes, from, SQUARE * BYTES);
                    write_rows::<S, WORDS, BYTES>(s, packets, to);
                    continue;
                }
                let mut edge = [[0_u8; SQUARE * MAX_BYTES]; PACKET_SIDE];
                let to = edge.each_mut().map(|row| &mut row[..]);
                write_rows::<S, WORDS, BYTES>(s, packets, to);
                for (row, texels) in bytes.chunks_mut(row_bytes).zip(&edge) {
                    row[from..][..columns * BYTES].copy_from_slice(&texels[..columns * BYTES]);
                }
            }
            if swaps || cfg!(target_endian = "big") {
                let rows = band.chunks_mut(self.place.row_words());
                for word in rows.flat_map(|row| &mut row[first * WORDS..][..columns * WORDS]) {
                    let stored = u32::from_le(*word);
                    *word = if swaps { swapped(stored) } else { stored };
                }
            }
        }
    }
}

impl RowsPlace {
    fn row_words(&self) -> usize {
        self.size[0] as usize * self.texel_words
    }

    /// The cache lines of the tile with this left column and top row.
    pub(crate) fn lines_of_tile(&self, (left, top): (u32, u32)) -> TileLines {
        const LINE_WORDS: usize = 16;
        let ([width, height], side) = (self.size, self.tile_side);
        let row_bytes = self.row_words() * 4;
        let columns = width.saturating_sub(left).min(side) as usize;
        TileLines {
            address: self.address + top as usize * row_bytes + left as usize * self.texel_words * 4,
            row_bytes,
            of_row: (columns * self.texel_words).div_ceil(LINE_WORDS),
            rows: height.saturating_sub(top).min(side) as usize,
        }
    }
}

/// Cache lines of a tile in an image in row order.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct TileLines {
    /// The address of the first row's first line.
    pub(crate) address: usize,
    /// Bytes from row to row.
    pub(crate) row_bytes: usize,
    /// Lines of a row.
    pub(crate) of_row: usize,
    /// Rows.
    pub(crate) rows: usize,
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
                for (word, number) in texels.words_mut().iter_mut().zip(0_u32..) {
                    *word = number.wrapping_mul(2_654_435_769);
                }
                let mut whole = vec![0; row_order_words(format, size)];
                for level in Level::all_available() {
                    texels
                        .row_jobs(&mut whole)
                        .for_each(|mut job| job.run(level));
                    for threads in [1, 64] {
                        let mut of_tiles = vec![0; whole.len()];
                        let grid = size.grid().for_threads(threads);
                        let rows = StoredRows::of_image((0, format), (size, grid), &mut of_tiles);
                        let tile_words = grid.tile_pixels() * texel_words(format);
                        let tiles = texels.words.chunks(tile_words);
                        assert_eq!(tiles.len(), grid.tiles());
                        for (number, tile) in (0..).zip(tiles) {
                            rows.store(level, grid.tile_origin(number), tile);
                        }
                        assert!(whole == of_tiles, "{}, {grid:?}, {level:?}", format.name());
                    }
                }
            }
        }
    }

    #[test]
    fn the_lines_of_a_tile_are_those_that_are_stored() {
        let (format, size) = (
            TextureFormat::Rgba8Unorm,
            ImageSize {
                width: 70,
                height: 66,
                samples: 1,
            },
        );
        let mut image = vec![0; row_order_words(format, size)];
        let first = image.as_ptr().addr();
        let mut of = |threads, x, y| {
            let tiles = (size, size.grid().for_threads(threads));
            let rows = StoredRows::of_image((0, format), tiles, &mut image);
            let lines = rows.place.lines_of_tile((x, y));
            let texel = (lines.address - first) / 4;
            assert_eq!(lines.row_bytes, 70 * 4);
            (texel, lines.of_row, lines.rows)
        };
        assert_eq!(of(1, 0, 0), (0, 4, 64));
        assert_eq!(of(1, 64, 0), (64, 1, 64));
        assert_eq!(of(1, 64, 64), (64 * 70 + 64, 1, 2));
        assert_eq!(of(64, 32, 32), (32 * 70 + 32, 2, 32));
        assert_eq!(of(64, 64, 64), (64 * 70 + 64, 1, 2));
    }
}
