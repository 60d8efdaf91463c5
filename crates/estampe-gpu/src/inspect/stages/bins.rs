//! Binning: the tiles of a piece, by the rule of the fast pipeline.

use super::pass_stages::StagePiece;
use crate::inspect::PrimitiveKind;
use estampe_reference::PixelBounds;
use estampe_reference::raster::sample_positions;
use std::ops::Range;

/// How the pieces of a draw are binned.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Binning {
    /// Tiles in a row of the target.
    columns: u32,
    /// Side of a tile in pixels.
    side: u32,
    /// The pixels that the draw may write.
    bounds: PixelBounds,
    /// The least and the greatest offset of a sample in its pixel, in 1/256 pixel.
    samples: [i64; 2],
}

/// Side of a tile in pixels.
pub(super) fn tile_side(samples: u32) -> u32 {
    match samples {
        1 | 4 => 64,
        _ => 32,
    }
}

impl Binning {
    pub(super) fn new(
        width: u32,
        samples: u32,
        bounds: PixelBounds,
        is_conservative: bool,
    ) -> Self {
        let side = tile_side(samples);
        let offsets = sample_positions(samples).as_flattened();
        let offset = |sixteenths: Option<&u8>| 16 * i64::from(*sixteenths.unwrap_or(&8));
        Self {
            columns: width.div_ceil(side),
            side,
            bounds,
            samples: if is_conservative {
                // Pixels are covered that the triangle touches at their edges.
                [0, 256]
            } else {
                [offset(offsets.iter().min()), offset(offsets.iter().max())]
            },
        }
    }

    /// Calls `visit` with each tile of a piece.
    pub(super) fn each_tile(&self, piece: &StagePiece, mut visit: impl FnMut(u32)) {
        if piece.is_culled {
            return;
        }
        let corners = piece.vertices.map(|vertex| vertex.position.map(subpixels));
        let [columns, rows] =
            [0, 1].map(|axis| self.range(corners.map(|at| at[axis]), piece.margin, axis));
        let is_box = columns.len() > 1 && rows.len() > 1;
        let edges = (is_box && piece.kind == PrimitiveKind::Triangle).then(|| edges(corners));
        for row in rows {
            for column in columns.clone() {
                let misses = edges.is_some_and(|edges| self.misses(edges, [column, row]));
                if !misses {
                    visit(row * self.columns + column);
                }
            }
        }
    }

    /// The columns (axis 0) or rows of tiles in which the box holds a sample.
    fn range(&self, corners: [i64; 3], margin: f32, axis: usize) -> Range<u32> {
        let bounds = [&self.bounds.x, &self.bounds.y][axis];
        let margin = subpixels(margin);
        let low = corners.into_iter().fold(i64::MAX, i64::min) - margin;
        let high = corners.into_iter().fold(i64::MIN, i64::max) + margin;
        let [least, greatest] = self.samples;
        let first = ((low - greatest + 255) >> 8).max(i64::from(bounds.start));
        let last = ((high - least) >> 8).min(i64::from(bounds.end) - 1);
        let tile = |pixel: i64| u32::try_from(pixel).unwrap_or(0) / self.side;
        if first > last {
            0..0
        } else {
            tile(first)..tile(last) + 1
        }
    }

    /// Returns true if all samples of a tile lie outside of one edge.
    fn misses(&self, edges: [[i64; 3]; 3], tile: [u32; 2]) -> bool {
        let [least, greatest] = self.samples;
        let side = i64::from(self.side);
        let [x, y] = tile.map(|tile| {
            let first = i64::from(tile) * side * 256;
            [first + least, first + (side - 1) * 256 + greatest]
        });
        edges.into_iter().any(|[a, b, c]| {
            let (x, y) = (x[usize::from(a > 0)], y[usize::from(b > 0)]);
            a * x + b * y + c < 0
        })
    }
}

/// The edges of a triangle as a·x + b·y + c, at least 0 inside.
fn edges(corners: [[i64; 2]; 3]) -> [[i64; 3]; 3] {
    let [a, b, c] = corners;
    let edge = |from: [i64; 2], to: [i64; 2]| {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        [-dy, dx, dy * from[0] - dx * from[1]]
    };
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    let [x, y] = c;
    let [p, q, r] = edges[0];
    let is_inside = p * x + q * y + r >= 0;
    edges.map(|edge| edge.map(|part| if is_inside { part } else { -part }))
}

