//! An image in storage order filled from rows.

use super::{row_order_words, swapped, swaps_red_and_blue, words_each};
use crate::attachment::retile;
use crate::attachment::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::layout::{BLOCK, texel_words};
use estampe_format::depth::FixedDepth;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level};
use estampe_types::TextureFormat;
use estampe_types::morton::compact;

impl ColorTexels {
    /// Cuts the storing of rows into jobs.
    pub(crate) fn storage_jobs<'a>(
        &'a mut self,
        rows: &'a [u32],
    ) -> impl Iterator<Item = FromRowsJob<'a>> {
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        let (format, size) = (self.format, self.size);
        let block = (BLOCK * BLOCK) as usize * size.samples as usize * texel_words(format);
        let blocks = self.words.chunks_exact_mut(block).enumerate();
        blocks.map(move |(number, words)| FromRowsJob {
            block: Block::Color(words),
            format,
            size,
            origin: block_origin(size, number),
            rows,
        })
    }
}

impl DepthStencilTexels {
    /// Cuts the storing of rows into jobs. Depths are clamped to 0..=1, NaN becomes 0.
    pub(crate) fn storage_jobs<'a>(
        &'a mut self,
        rows: &'a [u32],
    ) -> impl Iterator<Item = FromRowsJob<'a>> {
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        let (format, size) = (self.format, self.size);
        let block = (BLOCK * BLOCK) as usize * size.samples as usize;
        let count = size.stored_samples() / block;
        let mut depth = std::sync::Arc::make_mut(&mut self.depth).chunks_exact_mut(block);
        let mut stencil = self.stencil.chunks_exact_mut(block);
        (0..count).map(move |number| FromRowsJob {
            block: Block::DepthStencil {
                depth: depth.next().unwrap_or_default(),
                stencil: stencil.next().unwrap_or_default(),
            },
            format,
            size,
            origin: block_origin(size, number),
            rows,
        })
    }
}

/// The first pixel of a storage block.
fn block_origin(size: ImageSize, number: usize) -> [u32; 2] {
    let columns = size.width.div_ceil(BLOCK);
    let number = u32::try_from(number).unwrap_or(u32::MAX);
    [number % columns * BLOCK, number / columns * BLOCK]
}

/// A storage block that is filled from rows.
#[derive(Debug)]
pub(crate) struct FromRowsJob<'a> {
    block: Block<'a>,
    format: TextureFormat,
    size: ImageSize,
    origin: [u32; 2],
    rows: &'a [u32],
}

#[derive(Debug)]
enum Block<'a> {
    Color(&'a mut [u32]),
    DepthStencil {
        depth: &'a mut [f32],
        stencil: &'a mut [u8],
    },
}

impl FromRowsJob<'_> {
    /// Fills the block.
    pub(crate) fn run(&mut self, level: Level) {
        let samples = self.size.samples as usize;
        let each = words_each(self.format);
        let [width, height] = [self.size.width, self.size.height];
        let swaps = swaps_red_and_blue(self.format);
        let fixed = FixedDepth::new(self.format);
        for packet in 0..256_u32 {
            let x = self.origin[0] + compact(packet) * 4;
            let y = self.origin[1] + compact(packet >> 1) * 4;
            if x >= width || y >= height {
                continue;
            }
            let is_whole = x + 4 <= width && y + 4 <= height;
            let first = packet as usize * samples * LANES;
            if let Block::Color(words) = &mut self.block
                && is_whole
                && samples == 1
            {
                let to = &mut words[first * each..][..LANES * each];
                let row = |k: usize| {
                    let at = ((y as usize + k) * width as usize + x as usize) * each;
                    &self.rows[at..][..4 * each]
                };
                retile::packet(level, [row(0), row(1), row(2), row(3)], swaps, to);
                continue;
            }
            for lane in 0..LANES {
                let [x, y] = [x + u32::from(LANE_X[lane]), y + u32::from(LANE_Y[lane])];
                if x >= width || y >= height {
                    continue;
                }
                let texel = (y as usize * width as usize + x as usize) * samples;
                for sample in 0..samples {
                    let words = &self.rows[(texel + sample) * each..][..each];
                    let at = first + sample * LANES;
                    match &mut self.block {
                        Block::Color(to) => {
                            for (index, word) in words.iter().enumerate() {
                                let word = if swaps { swapped(*word) } else { *word };
                                to[at * each + index * LANES + lane] = word;
                            }
                        }
                        Block::DepthStencil { depth, stencil } => {
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
}

fn store_depth(fixed: Option<FixedDepth>, words: &[u32], to: Option<&mut f32>) {
    let Some(to) = to else {
        return;
    };
    *to = match fixed {
        Some(fixed) => fixed.decode(words[0] & fixed.greatest_code()),
        None => {
            let depth = f32::from_bits(words[0]);
            if depth > 0.0 { depth.min(1.0) } else { 0.0 }
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
