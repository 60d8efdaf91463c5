//! Coverage of a convex polygon that triangles make which share sides: the fan of a rounded panel.
//!
//! The fill rule gives each sample to at most one of triangles that share sides, and to one of them
//! exactly if the sample is in their polygon. So the polygon is covered in place of its triangles:
//! thin ones cross many packets, which are covered again and again, and most of the polygon's
//! packets are crossed by no side of it.
//!
//! A triangle that has a side in common with a convex polygon makes a greater one that is convex,
//! too, if the angles at the ends of that side stay within 180°:
//!
//! ```text
//!       before ── from          The corner `third` comes between `from` and `to`: right turns (y
//!        │          │  ╲        points down) at `from`, and at `to`.
//!        │          │   third
//!        │          │  ╱
//!       after ─── to
//! ```
//!
//! As in the [walk](super::walk), sides are evaluated at blocks, packets and pixels, sixteen at a
//! time; at the packets of a block, and the pixels of a packet, only those that cross it.

use super::triangle::Edge;
use super::{CoverageList, Covered, TileShape, packet_origin, rect_mask};
use crate::bounds::pixel_rect::PixelRect;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, SimdBase, i32x16};

/// The most corners.
const MOST: usize = 32;

/// A convex polygon, and memory for its coverage in a tile.
#[derive(Debug)]
pub(crate) struct ConvexPolygon<const N: usize> {
    /// Clockwise in a window with y down, in 1/256 pixel.
    corners: [[i32; 2]; MOST],
    len: usize,
    /// The corner that was added last: of a fan or a strip, the next triangle shares one of its
    /// sides.
    last: usize,
    sides: [Side<N>; MOST],
}

/// A side in a tile.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct Side<const N: usize> {
    /// `a·column + b·row` of each lane, one pixel apart.
    steps: [i32; LANES],
    /// Of the block at hand: the edge's values at its packets' first pixels, without a constant.
    packets: [i32; LANES],
    edge: Edge<N>,
    /// The blocks of the tile that it crosses, one bit each.
    blocks: u16,
    /// The packets of the block at hand that it crosses.
    crossed: u16,
}

impl<const N: usize> Default for ConvexPolygon<N> {
    fn default() -> Self {
        let side = Side {
            steps: [0; LANES],
            packets: [0; LANES],
            edge: Edge {
                a: 0,
                b: 0,
                c: [0; N],
            },
            blocks: 0,
            crossed: 0,
        };
        Self {
            corners: [[0; 2]; MOST],
            len: 0,
            last: 0,
            sides: [side; MOST],
        }
    }
}

impl<const N: usize> ConvexPolygon<N> {
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Begins with a triangle, whose corners are clockwise.
    #[inline(always)]
    pub(crate) fn begin(&mut self, triangle: [[i32; 2]; 3]) {
        self.corners[..3].copy_from_slice(&triangle);
        (self.len, self.last) = (3, 0);
    }

    #[inline(always)]
    fn next(&self, corner: usize) -> usize {
        if corner + 1 < self.len { corner + 1 } else { 0 }
    }

    #[inline(always)]
    fn previous(&self, corner: usize) -> usize {
        corner.checked_sub(1).unwrap_or(self.len.saturating_sub(1))
    }

    /// Adds a triangle, whose corners are clockwise, if it shares a side of the corner that was
    /// added last, or any of a triangle, and the polygon stays convex; otherwise returns false.
    #[inline(always)]
    pub(crate) fn add(&mut self, triangle: [[i32; 2]; 3]) -> bool {
        if self.len < 3 || self.len == MOST {
            return false;
        }
        let mut at = self.last;
        for _ in 0..if self.len == 3 { 3 } else { 2 } {
            let (from, to) = (self.corners[at], self.corners[self.next(at)]);
            // The triangle has the side in the other direction.
            let [a, b, c] = triangle;
            let third = match (to, from) {
                side if side == (a, b) => Some(c),
                side if side == (b, c) => Some(a),
                side if side == (c, a) => Some(b),
                _ => None,
            };
            if let Some(third) = third {
                return self.insert(at, third);
            }
            at = self.previous(at);
        }
        false
    }

    /// Adds a corner outside of the side from corner `at` to the next one.
    #[inline(always)]
    fn insert(&mut self, at: usize, third: [i32; 2]) -> bool {
        let end = self.next(at);
        let (from, to) = (self.corners[at], self.corners[end]);
        let before = self.corners[self.previous(at)];
        let after = self.corners[self.next(end)];
        if !turns_right(before, from, third) || !turns_right(third, to, after) {
            return false;
        }
        self.corners.copy_within(at + 1..self.len, at + 2);
        self.corners[at + 1] = third;
        self.last = at + 1;
        self.len += 1;
        true
    }

