//! Many small triangles: listed pixels, fragments that share packets across triangles, and edges
//! that are set up sixteen at a time.

use estampe::{Level, TilePath};
use estampe_simd::SquareLoads;
use estampe_tests::geometry::{Style, Vertex, clip_at, triangles};
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::shaders::{Colored, Cutout, FlatColored, Gradients, Halved, Probe, Scalar};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{BlendState, CompareFunction, CullMode, DepthState, ScissorRect};

/// Triangles of a few pixels, some drawn twice at the same depths, so that only their order tells
/// which is visible; in between a few larger ones.
fn case(random: &mut Random, shader: TestShader, size: [u32; 2], samples: u32) -> Case {
    let mut case = Case::new(size, samples);
    for _ in 0..2 {
        let mut vertices = Vec::new();
        for _ in 0..6 {
            let style = random.pick(&[Style::Small, Style::Tiny, Style::OnGrid]);
            let some = triangles(random, style, case.size, 40);
            vertices.extend_from_slice(&some);
            if random.once_in(2) {
                let mut others = triangles(random, style, case.size, 40);
                for (other, vertex) in others.iter_mut().zip(&some) {
                    other.position = vertex.position;
                }
                vertices.extend(others);
            }
            if random.once_in(3) {
                vertices.extend(triangles(random, Style::Large, case.size, 2));
            }
        }
        let mut draw = CaseDraw::new(shader.clone(), &vertices);
        let compare = random.pick(&[
            CompareFunction::Less,
            CompareFunction::Less,
            CompareFunction::LessEqual,
            CompareFunction::Always,
        ]);
        draw.depth = Some(DepthState {
            compare,
            write_enabled: !random.once_in(4),
        });
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
        draw.is_counted = random.once_in(4);
        case.draws.push(draw);
    }
    case
}

/// Rows: R1, O3.
#[test]
fn fragments_of_small_triangles_fill_packets() {
    let statistics = check_paths(
        "small_triangles/across",
        12,
        ExpectedPaths::default(),
        |random| {
            let shader = match random.below(2) {
                0 => Colored.into(),
                _ => Halved.into(),
            };
            case(random, shader, [150, 100], 1)
        },
    );
    let pixels = statistics.small_triangle_pixels;
    assert!(pixels > 0, "no pixels of small triangles were listed");
    let [fragments, packets] = statistics.fragments_across_triangles;
    // The last packet of a run is not full, and the runs are short. With one lane for each
    // triangle, half of the lanes and more would be empty.
    assert!(
        packets > 0 && fragments > packets * 10,
        "{fragments} fragments are in {packets} packets"
    );
}

/// Rows: R1, R6, O3.
#[test]
fn small_triangles_have_ids_where_their_shader_takes_derivatives() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/ids_{samples}");
        let statistics = check_paths(&topic, 12, ExpectedPaths::default(), |random| {
            let shader = match random.below(3) {
                0 => FlatColored.into(),
                _ => Probe::random(random).into(),
            };
            case(random, shader, [150, 100], samples)
        });
        let listed = statistics.small_triangle_pixels;
        assert!(listed > 0, "no samples of small triangles were listed");
    }
}

/// Rows: R1, R6.
#[test]
fn edges_of_a_packets_triangles_are_set_up_together() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/edges_{samples}");
        let statistics = check_paths(&topic, 8, ExpectedPaths::default(), |random| {
            // No triangle has 64 pixels in a row, so that nearly all are set up so.
            let mut case = case(random, Colored.into(), [60, 50], samples);
            let vertices = triangles(random, Style::Large, case.size, 24);
            case.draws.push(CaseDraw::new(Colored, &vertices));
            case
        });
        assert!(
            statistics.triangles_set_up_in_lanes > 0,
            "no edges were set up sixteen at a time"
        );
    }
}

/// Positions that are gathered in pairs, whatever a measurement chose for this processor: both ways
/// give the same bits, so that other tests do not notice.
///
/// Rows: A1, A2.
#[test]
fn positions_of_triangles_are_gathered_in_pairs() {
    let levels = Level::all_available();
    for level in &levels {
        level.set_square_loads(SquareLoads::Gathers);
    }
    let topic = "small_triangles/pairs";
    let statistics = check_paths(topic, 8, ExpectedPaths::default(), |random| {
        let mut case = case(random, Colored.into(), [60, 50], 1);
        let vertices = triangles(random, Style::AroundEye, case.size, 24);
        case.draws.push(CaseDraw::new(Colored, &vertices));
        case
    });
    let gathers = levels.iter().any(|level| level.name() == "avx512");
    assert_eq!(statistics.triangles_gathered_in_pairs > 0, gathers);
}

