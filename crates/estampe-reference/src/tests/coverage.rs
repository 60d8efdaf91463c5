//! Triangle coverage: fill rule, watertightness, independence of the order of vertices.

use super::*;
use crate::raster::{Edge, triangle};
use crate::viewport::PixelBounds;

fn bounds(width: u32, height: u32) -> PixelBounds {
    PixelBounds {
        x: 0..width,
        y: 0..height,
    }
}

/// The number of triangles that cover each sample.
fn hits(triangles: &[[[i32; 2]; 3]], width: u32, height: u32, samples: u32) -> Vec<u32> {
    let mut hits = vec![0; (width * height * samples) as usize];
    for &corners in triangles {
        for quad in triangle(corners, &bounds(width, height), samples) {
            for lane in 0..4 {
                let [x, y] = raster::QuadCoverage::pixel(quad.origin, lane);
                for s in 0..samples {
                    if quad.samples[lane] >> s & 1 == 1 {
                        hits[((y * width + x) * samples + s) as usize] += 1;
                    }
                }
            }
        }
    }
    hits
}

/// Rows: R1.
#[test]
fn top_and_left_edges_keep_their_samples_and_others_do_not() {
    // A square of 2 pixels whose corners lie on the centres of pixels 0 and 2: only the samples of
    // its top and left edges belong to it.
    let [a, b, c, d] = [[128, 128], [640, 128], [640, 640], [128, 640]];
    let covered = hits(&[[a, b, c], [a, c, d]], 3, 3, 1);
    assert_eq!(covered, [1, 1, 0, 1, 1, 0, 0, 0, 0]);

    // The fill rule of each edge: the triangle is clockwise in y-down coordinates (D > 0).
    assert!(Edge::new([0, 0], [9, 0]).is_top_or_left(), "top");
    assert!(!Edge::new([9, 9], [0, 9]).is_top_or_left(), "bottom");
    assert!(Edge::new([0, 9], [0, 0]).is_top_or_left(), "left");
    assert!(!Edge::new([9, 0], [9, 9]).is_top_or_left(), "right");
    assert_eq!(Edge::new([0, 0], [9, 0]).function([3, 2]), 18);
}

/// Rows: R6.
#[test]
fn multisample_positions_are_vulkans() {
    // A triangle far larger than the pixel, whose vertical right edge is at x = 0.5 pixel: samples
    // 0 (6/16) and 2 (2/16) are left of it.
    let corners = [[128, -1000], [128, 2000], [-5000, 256]];
    let quads = triangle(corners, &bounds(1, 1), 4);
    assert_eq!(quads.len(), 1);
    assert_eq!(quads[0].samples, [0b0101, 0, 0, 0]);
    // A sample that lies on a right edge is not covered: x = 6/16 pixel = 96.
    let corners = corners.map(|[x, y]| [Ord::min(x, 96), y]);
    assert_eq!(triangle(corners, &bounds(1, 1), 4)[0].samples[0], 0b0100);
}

/// A grid of jittered vertices larger than the target, cut into triangles of random winding.
fn random_triangulation(random: &mut Random, cell: i32, jitter: u32) -> Vec<[[i32; 2]; 3]> {
    let columns = 64 * 256 / cell + 3;
    let side = columns as usize + 1;
    let mut vertices = Vec::new();
    for y in 0..=columns {
        for x in 0..=columns {
            let mut offset = || random.below(jitter) as i32;
            vertices.push([(x - 1) * cell + offset(), (y - 1) * cell + offset()]);
        }
    }
    let mut triangles = Vec::new();
    for y in 0..side - 1 {
        for x in 0..side - 1 {
            let corner = |dx, dy| vertices[(y + dy) * side + x + dx];
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let pair = if random.below(2) == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            for mut corners in pair {
                corners.rotate_left(random.below(3) as usize);
                if random.below(2) == 0 {
                    corners.swap(0, 1);
                }
                triangles.push(corners);
            }
        }
    }
    triangles
}

/// Rows: R1, R6.
#[test]
fn a_planar_triangulation_covers_each_sample_once() {
    let mut random = Random::new(1);
    // Cells of many pixels, of one, and of less than one; the jitter keeps every cell convex. With
    // a jitter of 1 all vertices lie on pixel corners, with an offset of half a pixel on samples.
    for (cell, jitter) in [(3000, 900), (256, 70), (97, 25), (512, 1)] {
        for shift in [0, 128] {
            let mut triangles = random_triangulation(&mut random, cell, jitter);
            for corner in triangles.iter_mut().flatten() {
                *corner = corner.map(|at| at + shift - 128);
            }
            for samples in [1, 4] {
                let hits = hits(&triangles, 64, 64, samples);
                let wrong = hits.iter().filter(|&&count| count != 1).count();
                assert_eq!(wrong, 0, "cell {cell}, shift {shift}, {samples} samples");
            }
        }
    }
}

