//! From storage order to rows: the only place where the layout becomes visible as an image.

use super::RenderTarget;
use estampe_simd::{LANE_X, LANE_Y, LANES};
use estampe_types::srgb::{LINEAR_FROM_SRGB, srgb_from_linear};

impl RenderTarget {
    /// A colour attachment as RGBA bytes, row by row from the top; several samples are resolved to
    /// their mean (linear for sRGB). Beyond the last attachment it is empty.
    #[must_use]
    pub fn read_color(&self, index: usize) -> Vec<u8> {
        let (Some(stored), Some(format)) = (
            self.colors.get(index),
            self.descriptor.color_formats.get(index),
        ) else {
            return Vec::new();
        };
        let mut rows = vec![0; self.width() as usize * self.height() as usize];
        if self.samples() == 1 {
            self.rows_of(&mut rows, |packet, lane| stored[packet * LANES + lane]);
        } else {
            let resolve = if format.is_srgb() {
                resolve_srgb
            } else {
                resolve_unorm
            };
            self.rows_of(&mut rows, |packet, lane| {
                let first = packet * LANES * 4 + lane;
                resolve([0, 1, 2, 3].map(|sample| stored[first + sample * LANES]))
            });
        }
        rows.into_iter().flat_map(u32::to_le_bytes).collect()
    }

    /// The depth attachment, row by row from the top; of several samples the first. Without one it is
    /// empty.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        if self.depth.is_empty() {
            return Vec::new();
        }
        let mut rows = vec![0.0; self.width() as usize * self.height() as usize];
        let stride = LANES * self.samples() as usize;
        self.rows_of(&mut rows, |packet, lane| self.depth[packet * stride + lane]);
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

/// The mean of four unorm pixels, rounded to the nearest code.
fn resolve_unorm(samples: [u32; 4]) -> u32 {
    let channel = |shift: u32| {
        let sum: u32 = samples.iter().map(|sample| sample >> shift & 0xFF).sum();
        // floor(sum/4 + ½) in integers.
        ((sum + 2) >> 2) << shift
    };
    channel(0) | channel(8) | channel(16) | channel(24)
}

/// The mean of four sRGB pixels: linear for colour, alpha as it is.
fn resolve_srgb(samples: [u32; 4]) -> u32 {
    if samples[1..] == [samples[0]; 3] {
        return samples[0];
    }
    let table = &*LINEAR_FROM_SRGB;
    let channel = |shift: u32| {
        let [a, b, c, d] = samples.map(|sample| table[(sample >> shift & 0xFF) as usize]);
        u32::from(srgb_from_linear((a + b + c + d) * 0.25)) << shift
    };
    channel(0) | channel(8) | channel(16) | resolve_unorm(samples) & 0xFF00_0000
}
