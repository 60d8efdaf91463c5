//! Clipping, face culling and facing: positions, areas, shared crossings, dropped primitives.

use super::*;
use crate::clip::{
    Plane, SIDE_MAX, SIDE_MIN, clip_line, clip_polygon, clip_polygon_by, clip_triangle, keeps_point,
};
use crate::cull::{clip_space_determinant, doubled_area};
use crate::viewport::{PixelBounds, ViewportTransform};

fn viewport() -> Viewport {
    State::new(64, 64).viewport
}

fn transform() -> ViewportTransform {
    ViewportTransform::new(&viewport())
}

/// A vertex with |x|, |y| ≤ `reach` and |z| ≤ 3.
fn random_vertex(random: &mut Random, reach: f32) -> ClipVertex {
    let w = random.range(0.25, 4.0);
    let [x, y, z] = [reach, reach, 3.0].map(|reach| random.range(-reach, reach));
    clip_vertex([x, y, z, w], &[random.unit(), random.unit()])
}

/// All planes of [`viewport`], in the order in which they clip.
fn planes() -> Vec<Plane> {
    [&Plane::DEPTH[..], &Plane::sides(&transform())].concat()
}

/// Sutherland and Hodgman's algorithm in f64, on positions only. Window coordinates of the 64
/// pixels are 32·x/w + 32 and 32 − 32·y/w.
fn clip_f64(mut polygon: Vec<[f64; 4]>) -> Vec<[f64; 4]> {
    let (low, high) = (f64::from(SIDE_MIN), f64::from(SIDE_MAX));
    let normals = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, -1.0, 1.0],
        [32.0, 0.0, 0.0, 32.0 - low],
        [-32.0, 0.0, 0.0, high - 32.0],
        [0.0, -32.0, 0.0, 32.0 - low],
        [0.0, 32.0, 0.0, high - 32.0],
    ];
    for normal in normals {
        polygon = clip_f64_by(normal, &polygon);
    }
    polygon
}

fn ndc_area(polygon: &[[f64; 4]]) -> f64 {
    let ndc: Vec<_> = polygon.iter().map(|p| [p[0] / p[3], p[1] / p[3]]).collect();
    (0..ndc.len())
        .map(|i| {
            let (a, b) = (ndc[i], ndc[(i + 1) % ndc.len()]);
            (a[0] * b[1] - b[0] * a[1]) / 2.0
        })
        .sum()
}

/// Rows: A3.
#[test]
fn clipped_polygons_lie_inside_and_keep_their_area() {
    const ULP: f32 = f32::EPSILON;
    let mut random = Random::new(11);
    let (mut clipped, mut by_sides) = (0, 0);
    for round in 0..4000 {
        // NDC −257..767 lies within the guard band: vertices of the second reach leave it on all
        // sides.
        let reach = [3.0, 3000.0][round % 2];
        let triangle: Vec<_> = (0..3).map(|_| random_vertex(&mut random, reach)).collect();
        let mut polygon = triangle.clone();
        for (number, plane) in planes().into_iter().enumerate() {
            by_sides += usize::from(number >= 2 && polygon.iter().any(|v| plane.distance(v) < 0.0));
            polygon = clip_polygon_by(plane, &polygon);
        }
        clipped += usize::from(polygon.len() > 3);

        // Inside to 4 ulp of the largest terms of the distances: reach·w or x·scale, 24544·4 at
        // most.
        for vertex in &polygon {
            for plane in planes() {
                let size = if reach > 3.0 { 24_544.0 * 4.0 } else { 4.0 };
                assert!(plane.distance(vertex) >= -4.0 * size * ULP);
            }
        }

        // The same area as in f64, to 4 ulp of each vertex's largest clip coordinate, which the
        // division by w ≥ ¼ may enlarge fourfold, along the perimeter.
        let exact = clip_f64(triangle.iter().map(|v| v.position.map(f64::from)).collect());
        let mine: Vec<_> = polygon.iter().map(|v| v.position.map(f64::from)).collect();
        let across = if reach > 3.0 { 2.0 * 1024.0 } else { 8.0 * 4.0 };
        let bound = across * 4.0 * f64::from(reach.max(4.0)) * f64::from(4.0 * ULP);
        let difference = (ndc_area(&mine) - ndc_area(&exact)).abs();
        assert!(difference <= bound, "{difference:e} > {bound:e}");
    }
    assert!(clipped > 1000, "only {clipped} triangles had to be clipped");
    assert!(by_sides > 1000, "only {by_sides} cuts were by the sides");
}

