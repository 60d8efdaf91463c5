use std::collections::{HashMap, HashSet};

use fastrand::Rng;
use glam::Vec2;

use super::oracle::{Fraction, doubled_area};
use super::rings::{Kind, in_f32, slices};
use crate::polygon::arrangement::{Corner, arrange};
use crate::polygon::exact::{ExactPoint, MAX_COORDINATE};
use crate::polygon::sweep::triangulate;
use crate::polygon::*;

const RULES: [FillRule; 2] = [FillRule::EvenOdd, FillRule::NonZero];

/// Twice the exact area of a triangle.
fn add_doubled_area(sum: &mut Fraction, [a, b, c]: [&ExactPoint; 3]) {
    let [[ax, ay, aw], [bx, by, bw], [cx, cy, cw]] = [a, b, c].map(ExactPoint::fraction);
    let determinant =
        ax * (by * cw - cy * bw) - ay * (bx * cw - cx * bw) + aw * (bx * cy - cx * by);
    assert!(
        determinant > 0,
        "a triangle without area or of the wrong winding"
    );
    sum.add(determinant, aw * bw * cw);
}

/// The triangles of 100,000 random polygons have the polygon's area, by exact fractions and a
/// method of its own.
/// Rows: M6.
#[test]
fn triangles_have_the_exact_area() {
    let mut random = Rng::with_seed(6);
    let mut crossings_of: HashMap<Kind, usize> = HashMap::new();
    let (mut empty, mut whole) = (0, 0);
    for case in 0..100_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        let size = if random.u8(..4) == 0 { 1000 } else { 12 };
        let rings = kind.rings(size, &mut random);
        let rule = RULES[random.usize(..2)];
        let arrangement = arrange(&rings).expect("a small polygon");
        let triangles = triangulate(&arrangement, rule);
        let mut area = Fraction::zero();
        for triangle in &triangles {
            add_doubled_area(
                &mut area,
                triangle.map(|vertex| &arrangement.vertices[vertex]),
            );
        }
        let expected = doubled_area(&rings, rule);
        assert!(
            area.is_equal(&expected),
            "case {case}: {} instead of {}, {rule:?}: {rings:?}",
            area.rounded(),
            expected.rounded()
        );
        let crossings = arrangement
            .corner_of
            .iter()
            .filter(|corner| corner.is_none());
        *crossings_of.entry(kind).or_insert(0) += crossings.count();
        empty += usize::from(triangles.is_empty());
        whole += triangles.len();
    }
    assert!(crossings_of[&Kind::Any] > 10_000 && crossings_of[&Kind::Holes] > 10_000);
    assert!(
        crossings_of[&Kind::Convex] < 100,
        "those of corners that were rounded"
    );
    assert!(empty < 10_000 && whole > 400_000, "{empty} {whole}");
}

/// Triangles touch along whole edges, and the border of all is the border of the inside: an edge
/// that belongs to one triangle is a piece of the polygon's.
/// Rows: M6.
#[test]
fn triangles_touch_along_whole_edges() {
    let mut random = Rng::with_seed(60);
    for case in 0..20_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        let rings = kind.rings(20, &mut random);
        let arrangement = arrange(&rings).expect("a small polygon");
        let pieces: HashSet<[usize; 2]> = arrangement
            .pieces
            .iter()
            .map(|piece| [piece.low, piece.high])
            .collect();
        for rule in RULES {
            let mut edges: HashSet<[usize; 2]> = HashSet::new();
            for [a, b, c] in triangulate(&arrangement, rule) {
                for edge in [[a, b], [b, c], [c, a]] {
                    assert!(edges.insert(edge), "{edge:?} twice: {rings:?}");
                }
            }
            for &[a, b] in &edges {
                let is_border = !edges.contains(&[b, a]);
                assert!(
                    !is_border || pieces.contains(&[a.min(b), a.max(b)]),
                    "{rings:?}"
                );
            }
        }
    }
}