    /// Lists the packets of a tile that it covers. Pixels outside of `rect` (of the tile's own
    /// pixels) may be among them if the result is true.
    #[inline(always)]
    pub(crate) fn cover<S: Lanes>(
        &mut self,
        s: S,
        tile: TileShape,
        rect: &PixelRect,
        out: &mut CoverageList<N>,
    ) -> bool {
        let (mut low, mut high) = (self.corners[0], self.corners[0]);
        for [x, y] in &self.corners[..self.len] {
            low = [low[0].min(*x), low[1].min(*y)];
            high = [high[0].max(*x), high[1].max(*y)];
        }
        // A pixel more on each side does no harm.
        let bounds = PixelRect {
            x0: (low[0] >> 8) - tile.x,
            y0: (low[1] >> 8) - tile.y,
            x1: (high[0] >> 8) - tile.x + 1,
            y1: (high[1] >> 8) - tile.y + 1,
        };
        let pixels = bounds.intersection(*rect);
        if pixels.is_empty() {
            return false;
        }
        let blocks = PixelRect {
            x0: pixels.x0 >> 4,
            y0: pixels.y0 >> 4,
            x1: (pixels.x1 + 15) >> 4,
            y1: (pixels.y1 + 15) >> 4,
        };
        let Some((sides, mut live)) = self.set_sides(s, tile, out) else {
            return false;
        };
        live &= rect_mask(&blocks, 0, 0);
        while live != 0 {
            let block = live.trailing_zeros() as usize % LANES;
            live &= live - 1;
            cover_block(s, &mut self.sides[..sides.min(MOST)], block, out);
        }
        pixels != bounds
    }

    /// Sets the sides that cross the tile. Gives their number, and the blocks that hold covered
    /// samples, perhaps; `None` if there are none in the tile.
    #[inline(always)]
    fn set_sides<S: Lanes>(
        &mut self,
        s: S,
        tile: TileShape,
        out: &CoverageList<N>,
    ) -> Option<(usize, u16)> {
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        let mut lane = 0;
        while lane < LANES {
            (x[lane], y[lane]) = (i32::from(LANE_X[lane]), i32::from(LANE_Y[lane]));
            lane += 1;
        }
        let (x, y) = (i32x16::load_array(s, x), i32x16::load_array(s, y));
        let (mut count, mut live) = (0, u16::MAX);
        for corner in 0..self.len {
            let ends = [self.corners[corner], self.corners[self.next(corner)]];
            let edge = Edge::new(ends[0], ends[1], tile, out.samples())?;
            if [edge.a, edge.b] == [0; 2] {
                continue;
            }
            let steps = x * splat(s, edge.a) + y * splat(s, edge.b);
            let [best, worst] = edge.extremes(16);
            let blocks = steps << 4;
            live &= !s.sign_bits(blocks + splat(s, best));
            let side = &mut self.sides[count];
            side.blocks = s.sign_bits(blocks + splat(s, worst));
            steps.store_array(&mut side.steps);
            side.edge = edge;
            count += 1;
        }
        (live != 0).then_some((count, live))
    }
}

/// Lists the packets of a block of the tile that are inside of all sides.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
fn cover_block<S: Lanes, const N: usize>(
    s: S,
    sides: &mut [Side<N>],
    block: usize,
    out: &mut CoverageList<N>,
) {
    let (x, y) = packet_origin((block * LANES) as u32);
    let whole = out.samples().whole();
    let (mut alive, mut crossed) = (u16::MAX, 0);
    for side in sides.iter_mut() {
        side.crossed = 0;
        if side.blocks >> block & 1 == 0 {
            continue;
        }
        let Edge { a, b, .. } = side.edge;
        let packets = i32x16::load_array_ref(s, &side.steps) << 2;
        let packets = packets + splat(s, a * x + b * y);
        packets.store_array(&mut side.packets);
        let [best, worst] = side.edge.extremes(4);
        alive &= !s.sign_bits(packets + splat(s, best));
        side.crossed = s.sign_bits(packets + splat(s, worst));
        crossed |= side.crossed;
    }
    let mut masks = [whole; LANES];
    if crossed != 0 {
        for side in sides.iter() {
            let steps = i32x16::load_array_ref(s, &side.steps);
            let mut packets = side.crossed & alive;
            while packets != 0 {
                let packet = packets.trailing_zeros() as usize % LANES;
                packets &= packets - 1;
                let samples = masks[packet].iter_mut().zip(side.edge.c);
                for (mask, c) in samples.take(out.samples().count()) {
                    *mask &= !s.sign_bits(steps + splat(s, side.packets[packet] + c));
                }
            }
        }
    }
    while alive != 0 {
        let packet = alive.trailing_zeros() as usize % LANES;
        alive &= alive - 1;
        out.push_covered(Covered {
            packet: (block * LANES + packet) as u16,
            masks: masks[packet],
        });
    }
}

/// Returns true if the way over three corners turns to the right, or goes straight on.
#[inline(always)]
fn turns_right([ax, ay]: [i32; 2], [bx, by]: [i32; 2], [cx, cy]: [i32; 2]) -> bool {
    // Differences are below 2²⁴.
    let [along_x, along_y] = [bx - ax, by - ay].map(i64::from);
    let [to_x, to_y] = [cx - ax, cy - ay].map(i64::from);
    along_x * to_y - along_y * to_x >= 0
}

#[inline(always)]
fn splat<S: Lanes>(s: S, value: i32) -> i32x16<S> {
    SimdBase::splat(s, value)
}

#[cfg(test)]
mod tests;