/// Rows: R1, R6, O3, O4, O5, O9.
#[test]
fn pixels_of_small_triangles_in_order_fill_packets() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/in_order_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 8, paths, |random| {
            let shader = match random.below(6) {
                0 => Colored.into(),
                1 => Cutout.into(),
                2 => Gradients::random(random).into(),
                // Several varyings, one of them flat; inputs that are no varyings.
                _ => Probe(random.pick(&[
                    Scalar::Smooth,
                    Scalar::NoPerspective,
                    Scalar::Flat,
                    Scalar::X,
                    Scalar::Y,
                    Scalar::Z,
                    Scalar::InverseW,
                    Scalar::FrontFacing,
                ]))
                .into(),
            };
            let mut case = case(random, shader, [150, 100], samples);
            for draw in &mut case.draws {
                draw.blend = Some(random.pick(&[
                    BlendState::ALPHA_BLENDING,
                    BlendState::ADDITIVE,
                    BlendState::PREMULTIPLIED_ALPHA_BLENDING,
                ]));
            }
            case
        });
        let [fragments, packets] = statistics.fragments_listed_in_order;
        // Packets end before a pixel that comes again, and here triangles lie over each other. One
        // by one, each triangle would begin a packet for its two pixels or three.
        assert!(
            packets > 0 && fragments > packets * 7,
            "{samples} samples: {fragments} fragments are in {packets} packets"
        );
    }
}

/// Every state over lists: stencils, depths that are written early and late, formats of one word
/// and of several, several targets, masks, queries, large triangles in between.
///
/// Rows: R1, R6, O1, O3, O4, O5, O7, O8, O9, O10.
#[test]
fn lists_of_pixels_pass_through_every_state() {
    use TextureFormat as F;
    for samples in [1, 4] {
        let topic = format!("small_triangles/states_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 30, paths, |random| {
            let formats = [F::Rgba8Unorm, F::Bgra8UnormSrgb, F::Rgba16Float, F::R8Unorm];
            let mut targets = vec![random.pick(&formats)];
            if random.once_in(4) {
                targets.push(random.pick(&formats));
            }
            let depth = random.pick(&[
                None,
                Some(F::Depth32Float),
                Some(F::Depth16Unorm),
                Some(F::Depth24PlusStencil8),
                Some(F::Stencil8),
            ]);
            let mixture = Mixture {
                styles: vec![Style::Small, Style::Tiny, Style::OnGrid, Style::Large],
                triangles: 150,
                draws: 3,
                ..Mixture::new(&targets, depth, samples)
            };
            mixture.case(random)
        });
        let [fragments, packets] = statistics.fragments_listed_in_order;
        assert!(
            packets > 100 && fragments > packets * 4,
            "{samples} samples: {fragments} fragments are in {packets} packets"
        );
    }
}

/// Triangles of up to sixteen pixels across are listed as quarters of their boxes, by pixels and by
/// quads; those that are a little larger are drawn alone.
///
/// Rows: R1, R6, O5.
#[test]
fn middling_triangles_in_order_are_divided() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/quarters_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 24, paths, |random| {
            let mut case = Case::new([150, 100], samples);
            for _ in 0..2 {
                let mut vertices = triangles(random, Style::Small, case.size, 60);
                for corners in vertices.chunks_exact_mut(3) {
                    let middle = [random.range(0.0, 150.0), random.range(0.0, 100.0)];
                    let reach = random.pick(&[4.0, 5.0, 6.0, 7.0, 7.9, 8.2, 14.0]);
                    for corner in corners {
                        let at = middle.map(|at| at + random.range(-reach, reach));
                        let [_, _, z, w] = corner.position;
                        corner.position = clip_at(case.size, at, z / w, w);
                    }
                }
                let shader: TestShader = match random.below(3) {
                    0 => Colored.into(),
                    1 => Cutout.into(),
                    _ => Probe::random(random).into(),
                };
                let mut draw = CaseDraw::new(shader, &vertices);
                draw.blend = Some(BlendState::ADDITIVE);
                case.draws.push(draw);
            }
            case
        });
        let [fragments, packets] = statistics.fragments_listed_in_order;
        assert!(
            packets > 0 && fragments > packets * 8,
            "{samples} samples: {fragments} fragments are in {packets} packets"
        );
        let planes = statistics.planes_in_lanes;
        assert!(
            planes > 20,
            "{samples} samples: {planes} planes were made together"
        );
    }
}

