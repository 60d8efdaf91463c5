//! A tile of the target: its first pixel and its size.

use super::packet_origin;
use crate::bounds::pixel_rect::PixelRect;

/// A tile of the target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileShape {
    /// Left column and top row, in pixels.
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// log₂ of the side: 5 or 6.
    pub(crate) log2: u32,
}

impl TileShape {
    /// Pixels of a side.
    #[inline(always)]
    pub(crate) fn side(self) -> i32 {
        1 << self.log2
    }

    /// A rectangle of the target in the tile's own pixels, cut to the tile.
    #[inline(always)]
    pub(crate) fn local(self, rect: &PixelRect) -> PixelRect {
        let side = self.side();
        PixelRect {
            x0: (rect.x0 - self.x).clamp(0, side),
            y0: (rect.y0 - self.y).clamp(0, side),
            x1: (rect.x1 - self.x).clamp(0, side),
            y1: (rect.y1 - self.y).clamp(0, side),
        }
    }

    /// How many blocks of 16×16 pixels it has.
    #[inline(always)]
    pub(crate) fn blocks(self) -> usize {
        1 << (2 * (self.log2 - 4))
    }

    /// The blocks of 16×16 pixels that have pixels in a rectangle of the tile's own pixels, one bit
    /// each.
    pub(crate) fn blocks_reached(self, local: &PixelRect) -> u16 {
        if self.is_whole(local) {
            return u16::MAX;
        }
        (0u32..).take(self.blocks()).fold(0, |reached, block| {
            let (x, y) = packet_origin(block * 16);
            let is_reached = x < local.x1 && y < local.y1 && local.x0 < x + 16 && local.y0 < y + 16;
            reached | u16::from(is_reached) << block
        })
    }

    /// The blocks of 16×16 pixels that lie in a rectangle of the tile's own pixels, one bit each.
    pub(crate) fn blocks_inside(self, local: &PixelRect) -> u16 {
        (0u32..).take(self.blocks()).fold(0, |inside, block| {
            let (x, y) = packet_origin(block * 16);
            let is_inside =
                local.x0 <= x && local.y0 <= y && x + 16 <= local.x1 && y + 16 <= local.y1;
            inside | u16::from(is_inside) << block
        })
    }

    /// Returns true if a rectangle in the tile's own pixels is the whole tile.
    #[inline(always)]
    pub(crate) fn is_whole(self, local: &PixelRect) -> bool {
        let side = self.side();
        *local
            == PixelRect {
                x0: 0,
                y0: 0,
                x1: side,
                y1: side,
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_reached_hold_pixels_of_the_rectangle() {
        for log2 in [5, 6] {
            let shape = TileShape { x: 64, y: 0, log2 };
            let side = shape.side();
            for (width, height) in [(64, 9), (65, 1), (81, 17), (70, 64), (128, 20), (200, 300)] {
                let target = PixelRect {
                    x0: 0,
                    y0: 0,
                    x1: width,
                    y1: height,
                };
                let reached = shape.blocks_reached(&shape.local(&target));
                for block in (0..16_u32).take(shape.blocks()) {
                    let pixels = (0..16).flat_map(|packet| {
                        let (x, y) = packet_origin(block * 16 + packet);
                        (0..16).map(move |pixel| (x + pixel % 4, y + pixel / 4))
                    });
                    let holds_pixels = pixels.into_iter().any(|(x, y)| {
                        assert!(x < side && y < side);
                        shape.x + x < width && shape.y + y < height
                    });
                    assert_eq!(
                        reached >> block & 1 == 1,
                        holds_pixels,
                        "{width}×{height} {block}"
                    );
                }
            }
        }
    }
}
