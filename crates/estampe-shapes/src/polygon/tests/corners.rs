#![expect(clippy::cast_possible_truncation, reason = "tests count in hundreds")]

use std::time::{Duration, Instant};

use fastrand::Rng;
use glam::{DVec3, Vec2, Vec3};

use crate::polygon::*;
use crate::random_cases::random_cases;

fn polar(turns: f64, radius: f64) -> Vec2 {
    let angle = turns * std::f64::consts::TAU;
    glam::DVec2::new(libm::cos(angle) * radius, libm::sin(angle) * radius).as_vec2()
}

/// A star-shaped polygon: every corner is visible from the origin. It is simple and very concave.
fn star(count: usize, random: &mut Rng) -> Vec<Vec2> {
    let radius = |random: &mut Rng| 0.05 + f64::from(random.f32());
    (0..count)
        .map(|i| polar(i as f64 / count as f64, radius(random)))
        .collect()
}

/// Teeth of random height on a common base: all edges parallel to the axes, many collinear corners.
fn comb(count: usize, random: &mut Rng) -> Vec<Vec2> {
    let mut corners = Vec::new();
    for tooth in 0..count.div_ceil(4) {
        let left = 2.0 * tooth as f32;
        let height = 1.0 + (20.0 * random.f32()).floor();
        corners.extend([
            (left, 0.0),
            (left, height),
            (left + 1.0, height),
            (left + 1.0, 0.0),
        ]);
    }
    let right = corners[corners.len() - 1].0;
    corners.extend([(right, -1.0), (0.0, -1.0)]);
    corners.reverse();
    corners.into_iter().map(Vec2::from).collect()
}

/// A band that winds around the origin.
fn spiral(count: usize, random: &mut Rng) -> Vec<Vec2> {
    let half = count.div_ceil(2).max(3);
    let pitch = 0.01 + 0.04 * f64::from(random.f32());
    let turns = |i: usize| pitch * i as f64;
    let outwards = (0..half).map(|i| polar(turns(i), 1.0 + turns(i)));
    let back = (0..half).rev().map(|i| polar(turns(i), 1.5 + turns(i)));
    back.chain(outwards).rev().collect()
}

/// A staircase with additional corners in the middle of every edge.
fn staircase(count: usize, _: &mut Rng) -> Vec<Vec2> {
    let steps = count.div_ceil(4);
    let mut corners: Vec<Vec2> = Vec::new();
    for step in 0..steps {
        let at = step as f32;
        corners.extend(
            [
                (at, at),
                (at + 0.5, at),
                (at + 1.0, at),
                (at + 1.0, at + 0.5),
            ]
            .map(Vec2::from),
        );
    }
    corners.extend([
        Vec2::new(steps as f32, steps as f32 + 1.0),
        Vec2::new(0.0, steps as f32 + 1.0),
    ]);
    corners
}

/// A random one of these, of either winding, with a random first corner.
fn simple_polygon(random: &mut Rng) -> Vec<Vec2> {
    let count = random.usize(5..200);
    let make = [star, comb, spiral, staircase][random.usize(..4)];
    let mut corners = make(count, random);
    if random.bool() {
        corners.reverse();
    }
    let start = random.usize(..corners.len());
    corners.rotate_left(start);
    corners
}

fn triangles_2d(corners: &[Vec2]) -> Vec<[u32; 3]> {
    let mut out = Vec::new();
    triangulate_2d(corners, &mut out);
    out
}

fn triangles_3d(corners: &[Vec3]) -> Vec<[u32; 3]> {
    let mut out = Vec::new();
    triangulate_3d(corners, &mut out);
    out
}

/// Checks areas, winding, number, and that each of many points is covered the right number of
/// times.
fn assert_covers(corners: &[Vec2], triangles: &[[u32; 3]]) {
    assert_eq!(triangles.len(), corners.len() - 2);
    let area = signed_area_2d(corners);
    let of = |t: &[u32; 3]| t.map(|i| corners[i as usize]);
    let areas: Vec<f64> = triangles.iter().map(|t| signed_area_2d(&of(t))).collect();
    let sum: f64 = areas.iter().sum();
    assert!(
        (sum - area).abs() <= 1e-9 * area.abs(),
        "areas {sum}, polygon {area}"
    );
    assert!(
        areas
            .iter()
            .all(|a| a * area.signum() >= -1e-12 * area.abs()),
        "winding"
    );

    let low = corners.iter().copied().reduce(Vec2::min).unwrap();
    let high = corners.iter().copied().reduce(Vec2::max).unwrap();
    let mut random = Rng::with_seed(corners.len() as u64);
    let anywhere = |_| low + (high - low) * Vec2::new(random.f32(), random.f32());
    let points: Vec<Vec2> = (0..200).map(anywhere).collect();
    for &point in points.iter().chain(corners) {
        let covering = triangles
            .iter()
            .filter(|t| point_in_polygon(point, &of(t), FillRule::NonZero));
        let is_inside = point_in_polygon(point, corners, FillRule::EvenOdd);
        assert_eq!(covering.count(), usize::from(is_inside), "{point}");
    }
}

