//! Rasterization (R1, R3, R4, R6): which samples of a tile a primitive covers.
//!
//! *In* set-up primitives · *Out* [`CoverageList`]s · *Space* window, tile by tile · *Precision* exact
//! integers · *Spec* Pineda, A Parallel Algorithm for Polygon Rasterization, 1988; Olano and Greer 1997
//! for evaluating edges in blocks; `docs/NUMERICS.md` for the fill rule.
//!
//! A tile's 64×64 pixels are 16 blocks of 16×16, each 16 packets of 4×4, each 16 pixels, and at every
//! level the sixteen lie in the same Morton order. So one 16-lane operation evaluates an edge on a whole
//! level, and the sign bits are the answer:
//!
//! ```text
//!     64×64 ──▶ 16 blocks ──▶ 16 packets ──▶ 16 pixels        E = c + a·x + b·y ≥ 0 is inside
//!     reject: E at the block's best corner is negative;   accept: E at its worst corner is not
//! ```

pub(crate) mod triangle;

pub(crate) mod small;

pub(crate) mod line;

pub(crate) mod point;

pub(crate) mod general;

use crate::geometry::viewport::PixelRect;
use estampe_simd::LANES;

/// Offsets of the samples inside their pixel, in 1/256 pixel: the standard positions of Vulkan.
const SAMPLES_1: [[i32; 2]; 1] = [[128, 128]];
const SAMPLES_2: [[i32; 2]; 2] = [[192, 192], [64, 64]];
const SAMPLES_4: [[i32; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
const SAMPLES_8: [[i32; 2]; 8] = [
    [144, 80],
    [112, 176],
    [208, 144],
    [80, 48],
    [48, 208],
    [16, 112],
    [176, 240],
    [240, 16],
];
const SAMPLES_16: [[i32; 2]; 16] = [
    [144, 144],
    [112, 80],
    [80, 160],
    [192, 112],
    [48, 96],
    [160, 208],
    [208, 176],
    [176, 48],
    [96, 224],
    [128, 16],
    [64, 32],
    [32, 192],
    [0, 128],
    [240, 64],
    [224, 240],
    [16, 0],
];

/// The sample positions of `N` samples: 1, 2, 4, 8 or 16.
#[inline(always)]
pub(crate) fn sample_positions<const N: usize>() -> [[i32; 2]; N] {
    let mut positions = [[128; 2]; N];
    let standard: &[[i32; 2]] = match N {
        2 => &SAMPLES_2,
        4 => &SAMPLES_4,
        8 => &SAMPLES_8,
        16 => &SAMPLES_16,
        _ => &SAMPLES_1,
    };
    for (position, standard) in positions.iter_mut().zip(standard) {
        *position = *standard;
    }
    positions
}

/// Packets of the largest tile.
pub(crate) const MAX_PACKETS: usize = 256;

/// A packet of a tile and which of its samples are covered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Covered<const N: usize> {
    /// Number of the packet in the tile, in Morton order.
    pub(crate) packet: u16,
    /// By sample: bit `i` is lane `i`.
    pub(crate) masks: [u16; N],
}

impl<const N: usize> Covered<N> {
    /// The lanes of which any sample is covered.
    #[inline(always)]
    pub(crate) fn any(&self) -> u16 {
        self.masks.iter().fold(0, |all, mask| all | mask)
    }
}

/// What one primitive covers of a tile; each packet at most once.
#[derive(Debug, Clone)]
pub(crate) struct CoverageList<const N: usize> {
    items: [Covered<N>; MAX_PACKETS],
    len: usize,
}

impl<const N: usize> Default for CoverageList<N> {
    fn default() -> Self {
        Self {
            items: [Covered {
                packet: 0,
                masks: [0; N],
            }; MAX_PACKETS],
            len: 0,
        }
    }
}

impl<const N: usize> CoverageList<N> {
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, packet: u32, masks: [u16; N]) {
        // A tile has at most 256 packets and each comes once, so the index never wraps.
        let packet = (packet & 0xFF) as u16;
        self.items[self.len % MAX_PACKETS] = Covered { packet, masks };
        self.len += 1;
    }

    #[inline(always)]
    pub(crate) fn items(&self) -> &[Covered<N>] {
        &self.items[..self.len.min(MAX_PACKETS)]
    }

    /// Replaces each item by what `change` makes of it, and drops those that are left empty.
    #[inline(always)]
    pub(crate) fn retain(&mut self, mut change: impl FnMut(&mut Covered<N>)) {
        let mut kept = 0;
        for at in 0..self.len.min(MAX_PACKETS) {
            let mut item = self.items[at];
            change(&mut item);
            self.items[kept] = item;
            kept += usize::from(item.any() != 0);
        }
        self.len = kept;
    }

    /// Confines the list to a rectangle of the tile's pixels.
    pub(crate) fn confine(&mut self, rect: &PixelRect) {
        self.retain(|item| {
            let (x, y) = packet_origin(u32::from(item.packet));
            let inside = rect_mask(rect, x, y);
            item.masks.iter_mut().for_each(|mask| *mask &= inside);
        });
    }
}