/// Rows: A3.
#[test]
fn neighbours_share_their_clipped_vertices_to_the_bit() {
    let mut random = Random::new(12);
    let mut shared = 0;
    for round in 0..4000 {
        let reach = [3.0, 1500.0][round % 2];
        let [a, b, c, d]: [ClipVertex; 4] =
            std::array::from_fn(|_| random_vertex(&mut random, reach));
        // The crossings of edge ab are the vertices that both clipped triangles have: no other edge
        // makes them. They must include the ends that clipping the edge as a line gives.
        let left = clip_polygon(&[a.clone(), b.clone(), c], &transform());
        let right = clip_polygon(&[d, b.clone(), a.clone()], &transform());
        let edge = [[a.clone(), b.clone()], [b, a]].map(|ends| clip_line(&ends, &transform()));
        let Some([[start, end], [back_end, back_start]]) =
            edge[0].clone().zip(edge[1].clone()).map(|(x, y)| [x, y])
        else {
            continue;
        };
        assert_eq!(start, back_start);
        assert_eq!(end, back_end);
        for vertex in [&start, &end] {
            assert!(left.contains(vertex), "{vertex:?} is not in {left:?}");
            assert!(right.contains(vertex), "{vertex:?} is not in {right:?}");
        }
        shared += 1;
    }
    assert!(shared > 500);
}

#[test]
fn non_finite_and_invisible_triangles_are_dropped() {
    let seen = [
        [0.0, 0.0, 0.5, 1.0],
        [0.5, 0.0, 0.5, 1.0],
        [0.0, 0.5, 0.5, 1.0],
    ];
    let with = |corner: usize, axis: usize, value: f32| {
        let mut positions = seen;
        positions[corner][axis] = value;
        clip_triangle(&positions.map(|p| clip_vertex(p, &[])), &transform())
    };
    assert_eq!(with(0, 0, 0.0).len(), 1);
    for axis in 0..4 {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(with(1, axis, value).is_empty(), "{value} on axis {axis}");
        }
    }
    // Behind the eye, and w = 0, where the division would fail.
    let behind = seen.map(|[x, y, _, _]| clip_vertex([x, y, -1.0, -1.0], &[]));
    assert!(clip_triangle(&behind, &transform()).is_empty());
    let zeros = [[0.0; 4]; 3].map(|p| clip_vertex(p, &[]));
    assert!(clip_triangle(&zeros, &transform()).is_empty());
    // Beyond the left plane with all vertices, and beyond the guard band.
    let left = seen.map(|[x, y, z, w]| clip_vertex([x - 3000.0, y, z, w], &[]));
    assert!(clip_triangle(&left, &transform()).is_empty());
}

#[test]
fn a_triangle_inside_the_guard_band_is_kept_whole() {
    let wide = [
        [-30.0, 0.0, 0.5, 1.0],
        [30.0, 0.0, 0.5, 1.0],
        [0.0, 30.0, 0.5, 1.0],
    ];
    let kept = clip_triangle(&wide.map(|p| clip_vertex(p, &[])), &transform());
    assert_eq!(kept.len(), 1);
    // Beyond the guard band it is cut one pixel outside the band.
    let wider = wide.map(|[x, y, z, w]| clip_vertex([x * 1000.0, y * 1000.0, z, w], &[]));
    let kept = clip_triangle(&wider, &transform());
    assert_eq!(kept.len(), 2, "the upper half of the square");
    for vertex in kept.iter().flatten() {
        let window = transform().window(vertex.position);
        let reached = (SIDE_MIN - 0.01)..=(SIDE_MAX + 0.01);
        assert!(reached.contains(&window.x) && reached.contains(&window.y));
        assert!(
            [SIDE_MIN, SIDE_MAX]
                .iter()
                .any(|side| (window.x - side).abs() < 0.01)
        );
    }
}

