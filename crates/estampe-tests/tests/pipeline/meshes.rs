//! Meshes: shared edges, perspective, clipping, and invariants of every triangulation.

use estampe_tests::geometry::{Vertex, clip_at, values};
use estampe_tests::shaders::{Colored, Probe, Uniform};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check, check_one};
use estampe_types::state::{BlendState, CullMode};
use estampe_types::{Bindings, BoundGroup, BoundResource, BoundResources, BufferData, IndexFormat};
use std::sync::Arc;

/// Indices of the 2·(n − 1)² triangles of a grid of n × n vertices, wound alike.
fn grid_indices(n: u32) -> Vec<u32> {
    let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
    cells
        .flat_map(|at| [at, at + n, at + 1, at + 1, at + n, at + n + 1])
        .collect()
}

fn with_indices(shader: impl Into<TestShader>, vertices: &[Vertex], indices: &[u32]) -> CaseDraw {
    CaseDraw {
        indices: Some((IndexFormat::Uint32, BufferData::from_words(indices))),
        elements: 0..u32::try_from(indices.len()).expect("few indices"),
        ..CaseDraw::new(shader, vertices)
    }
}

/// A wavy, nearly level grid in front of, below and behind the eye.
fn perspective_grid(random: &mut Random, n: u32) -> Vec<Vertex> {
    let (near, far) = (0.1, 20.0);
    let [turn, height, reach] = [
        random.range(-1.0, 1.0),
        random.range(-0.9, -0.1),
        random.pick(&[1.0, 8.0, 300.0]),
    ];
    let place = |at: u32| at as f32 / (n - 1) as f32 * 2.0 - 1.0;
    (0..n * n)
        .map(|at| {
            let (u, v) = (place(at % n), place(at / n));
            let bump = random.range(-0.1, 0.1);
            let (x, z) = (u * reach + v * turn, v * reach - u * turn);
            // Looking down −z, w = −z.
            let w = -z;
            Vertex {
                position: [x * 1.5, height + bump, far / (far - near) * (w - near), w],
                values: [u, v, u * v, bump * 10.0],
            }
        })
        .collect()
}

/// Rows: A3, R5.
#[test]
fn perspective_grids_across_the_near_plane_and_the_eye() {
    check("meshes/perspective", 16, |random| {
        let mut case = Case::random_target(random);
        let n = random.pick(&[2, 5, 9]);
        let vertices = perspective_grid(random, n);
        case.draws.push(with_indices(
            Probe::random(random),
            &vertices,
            &grid_indices(n),
        ));
        case
    });
}

/// Rows: R1, R5.
#[test]
fn ridged_grids_of_small_triangles() {
    check("meshes/small", 8, |random| {
        let mut case = Case::new([96, 70], random.pick(&[1, 4]));
        let n = 34;
        let vertices: Vec<_> = (0..n * n)
            .map(|at| {
                let jitter = [random.range(-1.0, 1.0), random.range(-1.0, 1.0)];
                let (x, y) = ((at % n) as f32 * 3.1, (at / n) as f32 * 2.2);
                let place = [x + jitter[0], y + jitter[1]];
                let w = 1.0 + (at % n) as f32 * 0.125;
                Vertex {
                    position: clip_at(case.size, place, random.unit(), w),
                    values: values(random),
                }
            })
            .collect();
        let mut draw = with_indices(Probe::random(random), &vertices, &grid_indices(n));
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
        case.draws.push(draw);
        case
    });
}

