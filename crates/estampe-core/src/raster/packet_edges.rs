//! Edges of a packet's triangles in a tile, sixteen triangles at a time.
//!
//! [`TileTriangle::new`] is 64-bit arithmetic for one triangle. Here the lanes of a packet are set
//! up together in 32 bits, exactly: a constant c = ⌊(a·x + b·y + bias) / 256⌋ is, with x and y
//! divided into pixels and 1/256 pixels,
//!
//! ```text
//!     c = a·x_pixels + b·y_pixels + ⌊(a·x_rest + b·y_rest + bias) / 256⌋     modulo 2³²
//! ```
//!
//! Triangles have fewer than 8192 pixels in a row, so that |a| and |b| are below 2²¹, the sum
//! behind the division below 2³⁰, and an edge that crosses a tile has |c| < 126·2²¹ < 2²⁸ there.
//! The sum in f32 is wrong by less than 2¹⁶ of 2³⁸; where it is below 2²⁹ the true c fits 32 bits
//! and is the one that was computed, and elsewhere its sign tells on which side of the edge all of
//! the tile is.

use super::edge_lanes::{Corners, EdgeFrom, edges};
use super::triangle::{Edge, TileTriangle};
use super::{SampleSet, TileShape};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::TrianglePacket;
use estampe_simd::{LANES, Lane, Lanes, Select, SimdBase, SimdCvtFloat, f32x16, i32x16};

/// A triangle's extent in 1/256 pixel is below this.
const EXTENT: i32 = 1 << 21;
/// An edge whose constant is not below this, or its negative, does not cross the tile.
const CROSSES: f32 = (1 << 29) as f32;

/// The edges of those triangles of a packet that were set up.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct PacketEdges<const N: usize> {
    /// By edge and lane.
    a: [[i32; LANES]; 3],
    b: [[i32; LANES]; 3],
    c: [[[i32; LANES]; N]; 3],
    /// Columns and rows of packets that the box touches, half-open, by lane.
    columns: [[i32; LANES]; 2],
    rows: [[i32; LANES]; 2],
    /// The lanes that were set up.
    lanes: u16,
    /// Those of them whose box lies in the tile.
    touching: u16,
}

impl<const N: usize> Default for PacketEdges<N> {
    fn default() -> Self {
        Self {
            a: [[0; LANES]; 3],
            b: [[0; LANES]; 3],
            c: [[[0; LANES]; N]; 3],
            columns: [[0; LANES]; 2],
            rows: [[0; LANES]; 2],
            lanes: 0,
            touching: 0,
        }
    }
}

