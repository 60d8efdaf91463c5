use fastrand::Rng;
use glam::Vec2;

use super::rings::{Kind, in_f32, slices};
use crate::polygon::arrangement::{Corner, arrange};
use crate::polygon::exact::{ExactPoint, cross};
use crate::polygon::sweep::triangulate;
use crate::polygon::*;

/// True if an integer point lies on an edge.
fn is_on([a, b]: [Corner; 2], point: Corner) -> bool {
    let between = |k: usize| (a[k].min(b[k])..=a[k].max(b[k])).contains(&point[k]);
    cross(a, b, point) == 0 && between(0) && between(1)
}

/// A polygon is simple if its edges have the length of at least 1, neighbours have no end on each
/// other but the common one, and no other edges cross or have an end on each other.
fn is_simple(ring: &[Corner]) -> bool {
    let count = ring.len();
    let edge = |i: usize| [ring[i % count], ring[(i + 1) % count]];
    let touch = |p: [Corner; 2], q: [Corner; 2]| {
        q.iter().any(|&end| is_on(p, end)) || p.iter().any(|&end| is_on(q, end))
    };
    let do_cross = |[a, b]: [Corner; 2], [c, d]: [Corner; 2]| {
        cross(a, b, c).signum() * cross(a, b, d).signum() < 0
            && cross(c, d, a).signum() * cross(c, d, b).signum() < 0
    };
    count > 2
        && (0..count).all(|i| {
            let [[a, b], [_, c]] = [edge(i), edge(i + 1)];
            a != b && !is_on([a, b], c) && !is_on([b, c], a)
        })
        && (0..count).all(|i| {
            let others = (0..count).filter(|j| {
                let steps = (j + count - i) % count;
                steps > 1 && steps < count - 1
            });
            others
                .clone()
                .all(|j| !touch(edge(i), edge(j)) && !do_cross(edge(i), edge(j)))
        })
}

/// Rows: M6.
#[test]
fn simple_polygons_are_those_whose_edges_share_corners_only() {
    let mut random = Rng::with_seed(33);
    let (mut simple, mut other) = (0, 0);
    for case in 0..30_000 {
        let kind = [Kind::Any, Kind::Tiny, Kind::Star, Kind::Steps, Kind::Needle][case % 5];
        let mut ring = kind.rings(9, &mut random).remove(0);
        ring.truncate(random.usize(3..7));
        let corners = in_f32(std::slice::from_ref(&ring), 0.25).remove(0);
        let is_simple = is_simple(&ring);
        assert_eq!(is_simple_2d(&corners), is_simple, "{ring:?}");
        assert!(
            !is_convex_2d(&corners) || is_simple || has_repeated(&ring),
            "{ring:?}"
        );
        *(if is_simple { &mut simple } else { &mut other }) += 1;
    }
    assert!(simple > 5_000 && other > 5_000, "{simple} {other}");
    assert!(!is_simple_2d(&[]) && !is_simple_2d(&[Vec2::ZERO, Vec2::X]));
    assert!(!is_simple_2d(&[Vec2::ZERO, Vec2::X, Vec2::splat(f32::NAN)]));
}

fn has_repeated(ring: &[Corner]) -> bool {
    (0..ring.len()).any(|i| ring[i] == ring[(i + 1) % ring.len()])
}

/// Points are on an edge, or inside exactly one triangle of the polygon, or of none.
/// Rows: M6.
#[test]
fn points_are_inside_on_an_edge_or_outside() {
    let mut random = Rng::with_seed(34);
    let mut found = [0; 3];
    for case in 0..6_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        let rings = kind.rings(12, &mut random);
        let floats = in_f32(&rings, 1.0);
        let arrangement = arrange(&rings).unwrap();
        for rule in [FillRule::EvenOdd, FillRule::NonZero] {
            let triangles = triangulate(&arrangement, rule);
            for _ in 0..8 {
                let point = [random.i64(-1..14), random.i64(-1..14)];
                let exact = ExactPoint::corner(point);
                let place = Vec2::new(point[0] as f32, point[1] as f32);
                let is_on_edge = rings.iter().any(|ring| {
                    let next = |i: usize| ring[(i + 1) % ring.len()];
                    (0..ring.len()).any(|i| is_on([ring[i], next(i)], point))
                });
                let is_covered = triangles.iter().any(|triangle| {
                    let [a, b, c] = triangle.map(|vertex| &arrangement.vertices[vertex]);
                    [(a, b), (b, c), (c, a)]
                        .into_iter()
                        .all(|(from, to)| ExactPoint::orientation(from, to, &exact).is_ge())
                });
                let expected = match (is_on_edge, is_covered) {
                    (true, _) => PointLocation::OnEdge,
                    (false, true) => PointLocation::Inside,
                    (false, false) => PointLocation::Outside,
                };
                let slices = slices(&floats);
                assert_eq!(
                    locate_in_polygon(place, &slices, rule),
                    expected,
                    "{place} {rings:?}"
                );
                if let ([ring], false) = (&slices[..], is_on_edge) {
                    assert_eq!(point_in_polygon(place, ring, rule), is_covered);
                }
                found[expected as usize] += 1;
            }
        }
    }
    assert!(found.iter().all(|count| *count > 4_000), "{found:?}");
}
