//! Clip and cull distances, and unclipped depth.

use estampe_tests::geometry::{Style, Vertex, triangles};
use estampe_tests::shaders::{
    Colored, CutoutDepth, Distant, GivenDepth, ManyDistances, Probe, Scalar,
};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::state::{
    BlendState, CompareFunction, CullMode, DepthState, PolygonMode, PrimitiveTopology,
    ProvokingVertex, Viewport,
};

const TOPOLOGIES: [PrimitiveTopology; 8] = [
    PrimitiveTopology::PointList,
    PrimitiveTopology::LineList,
    PrimitiveTopology::LineStrip,
    PrimitiveTopology::TriangleList,
    PrimitiveTopology::TriangleList,
    PrimitiveTopology::TriangleList,
    PrimitiveTopology::TriangleStrip,
    PrimitiveTopology::TriangleFan,
];

fn vertices(random: &mut Random, size: [u32; 2]) -> Vec<Vertex> {
    let style = random.pick(&[
        Style::Small,
        Style::Large,
        Style::Large,
        Style::OnGrid,
        Style::Huge,
        Style::AcrossDepths,
        Style::AroundEye,
        Style::Hostile,
    ]);
    triangles(random, style, size, 6)
}

fn with_state(random: &mut Random, draw: &mut CaseDraw) {
    draw.primitive.topology = random.pick(&TOPOLOGIES);
    draw.primitive.provoking_vertex = random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
    draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Back]);
    draw.primitive.polygon_mode = random.pick(&[
        PolygonMode::Fill,
        PolygonMode::Fill,
        PolygonMode::Line,
        PolygonMode::Point,
    ]);
    draw.primitive.unclipped_depth = random.once_in(4);
    draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
    if random.once_in(4) {
        draw.blend = Some(random.pick(&[
            BlendState::ADDITIVE,
            BlendState::ALPHA_BLENDING,
            BlendState::PREMULTIPLIED_ALPHA_BLENDING,
        ]));
    }
}

fn distant(random: &mut Random) -> TestShader {
    if random.once_in(3) {
        return ManyDistances(random.pick(&[0.0, 0.3, 0.6])).into();
    }
    let shift = random.pick(&[0.0, 0.2, 0.4, 0.6, -0.5]);
    let shown = random.below(6);
    Distant { shift, shown }.into()
}

/// Rows: V1, A3, A5.
#[test]
fn every_topology_and_polygon_mode_is_clipped_and_culled_by_distances() {
    check("clip_distances/random", 300, |random| {
        let mut case = Case::random_target(random);
        let vertices = vertices(random, case.size);
        let mut draw = CaseDraw::new(distant(random), &vertices);
        with_state(random, &mut draw);
        draw.instances = random.pick(&[0..1, 0..1, 0..2]);
        case.draws.push(draw);
        case
    });
}

/// Rows: A3.
#[test]
fn nan_infinite_and_huge_distances() {
    check("clip_distances/hostile", 120, |random| {
        let mut case = Case::random_target(random);
        let mut vertices = triangles(random, Style::Large, case.size, 6);
        for _ in 0..8 {
            let vertex = random.index(vertices.len());
            vertices[vertex].values[random.index(4)] = random.odd_number();
        }
        let mut draw = CaseDraw::new(distant(random), &vertices);
        with_state(random, &mut draw);
        case.draws.push(draw);
        case
    });
}

/// Rows: A3.
#[test]
fn depth_that_is_not_clipped_is_clamped() {
    check("clip_distances/unclipped_depth", 200, |random| {
        let mut case = Case::random_target(random);
        case.clear_depth = random.pick(&[1.0, 0.5, 0.0]);
        for _ in 0..3 {
            let style = random.pick(&[
                Style::AcrossDepths,
                Style::AcrossDepths,
                Style::AroundEye,
                Style::Hostile,
                Style::Huge,
                Style::Gigantic,
                Style::Small,
            ]);
            let mut vertices = triangles(random, style, case.size, 12);
            let scale = random.pick(&[1.0, 1.0, 30.0, 1e9, 1e35]);
            for vertex in &mut vertices {
                vertex.position[2] *= scale;
            }
            let shader: TestShader = match random.below(4) {
                0 => Colored.into(),
                1 => Probe(Scalar::Z).into(),
                2 => Probe::random(random).into(),
                _ => CutoutDepth(GivenDepth::Value).into(),
            };
            let mut draw = CaseDraw::new(shader, &vertices);
            with_state(random, &mut draw);
            draw.primitive.unclipped_depth = true;
            draw.depth = Some(DepthState {
                write_enabled: true,
                compare: random.pick(&[
                    CompareFunction::Less,
                    CompareFunction::LessEqual,
                    CompareFunction::Greater,
                    CompareFunction::Always,
                ]),
            });
            draw.viewport = random
                .pick(&[None, Some([0.2, 0.7]), Some([1.0, 0.0]), Some([0.5; 2])])
                .map(|[min_depth, max_depth]| Viewport {
                    x: 0.0,
                    y: 0.0,
                    width: case.size[0] as f32,
                    height: case.size[1] as f32,
                    min_depth,
                    max_depth,
                });
            case.draws.push(draw);
        }
        case
    });
}
