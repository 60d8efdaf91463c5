//! Many small lines in order: listed pixels and quads, lines in two halves, lines that are drawn
//! alone in between.

use estampe::TilePath;
use estampe_tests::geometry::{Style, Vertex, clip_at, triangles, values};
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::shaders::{Colored, Cutout, FlatColored, Gradients, Probe, Scalar};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendState, CompareFunction, DepthState, LineRasterization, LineState, PolygonMode,
    PrimitiveTopology, ProvokingVertex, ScissorRect,
};

/// The target's size: two tiles and parts of two others.
const SIZE: [u32; 2] = [100, 70];

fn line_state(random: &mut Random) -> LineState {
    LineState {
        width: random.pick(&[0.3, 1.0, 1.0, 1.0, 1.0, 1.4, 2.0, 3.6]),
        rasterization: random.pick(&[LineRasterization::Bresenham, LineRasterization::Rectangular]),
        stipple: None,
    }
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(6) {
        0 => Colored.into(),
        1 => Cutout.into(),
        2 => FlatColored.into(),
        3 => Gradients::random(random).into(),
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
    }
}

/// The ends of lines, each some way from the one before: often along an axis, a diagonal or the
/// centres of pixels.
fn ends(random: &mut Random, count: usize) -> Vec<Vertex> {
    let mut at = [50.0, 35.0];
    let mut w = 1.0;
    let vertices = (0..count).map(|number| {
        if number % 2 == 0 || random.once_in(5) {
            at = [random.range(-4.0, 104.0), random.range(-4.0, 74.0)];
            w = random.pick(&[1.0, 1.0, 0.5]);
        } else {
            let reach = random.pick(&[0.4, 1.0, 3.0, 6.0, 9.0, 11.0, 11.9, 14.0, 30.0]);
            let mut way = [random.range(-reach, reach), random.range(-reach, reach)];
            match random.below(6) {
                0 => way[0] = 0.0,
                1 => way[1] = 0.0,
                2 => way[1] = way[0],
                3 => way[0] = -way[1],
                _ => {}
            }
            at = [at[0] + way[0], at[1] + way[1]];
            if random.once_in(3) {
                w = random.range(0.5, 2.0);
            }
        }
        if random.once_in(3) {
            at = at.map(|at| (at * 2.0_f32).round() * 0.5);
        }
        let depth = random.pick(&[0.25, 0.5, 0.75]);
        Vertex {
            position: clip_at(SIZE, at, depth, w),
            values: values(random),
        }
    });
    vertices.collect()
}

fn case(random: &mut Random, samples: u32) -> Case {
    let mut case = Case::new(SIZE, samples);
    for _ in 0..3 {
        let mut draw = CaseDraw::new(shader(random), &ends(random, 400));
        draw.primitive.topology = random.pick(&[
            PrimitiveTopology::LineList,
            PrimitiveTopology::LineList,
            PrimitiveTopology::LineStrip,
        ]);
        draw.primitive.line = line_state(random);
        draw.depth = Some(DepthState {
            compare: random.pick(&[
                CompareFunction::Less,
                CompareFunction::LessEqual,
                CompareFunction::Always,
            ]),
            write_enabled: random.once_in(2),
        });
        draw.blend = random.pick(&[
            None,
            Some(BlendState::ADDITIVE),
            Some(BlendState::ALPHA_BLENDING),
        ]);
        draw.is_counted = random.once_in(4);
        case.draws.push(draw);
    }
    case
}

