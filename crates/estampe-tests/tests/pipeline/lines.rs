//! Wide, rectangular, smooth and stippled lines, and round points.

use estampe::TilePath;
use estampe_tests::geometry::{Style, Vertex, clip_at, triangles, values};
use estampe_tests::shaders::{Colored, CutoutDepth, FlatColored, GivenDepth, Probe, Sized};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_paths};
use estampe_types::state::{
    BlendState, CullMode, DepthState, LineRasterization, LineState, LineStipple, PolygonMode,
    PrimitiveTopology, ProvokingVertex, ScissorRect,
};
use estampe_types::{BufferData, IndexFormat, TextureFormat};

const KINDS: [LineRasterization; 3] = [
    LineRasterization::Bresenham,
    LineRasterization::Rectangular,
    LineRasterization::RectangularSmooth,
];

const TOPOLOGIES: [PrimitiveTopology; 5] = [
    PrimitiveTopology::LineList,
    PrimitiveTopology::LineStrip,
    PrimitiveTopology::LineLoop,
    PrimitiveTopology::LineStripAdjacency,
    PrimitiveTopology::LineListAdjacency,
];

fn line_state(random: &mut Random) -> LineState {
    let stipple = LineStipple {
        factor: random.pick(&[1, 1, 2, 3, 256]),
        pattern: random.pick(&[0x5555, 0x00FF, 0x0F31, 0x8000, 0, 0xFFFF]),
    };
    LineState {
        width: random.pick(&[0.01, 0.5, 1.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.7, 8.0, 64.0]),
        rasterization: random.pick(&KINDS),
        stipple: random.once_in(2).then_some(stipple),
    }
}

fn vertices(random: &mut Random, size: [u32; 2], count: u32) -> Vec<Vertex> {
    let style = random.pick(&[
        Style::Small,
        Style::Large,
        Style::Large,
        Style::OnGrid,
        Style::OnGrid,
        Style::Huge,
        Style::AcrossDepths,
        Style::AroundEye,
        Style::Hostile,
    ]);
    triangles(random, style, size, count.div_ceil(3))
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(6) {
        0 | 1 => Colored.into(),
        2 => FlatColored.into(),
        3 => CutoutDepth(GivenDepth::Value).into(),
        _ => Probe::random(random).into(),
    }
}

fn with_state(random: &mut Random, case: &mut Case, draw: &mut CaseDraw) {
    draw.primitive.provoking_vertex = random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
    draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
    draw.blend = random.pick(&[
        None,
        Some(BlendState::ADDITIVE),
        Some(BlendState::ALPHA_BLENDING),
    ]);
    if random.once_in(4) {
        case.format = Some(TextureFormat::Rgba8UnormSrgb);
    }
    if random.once_in(5) {
        draw.scissor = Some(ScissorRect {
            x: 3,
            y: 2,
            width: 21,
            height: 9,
        });
    }
}

/// Rows: R3, R6.
#[test]
fn every_shape_width_and_pattern() {
    check_paths(
        "lines/shapes",
        400,
        ExpectedPaths(&[TilePath::InOrderQuads, TilePath::InOrderPackets]),
        |random| {
            let mut case = Case::random_target(random);
            let vertices = vertices(random, case.size, 9);
            let mut draw = CaseDraw::new(shader(random), &vertices);
            draw.primitive.topology = random.pick(&TOPOLOGIES);
            draw.primitive.line = line_state(random);
            with_state(random, &mut case, &mut draw);
            draw.instances = random.pick(&[0..1, 0..1, 0..2]);
            if random.once_in(3) {
                let count = draw.elements.end;
                let index = |_| match random.below(5) {
                    0 => u32::MAX,
                    _ => random.below(count),
                };
                let indices: Vec<_> = (0..14).map(index).collect();
                draw.indices = Some((IndexFormat::Uint32, BufferData::from_words(indices)));
                draw.elements = 0..14;
                draw.primitive.primitive_restart = true;
            }
            case.draws.push(draw);
            case
        },
    );
}

/// Rows: A5, R3.
#[test]
fn the_edges_of_triangles() {
    check("lines/polygon_mode", 120, |random| {
        let mut case = Case::random_target(random);
        let vertices = vertices(random, case.size, 9);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.primitive.polygon_mode = PolygonMode::Line;
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
        draw.primitive.line = line_state(random);
        with_state(random, &mut case, &mut draw);
        case.draws.push(draw);
        case
    });
}

/// Rows: R3.
#[test]
fn long_stippled_strips_go_on_where_they_ended() {
    check("lines/strips", 6, |random| {
        // More lines than a chunk holds.
        let mut case = Case::new([48, 48], 1);
        let vertices: Vec<_> = (0..5000)
            .map(|_| {
                let place = [random.range(0.0, 48.0), random.range(0.0, 48.0)];
                Vertex {
                    position: clip_at(case.size, place, random.unit(), 1.0),
                    values: values(random),
                }
            })
            .collect();
        let mut draw = CaseDraw::new(FlatColored, &vertices);
        draw.primitive.topology = PrimitiveTopology::LineStrip;
        draw.primitive.line = LineState {
            width: random.pick(&[1.0, 2.0]),
            rasterization: random.pick(&KINDS[..2]),
            stipple: Some(LineStipple {
                factor: 3,
                pattern: 0x0101,
            }),
        };
        draw.elements = 0..random.pick(&[3, 4097, 5000]);
        case.draws.push(draw);
        case
    });
}

/// Rows: R4.
#[test]
fn round_points() {
    check("lines/round_points", 80, |random| {
        let mut case = Case::random_target(random);
        let vertices = vertices(random, case.size, 9);
        let shader: TestShader = match random.below(3) {
            0 => Probe::random(random).into(),
            _ => Sized(Some(random.pick(&[
                0.5,
                1.0,
                2.0,
                5.0,
                20.0,
                3000.0,
                f32::NAN,
            ])))
            .into(),
        };
        let mut draw = CaseDraw::new(shader, &vertices);
        draw.primitive.round_points = true;
        if random.once_in(3) {
            draw.primitive.polygon_mode = PolygonMode::Point;
        } else {
            draw.primitive.topology = PrimitiveTopology::PointList;
        }
        with_state(random, &mut case, &mut draw);
        case.draws.push(draw);
        case
    });
}