/// Decisions are the same at the largest coordinates, where intermediate results are longest.
#[test]
fn the_largest_coordinates_change_nothing() {
    let mut random = Rng::with_seed(61);
    let mut tested = 0;
    for case in 0..5_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        let small = kind.rings(16, &mut random);
        let scale = MAX_COORDINATE / 16;
        let large: Vec<Vec<Corner>> = small
            .iter()
            .map(|ring| {
                ring.iter()
                    .map(|c| c.map(|x| (x - 8) * 2 * scale))
                    .collect()
            })
            .collect();
        let is_inside =
            |ring: &Vec<Corner>| ring.iter().flatten().all(|x| x.abs() <= MAX_COORDINATE);
        if !large.iter().all(is_inside) {
            continue;
        }
        tested += 1;
        for rule in RULES {
            let triangles = |rings| triangulate(&arrange(rings).unwrap(), rule);
            assert_eq!(triangles(&small), triangles(&large), "{small:?}");
        }
    }
    assert!(tested > 2_000, "{tested} cases fit");
}

/// The public form gives the same triangles in f32, at any scale and place.
#[test]
fn positions_are_corners_and_crossings() {
    let mut random = Rng::with_seed(8);
    for case in 0..3_000 {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        let rings = kind.rings(200, &mut random);
        let exponent = random.u8(..40);
        let scale = libm::exp2f(f32::from(exponent) - 20.0);
        let floats = in_f32(&rings, scale);
        for rule in RULES {
            let filled = triangulate_rings(&slices(&floats), rule).unwrap();
            let corners = floats.concat();
            assert_eq!(filled.vertices[..corners.len()], corners);
            let area = |t: &[u32; 3]| {
                let corners = t.map(|i| filled.vertices[i as usize] / scale);
                2.0 * signed_area_2d(&corners)
            };
            let sum: f64 = filled.triangles.iter().map(area).sum();
            let expected = doubled_area(&rings, rule).rounded();
            assert!((sum - expected).abs() < 0.02, "{sum} {expected} {rings:?}");
        }
    }
}

/// Simple polygons of the triangulation for mesh faces: n − 2 triangles of the exact area.
/// Rows: M6.
#[test]
fn faces_have_the_exact_area() {
    let mut random = Rng::with_seed(16);
    let (mut simple, mut convex) = (0, 0);
    for case in 0..100_000 {
        let kind = [Kind::Any, Kind::Convex, Kind::Star, Kind::Steps][case % 4];
        let ring = kind.rings(1000, &mut random).remove(0);
        let corners = in_f32(std::slice::from_ref(&ring), 1.0).remove(0);
        if !is_simple_2d(&corners) {
            continue;
        }
        simple += 1;
        convex += usize::from(is_convex_2d(&corners));
        let mut triangles = Vec::new();
        triangulate_2d(&corners, &mut triangles);
        let cross = |p: Corner, q: Corner| p[0] * q[1] - q[0] * p[1];
        let doubled = |ring: &[Corner]| -> i64 {
            (0..ring.len())
                .map(|i| cross(ring[i], ring[(i + 1) % ring.len()]))
                .sum()
        };
        let areas = triangles
            .iter()
            .map(|t| doubled(&t.map(|i| ring[i as usize])));
        let areas: Vec<i64> = areas.collect();
        assert_eq!(areas.iter().sum::<i64>(), doubled(&ring), "{ring:?}");
        let sign = doubled(&ring).signum();
        assert!(areas.iter().all(|area| area * sign >= 0), "{ring:?}");
    }
    assert!(simple > 40_000 && convex > 10_000, "{simple} {convex}");
}

