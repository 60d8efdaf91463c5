//! Coverage of a rectangle with level sides in one tile.

use super::TileShape;
use super::coverage::{CoverageList, lanes_of_columns, lanes_of_rows};
use crate::bounds::pixel_rect::PixelRect;
use crate::layout::morton;

/// Pixels of a tile that are a box, at least one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PixelBox(PixelRect);

impl PixelBox {
    /// The pixels whose centres lie in the rectangle between two corners, in 1/256 pixel, or on its
    /// left or upper side, confined to `rect` (of the tile's own pixels); `None` if there are none.
    #[inline(always)]
    pub(crate) fn between(
        [low, high]: [[i32; 2]; 2],
        tile: TileShape,
        rect: &PixelRect,
    ) -> Option<Self> {
        // The first pixel whose centre is at a place in 1/256 pixel, or behind it.
        let first = |at: i32| (at + 127) >> 8;
        let pixels = PixelRect {
            x0: first(low[0]) - tile.x,
            y0: first(low[1]) - tile.y,
            x1: first(high[0]) - tile.x,
            y1: first(high[1]) - tile.y,
        };
        let pixels = pixels.intersection(*rect);
        (!pixels.is_empty()).then_some(Self(pixels))
    }

    /// The first column or row of packets, and the one behind the last, of columns or rows of
    /// pixels.
    #[inline(always)]
    fn packets_of([first, end]: [i32; 2]) -> [i32; 2] {
        [first >> 2, (end + 3) >> 2]
    }

    /// The number of packets that it touches.
    #[inline(always)]
    pub(crate) fn packets(&self) -> i32 {
        let PixelRect { x0, y0, x1, y1 } = self.0;
        let ([left, right], [top, bottom]) =
            (Self::packets_of([x0, x1]), Self::packets_of([y0, y1]));
        (right - left) * (bottom - top)
    }

    /// Lists its packets, leaving out the blocks of `skip`. All samples of a pixel are alike.
    #[inline(always)]
    pub(crate) fn cover<const N: usize>(&self, skip: u16, out: &mut CoverageList<N>) {
        let PixelRect { x0, y0, x1, y1 } = self.0;
        let ([left, right], [top, bottom]) =
            (Self::packets_of([x0, x1]), Self::packets_of([y0, y1]));
        for row in top..bottom {
            let of_row = lanes_of_rows([y0, y1], row * 4);
            for column in left..right {
                let packet = morton(column.cast_unsigned(), row.cast_unsigned());
                if skip >> (packet >> 4) & 1 == 0 {
                    let lanes = of_row & lanes_of_columns([x0, x1], column * 4);
                    out.push(packet, [lanes; N]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::{SampleSet, packet_origin, rect_mask};

    #[test]
    fn a_box_holds_the_pixels_whose_centres_are_inside() {
        let tile = TileShape {
            x: 64,
            y: 128,
            log2: 6,
        };
        let rect = PixelRect {
            x0: 2,
            y0: 0,
            x1: 64,
            y1: 61,
        };
        let mut list = CoverageList::<1>::default();
        list.set_samples(SampleSet::new(1));
        // Sides at centres of pixels: the left and the upper one are inside, the others are not.
        let low = [(64 + 5) * 256 + 128, (128 + 9) * 256 + 128];
        let high = [(64 + 23) * 256 + 128, (128 + 90) * 256];
        let pixels = PixelBox::between([low, high], tile, &rect).expect("it has pixels");
        let expected = PixelRect {
            x0: 5,
            y0: 9,
            x1: 23,
            y1: 61,
        };
        assert_eq!(pixels.0, expected);
        // The first block is left out.
        pixels.cover(1, &mut list);
        let listed: u64 = list.items().iter().map(|item| item.count()).sum();
        assert_eq!(listed, 18 * 52 - 11 * 7);
        assert_eq!(pixels.packets(), 5 * 14);
        for item in list.items() {
            let (x, y) = packet_origin(u32::from(item.packet));
            assert_eq!(item.masks, [rect_mask(&expected, x, y)]);
        }
        let low = [high[0] - 255, low[1]];
        assert!(PixelBox::between([low, high], tile, &rect).is_none());
    }
}
