//! Triangles that count in the stencil and store no depth, between draws that do: their packets are
//! compared with the ranges of stored depths, which go out of date.

use estampe::TilePath;
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, Cutout, FlatColored};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{
    ColorWrites, CompareFunction, DepthState, ScissorRect, StencilFaceState, StencilOperation,
    StencilState, Viewport,
};

const ORDERED: [CompareFunction; 4] = [
    CompareFunction::Less,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::GreaterEqual,
];

fn some_triangles(random: &mut Random, size: [u32; 2], count: u32) -> CaseDraw {
    let style = random.pick(&[Style::Large, Style::AcrossDepths, Style::OnGrid]);
    let mut vertices = triangles(random, style, size, count);
    if random.once_in(2) {
        vertices.extend(triangles(random, Style::Small, size, 6));
    }
    CaseDraw::new(Colored, &vertices)
}

/// A draw that stores depths: on the visibility path, or in order.
fn solid(random: &mut Random, case: &Case) -> CaseDraw {
    let mut draw = some_triangles(random, case.size, 5);
    if random.once_in(3) {
        draw.shader = Cutout.into();
    }
    draw.depth = Some(DepthState {
        compare: random.pick(&ORDERED),
        write_enabled: true,
    });
    draw
}

/// A draw that counts, by depth fail or by depth pass, or tests the counts too.
fn volume(random: &mut Random, case: &Case) -> CaseDraw {
    let mut draw = some_triangles(random, case.size, 14);
    let face = |random: &mut Random| {
        let counts = [
            StencilOperation::IncrementWrap,
            StencilOperation::DecrementWrap,
            StencilOperation::IncrementClamp,
            StencilOperation::Keep,
        ];
        let mut face = StencilFaceState {
            depth_fail_op: random.pick(&counts),
            ..StencilFaceState::default()
        };
        if random.once_in(3) {
            face.pass_op = random.pick(&counts);
        }
        if random.once_in(4) {
            face.compare = random.pick(&[CompareFunction::Equal, CompareFunction::NotEqual]);
            face.fail_op = random.pick(&counts);
        }
        face
    };
    draw.stencil = Some(StencilState {
        front: face(random),
        back: face(random),
    });
    draw.depth = Some(DepthState {
        compare: random.pick(&ORDERED),
        write_enabled: random.once_in(12),
    });
    match random.below(4) {
        0 => draw.shader = FlatColored.into(),
        1 => {}
        _ => draw.write_mask = ColorWrites::NONE,
    }
    draw.is_counted = random.once_in(5);
    if random.once_in(4) {
        draw.scissor = Some(ScissorRect {
            x: random.below(60),
            y: random.below(40),
            width: 70,
            height: 30,
        });
    }
    if random.once_in(5) {
        draw.depth_bounds = Some([0.2, 0.7]);
    }
    if random.once_in(5) {
        draw.viewport = Some(Viewport {
            x: 0.0,
            y: 0.0,
            width: case.size[0] as f32,
            height: case.size[1] as f32,
            min_depth: 0.25,
            max_depth: 0.75,
        });
    }
    draw
}

/// Rows: R1, O2, O3, O4, U3.
#[test]
fn volumes_count_between_draws_that_store_depth() {
    let statistics = check_paths(
        "shadow volumes",
        40,
        ExpectedPaths(&[TilePath::VisibilityDepthOnly]),
        |random| {
            let mut case = Case::new([140, 75], random.pick(&[1, 1, 1, 4, 4, 2, 8]));
            case.depth_stencil = Some(random.pick(&[
                TextureFormat::Depth24PlusStencil8,
                TextureFormat::Depth32FloatStencil8,
            ]));
            case.clear_depth = random.pick(&[1.0, 0.5]);
            case.clear_color = random.four(0.0, 1.0);
            for _ in 0..3 {
                let draw = solid(random, &case);
                case.draws.push(draw);
                for _ in 0..=random.below(2) {
                    let draw = volume(random, &case);
                    case.draws.push(draw);
                }
            }
            case
        },
    );
    assert!(
        statistics.packets_failing_depth > 1000,
        "packets were not compared with ranges of depths"
    );
    assert!(
        statistics.triangles_gathered_in_tiles > 100,
        "no triangles of several packets were covered together"
    );
}