impl<const N: usize> PacketEdges<N> {
    /// Forgets all edges.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.lanes = 0;
    }

    /// Sets up those triangles in `lanes` that fit. Returns which those are.
    #[inline(always)]
    pub(crate) fn set_up<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        (tile, rect): (TileShape, &PixelRect),
        samples: SampleSet<N>,
    ) -> u16 {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let corners = Corners::new(s, packet);
        let ([x_min, x_max], y) = (corners.x_ends, corners.y);
        let extent = (x_max - x_min).max(y[2] - y[0]);
        self.lanes = s.bits_of_mask(extent.simd_lt(splat(EXTENT))) & lanes;
        if self.lanes == 0 {
            return 0;
        }
        // The box in the tile's own pixels; a pixel more on each side does no harm.
        let (tile_x, tile_y) = (splat(tile.x), splat(tile.y));
        let left = ((x_min >> 8) - tile_x).max(splat(rect.x0));
        let right = ((x_max >> 8) - tile_x).min(splat(rect.x1 - 1));
        let top = ((y[0] >> 8) - tile_y).max(splat(rect.y0));
        let bottom = ((y[2] >> 8) - tile_y).min(splat(rect.y1 - 1));
        self.touching = s.bits_of_mask(left.simd_le(right) & top.simd_le(bottom));
        (left >> 2).store_array(&mut self.columns[0]);
        ((right >> 2) + 1).store_array(&mut self.columns[1]);
        (top >> 2).store_array(&mut self.rows[0]);
        ((bottom >> 2) + 1).store_array(&mut self.rows[1]);

        let corner = [splat(tile.x << 8), splat(tile.y << 8)];
        let positions = samples.subpixels();
        for (number, edge) in edges(s, packet, &corners, corner).into_iter().enumerate() {
            let EdgeFrom { a, b, way, bias } = edge;
            let pixels = [way[0] >> 8, way[1] >> 8];
            let rest = [way[0] & splat(255), way[1] & splat(255)];
            let whole = a * pixels[0] + b * pixels[1];
            let part = a * rest[0] + b * rest[1] + bias;
            let about = f32x16::float_from(a) * f32x16::float_from(pixels[0])
                + f32x16::float_from(b) * f32x16::float_from(pixels[1]);
            let limit = <f32x16<S> as SimdBase<S>>::splat(s, CROSSES);
            self.touching &= !s.bits_of_mask((about + limit).simd_le(0.0));
            // An edge that does not cross the tile is always inside.
            let is_inside = about.simd_ge(limit);
            is_inside
                .select(splat(0), a)
                .store_array(&mut self.a[number]);
            is_inside
                .select(splat(0), b)
                .store_array(&mut self.b[number]);
            for (c, [sx, sy]) in self.c[number].iter_mut().zip(positions) {
                let at_sample = whole + ((part + (a * sx + b * sy)) >> 8);
                is_inside.select(splat(0), at_sample).store_array(c);
            }
        }
        self.lanes
    }

    /// A lane's triangle, if it was set up; inside, `None` when it covers nothing of the tile.
    #[inline(always)]
    pub(crate) fn triangle(&self, lane: Lane) -> Option<Option<TileTriangle<N>>> {
        if self.lanes & lane.bit() == 0 {
            return None;
        }
        if self.touching & lane.bit() == 0 {
            return Some(None);
        }
        let edge = |number: usize| {
            let mut c = [0; N];
            for (c, lanes) in c.iter_mut().zip(&self.c[number]) {
                *c = lane.of(lanes);
            }
            Edge {
                a: lane.of(&self.a[number]),
                b: lane.of(&self.b[number]),
                c,
            }
        };
        let range = |ends: &[[i32; LANES]; 2]| [lane.of(&ends[0]), lane.of(&ends[1])];
        Some(Some(TileTriangle {
            edges: [edge(0), edge(1), edge(2)],
            columns: range(&self.columns),
            rows: range(&self.rows),
            // Not asked on the visibility path.
            is_inside: false,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::{CoverageList, Covered};
    use estampe_simd::{Level, dispatch};

    const TILE: TileShape = TileShape {
        x: 64,
        y: 32,
        log2: 5,
    };

    /// Sixteen triangles around the tile, three of four of which are small enough; returns those
    /// that have an area.
    fn packet(random: &mut impl FnMut(i32) -> i32) -> (TrianglePacket, u16) {
        let mut packet = TrianglePacket::EMPTY;
        for lane in 0..LANES {
            let extent = [600, 16_000, 400_000, 3_000_000][lane % 4];
            // Every other one on a coarse grid, so that samples lie on edges.
            let grid = if lane % 8 < 4 { 1 } else { 32 };
            let first = [
                64 * 256 - 2000 + random(12_000),
                32 * 256 - 2000 + random(12_000),
            ];
            let mut corners =
                [0; 3].map(|_| first.map(|at| (at + random(extent) - extent / 2) / grid * grid));
            corners.sort_by_key(|[x, y]| (*y, *x));
            let [[ax, ay], [bx, by], [cx, cy]] = corners.map(|corner| corner.map(i64::from));
            let area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
            packet.len |= u16::from(area != 0) << lane;
            packet.clockwise |= u16::from(area > 0) << lane;
            for (corner, [x, y]) in corners.into_iter().enumerate() {
                (packet.x[corner][lane], packet.y[corner][lane]) = (x, y);
            }
        }
        let live = packet.len;
        (packet, live)
    }

    fn covered<const N: usize>(
        level: Level,
        triangle: Option<&TileTriangle<N>>,
    ) -> Vec<Covered<N>> {
        let mut list = CoverageList::default();
        if let Some(triangle) = triangle {
            let whole = dispatch!(level, s => triangle.cover(s, TILE, 0, 0, &mut list));
            assert_eq!(whole, 0, "no block was offered");
        }
        list.sort();
        list.items().to_vec()
    }

    fn compare<const N: usize>() {
        let mut state = 7u32;
        let mut random = |below: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            i32::try_from(state >> 8).unwrap_or_default() % below
        };
        let samples = SampleSet::<N>::new(N);
        let rect = PixelRect {
            x0: 0,
            y0: 3,
            x1: 32,
            y1: 32,
        };
        let (mut set_up, mut drawn) = (0, 0);
        for _ in 0..100 {
            let (packet, live) = packet(&mut random);
            for level in Level::all_available() {
                let mut edges = PacketEdges::<N>::default();
                let lanes =
                    dispatch!(level, s => edges.set_up(s, &packet, live, (TILE, &rect), samples));
                assert_eq!(lanes & !live, 0);
                set_up += lanes.count_ones();
                for lane in Lane::all_of(live) {
                    let one = packet.triangle(lane.get());
                    let one = TileTriangle::<N>::new(&one, TILE, &rect, samples);
                    let one = covered(level, one.as_ref());
                    match edges.triangle(lane) {
                        Some(together) => {
                            assert_eq!(covered(level, together.as_ref()), one);
                            drawn += usize::from(!one.is_empty());
                        }
                        None => assert_eq!(lanes & lane.bit(), 0),
                    }
                }
            }
        }
        assert!(set_up > 1000 && drawn > 500, "{set_up} {drawn}");
    }

    #[test]
    fn sixteen_triangles_cover_what_each_covers() {
        compare::<1>();
        compare::<4>();
    }
}
