//! Rows filled from an image in storage order.

use super::{row_order_words, swapped, swaps_red_and_blue, words_each};
use crate::attachment::detile::{RowsJob, StoredTexels, StoredWords};
use crate::attachment::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::layout::texel_words;
use estampe_format::depth::FixedDepth;
use estampe_simd::{Bytes, LANES, Lanes, Level, SimdBase, f32x16, outline, u32x16};
use estampe_types::TextureFormat;
use estampe_types::morton::spread;

/// Rows that one worker fills.
const BAND: usize = 16;

/// Rows that are filled from an image.
#[derive(Debug)]
pub(crate) enum ToRowsJob<'a> {
    /// Of texels with one sample: four packets at a time.
    Lanes {
        rows: RowsJob<'a>,
        swaps_red_and_blue: bool,
    },
    /// Texel by texel.
    Texels(TexelRows<'a>),
}

/// Rows that are filled texel by texel.
#[derive(Debug)]
pub(crate) struct TexelRows<'a> {
    image: Image<'a>,
    size: ImageSize,
    first_y: u32,
    rows: &'a mut [u32],
}

#[derive(Debug, Clone, Copy)]
enum Image<'a> {
    Color(&'a ColorTexels),
    DepthStencil(&'a DepthStencilTexels),
}

impl ToRowsJob<'_> {
    pub(crate) fn run(&mut self, level: Level) {
        match self {
            Self::Lanes {
                rows,
                swaps_red_and_blue,
            } => {
                rows.run(level);
                if *swaps_red_and_blue {
                    for texel in rows.bytes_mut().as_chunks_mut::<4>().0 {
                        texel.swap(0, 2);
                    }
                }
                if cfg!(target_endian = "big") {
                    for word in rows.bytes_mut().as_chunks_mut::<4>().0 {
                        word.reverse();
                    }
                }
            }
            Self::Texels(rows) => rows.fill(),
        }
    }
}

impl TexelRows<'_> {
    fn fill(&mut self) {
        let (width, samples) = (self.size.width as usize, self.size.samples as usize);
        let grid = self.size.grid();
        let format = match self.image {
            Image::Color(color) => color.format,
            Image::DepthStencil(depth) => depth.format,
        };
        let each = words_each(format);
        for (y, row) in (self.first_y..).zip(self.rows.chunks_mut(width * samples * each)) {
            for (x, texel) in (0..).zip(row.chunks_exact_mut(samples * each)) {
                let packet = grid.packet_of(x, y) * samples;
                let lane = (spread(x & 3) | spread(y & 3) << 1) as usize;
                for (sample, words) in texel.chunks_exact_mut(each).enumerate() {
                    let line = packet + sample;
                    match self.image {
                        Image::Color(color) => color.load(line * each, lane, words),
                        Image::DepthStencil(depth) => depth.load(line * LANES + lane, words),
                    }
                }
            }
        }
    }
}

impl ColorTexels {
    /// Cuts the filling of rows into jobs.
    pub(crate) fn row_jobs<'a>(
        &'a self,
        rows: &'a mut [u32],
    ) -> Box<dyn Iterator<Item = ToRowsJob<'a>> + 'a> {
        let each = texel_words(self.format);
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        if self.size.samples > 1 {
            return Box::new(texel_rows(Image::Color(self), self.size, each, rows));
        }
        let swaps = swaps_red_and_blue(self.format);
        let words = StoredWords::One(&self.words);
        Box::new(lane_rows(words, self.size, each, rows, swaps))
    }

    /// Loads a texel.
    fn load(&self, line: usize, lane: usize, words: &mut [u32]) {
        for (index, word) in words.iter_mut().enumerate() {
            let stored = self.words[(line + index) * LANES + lane];
            *word = if swaps_red_and_blue(self.format) {
                swapped(stored)
            } else {
                stored
            };
        }
    }
}

