//! Triangles over which nothing varies: their whole packets share one packet's colours.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, FlatColored, Halved, Probe};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::state::{BlendState, CompareFunction, DepthState};

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => FlatColored.into(),
        1 => Colored.into(),
        2 => Probe::random(random).into(),
        _ => Halved.into(),
    }
}

/// Triangles as of a user interface, blended in order; most have the same values at all vertices,
/// among them −0 and NaN, and some only nearly.
fn case(random: &mut Random) -> Case {
    let mut case = Case::new([100, 70], random.pick(&[1, 1, 1, 4, 2, 8]));
    for _ in 0..3 {
        let style = random.pick(&[Style::Large, Style::Large, Style::Small]);
        let mut vertices = triangles(random, style, case.size, 5);
        for triangle in vertices.chunks_exact_mut(3) {
            let special = random.pick(&[0.5, 0.25, -0.0, 0.0, f32::NAN, 1.0]);
            let channel = random.below(4) as usize;
            let is_constant = !random.once_in(4);
            let has_equal_w = !random.once_in(4);
            let values = triangle[0].values;
            for vertex in triangle {
                if is_constant {
                    vertex.values = values;
                    vertex.values[channel] = special;
                }
                if has_equal_w {
                    vertex.position[3] = 1.0;
                }
            }
        }
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.blend = Some(BlendState::ALPHA_BLENDING);
        draw.depth = random.once_in(2).then_some(DepthState {
            compare: CompareFunction::LessEqual,
            write_enabled: true,
        });
        draw.is_counted = random.once_in(3);
        case.draws.push(draw);
    }
    case
}

/// Rows: O5, V4.
#[test]
fn whole_packets_share_their_colours() {
    let statistics = check_paths("constant_primitives", 32, ExpectedPaths::default(), case);
    assert!(
        statistics.fragments_of_shared_colors > 0,
        "no packet took another's colours"
    );
}
