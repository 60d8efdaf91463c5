//! Conservative coverage (R8): a pixel is covered as a whole where its square touches the triangle,
//! or lies in it.
//!
//! Edges are evaluated in 64 bits at the corners of blocks, packets and pixels.
//!
//! *Spec* `docs/NUMERICS.md`; `VK_EXT_conservative_rasterization`; a square and a triangle touch
//! unless an edge of the triangle or a side of the square separates them.

use super::{CoverageList, TileShape, rect_mask, standard_positions};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::Triangle;
use crate::layout::morton;
use estampe_simd::{LANE_X, LANE_Y, LANES};
use estampe_types::state::ConservativeMode;

/// The least and the greatest offset of a sample, or of a pixel's square, that coverage looks at,
/// in 1/256 pixel.
pub(crate) fn sample_range(samples: usize, mode: ConservativeMode) -> [i32; 2] {
    if mode != ConservativeMode::Disabled {
        return [0, 256];
    }
    let offsets = standard_positions(samples).as_flattened();
    offsets.iter().fold([256, 0], |[least, most], &offset| {
        [least.min(offset), most.max(offset)]
    })
}

/// One edge: `c + a·x + b·y ≥ 0` is inside, x and y in 1/256 pixel from the tile's corner.
#[derive(Debug, Clone, Copy)]
struct Edge {
    a: i64,
    b: i64,
    c: i64,
    /// The value that each lane of a packet adds to that of the packet's first pixel.
    lanes: [i64; LANES],
}

impl Edge {
    fn new([ax, ay]: [i32; 2], [bx, by]: [i32; 2], tile: TileShape) -> Self {
        let (a, b) = (i64::from(ay - by), i64::from(bx - ax));
        let (x, y) = (i64::from(tile.x * 256 - ax), i64::from(tile.y * 256 - ay));
        let mut lanes = [0; LANES];
        for (lane, (x, y)) in lanes.iter_mut().zip(LANE_X.iter().zip(&LANE_Y)) {
            *lane = 256 * (a * i64::from(*x) + b * i64::from(*y));
        }
        Self {
            a,
            b,
            c: a * x + b * y,
            lanes,
        }
    }

    /// The value at the corner of a pixel of the tile.
    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> i64 {
        self.c + 256 * (self.a * i64::from(x) + self.b * i64::from(y))
    }

    /// The most that the value grows inside a square of `size` pixels.
    #[inline(always)]
    fn growth(&self, size: i64) -> i64 {
        (self.a.max(0) + self.b.max(0)) * 256 * size
    }

    /// The most that it shrinks there, as a negative number.
    #[inline(always)]
    fn shrinkage(&self, size: i64) -> i64 {
        (self.a.min(0) + self.b.min(0)) * 256 * size
    }
}

/// A triangle inside a tile.
#[derive(Debug)]
pub(crate) struct ConservativeTriangle {
    edges: [Edge; 3],
    /// The box in 1/256 pixel of the tile: left, top, right, bottom, all inside.
    bounds: [i32; 4],
    /// The pixels of the tile that may be covered; half-open.
    rect: PixelRect,
    mode: ConservativeMode,
}

impl ConservativeTriangle {
    /// A triangle inside a tile, whose pixels are confined to `rect` (of the tile's own
    /// pixels).
    pub(crate) fn new(
        triangle: &Triangle,
        tile: TileShape,
        rect: &PixelRect,
        mode: ConservativeMode,
    ) -> Self {
        let vertex = |corner: usize| [triangle.x[corner], triangle.y[corner]];
        let corners = [vertex(0), vertex(1), vertex(2)];
        let ends = if triangle.clockwise {
            [(0, 1), (1, 2), (2, 0)]
        } else {
            [(0, 2), (2, 1), (1, 0)]
        };
        let edges = ends.map(|(from, to)| Edge::new(corners[from], corners[to], tile));
        let local = corners.map(|[x, y]| [x - tile.x * 256, y - tile.y * 256]);
        let [a, b, c] = local;
        let least = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
        let most = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
        let bounds = [least(0), least(1), most(0), most(1)];
        // A pixel more on each side: a square is closed.
        let rect = PixelRect {
            x0: ((bounds[0] >> 8) - 1).max(rect.x0),
            y0: ((bounds[1] >> 8) - 1).max(rect.y0),
            x1: ((bounds[2] >> 8) + 2).min(rect.x1),
            y1: ((bounds[3] >> 8) + 2).min(rect.y1),
        };
        Self {
            edges,
            bounds,
            rect,
            mode,
        }
    }