impl DepthStencilTexels {
    /// Cuts the filling of rows into jobs.
    pub(crate) fn row_jobs<'a>(
        &'a self,
        rows: &'a mut [u32],
    ) -> Box<dyn Iterator<Item = ToRowsJob<'a>> + 'a> {
        let each = words_each(self.format);
        debug_assert_eq!(rows.len(), row_order_words(self.format, self.size));
        if self.size.samples > 1 {
            return Box::new(texel_rows(Image::DepthStencil(self), self.size, each, rows));
        }
        let words = match self.format {
            TextureFormat::Depth32Float => StoredWords::One(bytemuck::cast_slice(&self.depth)),
            _ => StoredWords::DepthStencil(self),
        };
        Box::new(lane_rows(words, self.size, each, rows, false))
    }

    /// Writes the words of a packet's texels, word by word and in the order of lanes. The image
    /// must have one sample.
    #[inline(always)]
    pub(in crate::attachment) fn write_packet<S: Lanes>(
        &self,
        s: S,
        packet: usize,
        words: &mut [u32],
    ) {
        outline!(s, {
            let at = packet * LANES;
            let mut stencil = [0; LANES];
            if !self.stencil.is_empty() {
                let values = &self.stencil[at..][..LANES];
                let mut lane = 0;
                while lane < LANES {
                    stencil[lane] = u32::from(values[lane]);
                    lane += 1;
                }
            }
            let stencil = u32x16::from_slice(s, &stencil);
            if self.depth.is_empty() {
                stencil.store_slice(&mut words[..LANES]);
                return;
            }
            let depth = f32x16::from_slice(s, &self.depth[at..][..LANES]);
            let Some(fixed) = FixedDepth::new(self.format) else {
                let bits: u32x16<S> = depth.bitcast();
                bits.store_slice(&mut words[..LANES]);
                if let Some(second) = words.get_mut(LANES..2 * LANES) {
                    stencil.store_slice(second);
                }
                return;
            };
            (fixed.code_lanes(s, depth) | stencil << 24).store_slice(&mut words[..LANES]);
        });
    }

    /// Loads a texel: see the module's documentation.
    fn load(&self, at: usize, words: &mut [u32]) {
        let depth = self.depth.get(at).copied().unwrap_or_default();
        let stencil = self.stencil.get(at).copied().map_or(0, u32::from);
        match (words, FixedDepth::new(self.format)) {
            ([word], Some(fixed)) => *word = fixed.code(depth) | stencil << 24,
            ([word], None) if self.depth.is_empty() => *word = stencil,
            ([word], None) => *word = depth.to_bits(),
            ([depth_word, stencil_word], _) => {
                (*depth_word, *stencil_word) = (depth.to_bits(), stencil);
            }
            _ => {}
        }
    }
}

fn lane_rows<'a>(
    words: StoredWords<'a>,
    size: ImageSize,
    words_each: usize,
    rows: &'a mut [u32],
    swaps_red_and_blue: bool,
) -> impl Iterator<Item = ToRowsJob<'a>> {
    let stored = StoredTexels {
        words,
        grid: size.grid(),
        words_each,
    };
    let bytes = bytemuck::cast_slice_mut(rows);
    let jobs = RowsJob::all(stored, size.width as usize, words_each * 4, bytes);
    jobs.map(move |rows| ToRowsJob::Lanes {
        rows,
        swaps_red_and_blue,
    })
}

fn texel_rows<'a>(
    image: Image<'a>,
    size: ImageSize,
    words_each: usize,
    rows: &'a mut [u32],
) -> impl Iterator<Item = ToRowsJob<'a>> {
    let band = size.width as usize * size.samples as usize * words_each * BAND;
    let bands = rows.chunks_mut(band).zip((0..).step_by(BAND));
    bands.map(move |(rows, first_y)| {
        ToRowsJob::Texels(TexelRows {
            image,
            size,
            first_y,
            rows,
        })
    })
}