/// A case in which additive blending adds one unit to a sample for each triangle that covers it.
fn counting(size: [u32; 2], samples: u32, mut draw: CaseDraw, unit: [f32; 8]) -> Case {
    let group = BoundResources {
        entries: vec![(
            0,
            BoundResource::Buffer {
                buffer: BufferData::from_f32s(&unit),
                offset: 0,
                size: u32::MAX,
                dynamic_offset: None,
            },
        )],
    };
    draw.bindings = Bindings {
        groups: vec![BoundGroup {
            group: Arc::new(group),
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    };
    draw.blend = Some(BlendState::ADDITIVE);
    draw.depth = None;
    let mut case = Case::new(size, samples);
    case.draws.push(draw);
    case
}

const UNIT: f32 = 1.0 / 255.0;

/// Rows: R1, R6.
#[test]
fn a_planar_triangulation_covers_each_sample_once() {
    for seed in 0..12 {
        let random = &mut Random::new("meshes/once", seed);
        let size = random.pick(&[[48, 48], [65, 37], [130, 20]]);
        let (width, height) = (size[0] as f32, size[1] as f32);
        // The outer ring of vertices lies outside the target, sometimes far outside the guard band.
        // Inner vertices are moved by less than a quarter of a cell, which reverses no triangle,
        // often onto pixel centres.
        let n = random.pick(&[3, 6, 12]);
        let out = random.pick(&[5.0, 9000.0, 90_000.0]);
        let grid = random.pick(&[2.0, 256.0]);
        let vertices: Vec<_> = (0..n * n)
            .map(|at| {
                let is_outer = |at: u32| at == 0 || at == n - 1;
                let is_in_ring = is_outer(at % n) || is_outer(at / n);
                let mut place = |at: u32, length: f32| {
                    let cell = length / (n - 1) as f32;
                    match at {
                        0 => -out * random.range(1.0, 1.5),
                        at if is_outer(at) => length + out * random.range(1.0, 1.5),
                        at if is_in_ring => at as f32 * cell,
                        at => {
                            let moved = (at as f32 + random.range(-0.2, 0.2)) * cell;
                            (moved * grid).round() / grid
                        }
                    }
                };
                let place = [place(at % n, width), place(at / n, height)];
                let w = random.pick(&[1.0, 1.0, 0.25, 3.0]);
                Vertex {
                    position: clip_at(size, place, 0.5, w),
                    values: [0.0; 4],
                }
            })
            .collect();
        let draw = with_indices(Uniform, &vertices, &grid_indices(n));
        let samples = random.pick(&[1, 4]);
        let case = counting(size, samples, draw, [UNIT; 8]);
        let image = check_one("meshes/once", &case);
        let wrong = image.color.iter().filter(|&&count| count != 1).count();
        assert_eq!(wrong, 0, "seed {seed}:\n{}", case.describe());
    }
}

/// Rows: A2, R1.
#[test]
fn of_a_closed_mesh_every_sample_has_as_many_front_as_back_hits() {
    for seed in 0..12 {
        let random = &mut Random::new("meshes/closed", seed);
        let size = random.pick(&[[48, 48], [65, 37]]);
        // A sphere of n × n vertices, displaced at random: it may fold and intersect itself. Its
        // last column is the first, and its first and last row are poles.
        let n = 9;
        let folded = random.pick(&[0.0, 0.6]);
        let around: Vec<_> = (0..n * n)
            .map(|at| {
                let (column, row) = (at % (n - 1), at / n);
                let (rise, radius) = (row as f32 / (n - 1) as f32 * 2.0 - 1.0, ring(row, n));
                let [east, north] = [octant(column), octant(column + 2)];
                [east * radius, rise, north * radius, 0.0]
            })
            .collect();
        let pulls: Vec<_> = (0..n * n).map(|_| random.four(-folded, folded)).collect();
        let scale = random.pick(&[0.5, 1.2, 40.0]);
        let vertices: Vec<_> = (0..n * n)
            .map(|at| {
                // Columns 0 and 8 are one, and all vertices of a pole are one vertex.
                let row = at / n;
                let same = match row {
                    0 => 0,
                    8 => 8 * n,
                    _ => row * n + at % n % (n - 1),
                };
                let (p, pull) = (around[same as usize], pulls[same as usize]);
                let [x, y, z] = [0, 1, 2].map(|axis: usize| (p[axis] + pull[axis]) * scale);
                let w = 2.0 + z * 0.4 / scale;
                Vertex {
                    position: [x, y, w * 0.5, w],
                    values: [0.0; 4],
                }
            })
            .collect();
        let draw = with_indices(Uniform, &vertices, &grid_indices(n));
        let unit = [UNIT, 0.0, 0.0, 0.0, 0.0, UNIT, 0.0, 0.0];
        let samples = random.pick(&[1, 4]);
        let image = check_one("meshes/closed", &counting(size, samples, draw, unit));
        // The mean of four samples rounds fronts and backs equally.
        let mut hits = 0;
        for pixel in image.color.chunks(4) {
            assert_eq!(pixel[0], pixel[1], "seed {seed}: front and back hits");
            hits += u32::from(pixel[0]);
        }
        assert!(hits > 10, "seed {seed}: nothing was drawn");
    }
}

/// The radius of a row of the sphere.
fn ring(row: u32, n: u32) -> f32 {
    let rise = row as f32 / (n - 1) as f32 * 2.0 - 1.0;
    (1.0 - rise * rise).sqrt()
}

/// The cosine of a multiple of 45°.
fn octant(step: u32) -> f32 {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    [1.0, half, 0.0, -half, -1.0, -half, 0.0, half][step as usize % 8]
}

/// Rows: R1, R5.
#[test]
fn the_order_of_a_triangles_vertices_changes_nothing() {
    for seed in 0..24 {
        let random = &mut Random::new("meshes/order", seed);
        let size = [40, 31];
        let style = random.pick(&[
            estampe_tests::geometry::Style::Small,
            estampe_tests::geometry::Style::Large,
            estampe_tests::geometry::Style::Sliver,
        ]);
        let [a, b, c] = estampe_tests::geometry::triangle(random, style, size);
        let orders = [
            [a, b, c],
            [b, c, a],
            [c, a, b],
            [a, c, b],
            [c, b, a],
            [b, a, c],
        ];
        let samples = random.pick(&[1, 4]);
        let images = orders.map(|vertices| {
            let mut case = Case::new(size, samples);
            case.draws.push(CaseDraw::new(Colored, &vertices));
            check_one("meshes/order", &case)
        });
        for image in &images {
            assert_eq!(*image, images[0], "seed {seed}");
        }
    }
}

/// Rows: A3, R1.
#[test]
fn two_triangles_of_which_one_leaves_the_guard_band_share_their_edge() {
    // The edge lies within the band and crosses the view; one triangle reaches far outside the
    // band.
    for seed in 0..24 {
        let random = &mut Random::new("meshes/crack", seed);
        let a = [random.range(-3.0, -1.1), random.range(-1.0, 1.0)];
        let b = [random.range(1.1, 3.0), random.range(-1.0, 1.0)];
        let corners = [a, b, [0.0, 3000.0], a, b, [0.0, -60.0]];
        let vertices = corners.map(|[x, y]| Vertex {
            position: [x, y, 0.5, 1.0],
            values: [0.0; 4],
        });
        let draw = CaseDraw::new(Uniform, &vertices);
        let image = check_one("meshes/crack", &counting([64, 64], 4, draw, [UNIT; 8]));
        assert!(image.color.iter().all(|&count| count == 1), "seed {seed}");
    }
}