    /// Lists the packets that the triangle covers.
    #[inline(always)]
    pub(crate) fn cover<const N: usize>(&self, out: &mut CoverageList<N>) {
        if self.rect.is_empty() {
            return;
        }
        for block_y in (self.rect.y0 & !15..self.rect.y1).step_by(16) {
            for block_x in (self.rect.x0 & !15..self.rect.x1).step_by(16) {
                if self.misses(block_x, block_y, 16) {
                    continue;
                }
                let (left, right) = (
                    block_x.max(self.rect.x0 & !3),
                    (block_x + 16).min(self.rect.x1),
                );
                let (top, bottom) = (
                    block_y.max(self.rect.y0 & !3),
                    (block_y + 16).min(self.rect.y1),
                );
                for y in (top..bottom).step_by(4) {
                    for x in (left..right).step_by(4) {
                        if !self.misses(x, y, 4) {
                            self.packet([x, y], out);
                        }
                    }
                }
            }
        }
    }

    /// Returns true if a square of pixels lies outside an edge.
    #[inline(always)]
    fn misses(&self, x: i32, y: i32, size: i64) -> bool {
        let outside = |edge: &Edge| edge.at(x, y) + edge.growth(size) < 0;
        self.edges.iter().any(outside)
    }

    #[inline(always)]
    fn packet<const N: usize>(&self, [x, y]: [i32; 2], out: &mut CoverageList<N>) {
        let inside = rect_mask(&self.rect, x, y);
        let covered = match self.mode {
            ConservativeMode::Underestimate => self.lanes_inside([x, y], |edge| edge.shrinkage(1)),
            // Ordinary coverage has code of its own.
            ConservativeMode::Overestimate | ConservativeMode::Disabled => {
                let touched = self.lanes_inside([x, y], |edge| edge.growth(1));
                touched & self.lanes_in_box([x, y])
            }
        };
        if covered & inside != 0 {
            let packet = morton((x >> 2).cast_unsigned(), (y >> 2).cast_unsigned());
            out.push(packet, [covered & inside; N]);
        }
    }

    /// The lanes whose pixels' corners, moved by an offset for each edge, lie inside all edges.
    #[inline(always)]
    fn lanes_inside(&self, [x, y]: [i32; 2], offset: impl Fn(&Edge) -> i64) -> u16 {
        let base = self
            .edges
            .each_ref()
            .map(|edge| edge.at(x, y) + offset(edge));
        let [a, b, c] = &self.edges;
        let mut outside = [0_i64; LANES];
        for (lane, outside) in outside.iter_mut().enumerate() {
            *outside =
                (base[0] + a.lanes[lane]) | (base[1] + b.lanes[lane]) | (base[2] + c.lanes[lane]);
        }
        let mut lanes = 0;
        for (lane, outside) in outside.iter().enumerate() {
            lanes |= u16::from(*outside >= 0) << lane;
        }
        lanes
    }

    /// The lanes whose closed squares touch the triangle's box.
    fn lanes_in_box(&self, [x, y]: [i32; 2]) -> u16 {
        let [left, top, right, bottom] = self.bounds;
        let mut lanes = 0;
        for (lane, (dx, dy)) in LANE_X.iter().zip(&LANE_Y).enumerate() {
            let (x, y) = ((x + i32::from(*dx)) * 256, (y + i32::from(*dy)) * 256);
            let touches = x + 256 >= left && x <= right && y + 256 >= top && y <= bottom;
            lanes |= u16::from(touches) << lane;
        }
        lanes
    }
}
