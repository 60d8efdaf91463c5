//! Derivatives of varyings that primitives give, and packets that triangles share because nothing
//! else asks for quads.

use estampe::{Statistics, TilePath};
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{CentroidGradients, Gradients, Halved, Probe, Scalar, Slope};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_paths};
use estampe_types::state::{
    BlendState, DepthState, LineRasterization, PolygonMode, PrimitiveTopology, ProvokingVertex,
};

fn case(random: &mut Random, samples: u32, shader: impl Fn(&mut Random) -> TestShader) -> Case {
    let mut case = Case::new(
        random.pick(&[[64, 64], [33, 20], [19, 21], [70, 5]]),
        samples,
    );
    for _ in 0..=random.below(2) {
        let style = random.pick(&[
            Style::Tiny,
            Style::Small,
            Style::Large,
            Style::OnGrid,
            Style::Sliver,
            Style::AroundEye,
            Style::AcrossDepths,
        ]);
        let vertices = triangles(random, style, case.size, 12);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.depth = random.pick(&[None, Some(DepthState::LESS_WRITE)]);
        draw.primitive.provoking_vertex =
            random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
        case.draws.push(draw);
    }
    case
}

/// Rows: R5, R7, R6.
#[test]
fn derivatives_of_triangles() {
    for samples in [1, 4, 8] {
        let topic = format!("gradients/triangles_{samples}");
        let paths = match samples {
            1 => ExpectedPaths(&[TilePath::VisibilityCrossTriangle, TilePath::InOrderQuads]),
            _ => ExpectedPaths(&[TilePath::VisibilityQuads, TilePath::InOrderQuads]),
        };
        let statistics = check_paths(&topic, 40, paths, |random| {
            let mut case = case(random, samples, |random| Gradients::random(random).into());
            for draw in &mut case.draws {
                draw.blend = random.pick(&[None, None, Some(BlendState::ADDITIVE)]);
            }
            case
        });
        let [fragments, _] = statistics.fragments_across_triangles;
        let shares = statistics.fragments_by_pixels > 0 && fragments > 0;
        assert!(samples > 1 || shares, "no triangles share packets");
    }
}

/// Rows: R5, R7, R3, R4.
#[test]
fn derivatives_of_lines_and_points() {
    check("gradients/lines", 80, |random| {
        let samples = random.pick(&[1, 4]);
        let mut case = case(random, samples, |random| Gradients::random(random).into());
        for draw in &mut case.draws {
            draw.primitive.topology = random.pick(&[
                PrimitiveTopology::LineList,
                PrimitiveTopology::LineStrip,
                PrimitiveTopology::PointList,
                PrimitiveTopology::TriangleList,
            ]);
            draw.primitive.polygon_mode = PolygonMode::Line;
            draw.primitive.line.width = random.pick(&[1.0, 1.0, 3.5]);
            draw.primitive.line.rasterization = random.pick(&[
                LineRasterization::Bresenham,
                LineRasterization::Rectangular,
                LineRasterization::RectangularSmooth,
            ]);
        }
        case
    });
}

/// Rows: R6, R7.
#[test]
fn derivatives_at_centroids_and_samples() {
    check("gradients/centroids", 60, |random| {
        let samples = random.pick(&[1, 4, 8]);
        let mut case = case(random, samples, |random| {
            CentroidGradients(random.pick(&Slope::ALL)).into()
        });
        for draw in &mut case.draws {
            draw.sample_shading = random.once_in(3);
            draw.blend = random.pick(&[None, Some(BlendState::ADDITIVE)]);
        }
        case
    });
}

