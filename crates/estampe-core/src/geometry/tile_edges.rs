//! The edges of a triangle, to tell tiles of its box that it misses.

use crate::bounds::primitives::TrianglePacket;
use estampe_simd::Lane;
use std::ops::Range;

/// The edges of one triangle. Exact in 64 bits.
pub(super) struct TileEdges {
    /// For each edge the values at a point: `a·x + b·y + c`, in 1/256 pixel; inside is ≥ 0.
    edges: [[i64; 3]; 3],
    sample_range: [i32; 2],
}

impl TileEdges {
    pub(super) fn new(packet: &TrianglePacket, lane: Lane, sample_range: [i32; 2]) -> Self {
        let at = |corner: usize| {
            (
                i64::from(lane.of(&packet.x[corner])),
                i64::from(lane.of(&packet.y[corner])),
            )
        };
        let ends = if lane.is_in(packet.clockwise) {
            [(0, 1), (1, 2), (2, 0)]
        } else {
            [(0, 2), (2, 1), (1, 0)]
        };
        let edge = |(from, to)| {
            let ((ax, ay), (bx, by)) = (at(from), at(to));
            [ay - by, bx - ax, (by - ay) * ax - (bx - ax) * ay]
        };
        Self {
            edges: ends.map(edge),
            sample_range,
        }
    }

    /// Returns true if no sample of the tile can be inside the triangle.
    pub(super) fn miss(&self, column: i32, row: i32, tile_log2: u32) -> bool {
        self.edges.iter().any(|[a, b, c]| {
            let x = self.innermost(*a, column, tile_log2);
            let y = self.innermost(*b, row, tile_log2);
            a * x + b * y + c < 0
        })
    }

    /// Those of some columns whose tiles in a row are not [missed](TileEdges::miss): they follow
    /// one another, as those of each edge begin or end somewhere.
    pub(super) fn columns(&self, row: i32, columns: Range<i32>, tile_log2: u32) -> Range<i32> {
        let [mut first, mut end] = [columns.start, columns.end].map(i64::from);
        for [a, b, c] in &self.edges {
            // The edge's value in column 0, and what a column adds to it.
            let value =
                a * self.innermost(*a, 0, tile_log2) + b * self.innermost(*b, row, tile_log2) + c;
            let step = a << (tile_log2 + 8);
            if step > 0 {
                first = first.max(-value.div_euclid(step));
            } else if step < 0 {
                end = end.min(value.div_euclid(-step) + 1);
            } else if value < 0 {
                end = first;
            }
        }
        // What does not fit, or is negative, ends before the first column.
        let inside = |at: i64| i32::try_from(at).unwrap_or(0).max(0);
        inside(first.min(end))..inside(end)
    }

    /// The samples' coordinate in a column or row of tiles where an edge of this slope has its
    /// greatest value.
    fn innermost(&self, slope: i64, tile: i32, tile_log2: u32) -> i64 {
        let [first, last] = self.sample_range;
        i64::from(if slope > 0 {
            ((tile + 1) << (tile_log2 + 8)) - 256 + last
        } else {
            (tile << (tile_log2 + 8)) + first
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of random triangles, some beyond the target, and some with level or upright edges.
    #[test]
    fn columns_of_a_row_are_those_that_are_not_missed() {
        let (mut state, mut missed, mut found) = (3_u32, 0, 0);
        let mut random = |below: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            i32::try_from(state >> 8).unwrap() % below
        };
        for turn in 0..400 {
            let size = [1 << 12, 1 << 16, 1 << 21][turn % 3];
            let mut packet = TrianglePacket::EMPTY;
            let place = [random(1 << 18), random(1 << 18)];
            for corner in 0..3 {
                packet.x[corner][5] = place[0] - size / 2 + random(size);
                packet.y[corner][5] = place[1] - size / 2 + random(size);
            }
            if turn % 4 == 0 {
                packet.x[1][5] = packet.x[0][5];
                packet.y[2][5] = packet.y[0][5];
            }
            // Of either turn: the other's edges leave nothing, or everything outside.
            packet.clockwise = u16::from(random(2) == 0) << 5;
            let edges = TileEdges::new(&packet, Lane::new(5), [32, 224]);
            for tile_log2 in [5, 6] {
                for row in 0..20 {
                    let columns = random(8)..8 + random(20);
                    let hits = |column: &i32| !edges.miss(*column, row, tile_log2);
                    let expected: Vec<i32> = columns.clone().filter(hits).collect();
                    missed += columns.len() - expected.len();
                    found += expected.len();
                    let range = edges.columns(row, columns, tile_log2);
                    assert!(range.clone().eq(expected), "{range:?} of {packet:?}");
                }
            }
        }
        assert!(missed > 10_000 && found > 5_000, "{missed} {found}");
    }
}