/// Two triangles of a box with level sides, in any order and from any corner, whose values change
/// along x, along y, or not; now and then not quite so.
fn sprite(random: &mut Random, size: [u32; 2]) -> [Vertex; 6] {
    let grid = random.pick(&[1.0, 2.0, 16.0, 256.0]);
    let mut at = |least: f32, most: f32| (random.range(least, most) * grid).round() / grid;
    let [x, y] = [at(-4.0, 150.0), at(-4.0, 100.0)];
    let most = random.pick(&[18.0, 18.0, 18.0, 70.0]);
    let mut at = |least: f32, most: f32| (random.range(least, most) * grid).round() / grid;
    let [mut right, bottom] = [x + at(0.5, most), y + at(0.5, most)];
    let w = random.pick(&[1.0, 1.0, 0.3, 7.0]);
    let depth = random.range(0.0, 1.0);
    let mut corners = [[0.0; 4]; 4];
    let is_odd = random.once_in(4);
    for channel in 0..4 {
        let [mut a, mut b] = [random.range(0.0, 1.0), random.range(0.0, 1.0)];
        if is_odd {
            [a, b] = random.pick(&[[a, b], [-0.0, b], [0.0, -0.0], [a, f32::NAN]]);
        }
        let of_corners = match random.below(8) {
            0..3 => [a, b, a, b],
            3..6 => [a, a, b, b],
            6 if is_odd => [a, a, a, b],
            7 if is_odd => [a, b, b, a],
            _ => [a; 4],
        };
        for (corner, value) in corners.iter_mut().zip(of_corners) {
            corner[channel] = value;
        }
    }
    let mut places = [[x, y], [right, y], [x, bottom], [right, bottom]];
    if random.once_in(8) {
        right += 1.0 / 256.0;
        places[3] = [right, bottom];
    }
    let mut vertices = [0, 1, 2, 3].map(|corner: usize| Vertex {
        position: clip_at(size, places[corner], depth, w),
        values: corners[corner],
    });
    if random.once_in(8) {
        vertices[1].position[2] *= 0.9;
    }
    let order = match random.below(5) {
        0 => [0, 1, 3, 0, 3, 2],
        1 => [0, 2, 3, 0, 3, 1],
        2 => [3, 0, 1, 3, 0, 2],
        3 => [1, 3, 0, 3, 2, 0],
        _ => [0, 1, 2, 1, 2, 3],
    };
    order.map(|corner| vertices[corner])
}

/// Sprites, which are drawn as boxes where both triangles have the same planes, in draws that
/// differ in scissors alone.
///
/// Rows: R1, R6, O5, O9.
#[test]
fn rectangles_in_order_are_boxes() {
    for samples in [1, 4] {
        let topic = format!("small_triangles/rectangles_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 24, paths, |random| {
            let mut case = Case::new([150, 100], samples);
            let shader: TestShader = match random.below(6) {
                0 => Colored.into(),
                1 => Cutout.into(),
                2 => Gradients::random(random).into(),
                3 => Halved.into(),
                _ => Probe::random(random).into(),
            };
            let mut draw = CaseDraw::new(shader, &[]);
            draw.blend = Some(random.pick(&[
                BlendState::ADDITIVE,
                BlendState::PREMULTIPLIED_ALPHA_BLENDING,
            ]));
            draw.depth = random.once_in(2).then_some(DepthState {
                compare: CompareFunction::LessEqual,
                write_enabled: random.once_in(2),
            });
            draw.is_counted = random.once_in(6);
            for _ in 0..3 {
                let mut vertices = Vec::new();
                for _ in 0..40 {
                    vertices.extend(sprite(random, case.size));
                    if random.once_in(4) {
                        vertices.extend(triangles(random, Style::Small, case.size, 1));
                    }
                }
                let of_vertices = CaseDraw::new(Colored, &vertices);
                let scissor = random.once_in(2).then(|| ScissorRect {
                    x: random.below(40),
                    y: random.below(30),
                    width: 80,
                    height: 60,
                });
                case.draws.push(CaseDraw {
                    buffers: of_vertices.buffers,
                    elements: of_vertices.elements,
                    scissor,
                    ..draw.clone()
                });
            }
            case
        });
        let (rectangles, kept) = (statistics.rectangles_in_order, statistics.queues_kept);
        let boxes = statistics.boxes_in_order;
        for counted in [rectangles, boxes] {
            assert!(
                (counted > 100) == (samples == 1),
                "{samples} samples: {rectangles} rectangles, {boxes} of them alone"
            );
        }
        assert!(kept > 10, "{samples} samples: {kept} runs shared a queue");
    }
}

/// Sprites whose triangles are blended from their planes where they cover blocks.
///
/// Rows: R1, O5.
#[test]
fn rectangles_that_cover_blocks_are_two_triangles() {
    let paths = ExpectedPaths(&[TilePath::InOrderBlocks]);
    let statistics = check_paths("small_triangles/blocks", 24, paths, |random| {
        let mut case = Case::new([150, 100], 1);
        let mut vertices = Vec::new();
        for _ in 0..60 {
            vertices.extend(sprite(random, case.size));
        }
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.blend = Some(BlendState::ALPHA_BLENDING);
        case.draws.push(draw);
        case
    });
    assert!(statistics.rectangles_in_order > 100);
    assert_eq!(statistics.boxes_in_order, 0);
}
