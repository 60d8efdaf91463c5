//! Conservative coverage, compared with another intersection test of square and triangle.

use super::*;
use crate::conservative;
use crate::raster::{QuadCoverage, triangle};
use crate::viewport::PixelBounds;
use ConservativeMode as M;

type Point = [i64; 2];

fn cross([ax, ay]: Point, [bx, by]: Point, [px, py]: Point) -> i64 {
    (bx - ax) * (py - ay) - (by - ay) * (px - ax)
}

/// Returns true if two closed segments have a point in common.
fn segments_meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let lies_on = |p: Point, a: Point, b: Point| {
        cross(a, b, p) == 0 && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
    };
    let sides = |a, b, p, q| cross(a, b, p).signum() * cross(a, b, q).signum();
    sides(a, b, c, d) < 0 && sides(c, d, a, b) < 0
        || lies_on(a, c, d)
        || lies_on(b, c, d)
        || lies_on(c, a, b)
        || lies_on(d, a, b)
}

/// Returns true if a square and a triangle have a point in common: a corner of one lies in the
/// other, or their borders cross.
fn meet(corners: [Point; 3], square: [Point; 4]) -> bool {
    let sides_of = |p: Point| {
        let [a, b, c] = corners;
        [cross(a, b, p), cross(b, c, p), cross(c, a, p)]
    };
    let in_triangle = |p: &Point| {
        let sides = sides_of(*p);
        sides.iter().all(|&side| side >= 0) || sides.iter().all(|&side| side <= 0)
    };
    let in_square = |p: &Point| (0..2).all(|k| square[0][k] <= p[k] && p[k] <= square[3][k]);
    let [p, q, r, s] = square;
    let borders = [[p, q], [q, s], [s, r], [r, p]];
    let [a, b, c] = corners;
    square.iter().any(in_triangle)
        || corners.iter().any(in_square)
        || [[a, b], [b, c], [c, a]]
            .iter()
            .any(|edge| borders.iter().any(|border| segments_meet(*edge, *border)))
}

fn covered(quads: &[QuadCoverage]) -> Vec<[u32; 2]> {
    let lanes = |quad: &QuadCoverage| {
        let (origin, samples) = (quad.origin, quad.samples);
        (0..4)
            .filter(move |&lane| samples[lane] != 0)
            .map(move |lane| QuadCoverage::pixel(origin, lane))
    };
    let mut pixels: Vec<_> = quads.iter().flat_map(lanes).collect();
    pixels.sort_unstable();
    pixels
}

/// Rows: R8.
#[test]
fn touched_and_filled_pixels_are_those_of_another_method() {
    let bounds = PixelBounds { x: 1..13, y: 0..12 };
    let mut random = Random::new(91);
    let mut counts = [0; 3];
    for round in 0..1500 {
        let (step, reach) = (
            [1, 256, 128, 64][round % 4],
            [3000_i32, 600, 30_000][round % 3],
        );
        let corners = [0; 3].map(|_| {
            [0; 2].map(|_| {
                let at = 1500 - reach / 2 + random.below(reach.cast_unsigned()).cast_signed();
                at.div_euclid(step) * step
            })
        });
        let [over, under] = [M::Overestimate, M::Underestimate]
            .map(|mode| covered(&conservative::triangle(corners, mode, &bounds, 4)));
        if crate::cull::doubled_area(corners) == 0 {
            assert!(over.is_empty() && under.is_empty());
            continue;
        }
        let wide = corners.map(|corner: [i32; 2]| corner.map(i64::from));
        let mut wanted = Vec::new();
        for x in bounds.x.clone() {
            for y in bounds.y.clone() {
                let [left, top] = [x, y].map(|at| i64::from(at) * 256);
                let square = [
                    [left, top],
                    [left + 256, top],
                    [left, top + 256],
                    [left + 256, top + 256],
                ];
                if meet(wide, square) {
                    wanted.push([x, y]);
                }
            }
        }
        assert_eq!(over, wanted, "{corners:?}");
        // Filled pixels are covered, and covered pixels are touched.
        let at_centres = covered(&triangle(corners, &bounds, 1));
        let strict = covered(&triangle(corners, &bounds, 16));
        assert!(
            under.iter().all(|pixel| at_centres.contains(pixel)),
            "{corners:?}"
        );
        assert!(
            strict.iter().all(|pixel| over.contains(pixel)),
            "{corners:?}"
        );
        for (count, pixels) in counts.iter_mut().zip([&over, &at_centres, &under]) {
            *count += pixels.len();
        }
    }
    assert!(
        counts[0] > counts[1] && counts[1] > counts[2] && counts[2] > 1000,
        "{counts:?}"
    );
}

/// Rows: R8.
#[test]
fn a_corner_that_is_touched_counts_and_every_sample_is_covered() {
    let bounds = PixelBounds { x: 0..8, y: 0..8 };
    // From (1, 1) to (3, 1) and (1, 3) in pixels.
    let corners = [[256, 256], [768, 256], [256, 768]];
    let over = conservative::triangle(corners, M::Overestimate, &bounds, 16);
    let rows = covered(&over);
    let in_row = |y: u32| rows.iter().filter(|pixel| pixel[1] == y).count();
    // The corner (3, 1) touches pixels up to column 3 in rows 0 and 1; the long side passes through
    // (2, 2).
    assert_eq!([0, 1, 2, 3, 4].map(in_row), [4, 4, 3, 2, 0]);
    assert!(
        over.iter()
            .flat_map(|quad| quad.samples)
            .all(|mask| mask == 0 || mask == u16::MAX)
    );
    let under = conservative::triangle(corners, M::Underestimate, &bounds, 1);
    assert_eq!(covered(&under), [[1, 1]]);
}
