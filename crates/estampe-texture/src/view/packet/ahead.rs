//! The texels that a filter reads for the next batch of packets, brought to the cache while it
//! filters this one.
//!
//! What pass after pass reads lies in no cache near the processor, as images are large, and the
//! rows of a tile are too short for the processor to foresee. A batch is a square of 16×16 pixels,
//! whose texels are a window: as many as pixels, or several times as many, and those that taps
//! beside the place reach.

use super::shifts::TapShifts;
use crate::view::blocks::blocks_ahead;
use crate::view::plane::Plane;
use estampe_simd::{LANES, Lanes, Packet as Values};

/// The pixels along a side of a batch, and the packets.
const SIDE: i32 = 16;
const PACKETS: usize = 16;

/// The words of a texel, and of a cache line.
const WORDS: usize = 2;
const LINE: usize = 16;

/// More pixels than any image has along a side.
const MOST_PIXELS: i32 = 1 << 20;

/// The most texels between one pixel and the next.
const MOST_STEP: f32 = 4.0;

/// The lines of a window of texels that are not prefetched yet.
#[derive(Debug, Default)]
pub(super) struct Ahead<'a> {
    /// From the next row's first word on.
    texels: &'a [u32],
    row_words: usize,
    /// The lines of each row.
    lines: usize,
    /// The rows that are left, and those of a packet.
    rows: usize,
    rows_of_packet: usize,
}

impl<'a> Ahead<'a> {
    /// The window of the batch after the one whose first packet is at (u, v), in a level whose
    /// texels these are; none if it does not begin at a square of 16×16 pixels.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "numbers of texels, and of packets"
    )]
    pub(super) fn new(
        (texels, row_words): (&'a [u32], usize),
        plane: &Plane,
        [u, v]: [&Values<f32>; 2],
        shifts: &TapShifts,
    ) -> Self {
        // Lanes 5 and 10 are the last column and row.
        let along = [(u, 5), (v, 10)];
        let mut window = [[0_i32; 2]; 2];
        let mut steps = [0.0; 2];
        let mut pixel = [0; 2];
        for (axis, (at, last)) in along.into_iter().enumerate() {
            let first = at.0[0] * plane.size[axis];
            let step = (at.0[last] * plane.size[axis] - first) / 3.0;
            if !(0.9..=MOST_STEP).contains(&step) {
                return Self::default();
            }
            steps[axis] = step;
            pixel[axis] = (first / step) as i32;
        }
        let begins_batch = pixel
            .iter()
            .all(|pixel| (0..MOST_PIXELS).contains(pixel) && pixel % SIDE < 4);
        let next = blocks_ahead(pixel, PACKETS as u32).filter(|_| begins_batch);
        let Some(next) = next else {
            return Self::default();
        };
        for axis in 0..2 {
            let (step, size) = (steps[axis], plane.size[axis]);
            let [least, greatest] = shifts.extents[axis].map(|shift| shift * size);
            let first = (next[axis] as f32 * step + least) as i32;
            let last = ((next[axis] + SIDE) as f32 * step + greatest) as i32;
            let most = plane.sides[axis] - 1;
            let first = first.clamp(0, most);
            // A filter reaches the texel after, and is never wider than a few squares.
            window[axis] = [first, last.clamp(first, most.min(first + 8 * SIDE))];
        }
        let [columns, rows] = window.map(|[first, last]| {
            let count = last - first + 1;
            [first, count].map(|number| number.cast_unsigned() as usize)
        });
        let first = rows[0] * row_words + columns[0] * WORDS;
        Self {
            texels: texels.get(first..).unwrap_or_default(),
            row_words,
            lines: (columns[1] * WORDS).div_ceil(LINE) + 1,
            rows: rows[1],
            rows_of_packet: rows[1].div_ceil(PACKETS),
        }
    }

    /// Prefetches the share of a packet.
    #[inline(always)]
    pub(super) fn step<S: Lanes>(&mut self, s: S) {
        let rows = self.rows_of_packet.min(self.rows);
        self.rows -= rows;
        for _ in 0..rows {
            self.prefetch_row(s);
        }
    }

    /// Prefetches a row. False if none is left.
    #[inline(always)]
    pub(super) fn row<S: Lanes>(&mut self, s: S) -> bool {
        if self.rows == 0 {
            return false;
        }
        self.rows -= 1;
        self.prefetch_row(s);
        true
    }

    #[inline(always)]
    fn prefetch_row<S: Lanes>(&mut self, s: S) {
        // A loop: the adapters of an iterator may be left out of line, where lanes are not.
        for line in 0..self.lines {
            let Some(word) = self.texels.get(line * LINE) else {
                break;
            };
            s.prefetch(word);
        }
        self.texels = self.texels.get(self.row_words..).unwrap_or_default();
    }
}

const _: () = assert!(LINE == LANES, "a line has the words of a packet");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MipGeneration, TexelDescriptor, TexelView, TextureFormat};
    use estampe_simd::{LANE_X, LANE_Y};
    use estampe_types::Limits;

    /// The window after a batch whose first packet is at these pixels, of `step` texels each.
    fn window(view: &TexelView, pixel: [i32; 2], step: f32, taps: &[[f32; 2]]) -> [usize; 4] {
        let axis = |pixel: i32, lanes: [u8; LANES], size: f32| {
            Values(lanes.map(|lane| (pixel as f32 + f32::from(lane) + 0.5) * step / size))
        };
        let plane = &view.planes[0];
        let u = axis(pixel[0], LANE_X, plane.size[0]);
        let v = axis(pixel[1], LANE_Y, plane.size[1]);
        let texels = &view.texture.texels[..];
        let row_words = plane.sides[0].cast_unsigned() as usize * WORDS;
        let ahead = Ahead::new((texels, row_words), plane, [&u, &v], &TapShifts::new(taps));
        let first = (texels.len() - ahead.texels.len()) / WORDS;
        let side = row_words / WORDS;
        [first % side, first / side, ahead.lines, ahead.rows]
    }

    #[test]
    fn windows_are_those_of_the_next_squares() {
        let descriptor = TexelDescriptor::new_2d(512, 256, TextureFormat::Rgba16Float);
        let texture = descriptor.create(&[], MipGeneration::None, &Limits::default());
        let view = TexelView::of(texture.expect("it is small")).expect("it has a level");
        let centre = [[-0.0; 2]];
        // To the right, then below: 17 texels along a side.
        assert_eq!(window(&view, [0, 0], 1.0, &centre), [16, 0, 4, 17]);
        assert_eq!(window(&view, [16, 0], 1.0, &centre), [0, 16, 4, 17]);
        // The next tile.
        assert_eq!(window(&view, [48, 48], 1.0, &centre), [64, 0, 4, 17]);
        // Taps reach further.
        let taps = [[0.0, -3.0 / 256.0], [4.0 / 512.0, 3.0 / 256.0]];
        assert_eq!(window(&view, [16, 0], 1.0, &taps), [0, 13, 4, 23]);
        // Two texels a pixel.
        assert_eq!(window(&view, [16, 0], 2.0, &centre), [0, 32, 6, 33]);
        // Not at a square, or with too many texels a pixel, or too few.
        for (pixel, step) in [([4, 0], 1.0), ([0, 0], 5.0), ([0, 0], 0.5)] {
            assert_eq!(window(&view, pixel, step, &centre)[3], 0);
        }
    }
}
