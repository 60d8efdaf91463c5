//! Topologies, lines, points and polygon modes.

use estampe_tests::geometry::{Style, Vertex, clip_at, triangles, values};
use estampe_tests::shaders::{Colored, FlatColored, Probe, Scalar, Sized};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::state::{CullMode, DepthState, FrontFace, PolygonMode, PrimitiveTopology};

/// Scattered vertices, some on pixel centres and corners, some far away.
fn scattered(random: &mut Random, size: [u32; 2], count: u32) -> Vec<Vertex> {
    let style = random.pick(&[
        Style::Small,
        Style::Large,
        Style::Large,
        Style::OnGrid,
        Style::OnGrid,
        Style::Huge,
        Style::Gigantic,
        Style::AcrossDepths,
        Style::AroundEye,
        Style::Hostile,
    ]);
    triangles(random, style, size, count.div_ceil(3))
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => Colored.into(),
        1 => FlatColored.into(),
        _ => Probe::random(random).into(),
    }
}

fn check_topologies(topic: &str, count: u64, topologies: &[PrimitiveTopology]) {
    check(topic, count, |random| {
        let mut case = Case::random_target(random);
        let number = random.pick(&[0, 1, 2, 3, 4, 7, 12]);
        let vertices = scattered(random, case.size, number);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.elements.end = number.min(draw.elements.end);
        draw.elements.start = random.pick(&[0, 0, 1]).min(number);
        draw.primitive.topology = random.pick(topologies);
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Back]);
        draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
        case.draws.push(draw);
        case
    });
}

/// Rows: A1.
#[test]
fn strips_and_fans() {
    let topologies = [
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
    ];
    check_topologies("primitives/strips", 40, &topologies);
}

/// Rows: A1, R3.
#[test]
fn lines_strips_and_loops() {
    let topologies = [
        PrimitiveTopology::LineList,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::LineLoop,
    ];
    check_topologies("primitives/lines", 80, &topologies);
}

/// Rows: R3.
#[test]
fn lines_in_every_octant_from_and_to_pixel_centres() {
    check("primitives/octants", 12, |random| {
        let mut case = Case::new([24, 24], random.pick(&[1, 4]));
        let center = [12.5, 12.5];
        let vertices: Vec<_> = (0..60)
            .map(|at| {
                let place = if at % 2 == 0 {
                    center
                } else {
                    [0, 1].map(|_| random.below(48) as f32 * 0.5)
                };
                let w = random.pick(&[1.0, 1.0, 0.5, 3.0]);
                Vertex {
                    position: clip_at(case.size, place, random.unit(), w),
                    values: values(random),
                }
            })
            .collect();
        let mut draw = CaseDraw::new(Probe::random(random), &vertices);
        draw.primitive.topology = PrimitiveTopology::LineList;
        case.draws.push(draw);
        case
    });
}

/// Rows: R4.
#[test]
fn points_of_every_size() {
    check("primitives/points", 60, |random| {
        let mut case = Case::random_target(random);
        let vertices = scattered(random, case.size, 9);
        let sizes = [
            0.0,
            0.7,
            1.0,
            3.0,
            8.0,
            40.0,
            3000.0,
            -4.0,
            f32::NAN,
            f32::INFINITY,
        ];
        let shader: TestShader = match random.below(4) {
            0 => Probe::random(random).into(),
            1 => Sized(None).into(),
            _ => Sized(Some(random.pick(&sizes))).into(),
        };
        let mut draw = CaseDraw::new(shader, &vertices);
        draw.primitive.topology = PrimitiveTopology::PointList;
        case.draws.push(draw);
        case
    });
}

/// Rows: A5.
#[test]
fn polygon_modes_line_and_point() {
    check("primitives/polygon_modes", 80, |random| {
        let mut case = Case::random_target(random);
        let vertices = scattered(random, case.size, 12);
        let shader: TestShader = match random.below(4) {
            0 => Sized(Some(random.range(1.0, 9.0))).into(),
            1 => Probe(Scalar::Flat).into(),
            2 => Probe(Scalar::FrontFacing).into(),
            _ => Probe::random(random).into(),
        };
        let mut draw = CaseDraw::new(shader, &vertices);
        draw.primitive.polygon_mode = random.pick(&[PolygonMode::Line, PolygonMode::Point]);
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Front, CullMode::Back]);
        draw.primitive.front_face = random.pick(&[FrontFace::Ccw, FrontFace::Cw]);
        draw.primitive.topology = random.pick(&[
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleStrip,
            PrimitiveTopology::TriangleFan,
        ]);
        case.draws.push(draw);
        case
    });
}