/// Rows: A3.
#[test]
fn an_edge_within_the_guard_band_has_no_crack_where_one_of_its_triangles_leaves_it() {
    let mut random = Random::new(77);
    let bounds = PixelBounds { x: 0..64, y: 0..64 };
    for round in 0..300 {
        // Edge ab crosses the view, c lies far above the band, d below the view but within the
        // band; all edges except ab pass outside the view.
        let a = [random.range(-3.0, -1.1), random.range(-1.0, 1.0)];
        let b = [random.range(1.1, 3.0), random.range(-1.0, 1.0)];
        let (c, d) = ([random.range(-9.0, 9.0), 3000.0], [0.0, -60.0]);
        let w = [1.0, 1.0, 1.0, 1.0].map(|w: f32| {
            if round % 2 == 0 {
                w
            } else {
                random.range(0.5, 2.0)
            }
        });
        let vertex = |p: [f32; 2], w: f32| clip_vertex([p[0] * w, p[1] * w, 0.5 * w, w], &[]);
        let [a, b, c, d] = [
            vertex(a, w[0]),
            vertex(b, w[1]),
            vertex(c, w[2]),
            vertex(d, w[3]),
        ];
        let mut hits = [0; 64 * 64 * 4];
        for triangle in [[a.clone(), b.clone(), c], [a, b, d]] {
            for piece in clip_triangle(&triangle, &transform()) {
                let corners = piece
                    .each_ref()
                    .map(|vertex| transform().place(vertex).snapped);
                for quad in raster::triangle(corners, &bounds, 4) {
                    for lane in 0..4 {
                        let [x, y] = raster::QuadCoverage::pixel(quad.origin, lane);
                        for sample in 0..4 {
                            let is_hit = quad.samples[lane] >> sample & 1;
                            hits[((y * 64 + x) * 4 + sample) as usize] += is_hit;
                        }
                    }
                }
            }
        }
        let wrong = hits.iter().filter(|&&count| count != 1).count();
        assert_eq!(wrong, 0, "samples missed or hit twice in mesh {round}");
    }
}

/// Rows: A3.
#[test]
fn near_crossings_are_where_hand_computation_puts_them() {
    // z from 0.75 to −0.25: the crossing is at three quarters.
    let a = clip_vertex([0.0, 0.0, 0.75, 1.0], &[0.0]);
    let b = clip_vertex([1.0, 0.0, -0.25, 1.0], &[8.0]);
    let [start, end] = clip_line(&[a.clone(), b.clone()], &transform()).expect("half is seen");
    assert_eq!(start, a);
    assert_eq!(end.position, [0.75, 0.0, 0.0, 1.0]);
    assert_eq!(end.varyings, [6.0]);
    let [start, end] = clip_line(&[b, a.clone()], &transform()).expect("half is seen");
    assert_eq!((start.position[0], end), (0.75, a));
}

/// Rows: A3, R4.
#[test]
fn points_are_clipped_by_their_centre() {
    let point = |position| keeps_point(&clip_vertex(position, &[]), &transform());
    assert!(point([1.0, -1.0, 0.0, 1.0]));
    assert!(!point([1.001, 0.0, 0.5, 1.0]));
    assert!(!point([0.0, 0.0, -0.001, 1.0]));
    assert!(!point([0.0, 0.0, 0.0, 0.0]));
    assert!(!point([0.0, 0.0, 0.5, f32::INFINITY]));
}

/// Rows: A2.
#[test]
fn counter_clockwise_as_seen_is_negative_in_the_window_and_positive_in_clip_space() {
    let ccw = [
        [-0.5, -0.5, 0.5, 1.0],
        [0.5, -0.5, 0.5, 1.0],
        [0.0, 0.5, 0.5, 1.0],
    ];
    let snapped = ccw.map(|p| transform().place(&clip_vertex(p, &[])).snapped);
    assert!(doubled_area(snapped) < 0);
    assert!(clip_space_determinant(ccw).0 > 0.0);
    assert_eq!(cull::face(snapped, FrontFace::Ccw), Some(cull::Face::Front));
    assert_eq!(cull::face(snapped, FrontFace::Cw), Some(cull::Face::Back));
    assert!(cull::is_culled(cull::Face::Back, CullMode::Back));
    assert!(!cull::is_culled(cull::Face::Back, CullMode::Front));
}