/// Varyings that do not vary, whose zeros have signs, and values without a derivative.
///
/// Rows: R5, R7.
#[test]
fn derivatives_of_odd_values() {
    check("gradients/odd", 60, |random| {
        let samples = random.pick(&[1, 4]);
        let mut case = case(random, samples, |random| Gradients::random(random).into());
        for draw in &mut case.draws {
            let mut vertices = triangles(random, Style::Large, case.size, 6);
            let odd = [0; 4].map(|_| random.odd_number());
            let is_constant = random.once_in(2);
            for vertex in &mut vertices {
                vertex.values = match is_constant {
                    true => odd,
                    false => [0; 4].map(|_| random.odd_number()),
                };
            }
            *draw = CaseDraw {
                blend: random.pick(&[None, Some(BlendState::ADDITIVE)]),
                ..CaseDraw::new(draw.shader.clone(), &vertices)
            };
        }
        case
    });
}

/// Many triangles of which several meet in most packets; shaders that read the position and the
/// side that is seen, which are those of each lane's triangle. With four samples, triangles meet at
/// pixels too.
///
/// Rows: R1, R5, R6, O3.
#[test]
fn pixels_fill_packets_where_no_quads_are_needed() {
    use TilePath::{VisibilityCrossTriangle, VisibilityQuads};
    for (samples, paths) in [
        (
            1,
            ExpectedPaths(&[VisibilityCrossTriangle, VisibilityQuads]),
        ),
        (4, ExpectedPaths(&[VisibilityQuads])),
    ] {
        let topic = format!("gradients/by pixels_{samples}");
        let statistics = check_meeting(&topic, samples, paths);
        let by_pixels = statistics.fragments_by_pixels;
        assert!(by_pixels > 1000, "{by_pixels} fragments fill packets");
        let listed = statistics.fragments_by_triangle;
        assert!(
            listed > 1000,
            "{listed} of them were found triangle by triangle"
        );
    }
}

/// Shaders that take derivatives by quads: those of triangles of any size share packets.
///
/// Rows: R1, R5, R6, R7, O3.
#[test]
fn quads_of_triangles_share_packets() {
    for samples in [1, 4, 8] {
        let topic = format!("gradients/quads_{samples}");
        let statistics = check_paths(&topic, 40, ExpectedPaths(&[TilePath::VisibilityQuads]), {
            |random| {
                let scalars = [
                    Scalar::Ddx,
                    Scalar::Ddy,
                    Scalar::DdxCoarse,
                    Scalar::DdyCoarse,
                    Scalar::DepthSlope,
                ];
                let mut case = case(random, samples, |random| {
                    Probe(random.pick(&scalars)).into()
                });
                for draw in &mut case.draws {
                    let style = random.pick(&[
                        Style::Small,
                        Style::OnGrid,
                        Style::Large,
                        Style::AroundEye,
                        Style::AcrossDepths,
                    ]);
                    let vertices = triangles(random, style, case.size, 40);
                    *draw = CaseDraw {
                        depth: draw.depth,
                        ..CaseDraw::new(draw.shader.clone(), &vertices)
                    };
                }
                case
            }
        });
        let quads = statistics.quads_across_triangles;
        assert!(
            quads > 1000,
            "{quads} quads of {samples} samples share packets"
        );
    }
}

/// Many triangles of which several meet in most packets.
fn check_meeting(topic: &str, samples: u32, paths: ExpectedPaths) -> Statistics {
    check_paths(topic, 40, paths, |random| {
        let shader = |random: &mut Random| match random.below(3) {
            0 => Halved.into(),
            1 => Probe(random.pick(&[Scalar::X, Scalar::Z, Scalar::InverseW, Scalar::FrontFacing]))
                .into(),
            _ => Gradients::random(random).into(),
        };
        let mut case = case(random, samples, shader);
        for draw in &mut case.draws {
            let style = random.pick(&[Style::OnGrid, Style::Large, Style::AcrossDepths]);
            let vertices = triangles(random, style, case.size, 40);
            *draw = CaseDraw {
                depth: draw.depth,
                ..CaseDraw::new(draw.shader.clone(), &vertices)
            };
        }
        case
    })
}
