//! Random triangles of every style: coverage, depth and interpolated values.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, FlatColored, Probe};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::state::{CullMode, DepthState, FrontFace};

fn case_of(random: &mut Random, style: Style) -> Case {
    let mut case = Case::random_target(random);
    let count = match style {
        Style::Tiny | Style::Degenerate => 40,
        Style::Small | Style::OnGrid => 12,
        _ => 5,
    };
    let vertices = triangles(random, style, case.size, count);
    let shader: TestShader = match random.below(4) {
        0 => Colored.into(),
        1 => FlatColored.into(),
        _ => Probe::random(random).into(),
    };
    let mut draw = CaseDraw::new(shader, &vertices);
    draw.depth = random.pick(&[
        None,
        Some(DepthState::LESS_WRITE),
        Some(DepthState::LESS_WRITE),
    ]);
    draw.primitive.cull_mode = random.pick(&[
        CullMode::None,
        CullMode::None,
        CullMode::Front,
        CullMode::Back,
    ]);
    draw.primitive.front_face = random.pick(&[FrontFace::Ccw, FrontFace::Cw]);
    case.draws.push(draw);
    case
}

macro_rules! styles {
    ($($name:ident: $style:ident;)+) => {
        $(#[test]
        fn $name() {
            check(concat!("triangles/", stringify!($name)), 18, |random| {
                case_of(random, Style::$style)
            });
        })+
    };
}
styles! {
    tiny: Tiny;
    small: Small;
    large: Large;
    beyond_the_guard_band: Huge;
    to_the_end_of_f32: Gigantic;
    slivers: Sliver;
    without_area: Degenerate;
    on_every_tie: OnGrid;
    across_the_near_and_far_planes: AcrossDepths;
    before_and_behind_the_eye: AroundEye;
    hostile: Hostile;
}

/// Rows: R1, R5, U3.
#[test]
fn larger_targets_with_a_mixture() {
    check("triangles/mixture", 4, |random| {
        let mut case = Case::new([200, 130], random.pick(&[1, 4]));
        let mut vertices = Vec::new();
        for _ in 0..30 {
            let style = random.pick(&[Style::Small, Style::Small, Style::Tiny, Style::Sliver]);
            vertices.extend(triangles(random, style, case.size, 3));
        }
        vertices.extend(triangles(random, Style::Large, case.size, 2));
        vertices.extend(triangles(random, Style::Tiny, case.size, 60));
        case.draws
            .push(CaseDraw::new(Probe::random(random), &vertices));
        case
    });
}

/// Rows: A3, A4.
#[test]
fn a_w_that_is_infinite_drops_its_triangle_though_its_inverse_is_finite() {
    check("triangles/infinite_w", 4, |random| {
        let mut case = Case::new([8, 8], 1);
        let mut vertices = triangles(random, Style::Large, case.size, 2);
        vertices[1].position[3] = f32::INFINITY;
        case.draws.push(CaseDraw::new(Colored, &vertices));
        case
    });
}