/// Rows: A2.
#[test]
fn the_clip_space_test_agrees_with_the_snapped_one_beyond_snapping() {
    let mut random = Random::new(13);
    let (mut agreed, mut behind) = (0, 0);
    for _ in 0..3000 {
        // Vertices in front of and behind the eye; near plane at w = ¼ (z = w − ¼, scaled).
        let triangle: [ClipVertex; 3] = std::array::from_fn(|_| {
            let w = random.range(-1.0, 3.0);
            let mut across = || random.range(-1.0, 1.0);
            clip_vertex([across(), across(), (w - 0.25) * 0.5, w], &[])
        });
        let (determinant, bound) =
            clip_space_determinant(triangle.each_ref().map(|vertex| vertex.position));
        assert!(bound < 1e-13);
        for piece in clip_triangle(&triangle, &transform()) {
            let area = doubled_area(piece.each_ref().map(|v| transform().place(v).snapped));
            // Snapping may reverse the winding of pieces of a few subpixels.
            if area.abs() > 20_000 {
                assert_eq!(area < 0, determinant > 0.0);
                agreed += 1;
                behind += usize::from(triangle.iter().any(|v| v.position[3] < 0.0));
            }
        }
    }
    assert!(agreed > 1000 && behind > 300, "{agreed}, {behind}");
}

/// Rows: A4, O2.
#[test]
fn bounds_are_the_pixels_whose_centres_lie_inside() {
    let viewport = Viewport {
        x: 0.5,
        y: -3.0,
        width: 2.0,
        height: 4.6,
        min_depth: 0.0,
        max_depth: 1.0,
    };
    let scissor = |x, y, width, height| ScissorRect {
        x,
        y,
        width,
        height,
    };
    let whole = PixelBounds::new(&viewport, &scissor(0, 0, u32::MAX, u32::MAX), [100, 100], 1);
    assert_eq!((whole.x, whole.y), (0..2, 0..2));
    let cut = PixelBounds::new(&viewport, &scissor(1, 5, 7, 7), [100, 100], 1);
    assert_eq!(cut.x, 1..2);
    assert!(cut.y.is_empty());
}

/// The clip distance of a plane through the view volume, as a shader computes it.
fn plane_distance(normal: [f32; 4], p: [f32; 4]) -> f32 {
    p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] + p[3] * normal[3]
}

/// Rows: A3.
#[test]
fn triangles_clipped_by_distances_lie_inside_and_keep_their_area() {
    let random = &mut Random::new(29);
    let mut clipped = 0;
    for _ in 0..3000 {
        let normals: Vec<[f32; 4]> = (0..3)
            .map(|_| [0, 1, 2, 3].map(|_| random.range(-1.0, 1.0)))
            .collect();
        let triangle = [0, 1, 2].map(|_| {
            let vertex = random_vertex(random, 1.0);
            ClipVertex {
                clip_distances: normals
                    .iter()
                    .map(|&normal| plane_distance(normal, vertex.position))
                    .collect(),
                ..vertex
            }
        });
        let mut polygon = triangle.to_vec();
        let mut exact: Vec<_> = triangle.iter().map(|v| v.position.map(f64::from)).collect();
        for (k, normal) in normals.iter().enumerate() {
            polygon = clip_polygon_by(Plane::Distance(k), &polygon);
            exact = clip_f64_by(normal.map(f64::from), &exact);
        }
        clipped += usize::from(!polygon.is_empty() && polygon.len() != 3);
        // Coordinates are at most 4 and four terms of a distance at most 4 each: to 4 ulp of their
        // sum.
        let bound = 4.0 * 16.0 * f32::EPSILON;
        for vertex in &polygon {
            for (k, &normal) in normals.iter().enumerate() {
                assert!(vertex.clip_distances[k] >= -bound);
                let distance = plane_distance(normal, vertex.position);
                assert!(distance >= -bound, "{distance:e} outside plane {k}");
            }
        }
        let mine: Vec<_> = polygon.iter().map(|v| v.position.map(f64::from)).collect();
        // A plane through a corner may cut it off in only one of the two arithmetics, and the
        // clipped sliver has no area. So only polygons with equally many vertices are compared,
        // which are nearly all.
        if mine.len() == exact.len() && !mine.is_empty() {
            let difference = (ndc_area(&mine) - ndc_area(&exact)).abs();
            // Divided by w ≥ ¼, and moved along cuts at a possibly small angle.
            assert!(
                difference <= 64.0 * 4.0 * f64::from(bound),
                "{difference:e}"
            );
        }
    }
    assert!(clipped > 400, "only {clipped} triangles had to be clipped");
}

