//! From storage order to rows: the only place where the layout becomes visible as an image.

use super::RenderTarget;
use super::resolve::{is_rgba8, mean_srgb, mean_unorm, mean_words};
use crate::per_sample::texel::{MAX_WORDS, TexelCodec};
use estampe_simd::{LANE_X, LANE_Y, LANES};
use estampe_types::TextureFormat;

/// Lanes of each row of a packet, from left to right.
const LANES_OF_ROW: [[usize; 4]; 4] = {
    let mut lanes = [[0; 4]; 4];
    let mut lane = 0;
    while lane < LANES {
        lanes[LANE_Y[lane] as usize][LANE_X[lane] as usize] = lane;
        lane += 1;
    }
    lanes
};

impl RenderTarget {
    /// A colour attachment's texels in the format's own bytes (of RGBA8 R, G, B, A), row by row from the top;
    /// several samples are resolved to their mean (linear for sRGB). Beyond the last attachment it is empty.
    #[must_use]
    pub fn read_color(&self, index: usize) -> Vec<u8> {
        self.read_color_by(index, 1)
    }

    /// [`Self::read_color`] by so many threads, whose number changes nothing but the time.
    #[must_use]
    pub fn read_color_by(&self, index: usize, threads: usize) -> Vec<u8> {
        let (Some(stored), Some(&format)) = (
            self.colors.get(index),
            self.descriptor.color_formats.get(index),
        ) else {
            return Vec::new();
        };
        let stored = &stored[..];
        let samples = self.samples() as usize;
        if !is_rgba8(format) || !matches!(samples, 1 | 4) {
            let codec = TexelCodec::new(format);
            let elements = LANES * codec.words * samples;
            return self.texels_of(format, |packet| {
                let of_packet = &stored[packet * elements..][..elements];
                if samples == 1 {
                    codec.words_of(of_packet)
                } else {
                    mean_words(&codec, of_packet, samples)
                }
            });
        }
        if samples == 1 {
            return self.bytes_of(threads, |packet| {
                let pixels = stored[packet * LANES..].first_chunk();
                *pixels.expect("every packet is stored whole")
            });
        }
        let resolve = if format.is_srgb() {
            mean_srgb
        } else {
            mean_unorm
        };
        self.bytes_of(threads, |packet| {
            let samples = &stored[packet * LANES * 4..][..LANES * 4];
            std::array::from_fn(|lane| {
                resolve([0, 1, 2, 3].map(|sample| samples[sample * LANES + lane]))
            })
        })
    }

    /// The texels of one sample of a colour attachment in the format's own bytes, row by row from the top. Beyond
    /// the last attachment or sample it is empty.
    #[must_use]
    pub fn read_texels(&self, index: usize, sample: u32) -> Vec<u8> {
        let (Some(stored), Some(&format), true) = (
            self.colors.get(index),
            self.descriptor.color_formats.get(index),
            sample < self.samples(),
        ) else {
            return Vec::new();
        };
        let codec = TexelCodec::new(format);
        let elements = LANES * codec.words;
        self.texels_of(format, |packet| {
            let number = packet * self.samples() as usize + sample as usize;
            codec.words_of(&stored[number * elements..][..elements])
        })
    }

    /// Rows of texels from a function of the packet.
    fn texels_of(
        &self,
        format: TextureFormat,
        packet: impl Fn(usize) -> [[u32; LANES]; MAX_WORDS],
    ) -> Vec<u8> {
        let (width, height) = (self.width() as usize, self.height() as usize);
        let bytes_each = format.block_bytes() as usize;
        let mut bytes = vec![0; width * height * bytes_each];
        for y in (0..self.height()).step_by(4) {
            for x in (0..self.width()).step_by(4) {
                let words = packet(self.grid.packet_of(x, y));
                for lane in 0..LANES {
                    let (x, y) = (x + u32::from(LANE_X[lane]), y + u32::from(LANE_Y[lane]));
                    let (x, y) = (x as usize, y as usize);
                    if x >= width || y >= height {
                        continue;
                    }
                    let texel = &mut bytes[(y * width + x) * bytes_each..][..bytes_each];
                    for (part, word) in texel.chunks_mut(4).zip(&words) {
                        part.copy_from_slice(&word[lane].to_le_bytes()[..part.len()]);
                    }
                }
            }
        }
        bytes
    }