/// Rows: M6.
#[test]
fn triangles_cover_a_simple_polygon_once() {
    random_cases(|random| {
        let corners = simple_polygon(random);
        assert_covers(&corners, &triangles_2d(&corners));
    });
}

#[test]
fn quads_are_covered_once() {
    random_cases(|random| {
        let mut corners = star(4, random);
        if random.bool() {
            corners.reverse();
        }
        assert_covers(&corners, &triangles_2d(&corners));
        let flat: Vec<Vec3> = corners.iter().map(|p| p.extend(7.0)).collect();
        assert_covers(&corners, &triangles_3d(&flat));
    });
}

/// On any plane the area vectors of the triangles have the direction of the polygon's, and sum to
/// it.
#[test]
fn planes_in_space() {
    random_cases(|random| {
        let corners = simple_polygon(random);
        let mut axis = || Vec3::from_array([0; 3].map(|_| 2.0 * random.f32() - 1.0));
        let (origin, x, y) = (axis() * 10.0, axis(), axis());
        if x.cross(y).length() <= 0.1 * x.length() * y.length() {
            return;
        }
        let corners: Vec<Vec3> = corners.iter().map(|p| origin + x * p.x + y * p.y).collect();
        let doubled = |ring: &[Vec3]| -> DVec3 {
            let at = |i: usize| ring[i % ring.len()].as_dvec3() - ring[0].as_dvec3();
            (0..ring.len()).map(|i| at(i).cross(at(i + 1))).sum()
        };
        let whole = doubled(&corners);
        let mut sum = DVec3::ZERO;
        let triangles = triangles_3d(&corners);
        for t in &triangles {
            let part = doubled(&t.map(|i| corners[i as usize]));
            assert!(part.dot(whole) >= -1e-5 * whole.length_squared());
            sum += part;
        }
        assert!(
            (sum - whole).length() <= 1e-4 * whole.length(),
            "{sum} {whole}"
        );
    });
}

/// Arbitrary corners: indices are in range, at most n − 2 triangles, no panic, bounded time.
#[test]
fn hostile_corners() {
    random_cases(|random| {
        let count = random.usize(..120);
        let bits: Vec<[u32; 3]> = (0..count).map(|_| [0; 3].map(|_| random.u32(..))).collect();
        let snap = random.bool();
        let corners: Vec<Vec3> = bits
            .iter()
            .map(|bits| match snap {
                true => Vec3::from_array(bits.map(|b| (b % 5) as f32)),
                false => Vec3::from_array(bits.map(f32::from_bits)),
            })
            .collect();
        let flat: Vec<Vec2> = corners.iter().map(|corner| corner.truncate()).collect();
        for triangles in [triangles_3d(&corners), triangles_2d(&flat)] {
            assert!(triangles.len() <= corners.len().saturating_sub(2));
            assert!(
                triangles
                    .as_flattened()
                    .iter()
                    .all(|&i| (i as usize) < corners.len())
            );
            assert!(triangles.is_empty() == (corners.len() < 3));
        }
        let _ = (is_convex_2d(&flat), signed_area_2d(&flat));
        for &point in &flat {
            let _ = point_in_polygon(point, &flat, FillRule::NonZero);
        }
    });
}

/// Convex polygons: corners of an ellipse, some repeated, some in the middle of edges.
/// Rows: M6.
#[test]
fn convex_polygons() {
    random_cases(|random| {
        let count = random.usize(3..60);
        // Corners on a coarse grid keep the middles of edges exact.
        let mut ring: Vec<Vec2> = Vec::new();
        for i in 0..count {
            let corner = (polar(i as f64 / count as f64, 1e5)).round() * 2.0;
            if random.f32() < 0.3
                && let Some(&last) = ring.last()
            {
                ring.push((last + corner) * 0.5);
            }
            ring.push(corner);
        }
        assert!(is_convex_2d(&ring));
        assert_covers(&ring, &triangles_2d(&ring));
        ring.push(ring[0]);
        assert!(is_convex_2d(&ring));
    });
}

/// Rows: M6.
#[test]
fn convexity_of_known_shapes() {
    let ring = |points: &[(f32, f32)]| points.iter().copied().map(Vec2::from).collect::<Vec<_>>();
    let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let arrow = ring(&[(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0)]);
    let bow_tie = ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
    let spike = ring(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
    let line = ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]);
    let pentagon: Vec<Vec2> = (0..5).map(|i| polar(0.2 * f64::from(i), 1.0)).collect();
    let pentagram: Vec<Vec2> = (0..5).map(|i| polar(0.4 * f64::from(i), 1.0)).collect();
    assert!(is_convex_2d(&square) && is_convex_2d(&pentagon));
    for other in [arrow, bow_tie, spike, line, pentagram.clone(), Vec::new()] {
        assert!(!is_convex_2d(&other), "{other:?}");
    }
    // The boundary winds twice around the middle of a pentagram.
    assert!(point_in_polygon(Vec2::ZERO, &pentagram, FillRule::NonZero));
    assert!(!point_in_polygon(Vec2::ZERO, &pentagram, FillRule::EvenOdd));
    assert!((signed_area_2d(&square) - 1.0).abs() < 1e-12);
}