/// One pass of Sutherland and Hodgman's loop in f64.
fn clip_f64_by(normal: [f64; 4], polygon: &[[f64; 4]]) -> Vec<[f64; 4]> {
    let distance = |p: &[f64; 4]| (0..4).map(|k| p[k] * normal[k]).sum::<f64>();
    let mut kept = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (da, db) = (distance(a), distance(b));
        if da >= 0.0 {
            kept.push(*a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            let t = da / (da - db);
            kept.push(std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t));
        }
    }
    kept
}

/// Rows: A3.
#[test]
fn neighbours_share_the_crossings_of_clip_distances() {
    let random = &mut Random::new(31);
    for _ in 0..500 {
        let [mut a, mut b] = [0, 1].map(|_| random_vertex(random, 2.0));
        a.clip_distances = vec![random.range(0.0, 3.0)];
        b.clip_distances = vec![random.range(-3.0, -0.001)];
        let crossing = Plane::Distance(0).crossing(&a, &b);
        for edge in [[a.clone(), b.clone()], [b.clone(), a.clone()]] {
            let kept = clip_polygon_by(
                Plane::Distance(0),
                &[edge[0].clone(), edge[1].clone(), b.clone()],
            );
            assert!(kept.contains(&crossing));
        }
        assert_eq!(crossing.clip_distances, [0.0]);
    }
}

/// Rows: A3.
#[test]
fn cull_distances_drop_what_is_wholly_outside_one() {
    let vertex = |distances: &[f32]| ClipVertex {
        cull_distances: distances.to_vec(),
        ..clip_vertex([0.0, 0.0, 0.5, 1.0], &[])
    };
    let is_distant = |vertices: &[ClipVertex]| crate::clip::is_distant(vertices);
    assert!(is_distant(&[vertex(&[1.0, -1.0]), vertex(&[-1.0, -0.1])]));
    assert!(!is_distant(&[vertex(&[1.0, -1.0]), vertex(&[-1.0, 0.0])]));
    assert!(!is_distant(&[vertex(&[f32::NAN]), vertex(&[-1.0])]));
    assert!(!is_distant(&[vertex(&[])]));
}

/// Rows: A3.
#[test]
fn without_depth_clipping_w_is_clipped_instead() {
    let open = transform().with_unclipped_depth(true);
    // Far beyond near and far: not clipped.
    let far = [
        [0.0, 0.0, -9.0, 1.0],
        [1.0, 0.0, 70.0, 1.0],
        [0.0, 1.0, 0.5, 1.0],
    ]
    .map(|p| clip_vertex(p, &[]));
    assert_eq!(clip_triangle(&far, &open), std::slice::from_ref(&far));
    // Through the eye: cut at the least w, to which w is set.
    let eye = [
        [0.0, 0.0, 0.5, 1.0],
        [0.1, 0.0, 0.5, -1.0],
        [0.0, 0.1, 0.5, 1.0],
    ]
    .map(|p| clip_vertex(p, &[]));
    let pieces = clip_triangle(&eye, &open);
    assert!(!pieces.is_empty());
    let least = crate::viewport::LEAST_W;
    assert!(pieces.iter().flatten().all(|v| v.position[3] >= least));
    assert!(keeps_point(&far[1], &open) && !keeps_point(&far[1], &transform()));
    // Huge depths stay finite.
    let z = open.window([0.0, 0.0, f32::MAX, least]).z;
    assert_eq!(z, crate::viewport::FARTHEST);
}