#[test]
fn known_polygons() {
    let ring = |corners: &[(f32, f32)]| -> Vec<Vec2> {
        corners.iter().map(|&corner| Vec2::from(corner)).collect()
    };
    let area = |rings: &[Vec<Vec2>], rule| -> f64 {
        let filled = triangulate_rings(&slices(rings), rule).unwrap();
        let triangles = filled.triangles.iter();
        triangles
            .map(|t| signed_area_2d(&t.map(|i| filled.vertices[i as usize])))
            .sum()
    };
    let square = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
    let mut hole = ring(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]);
    let bow = ring(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    let twice = [square.clone(), square.clone()].concat();
    for (rings, even_odd, non_zero) in [
        (vec![square.clone()], 16.0, 16.0),
        (vec![square.clone(), hole.clone()], 12.0, 16.0),
        (vec![bow], 2.0, 2.0),
        (vec![twice], 0.0, 16.0),
        (vec![], 0.0, 0.0),
        (
            vec![ring(&[(1.0, 1.0)]), ring(&[(0.0, 0.0), (5.0, 5.0)])],
            0.0,
            0.0,
        ),
    ] {
        assert_eq!(area(&rings, FillRule::EvenOdd), even_odd, "{rings:?}");
        assert_eq!(area(&rings, FillRule::NonZero), non_zero, "{rings:?}");
    }
    hole.reverse();
    assert_eq!(area(&[square.clone(), hole], FillRule::NonZero), 12.0);

    // A pentagram's crossings are new vertices: 5 corners and 5 crossings.
    let star: Vec<Vec2> = (0..5)
        .map(|i| {
            let (cos, sin) = crate::parametric::cos_sin_turns(0.4 * f64::from(i) + 0.25);
            glam::DVec2::new(cos, sin).as_vec2()
        })
        .collect();
    let even_odd = triangulate_rings(&[&star], FillRule::EvenOdd).unwrap();
    let non_zero = triangulate_rings(&[&star], FillRule::NonZero).unwrap();
    assert_eq!((even_odd.vertices.len(), non_zero.vertices.len()), (10, 10));
    assert_eq!((even_odd.triangles.len(), non_zero.triangles.len()), (5, 8));

    let bad = ring(&[(0.0, 0.0), (f32::NAN, 1.0), (1.0, 1.0)]);
    assert_eq!(
        triangulate_rings(&[&square, &bad], FillRule::EvenOdd),
        Err(PolygonError::Coordinate { ring: 1, corner: 1 })
    );
}

/// Polygons made to be slow end soon, with a result or an error.
#[test]
fn hostile_rings_end_soon() {
    let mut random = Rng::with_seed(4);
    let noise: Vec<Vec2> = (0..4_000)
        .map(|_| Vec2::new(random.f32(), random.f32()))
        .collect();
    let zigzag: Vec<Vec2> = (0..10_000)
        .map(|i| Vec2::new(i as f32, if i % 2 == 0 { 0.0 } else { 1e6 }))
        .collect();
    let many = vec![Vec2::ZERO; MAX_CORNERS + 1];
    let start = std::time::Instant::now();
    assert_eq!(
        triangulate_rings(&[&noise], FillRule::NonZero),
        Err(PolygonError::TooManyCrossings)
    );
    assert!(triangulate_rings(&[&zigzag], FillRule::EvenOdd).is_ok());
    let error = triangulate_rings(&[&many], FillRule::EvenOdd).unwrap_err();
    assert!(error.to_string().contains("131073 corners"), "{error}");
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
    for _ in 0..2_000 {
        let any =
            |random: &mut Rng| Vec2::new(f32::from_bits(random.u32(..)), random.f32() * 1e-30);
        let ring: Vec<Vec2> = (0..random.usize(..20)).map(|_| any(&mut random)).collect();
        if let Ok(filled) = triangulate_rings(&[&ring, &ring], FillRule::NonZero) {
            let count = filled.vertices.len();
            assert!(
                filled
                    .triangles
                    .as_flattened()
                    .iter()
                    .all(|&i| (i as usize) < count)
            );
        }
    }
}
