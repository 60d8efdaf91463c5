//! Trees lose nothing, order exactly, and are bounded.

use super::*;
use crate::eye::Eye;
use crate::picture::{Hiding, differing_pixels, draw};
use crate::polygon::{Corner, Polygon};
use crate::random_scene;
use fastrand::Rng;

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The area of a flat polygon as a vector.
fn area(corners: &[Corner<3>]) -> [f64; 3] {
    let first = corners[0].position;
    let mut sum = [0.0; 3];
    for pair in corners[1..].windows(2) {
        let part = cross(
            minus(pair[0].position, first),
            minus(pair[1].position, first),
        );
        sum = [0, 1, 2].map(|k: usize| sum[k] + part[k]);
    }
    sum
}

/// The pieces of each polygon have its area and its winding, and its attributes.
/// Rows: D4.
#[test]
fn pieces_are_the_polygons() {
    let mut random = Rng::with_seed(7);
    let mut cuts = 0;
    for size in [0.1, 0.5, 1.0] {
        // Three attributes that are the position: interpolated, they stay it.
        let polygons: Vec<Polygon<3>> = random_scene::polygons(&mut random, 300, size)
            .iter()
            .map(|polygon| {
                #[expect(clippy::cast_possible_truncation, reason = "they were f32")]
                let corner = |c: &Corner<3>| {
                    let position = c.position.map(|x| x as f32);
                    (position, position)
                };
                let corners: Vec<_> = polygon.corners().iter().map(corner).collect();
                Polygon::new(&corners).expect("it was one")
            })
            .collect();
        let tree = BspTree::new(&polygons, BspOptions::default()).expect("small");
        cuts += tree.pieces().len() - polygons.len();
        let mut sums = vec![[0.0; 3]; polygons.len()];
        for piece in tree.pieces() {
            let own = area(&piece.corners);
            let whole = area(polygons[piece.source as usize].corners());
            assert!(dot(own, whole) > -1e-12, "the winding is kept");
            let sum = &mut sums[piece.source as usize];
            *sum = [0, 1, 2].map(|k: usize| sum[k] + own[k]);
            for corner in &piece.corners {
                let distances =
                    (0..3).map(|k| corner.position[k] - f64::from(corner.attributes[k]));
                assert!(distances.into_iter().all(|d| d.abs() < 1e-6), "{corner:?}");
            }
        }
        for (sum, polygon) in sums.iter().zip(&polygons) {
            let lost = minus(*sum, area(polygon.corners()));
            assert!(dot(lost, lost).sqrt() < 1e-12, "{lost:?}");
        }
    }
    assert!(cuts > 1000, "{cuts}");
}

/// The distance along a ray at which it meets a convex piece.
fn meeting(piece: &Piece<3>, from: [f64; 3], along: [f64; 3]) -> Option<f64> {
    let normal = area(&piece.corners);
    let steepness = dot(normal, along);
    if steepness.abs() < 1e-9 * dot(normal, normal).sqrt() {
        return None;
    }
    let t = dot(normal, minus(piece.corners[0].position, from)) / steepness;
    let at = [0, 1, 2].map(|k: usize| from[k] + along[k] * t);
    let count = piece.corners.len();
    let is_inside = (0..count).all(|k| {
        let (a, b) = (
            piece.corners[k].position,
            piece.corners[(k + 1) % count].position,
        );
        dot(cross(minus(b, a), minus(at, a)), normal) >= 0.0
    });
    // The eye may be a corner of the piece.
    (is_inside && t > 1e-6).then_some(t)
}