/// Rows: R3, R6, O3, O5.
#[test]
fn pixels_of_small_lines_fill_packets() {
    for samples in [1, 4] {
        let topic = format!("small_lines/in_order_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 16, paths, |random| case(random, samples));
        let [fragments, packets] = statistics.fragments_listed_in_order;
        // A third of the draws has quads; one by one, each line would begin several packets.
        assert!(
            packets > 100 && fragments > packets * 6,
            "{samples} samples: {fragments} fragments are in {packets} packets"
        );
        let lines = statistics.lines_in_packets;
        assert!(lines > 5000, "{lines} lines were set up together");
    }
}

/// Lists, strips and loops, instances of one line and of many, near the eye and through it, so that
/// some lanes of a packet are clipped and some lines touch many tiles.
///
/// Rows: A1, A3, R3.
#[test]
fn lines_are_set_up_together() {
    let statistics = check_paths(
        "small_lines/packets",
        40,
        ExpectedPaths::default(),
        |random| {
            let mut case = Case::new([150, 140], random.pick(&[1, 4]));
            for _ in 0..3 {
                let style = random.pick(&[
                    Style::Small,
                    Style::Large,
                    Style::OnGrid,
                    Style::Huge,
                    Style::AcrossDepths,
                    Style::AroundEye,
                    Style::Hostile,
                ]);
                let count = random.pick(&[1, 6, 40]);
                let vertices = triangles(random, style, case.size, count);
                let mut draw = CaseDraw::new(shader(random), &vertices);
                draw.primitive.topology = random.pick(&[
                    PrimitiveTopology::LineList,
                    PrimitiveTopology::LineStrip,
                    PrimitiveTopology::LineLoop,
                    PrimitiveTopology::LineListAdjacency,
                ]);
                draw.primitive.line = line_state(random);
                draw.instances = 0..random.pick(&[1, 1, 3]);
                draw.primitive.provoking_vertex =
                    random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
                draw.blend = random.pick(&[None, Some(BlendState::ALPHA_BLENDING)]);
                case.draws.push(draw);
            }
            case
        },
    );
    let lines = statistics.lines_in_packets;
    assert!(lines > 1000, "{lines} lines were set up together");
    assert!(
        statistics.primitives_clipped > 100,
        "clipped lines are among them"
    );
}

/// The edges of small triangles, with every state: stencils, depths that are written early and
/// late, formats of one word and of several, masks, queries, biases.
///
/// Rows: R3, R6, A5, O1, O3, O4, O5, O7, O8, O9, O10.
#[test]
fn lists_of_lines_pass_through_every_state() {
    use TextureFormat as F;
    for samples in [1, 4] {
        let topic = format!("small_lines/states_{samples}");
        let paths = ExpectedPaths(&[TilePath::InOrderQuads]);
        let statistics = check_paths(&topic, 30, paths, |random| {
            let formats = [F::Rgba8Unorm, F::Bgra8UnormSrgb, F::Rgba16Float, F::R8Unorm];
            let depth = random.pick(&[
                None,
                Some(F::Depth32Float),
                Some(F::Depth16Unorm),
                Some(F::Depth24PlusStencil8),
            ]);
            let mixture = Mixture {
                styles: vec![Style::Small, Style::Tiny, Style::OnGrid, Style::Large],
                triangles: 80,
                draws: 3,
                ..Mixture::new(&[random.pick(&formats)], depth, samples)
            };
            let mut case = mixture.case(random);
            for draw in &mut case.draws {
                draw.primitive.polygon_mode = PolygonMode::Line;
                draw.primitive.line = line_state(random);
            }
            case
        });
        let [fragments, packets] = statistics.fragments_listed_in_order;
        assert!(
            packets > 100 && fragments > packets * 3,
            "{samples} samples: {fragments} fragments are in {packets} packets"
        );
    }
}

/// Triangles and lines by turns, and lines that are longer than a tile.
///
/// Rows: R1, R3.
#[test]
fn lines_keep_their_order_among_others() {
    let topic = "small_lines/order";
    let statistics = check_paths(topic, 10, ExpectedPaths::default(), |random| {
        let mut case = Case::new(SIZE, 1);
        for turn in 0..6 {
            let is_line = turn % 2 == 1;
            let vertices = if is_line {
                ends(random, 120)
            } else {
                triangles(random, Style::Small, SIZE, 40)
            };
            let mut draw = CaseDraw::new(Colored, &vertices);
            if is_line {
                draw.primitive.topology = PrimitiveTopology::LineList;
                draw.primitive.line = line_state(random);
            }
            draw.blend = random.pick(&[None, Some(BlendState::ALPHA_BLENDING)]);
            case.draws.push(draw);
        }
        case
    });
    assert!(statistics.fragments_listed_in_order[0] > 0);
}

/// Opaque lines over opaque triangles, short and long, so that they join the run of visibility;
/// with every comparison, with and without writing depth, queries, formats of one word and of
/// several, and draws of other kinds between.
///
/// Rows: R3, R6, O3, O4, O7, U3.
#[test]
fn lines_among_visible_triangles() {
    use TextureFormat as F;
    let paths = ExpectedPaths(&[TilePath::InOrderQuads, TilePath::VisibilityQuads]);
    let statistics = check_paths("small_lines/visibility", 60, paths, |random| {
        let mut case = Case::new(SIZE, random.pick(&[1, 1, 1, 4]));
        case.clear_depth = random.pick(&[1.0, 0.5]);
        case.clear_color = random.four(0.0, 1.0);
        let formats = [F::Rgba8Unorm, F::Bgra8UnormSrgb, F::Rgba16Float, F::R8Unorm];
        case.format = Some(random.pick(&formats));
        for turn in 0..2 + random.below(5) {
            let is_line = turn % 2 == 1;
            let vertices = if is_line {
                ends(random, 300)
            } else {
                let style = random.pick(&[Style::Small, Style::Large, Style::OnGrid]);
                let count = random.pick(&[3, 40]);
                triangles(random, style, SIZE, count)
            };
            let mut draw = CaseDraw::new(shader(random), &vertices);
            if is_line {
                draw.primitive.topology =
                    random.pick(&[PrimitiveTopology::LineList, PrimitiveTopology::LineStrip]);
                draw.primitive.line = line_state(random);
            } else if random.once_in(6) {
                draw.primitive.polygon_mode = PolygonMode::Line;
            }
            draw.depth = random
                .pick(&[
                    None,
                    Some(CompareFunction::Less),
                    Some(CompareFunction::LessEqual),
                    Some(CompareFunction::LessEqual),
                    Some(CompareFunction::GreaterEqual),
                    Some(CompareFunction::NotEqual),
                ])
                .map(|compare| DepthState {
                    compare,
                    write_enabled: random.once_in(2),
                });
            draw.is_counted = random.once_in(6);
            if random.once_in(8) {
                draw.blend = Some(BlendState::ALPHA_BLENDING);
            }
            if random.once_in(4) {
                draw.scissor = Some(ScissorRect {
                    x: random.below(60),
                    y: random.below(40),
                    width: 40,
                    height: 30,
                });
            }
            case.draws.push(draw);
        }
        case
    });
    let shown = statistics.line_fragments_shown;
    assert!(shown > 10_000, "{shown} fragments of lines were shown");
}