/// Rows: R1, R5.
#[test]
fn the_order_of_vertices_changes_no_bit() {
    let mut random = Random::new(2);
    let state = State {
        depth: Some(DepthState::LESS_WRITE),
        ..State::new(32, 32)
    };
    for _ in 0..200 {
        let flat = random.unit();
        let vertices: [Vertex; 3] = std::array::from_fn(|_| {
            let w = random.range(0.5, 4.0);
            let place = [random.range(-1.5, 1.5), random.range(-1.5, 1.5)];
            let position = [place[0] * w, place[1] * w, random.unit() * w, w];
            (position, [random.unit(), random.unit(), flat])
        });
        let mut images = Vec::new();
        for [a, b, c] in [
            [0, 1, 2],
            [1, 2, 0],
            [2, 0, 1],
            [0, 2, 1],
            [2, 1, 0],
            [1, 0, 2],
        ] {
            let mut target = unorm(32, 32, 4);
            draw_plain(
                &mut target,
                &state,
                &[vertices[a], vertices[b], vertices[c]],
            );
            images.push((target.color.clone(), target.depth.map_bits()));
        }
        assert!(images.windows(2).all(|pair| pair[0] == pair[1]));
    }
}

trait MapBits {
    fn map_bits(&self) -> Vec<u32>;
}

impl MapBits for Vec<f32> {
    fn map_bits(&self) -> Vec<u32> {
        self.iter().map(|value| value.to_bits()).collect()
    }
}

/// Rows: R1.
#[test]
fn degenerate_triangles_cover_nothing_and_huge_ones_do_not_overflow() {
    let mut target = unorm(8, 8, 1);
    let line =
        [(1.0, 1.0), (4.0, 4.0), (7.0, 7.0)].map(|(x, y)| (at(&target, x, y, 0.0), [1.0; 3]));
    let counts = draw_plain(&mut target, &State::new(8, 8), &line);
    assert_eq!((counts.primitives, counts.rasterized), (1, 0));

    // The corners of the guard band.
    let (low, high) = (-8192 * 256, 24_575 * 256);
    let covered = hits(&[[[low, low], [high, low], [low, high]]], 4, 4, 4);
    assert!(covered.iter().all(|&count| count == 1));
}

/// Rows: A2, R1.
#[test]
fn a_closed_mesh_shows_each_sample_as_many_fronts_as_backs() {
    /// Adds 1/255 to red for each covered sample.
    struct Count;
    estampe_types::shader! {
        impl Shader for Count {
            type Attributes<R: Real> = Vec4<R>;
            type Varyings<R: Real> = ();

            fn vertex<R: Real>(
                &self,
                _input: shader::VertexIn<'_, R>,
                position: Vec4<R>,
            ) -> shader::VertexOut<R, ()> {
                shader::VertexOut::new(position, ())
            }

            fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _varyings: ()) -> FragmentOut<R> {
                FragmentOut::color(Vec4::repeat(input.real(1.0 / 255.0)))
            }
        }
    }
    let mut random = Random::new(3);
    let mut seen = 0;
    for _ in 0..60 {
        // A tetrahedron with its faces wound alike, partly outside the window.
        let corners: [[f32; 4]; 4] = std::array::from_fn(|_| {
            let w = random.range(1.0, 3.0);
            let mut across = || random.range(-1.4, 1.4) * w;
            [across(), across(), 0.5 * w, w]
        });
        let vertices: Vec<Vertex> = [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0]
            .map(|corner: usize| (corners[corner], [0.0; 3]))
            .to_vec();
        let images = [CullMode::Front, CullMode::Back].map(|cull_mode| {
            let mut target = unorm(24, 24, 4);
            let state = State {
                targets: vec![TargetState {
                    blend: Some(BlendState::ADDITIVE),
                    ..TargetState::default()
                }],
                primitive: PrimitiveState {
                    cull_mode,
                    ..PrimitiveState::default()
                },
                ..State::new(24, 24)
            };
            draw_with(&mut target, &Count, &state, &vertices);
            target.color
        });
        assert_eq!(images[0], images[1]);
        seen += images[0].iter().filter(|code| code[0] > 0).count();
    }
    assert!(seen > 10_000, "the meshes must be seen: {seen} samples");
}