/// The pixel at which a packet of a tile begins.
#[inline(always)]
pub(crate) fn packet_origin(packet: u32) -> (i32, i32) {
    // Every other bit of the number, four pixels apart.
    let gather = |v: u32| {
        let v = v & 0x55;
        let v = (v | v >> 1) & 0x33;
        ((v | v >> 2) & 0x0F).cast_signed() * 4
    };
    (gather(packet), gather(packet >> 1))
}

/// The lanes of the packet at (x, y) that lie in a rectangle of the tile's pixels.
#[inline(always)]
pub(crate) fn rect_mask(rect: &PixelRect, x: i32, y: i32) -> u16 {
    /// Lanes whose column (row) is at least 0, 1, 2, 3, 4.
    const COLUMNS_FROM: [u16; 5] = lanes_from(&estampe_simd::LANE_X);
    const ROWS_FROM: [u16; 5] = lanes_from(&estampe_simd::LANE_Y);
    let at = |edge: i32, origin: i32| (edge - origin).clamp(0, 4) as usize;
    COLUMNS_FROM[at(rect.x0, x)]
        & !COLUMNS_FROM[at(rect.x1, x)]
        & ROWS_FROM[at(rect.y0, y)]
        & !ROWS_FROM[at(rect.y1, y)]
}

const fn lanes_from(coordinate: &[u8; LANES]) -> [u16; 5] {
    let mut masks = [0; 5];
    let mut from = 0;
    while from < 5 {
        let mut lane = 0;
        while lane < LANES {
            if coordinate[lane] as usize >= from {
                masks[from] |= 1 << lane;
            }
            lane += 1;
        }
        from += 1;
    }
    masks
}

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

    /// Whether a rectangle in the tile's own pixels is all of it.
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
    use crate::layout::TileGrid;

    #[test]
    fn packets_are_numbered_as_they_are_stored() {
        let grid = TileGrid::new(64, 64, 1);
        for packet in 0..256 {
            let (x, y) = packet_origin(packet);
            assert_eq!(
                grid.packet_of(x.cast_unsigned(), y.cast_unsigned()),
                packet as usize
            );
        }
    }

    #[test]
    fn a_rectangle_confines_lane_by_lane() {
        let rect = PixelRect {
            x0: 1,
            y0: 2,
            x1: 7,
            y1: 5,
        };
        for (x, y) in [(0, 0), (4, 0), (0, 4), (4, 4), (8, 0)] {
            let mask = rect_mask(&rect, x, y);
            for lane in 0..LANES {
                let (px, py) = (
                    x + i32::from(estampe_simd::LANE_X[lane]),
                    y + i32::from(estampe_simd::LANE_Y[lane]),
                );
                let inside = (1..7).contains(&px) && (2..5).contains(&py);
                assert_eq!(mask >> lane & 1 == 1, inside, "pixel ({px}, {py})");
            }
        }
    }
}
