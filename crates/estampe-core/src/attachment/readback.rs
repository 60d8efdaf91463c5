//! From storage order to rows: the only place where the layout becomes visible as an image.

use super::RenderTarget;
use super::resolve::{mean_srgb, mean_unorm};
use estampe_simd::{LANE_X, LANE_Y, LANES};

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
    /// A colour attachment as RGBA bytes, row by row from the top; several samples are resolved to
    /// their mean (linear for sRGB). Beyond the last attachment it is empty.
    #[must_use]
    pub fn read_color(&self, index: usize) -> Vec<u8> {
        self.read_color_by(index, 1)
    }

    /// [`Self::read_color`] by so many threads, whose number changes nothing but the time.
    #[must_use]
    pub fn read_color_by(&self, index: usize, threads: usize) -> Vec<u8> {
        let (Some(stored), Some(format)) = (
            self.colors.get(index),
            self.descriptor.color_formats.get(index),
        ) else {
            return Vec::new();
        };
        let stored = &stored[..];
        if self.samples() == 1 {
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