/// Pixels as a whole number of 1/256 pixel: exact for window positions.
#[expect(
    clippy::cast_possible_truncation,
    reason = "window positions are below 2^15 pixels, and margins below 1026"
)]
fn subpixels(pixels: f32) -> i64 {
    (pixels * 256.0) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspect::PieceVertex;
    use estampe_reference::conservative;
    use estampe_reference::raster::{QuadCoverage, triangle};
    use estampe_types::state::ConservativeMode;
    use std::collections::BTreeSet;

    const SIZE: [u32; 2] = [300, 200];

    fn piece(corners: [[i32; 2]; 3], kind: PrimitiveKind) -> StagePiece {
        StagePiece {
            primitive: 0,
            kind,
            vertices: corners.map(|corner| PieceVertex {
                position: corner.map(|subpixels| subpixels as f32 / 256.0),
                depth: 0.5,
                inverse_w: 1.0,
            }),
            front_facing: true,
            is_culled: false,
            margin: 0.0,
        }
    }

    fn tiles(binning: &Binning, piece: &StagePiece) -> BTreeSet<u32> {
        let mut tiles = BTreeSet::new();
        binning.each_tile(piece, |tile| assert!(tiles.insert(tile), "twice"));
        tiles
    }

    /// The tiles with covered samples, by testing each sample.
    fn covered(quads: &[QuadCoverage], side: u32) -> BTreeSet<u32> {
        let columns = SIZE[0].div_ceil(side);
        let pixels = quads.iter().flat_map(|quad| {
            let lanes = (0..4).filter(|&lane| quad.samples[lane] != 0);
            lanes.map(|lane| QuadCoverage::pixel(quad.origin, lane))
        });
        pixels.map(|[x, y]| y / side * columns + x / side).collect()
    }

    #[test]
    fn bins_hold_every_tile_with_a_covered_sample_and_few_others() {
        let mut random = fastrand::Rng::with_seed(1);
        let whole = || PixelBounds {
            x: 0..SIZE[0],
            y: 0..SIZE[1],
        };
        let cut = || PixelBounds {
            x: 37..291,
            y: 5..130,
        };
        let (mut with_samples, mut without, mut in_box) = (0, 0, 0);
        for turn in 0..3000 {
            let samples = [1, 2, 4, 8, 16][turn % 5];
            let bounds = if turn % 3 == 0 { cut() } else { whole() };
            let is_conservative = turn % 7 == 0;
            let reach = [3, 40, 400][turn % 3] * 256;
            let at = [random.i32(-9000..86_000), random.i32(-9000..60_000)];
            let mut corners = [0; 3].map(|_| at.map(|place| place + random.i32(-reach..reach) / 2));
            corners.sort_by_key(|corner| [corner[1], corner[0]]);
            let binning = Binning::new(SIZE[0], samples, bounds.clone(), is_conservative);
            let found = tiles(&binning, &piece(corners, PrimitiveKind::Triangle));
            let quads = if is_conservative {
                let mode = ConservativeMode::Overestimate;
                conservative::triangle(corners, mode, &bounds, samples)
            } else {
                triangle(corners, &bounds, samples)
            };
            let covered = covered(&quads, tile_side(samples));
            assert!(
                covered.is_subset(&found),
                "{corners:?}: {covered:?}, {found:?}"
            );
            with_samples += covered.len();
            without += found.len() - covered.len();
            let as_box = Binning::range;
            let subpixels = corners.map(|corner| corner.map(i64::from));
            let sides = [0, 1].map(|axis| {
                as_box(&binning, subpixels.map(|corner| corner[axis]), 0.0, axis).len()
            });
            in_box += sides[0] * sides[1];
        }
        // The edges leave out most of the tiles of the box that hold nothing.
        assert!(with_samples > 5000, "{with_samples}");
        assert!(without * 5 < in_box - with_samples, "{without} of {in_box}");
    }

    #[test]
    fn culled_pieces_have_no_tiles_and_wide_points_have_those_of_their_square() {
        let whole = PixelBounds {
            x: 0..SIZE[0],
            y: 0..SIZE[1],
        };
        let binning = Binning::new(SIZE[0], 1, whole, false);
        let mut point = piece([[64 * 256; 2]; 3], PrimitiveKind::Point);
        point.margin = 2.0;
        assert_eq!(tiles(&binning, &point), BTreeSet::from([0, 1, 5, 6]));
        // A point of half a pixel to the right of the tile's edge covers no centre to its left.
        point.margin = 0.25;
        assert_eq!(tiles(&binning, &point), BTreeSet::new());
        point.margin = 0.5;
        assert_eq!(tiles(&binning, &point), BTreeSet::from([0, 1, 5, 6]));
        point.is_culled = true;
        assert_eq!(tiles(&binning, &point), BTreeSet::new());
    }
}
