//! The lanes of a tile's packets that lie in a rectangle of its pixels, by tables: many triangles
//! are clipped to one scissor.

use super::coverage::{lanes_of_columns, lanes_of_rows};
use super::packet_origin;
use crate::bounds::pixel_rect::PixelRect;

/// Columns and rows of packets of the largest tile.
const SIDE: usize = 16;

/// See the head of the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClipMasks {
    rect: PixelRect,
    /// By column and by row of packets: lanes of pixels that lie in the rectangle's columns, and in
    /// its rows.
    columns: [u16; SIDE],
    rows: [u16; SIDE],
}

impl Default for ClipMasks {
    fn default() -> Self {
        Self::new(&PixelRect {
            x0: 0,
            y0: 0,
            x1: 0,
            y1: 0,
        })
    }
}

impl ClipMasks {
    fn new(rect: &PixelRect) -> Self {
        let (mut columns, mut rows) = ([0; SIDE], [0; SIDE]);
        for ((column, row), at) in columns.iter_mut().zip(&mut rows).zip((0..).step_by(4)) {
            *column = lanes_of_columns([rect.x0, rect.x1], at);
            *row = lanes_of_rows([rect.y0, rect.y1], at);
        }
        Self {
            rect: *rect,
            columns,
            rows,
        }
    }

    /// The tables of a rectangle, made anew if those at hand are another's.
    #[inline(always)]
    pub(crate) fn of(&mut self, rect: &PixelRect) -> &Self {
        if self.rect != *rect {
            *self = Self::new(rect);
        }
        self
    }

    /// The lanes of a packet that lie in the rectangle.
    #[inline(always)]
    pub(super) fn of_packet(&self, packet: u16) -> u16 {
        let (x, y) = packet_origin(u32::from(packet));
        let at = |first: i32| (first >> 2).cast_unsigned() as usize % SIDE;
        self.columns[at(x)] & self.rows[at(y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::{CoverageList, Covered, MAX_PACKETS, SampleSet, rect_mask};

    #[test]
    fn lists_are_clipped_to_one_rectangle_after_the_other() {
        let rects = [
            [5, 9, 40, 61],
            [0, 0, 64, 1],
            [5, 9, 40, 61],
            [63, 2, 64, 64],
        ];
        let (mut list, mut masks) = (CoverageList::<1>::default(), ClipMasks::default());
        for [x0, y0, x1, y1] in rects {
            let rect = PixelRect { x0, y0, x1, y1 };
            list.set_samples(SampleSet::new(1));
            for (packet, _) in (0..).zip(0..MAX_PACKETS) {
                list.push(packet, [u16::MAX]);
            }
            list.clip_to(masks.of(&rect));
            for item in list.items() {
                let (x, y) = packet_origin(u32::from(item.packet));
                assert_eq!(item.masks, [rect_mask(&rect, x, y)], "{rect:?}, {item:?}");
            }
            let pixels: u64 = list.items().iter().map(Covered::count).sum();
            let expected = (x1 - x0) * (y1 - y0);
            assert_eq!(pixels, u64::from(expected.cast_unsigned()), "{rect:?}");
        }
    }
}