/// Along every ray the pieces come from the farthest on, wherever the eye is: outside, among the
/// polygons, in the plane of one, at infinity.
/// Rows: D4.
#[test]
fn the_order_is_exact_for_any_eye() {
    let mut random = Rng::with_seed(11);
    let mut met = 0;
    for size in [0.2, 0.7, 1.0] {
        let polygons = random_scene::polygons(&mut random, 120, size);
        let tree = BspTree::new(&polygons, BspOptions::default()).expect("small");
        for (case, polygon) in polygons.iter().enumerate().take(24) {
            let mut vector = |scale: f64| [0; 3].map(|_| (random.f64() * 2.0 - 1.0) * scale);
            let (far, near, towards) = (vector(5.0), vector(0.5), vector(1.0));
            let eye = match case % 4 {
                0 => Eye::Point(far),
                1 => Eye::Point(near),
                2 => Eye::Point(polygon.corners()[1].position),
                _ => Eye::Direction(towards),
            };
            let mut order = Vec::new();
            tree.back_to_front(eye, |piece| order.push(piece));
            let mut reversed = Vec::new();
            tree.front_to_back(eye, |piece| reversed.push(piece));
            assert_eq!(order.len(), tree.pieces().len());
            assert_eq!(reversed.len(), order.len());
            for _ in 0..60 {
                let target = [0; 3].map(|_| random.f64() * 1.6 - 0.8);
                let (from, along) = match eye {
                    Eye::Point(eye) => (eye, minus(target, eye)),
                    Eye::Direction(d) => {
                        let from = [0, 1, 2].map(|k: usize| target[k] + d[k] * 100.0);
                        (from, minus(target, from))
                    }
                };
                let along_ray = |pieces: &[&Piece<3>]| -> Vec<f64> {
                    pieces
                        .iter()
                        .filter_map(|piece| meeting(piece, from, along))
                        .collect()
                };
                let distances = along_ray(&order);
                assert!(
                    distances.is_sorted_by(|a, b| *a >= b - 1e-9),
                    "{eye:?}: {distances:?}"
                );
                let distances = along_ray(&reversed);
                assert!(
                    distances.is_sorted_by(|a, b| a - 1e-9 <= *b),
                    "{eye:?}: {distances:?}"
                );
                met += distances.len();
            }
        }
    }
    assert!(met > 10_000, "{met}");
}

