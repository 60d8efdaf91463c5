//! An image in storage order filled from rows.

use super::{row_order_words, swapped, swaps_red_and_blue, words_each};
use crate::attachment::retile::{self, PACKETS, SquareRows};
use crate::attachment::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::layout::{BLOCK, morton, texel_words};
use estampe_format::depth::FixedDepth;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level};
use estampe_types::TextureFormat;

impl ColorTexels {
    /// Cuts the storing of rows into jobs.
    pub(crate) fn storage_jobs<'a>(
        &'a mut self,
        rows: &'a [u32],
    ) -> impl Iterator<Item = FromRowsJob<'a>> {
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        let (format, size) = (self.format, self.size);
        let row = row_of_blocks(size);
        let rows_of_blocks = self.words_mut().chunks_exact_mut(row * texel_words(format));
        (0..)
            .zip(rows_of_blocks)
            .map(move |(y, words)| FromRowsJob {
                stored: Stored::Color(words),
                format,
                size,
                first_y: y * BLOCK,
                rows,
            })
    }
}

impl DepthStencilTexels {
    /// Cuts the storing of rows into jobs. Depths are clamped to 0..=1, −0 stays, NaN becomes 0.
    pub(crate) fn storage_jobs<'a>(
        &'a mut self,
        rows: &'a [u32],
    ) -> impl Iterator<Item = FromRowsJob<'a>> {
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        let (format, size) = (self.format, self.size);
        let row = row_of_blocks(size);
        let (depth, stencil, _) = self.tiles_mut(None);
        let mut depth = depth.chunks_exact_mut(row);
        let mut stencil = stencil.chunks_exact_mut(row);
        (0..size.height.div_ceil(BLOCK)).map(move |y| FromRowsJob {
            stored: Stored::DepthStencil {
                depth: depth.next().unwrap_or_default(),
                stencil: stencil.next().unwrap_or_default(),
            },
            format,
            size,
            first_y: y * BLOCK,
            rows,
        })
    }
}

/// Side of the squares that are filled one after the other.
const SQUARE: usize = 16;

/// The samples of a row of storage blocks.
fn row_of_blocks(size: ImageSize) -> usize {
    let blocks = size.width.div_ceil(BLOCK) as usize;
    blocks * (BLOCK * BLOCK) as usize * size.samples as usize
}

/// A row of storage blocks that is filled from rows.
#[derive(Debug)]
pub(crate) struct FromRowsJob<'a> {
    stored: Stored<'a>,
    format: TextureFormat,
    size: ImageSize,
    first_y: u32,
    rows: &'a [u32],
}

/// Samples in storage order.
#[derive(Debug)]
enum Stored<'a> {
    Color(&'a mut [u32]),
    DepthStencil {
        depth: &'a mut [f32],
        stencil: &'a mut [u8],
    },
}

impl Stored<'_> {
    /// So many samples from one on. Where the image has no depth or no stencil, that part is empty.
    fn part(&mut self, first: usize, len: usize, words_each: usize) -> Stored<'_> {
        match self {
            Self::Color(words) => {
                Stored::Color(&mut words[first * words_each..][..len * words_each])
            }
            Self::DepthStencil { depth, stencil } => Stored::DepthStencil {
                depth: depth.get_mut(first..first + len).unwrap_or_default(),
                stencil: stencil.get_mut(first..first + len).unwrap_or_default(),
            },
        }
    }
}

impl FromRowsJob<'_> {
    /// Fills the blocks: a band of sixteen rows after the other, so that the rows are read from the
    /// left to the right.
    pub(crate) fn run(&mut self, level: Level) {
        let samples = self.size.samples as usize;
        let each = words_each(self.format);
        for y in (0..BLOCK).step_by(SQUARE) {
            for x in (0..self.size.width).step_by(SQUARE) {
                let origin = [x, self.first_y + y];
                if origin[1] >= self.size.height {
                    return;
                }
                let block = x / BLOCK * (BLOCK * BLOCK);
                let packet = morton(x % BLOCK / 4, y / 4) * 16;
                let square = PACKETS * LANES * samples;
                let first = (block + packet) as usize * samples;
                SquareJob {
                    stored: self.stored.part(first, square, each),
                    format: self.format,
                    from: SquareRows {
                        rows: self.rows,
                        size: self.size,
                        origin,
                    },
                }
                .run(level);
            }
        }
    }
}

/// A square of 16×16 pixels that is filled from rows.
#[derive(Debug)]
struct SquareJob<'a> {
    stored: Stored<'a>,
    format: TextureFormat,
    from: SquareRows<'a>,
}

impl SquareJob<'_> {
    fn run(&mut self, level: Level) {
        let from = self.from;
        let has_lanes = from.size.samples == 1;
        if has_lanes {
            match &mut self.stored {
                Stored::Color(words) => {
                    retile::color(level, from, swaps_red_and_blue(self.format), words);
                }
                Stored::DepthStencil { depth, stencil } => {
                    retile::depth_stencil(level, from, self.format, depth, stencil);
                }
            }
        }
        for packet in 0..PACKETS {
            if !(has_lanes && from.has_whole_band(from.first_pixel(packet)[1])) {
                self.fill_packet(packet);
            }
        }
    }

    /// Fills the pixels of a packet that lie in the image, one by one.
    fn fill_packet(&mut self, packet: usize) {
        let size = self.from.size;
        let samples = size.samples as usize;
        let each = words_each(self.format);
        let swaps = swaps_red_and_blue(self.format);
        let fixed = FixedDepth::new(self.format);
        let [x, y] = self.from.first_pixel(packet);
        for lane in 0..LANES {
            let [x, y] = [x + u32::from(LANE_X[lane]), y + u32::from(LANE_Y[lane])];
            if x >= size.width || y >= size.height {
                continue;
            }
            let texel = (y as usize * size.width as usize + x as usize) * samples;
            for sample in 0..samples {
                let words = &self.from.rows[(texel + sample) * each..][..each];
                let at = (packet * samples + sample) * LANES;
                match &mut self.stored {
                    Stored::Color(to) => {
                        for (index, word) in words.iter().enumerate() {
                            let word = if swaps { swapped(*word) } else { *word };
                            to[at * each + index * LANES + lane] = word;
                        }
                    }
                    Stored::DepthStencil { depth, stencil } => {
                        store_depth(fixed, words, depth.get_mut(at + lane));
                        let stored = stencil_of(self.format, words);
                        if let Some(to) = stencil.get_mut(at + lane) {
                            *to = stored;
                        }
                    }
                }
            }
        }
    }
}

fn store_depth(fixed: Option<FixedDepth>, words: &[u32], to: Option<&mut f32>) {
    let Some(to) = to else {
        return;
    };
    *to = match fixed {
        Some(fixed) => fixed.decode(words[0] & fixed.greatest_code()),
        None => {
            let depth = f32::from_bits(words[0]);
            // −0 is a depth that passes store: it stays.
            if depth >= 0.0 { depth.min(1.0) } else { 0.0 }
        }
    };
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a stencil value has 8 bits"
)]
fn stencil_of(format: TextureFormat, words: &[u32]) -> u8 {
    match format {
        TextureFormat::Depth24PlusStencil8 => (words[0] >> 24) as u8,
        TextureFormat::Depth32FloatStencil8 => words[1] as u8,
        _ => words[0] as u8,
    }
}
