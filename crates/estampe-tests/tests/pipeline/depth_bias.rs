//! Depth bias of triangles, and of their edges and corners.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, CutoutDepth, FlatColored, GivenDepth, Probe, Scalar};
use estampe_tests::{Case, CaseDraw, TestShader, check};
use estampe_types::state::{
    BlendState, CompareFunction, CullMode, DepthBiasState, DepthState, PolygonMode,
    PrimitiveTopology, Viewport,
};

/// Rows: A5, D1.
#[test]
fn every_kind_of_bias_and_triangle() {
    check("depth_bias/random", 300, |random| {
        let mut case = Case::random_target(random);
        case.clear_depth = random.pick(&[1.0, 1.0, 0.5]);
        for _ in 0..2 {
            let style = random.pick(&[
                Style::Small,
                Style::Large,
                Style::Tiny,
                Style::Huge,
                Style::Sliver,
                Style::AcrossDepths,
                Style::AroundEye,
                Style::Hostile,
            ]);
            let mut vertices = triangles(random, style, case.size, 10);
            let scale = random.pick(&[1.0, 1.0, 1e-3, 1e-38]);
            for vertex in &mut vertices {
                vertex.position[2] *= scale;
            }
            let shader: TestShader = match random.below(6) {
                0 => Colored.into(),
                1 => FlatColored.into(),
                2 => Probe(Scalar::Z).into(),
                3 => Probe(Scalar::DepthSlope).into(),
                4 => CutoutDepth(GivenDepth::Value).into(),
                _ => Probe::random(random).into(),
            };
            let mut draw = CaseDraw::new(shader, &vertices);
            draw.depth_bias = DepthBiasState {
                constant: random.pick(&[0.0, 1.0, -3.0, 1000.0, 4e6, -1e9, f32::MAX, f32::NAN]),
                slope_scale: random.pick(&[0.0, 0.0, 1.0, -2.5, 40.0, f32::INFINITY]),
                clamp: random.pick(&[0.0, 0.0, 0.01, -0.01, 1e-7, f32::NAN]),
            };
            draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::Back]);
            draw.primitive.polygon_mode = random.pick(&[
                PolygonMode::Fill,
                PolygonMode::Fill,
                PolygonMode::Line,
                PolygonMode::Point,
            ]);
            draw.primitive.topology = random.pick(&[
                PrimitiveTopology::TriangleList,
                PrimitiveTopology::TriangleList,
                PrimitiveTopology::TriangleStrip,
                // Line and point topologies have no depth bias.
                PrimitiveTopology::LineList,
                PrimitiveTopology::PointList,
            ]);
            draw.primitive.unclipped_depth = random.once_in(4);
            draw.depth = Some(DepthState {
                write_enabled: !random.once_in(4),
                compare: random.pick(&[
                    CompareFunction::Less,
                    CompareFunction::LessEqual,
                    CompareFunction::Greater,
                    CompareFunction::Always,
                    CompareFunction::Equal,
                ]),
            });
            if random.once_in(4) {
                draw.blend = Some(random.pick(&[
                    BlendState::ADDITIVE,
                    BlendState::ALPHA_BLENDING,
                    BlendState::PREMULTIPLIED_ALPHA_BLENDING,
                ]));
            }
            if random.once_in(4) {
                let [min_depth, max_depth] = random.pick(&[[0.2, 0.7], [1.0, 0.0], [0.0, 1e-4]]);
                draw.viewport = Some(Viewport {
                    x: 0.0,
                    y: 0.0,
                    width: case.size[0] as f32,
                    height: case.size[1] as f32,
                    min_depth,
                    max_depth,
                });
            }
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: A5, D1.
#[test]
fn coplanar_triangles_are_told_apart_by_one_unit() {
    // Drawn twice with `Less`: the second draw is visible only with a bias towards the viewer.
    for (constant, is_seen) in [(0.0, false), (-1.0, true), (1.0, false)] {
        let random = &mut estampe_tests::Random::new("depth_bias/coplanar", 1);
        let mut case = Case::new([32, 32], 1);
        let mut vertices = triangles(random, Style::Large, case.size, 1);
        for (vertex, x) in vertices.iter_mut().zip([-1.0, 3.0, -1.0]) {
            vertex.position = [x, 0.0, 0.6, 1.0];
            vertex.values = [1.0, 0.0, 0.0, 1.0];
        }
        vertices[0].position[1] = -1.0;
        vertices[1].position[1] = -1.0;
        vertices[2].position[1] = 3.0;
        case.draws.push(CaseDraw::new(Colored, &vertices));
        for vertex in &mut vertices {
            vertex.values = [0.0, 1.0, 0.0, 1.0];
        }
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.depth_bias.constant = constant;
        case.draws.push(draw);
        let image = estampe_tests::check_one("depth_bias/coplanar", &case);
        let wanted = if is_seen {
            [0, 255, 0, 255]
        } else {
            [255, 0, 0, 255]
        };
        assert!(image.color.chunks(4).all(|pixel| pixel == wanted));
    }
}