/// The distance of a point from a segment.
fn distance_from([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = u[0] * u[0] + u[1] * u[1];
    let t = if square > 0.0 {
        ((u[0] * v[0] + u[1] * v[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let [dx, dy] = [v[0] - u[0] * t, v[1] - u[1] * t];
    (dx * dx + dy * dy).sqrt()
}

/// The picture in the tree's order is that of the depth buffer, but for pixels within one pixel of
/// an edge of a piece.
/// Rows: D3, D4, D5.
#[test]
fn the_picture_is_that_of_the_depth_buffer() {
    let device = random_scene::device();
    let mut random = Rng::with_seed(5);
    let (mut differing, mut pixels) = (0, 0);
    for (size, count) in [(0.15, 600), (0.4, 120), (0.8, 60), (1.0, 40)] {
        for _ in 0..3 {
            let polygons = random_scene::polygons(&mut random, count, size);
            let tree = BspTree::new(&polygons, BspOptions::default()).expect("small");
            let (view, eye) = random_scene::view(&mut random, [160, 160]);
            let by_depth = polygons.iter().map(Polygon::corners);
            let by_depth = draw(&device, &view, by_depth, Hiding::ByDepth).expect("small");
            let mut order = Vec::new();
            tree.back_to_front(eye, |piece| order.push(piece.corners.as_slice()));
            let by_order = draw(&device, &view, order.iter().copied(), Hiding::ByOrder);
            let by_order = by_order.expect("small");

            let edges: Vec<[[f64; 2]; 2]> = tree
                .pieces()
                .iter()
                .flat_map(|piece| {
                    let corners = random_scene::in_pixels(&view, &piece.corners);
                    (0..corners.len()).map(move |k| [corners[k], corners[(k + 1) % corners.len()]])
                })
                .collect();
            let [a, b] = [&by_depth, &by_order].map(|picture| picture.rgba.as_chunks::<4>().0);
            let covered = a.iter().filter(|pixel| **pixel != [255; 4]).count();
            assert!(covered > 3000, "the scene is in the picture");
            for (pixel, _) in a.iter().zip(b).enumerate().filter(|(_, (a, b))| a != b) {
                let centre = [(pixel % 160) as f64 + 0.5, (pixel / 160) as f64 + 0.5];
                let distances = edges.iter().map(|edge| distance_from(*edge, centre));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                assert!(nearest <= 1.0, "{nearest} pixels from an edge");
            }
            differing += differing_pixels(&by_depth, &by_order);
            pixels += covered;
        }
    }
    assert!(differing * 100 < pixels, "{differing} of {pixels}");
}

/// Meshes whose facets share corners and planes: no cut is needed, and none is made but by axes.
/// Rows: D4.
#[test]
fn meshes_and_coplanar_polygons_are_not_cut_to_slivers() {
    // A grid of squares in one plane, in random orders, cut by polygons across it.
    let mut random = Rng::with_seed(8);
    let mut polygons = Vec::new();
    let slant = |x: f32, y: f32| [x, y, 0.25 * x + 0.125 * y];
    for i in 0..10 {
        for j in 0..10 {
            let (x, y) = (i as f32 * 0.1, j as f32 * 0.1);
            let corners = [(x, y), (x + 0.1, y), (x + 0.1, y + 0.1)];
            polygons.extend(Polygon::new(&corners.map(|(x, y)| (slant(x, y), [1.0; 3]))));
        }
    }
    assert_eq!(polygons.len(), 100);
    random.shuffle(&mut polygons);
    let tree = BspTree::new(&polygons, BspOptions::default()).expect("small");
    assert!(tree.pieces().len() < 160, "{}", tree.pieces().len());
    // Equal polygons are in one node, in the input's order.
    let twice = vec![polygons[0].clone(); 5];
    let tree = BspTree::new(&twice, BspOptions::default()).expect("small");
    assert_eq!(tree.node_count(), 1);
    let mut sources = Vec::new();
    tree.back_to_front(Eye::Direction([0.0, 0.0, 1.0]), |piece| {
        sources.push(piece.source)
    });
    assert_eq!(sources, [0, 1, 2, 3, 4]);
}

/// Pieces and depth of large scenes stay small; ten times the polygons are ten times the work.
/// Rows: D4.
#[test]
fn large_scenes_have_shallow_trees() {
    let mut random = Rng::with_seed(10);
    for (count, size) in [(2_000, 0.1), (20_000, 0.03)] {
        let polygons = random_scene::polygons(&mut random, count, size);
        let tree = BspTree::new(&polygons, BspOptions::default()).expect("it fits");
        let pieces = tree.pieces().len();
        assert!(
            pieces < 3 * count && tree.depth() < 60,
            "{pieces} {}",
            tree.depth()
        );
    }
}

/// Hostile input ends with a tree or an error: deep lists, crossings of all with all, none at all.
/// Rows: D4.
#[test]
fn trees_are_bounded() {
    let mut random = Rng::with_seed(9);
    let crossing = random_scene::polygons(&mut random, 400, 1.0);
    let options = BspOptions {
        max_pieces: 1000,
        ..BspOptions::default()
    };
    let error = BspTree::new(&crossing, options).expect_err("too many");
    assert!(
        error
            .to_string()
            .contains("400 polygons become more than 1000 pieces")
    );
    let empty = BspTree::<3>::new(&[], options).expect("nothing");
    empty.back_to_front(Eye::Point([0.0; 3]), |_| unreachable!("there is none"));

    // A ball of facets: no facet has facets on both sides.
    let mut ball = Vec::new();
    let (rings, sectors) = (60, 100);
    let at = |i: usize, j: usize| {
        let (u, v) = (
            i as f32 / rings as f32 * 3.1,
            j as f32 / sectors as f32 * 6.2,
        );
        [
            libm::sinf(u) * libm::cosf(v),
            libm::sinf(u) * libm::sinf(v),
            libm::cosf(u),
        ]
    };
    for i in 0..rings {
        for j in 0..sectors {
            for corners in [
                [at(i, j), at(i + 1, j), at(i, j + 1)],
                [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)],
            ] {
                ball.extend(Polygon::new(&corners.map(|p| (p, [0.5; 3]))));
            }
        }
    }
    let tree = BspTree::new(&ball, BspOptions::default()).expect("it fits");
    assert!(
        tree.depth() < 400 && 2 * tree.pieces().len() < 5 * ball.len(),
        "{} {}",
        tree.depth(),
        tree.pieces().len()
    );

    // Extreme coordinates.
    let huge = [[3e38, 0.0, 0.0], [-3e38, 1e-45, 0.0], [0.0, 3e38, 1.0]];
    let tiny = [[1e-45, 0.0, 0.0], [0.0, 1e-45, 0.0], [0.0, 0.0, 1e-45]];
    let extreme: Vec<Polygon<3>> = [huge, tiny]
        .iter()
        .filter_map(|corners| Polygon::new(&corners.map(|p| (p, [0.0; 3]))).ok())
        .collect();
    assert_eq!(extreme.len(), 2);
    let tree = BspTree::new(&extreme, BspOptions::default()).expect("small");
    assert!(tree.pieces().len() <= 4);
}
