use std::cmp::Ordering;

use fastrand::Rng;
use glam::Vec2;

use super::rings::{Kind, in_f32, slices};
use crate::polygon::arrangement::{Corner, arrange};
use crate::polygon::exact::ExactPoint;
use crate::polygon::sweep::triangulate;
use crate::polygon::*;

const SIZE: [u32; 2] = [24, 20];

/// How often each pixel is covered by the spans of a polygon.
fn filled(rings: &[&[Vec2]], rule: FillRule) -> Vec<u32> {
    let [width, height] = SIZE;
    let mut covered = vec![0; (width * height) as usize];
    let mut last: Option<PixelSpan> = None;
    fill_spans(rings, rule, SIZE, |span| {
        assert!(span.x.start < span.x.end && span.x.end <= width && span.y < height);
        if let Some(last) = &last {
            let is_after = last.y < span.y || last.y == span.y && last.x.end < span.x.start;
            assert!(is_after, "{last:?} {span:?}");
        }
        for x in span.x.clone() {
            covered[(span.y * width + x) as usize] += 1;
        }
        last = Some(span);
    })
    .unwrap();
    covered
}

/// True if a counter-clockwise triangle, with y up, covers a point that moves a little to +x and
/// less to +y: the top-left rule, with y down.
fn covers(triangle: [&ExactPoint; 3], [x, y]: [i64; 2]) -> bool {
    let point = ExactPoint::corner([x, y]);
    let moved = |axis: usize| {
        let mut to = [x, y];
        to[axis] += 1;
        ExactPoint::corner(to)
    };
    let [a, b, c] = triangle;
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        // On the edge's line, the moved point is on the side on which a point further on is.
        let side = |point: &ExactPoint| ExactPoint::orientation(from, to, point);
        let side = side(&point)
            .then_with(|| side(&moved(0)))
            .then_with(|| side(&moved(1)));
        side == Ordering::Greater
    })
}

/// Spans cover the pixels that the triangles of the same polygon cover together, each once; corners
/// lie on 1/256 pixel, many of them on centres, so that edges pass through centres exactly.
/// Rows: M6.
#[test]
fn spans_cover_what_triangles_cover() {
    let [width, height] = SIZE;
    let mut random = Rng::with_seed(21);
    let mut total = 0_u32;
    for case in 0..4_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        // In steps of half a pixel, or of 1/256.
        let (size, step) = if random.bool() {
            (40, 128_i64)
        } else {
            (5120, 1)
        };
        let rings = kind.rings(size, &mut random);
        let offset = step * random.i64(-4..4);
        let subpixels: Vec<Vec<Corner>> = rings
            .iter()
            .map(|ring| ring.iter().map(|c| c.map(|x| x * step + offset)).collect())
            .collect();
        let floats = in_f32(&subpixels, 1.0 / 256.0);
        for rule in [FillRule::EvenOdd, FillRule::NonZero] {
            let covered = filled(&slices(&floats), rule);
            let arrangement = arrange(&subpixels).unwrap();
            let mut expected = vec![0; covered.len()];
            for triangle in triangulate(&arrangement, rule) {
                let triangle = triangle.map(|vertex| &arrangement.vertices[vertex]);
                for y in 0..height {
                    for x in 0..width {
                        let center = [x, y].map(|at| i64::from(at) * 256 + 128);
                        expected[(y * width + x) as usize] += u32::from(covers(triangle, center));
                    }
                }
            }
            assert_eq!(covered, expected, "case {case}, {rule:?}: {subpixels:?}");
            total += covered.iter().sum::<u32>();
        }
    }
    assert!(total > 300_000, "{total}");
}

/// The rule at edges, on a square between pixel centres and one through them.
#[test]
fn left_and_top_edges_are_inside() {
    let square = |low: f32, high: f32| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| Vec2::new(x, y))
    };
    let spans = |ring: &[Vec2]| {
        let mut spans = Vec::new();
        fill_spans(&[ring], FillRule::EvenOdd, [8, 8], |span| {
            spans.push((span.y, span.x))
        })
        .unwrap();
        spans
    };
    assert_eq!(spans(&square(1.0, 3.0)), [(1, 1..3), (2, 1..3)]);
    assert_eq!(spans(&square(1.5, 3.5)), [(1, 1..3), (2, 1..3)]);
    // Half a sub-pixel is rounded to the even one: 1.5 - 1/512 and 1.5 + 1/512 both to 1.5.
    assert_eq!(
        spans(&square(1.5 + 1.0 / 512.0, 3.5)),
        [(1, 1..3), (2, 1..3)]
    );
    assert_eq!(spans(&square(1.5 + 1.0 / 256.0, 3.5)), [(2, 2..3)]);
    // Beyond the window on all sides.
    assert_eq!(spans(&square(-9.0, 99.0)).len(), 8);
    let far = square(-9.0, 1e7);
    let error = fill_spans(&[&far], FillRule::EvenOdd, [8, 8], |_| {}).unwrap_err();
    assert_eq!(error, PolygonError::Coordinate { ring: 0, corner: 1 });
}