    /// Rows of bytes from a function of the packet. A thread makes a run of rows, and is the first to touch
    /// their memory: that takes as long as filling them.
    fn bytes_of(&self, threads: usize, packet: impl Fn(usize) -> [u32; LANES] + Sync) -> Vec<u8> {
        let row_bytes = self.width() as usize * 4;
        let bands = self.height().div_ceil(4) as usize;
        let bands_each = bands.div_ceil(threads.clamp(1, bands));
        let mut bytes = vec![0; row_bytes * self.height() as usize];
        let fill = |bytes: &mut [u8], first_y: u32| {
            for (rows, y) in bytes.chunks_mut(row_bytes * 4).zip((first_y..).step_by(4)) {
                for x in (0..self.width()).step_by(4) {
                    let pixels = packet(self.grid.packet_of(x, y));
                    for (row, lanes) in rows.chunks_mut(row_bytes).zip(&LANES_OF_ROW) {
                        let quad = lanes.map(|lane| pixels[lane].to_le_bytes());
                        let to = &mut row[x as usize * 4..];
                        match to.first_chunk_mut::<16>() {
                            Some(to) => to.copy_from_slice(quad.as_flattened()),
                            // At the right edge.
                            None => to.copy_from_slice(&quad.as_flattened()[..to.len()]),
                        }
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            let step_y = u32::try_from(bands_each * 4).unwrap_or(u32::MAX);
            let mut parts = bytes
                .chunks_mut(row_bytes * 4 * bands_each)
                .zip((0..).step_by(step_y as usize));
            let own = parts.next();
            for (part, y) in parts {
                scope.spawn(move || fill(part, y));
            }
            if let Some((part, y)) = own {
                fill(part, y);
            }
        });
        bytes
    }

    /// The depth attachment, row by row from the top; of several samples the first. Depths of fixed-point formats
    /// are the numbers nearest to their codes. Without depth it is empty.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        self.read_depth_sample(0)
    }

    /// The depths of one sample. Without depth, or beyond the last sample, it is empty.
    #[must_use]
    pub fn read_depth_sample(&self, sample: u32) -> Vec<f32> {
        self.rows_of_sample(&self.depth, sample)
    }

    /// The stencil values of one sample, row by row from the top. Without stencil, or beyond the last sample, it
    /// is empty.
    #[must_use]
    pub fn read_stencil(&self, sample: u32) -> Vec<u8> {
        self.rows_of_sample(&self.stencil, sample)
    }

    fn rows_of_sample<T: Copy + Default>(&self, stored: &[T], sample: u32) -> Vec<T> {
        if stored.is_empty() || sample >= self.samples() {
            return Vec::new();
        }
        let mut rows = vec![T::default(); self.width() as usize * self.height() as usize];
        let (samples, sample) = (self.samples() as usize, sample as usize);
        self.rows_of(&mut rows, |packet, lane| {
            stored[(packet * samples + sample) * LANES + lane]
        });
        rows
    }

    /// Fills rows from a function of packet and lane, four rows of packets at a time.
    fn rows_of<T: Copy>(&self, rows: &mut [T], value: impl Fn(usize, usize) -> T) {
        let (width, height) = (self.width(), self.height());
        for y in (0..height).step_by(4) {
            for x in (0..width).step_by(4) {
                let packet = self.grid.packet_of(x, y);
                for lane in 0..LANES {
                    let (x, y) = (x + u32::from(LANE_X[lane]), y + u32::from(LANE_Y[lane]));
                    if x < width && y < height {
                        rows[y as usize * width as usize + x as usize] = value(packet, lane);
                    }
                }
            }
        }
    }
}