/// Every first corner and both windings of a concave quad: the diagonal starts at the reflex
/// corner.
#[test]
fn concave_quads_take_the_inner_diagonal() {
    let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)].map(Vec2::from);
    for start in 0..4 {
        for is_reversed in [false, true] {
            let mut corners = arrow;
            corners.rotate_left(start);
            if is_reversed {
                corners.reverse();
            }
            let reflex = corners
                .iter()
                .position(|&corner| corner == arrow[3])
                .unwrap() as u32;
            for triangle in triangles_2d(&corners) {
                assert!(triangle.contains(&reflex), "{corners:?}");
            }
            let upright: Vec<Vec3> = corners.iter().map(|p| Vec3::new(3.0, p.x, p.y)).collect();
            assert_eq!(triangles_3d(&upright), triangles_2d(&corners));
        }
    }
}

#[test]
fn the_shorter_diagonal_of_a_bent_quad() {
    let bent = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::new(0.0, 1.0, 5.0),
    ];
    assert_eq!(triangles_3d(&bent), [[0, 1, 2], [0, 2, 3]]);
    let rotated = [bent[3], bent[0], bent[1], bent[2]];
    assert_eq!(triangles_3d(&rotated), [[0, 1, 3], [1, 2, 3]]);
}

#[test]
fn triangles_stay_themselves() {
    let anywhere = [
        Vec3::splat(f32::NAN),
        Vec3::splat(f32::INFINITY),
        Vec3::splat(f32::MAX),
    ];
    assert_eq!(triangles_3d(&anywhere), [[0, 1, 2]]);
    assert_eq!(triangles_3d(&anywhere[..2]), [[0_u32; 3]; 0]);
    assert_eq!(triangles_3d(&[Vec3::ONE; 7]).len(), 5);
}

/// The extremes of f32: no overflow and no loss of precision.
#[test]
fn extreme_coordinates() {
    let mut random = Rng::with_seed(5);
    let shape = star(50, &mut random);
    for scale in [1e-38, 1e-20, 1e20, 3e38] {
        let scaled: Vec<Vec2> = shape.iter().map(|&p| p * scale).collect();
        assert_eq!(triangles_2d(&scaled).len(), 48, "{scale}");
    }
    let large: Vec<Vec2> = shape.iter().map(|&p| p * 3e38).collect();
    let area: f64 = triangles_2d(&large)
        .iter()
        .map(|t| signed_area_2d(&t.map(|i| large[i as usize])))
        .sum();
    assert!((area / signed_area_2d(&large) - 1.0).abs() < 1e-9);
}

/// Polygons constructed to be slow: without the guards they take seconds.
#[test]
fn hostile_polygons_end_soon() {
    let mut random = Rng::with_seed(11);
    let zigzag = |i: usize| Vec2::new(i as f32 * [1.0, -1.0][i % 2], (i * i % 7919) as f32);
    let needle = |i: usize| Vec2::splat((i / 2) as f32) + [Vec2::ZERO, Vec2::new(3e4, -3e4)][i % 2];
    let polygons: [(&str, Vec<Vec2>); 5] = [
        ("zigzag", (0..16_000).map(zigzag).collect()),
        (
            "noise",
            (0..16_000)
                .map(|_| Vec2::new(random.f32(), random.f32()))
                .collect(),
        ),
        (
            "needles",
            (0..6_000)
                .map(needle)
                .chain([Vec2::new(-1.0, 3000.0)])
                .collect(),
        ),
        (
            "one line",
            (0..16_000)
                .map(|i| Vec2::new((i * i % 7919) as f32, 0.0))
                .chain([Vec2::Y])
                .collect(),
        ),
        (
            "too many",
            (0..100_000)
                .map(|i| polar(f64::from(i) * 1e-5, f64::from(1 + i % 2)))
                .collect(),
        ),
    ];
    for (name, corners) in polygons {
        let start = Instant::now();
        let count = triangles_2d(&corners).len();
        assert!(count > 0 && count <= corners.len() - 2, "{name}: {count}");
        assert!(
            start.elapsed() < Duration::from_secs(5),
            "{name}: {:?}",
            start.elapsed()
        );
    }
}

#[test]
fn the_work_budget_runs_out() {
    let mut triangulator = Triangulator::new();
    triangulator.work_left = 5_000;
    let small = star(60, &mut Rng::with_seed(1));
    let large = star(70, &mut Rng::with_seed(1));
    let mut run = |corners: &[Vec2]| {
        let mut out = Vec::new();
        triangulator.triangulate_2d(corners, &mut out);
        out
    };
    assert_covers(&large, &run(&large));
    // 4,900 of 5,000 are spent.
    let fan = run(&large);
    assert!(fan.iter().all(|t| t[0] == 0));
    assert_covers(&small, &run(&small));
}
