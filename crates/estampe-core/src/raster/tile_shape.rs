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

    /// The blocks of 16×16 pixels that lie in a rectangle of the tile's own pixels, one bit each.
    pub(crate) fn blocks_inside(self, local: &PixelRect) -> u16 {
        let blocks = 1u32 << (2 * (self.log2 - 4));
        (0..blocks).fold(0, |inside, block| {
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
