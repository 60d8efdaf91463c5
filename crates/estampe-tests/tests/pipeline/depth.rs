//! The depth test: every comparison, with and without writing, early and late.

use estampe::TilePath;
use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{
    Colored, Cutout, CutoutDepth, DepthGiven, DepthOnly, FlatColored, GivenDepth, Probe, Scalar,
};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_paths};
use estampe_types::state::{CompareFunction, DepthState, PrimitiveTopology, Viewport};

const FUNCTIONS: [CompareFunction; 8] = [
    CompareFunction::Never,
    CompareFunction::Less,
    CompareFunction::Equal,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::NotEqual,
    CompareFunction::GreaterEqual,
    CompareFunction::Always,
];

fn depth_state(random: &mut Random) -> Option<DepthState> {
    let state = DepthState {
        compare: random.pick(&FUNCTIONS),
        write_enabled: !random.once_in(3),
    };
    (!random.once_in(8)).then_some(state)
}

fn target(random: &mut Random) -> Case {
    let mut case = Case::random_target(random);
    case.clear_depth = random.pick(&[1.0, 1.0, 0.0, 0.5, 0.3]);
    case
}

/// Large and small triangles, some of them parallel to the window, some drawn twice.
fn draw_with(random: &mut Random, case: &Case, shader: impl Into<TestShader>) -> CaseDraw {
    let mut vertices = Vec::new();
    for _ in 0..4 {
        let style = random.pick(&[
            Style::Large,
            Style::Small,
            Style::AcrossDepths,
            Style::Large,
        ]);
        let mut some = triangles(random, style, case.size, 1);
        if random.once_in(3) {
            // The same plane, beginning with another vertex: depths equal to the bit.
            let mut again = some.clone();
            again.rotate_left(1);
            again.iter_mut().for_each(|vertex| vertex.values.reverse());
            some.extend(again);
        }
        vertices.extend(some);
    }
    let mut draw = CaseDraw::new(shader, &vertices);
    draw.depth = depth_state(random);
    draw.primitive.topology = random.pick(&[
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::PointList,
    ]);
    if random.once_in(4) {
        let [min_depth, max_depth] = random.pick(&[[1.0, 0.0], [0.2, 0.6], [0.8, 0.4]]);
        draw.viewport = Some(Viewport {
            x: 0.0,
            y: 0.0,
            width: case.size[0] as f32,
            height: case.size[1] as f32,
            min_depth,
            max_depth,
        });
    }
    draw
}

/// Rows: O4, O9.
#[test]
fn early_tests() {
    check("depth/early", 60, |random| {
        let mut case = target(random);
        for _ in 0..3 {
            let shader: TestShader = match random.below(3) {
                0 => Colored.into(),
                1 => FlatColored.into(),
                _ => Probe(Scalar::Z).into(),
            };
            let draw = draw_with(random, &case, shader);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: F1, O9.
#[test]
fn discarded_fragments_leave_no_depth() {
    check("depth/discard", 40, |random| {
        let mut case = target(random);
        for _ in 0..3 {
            let shader: TestShader = match random.below(3) {
                0 => Colored.into(),
                _ => Cutout.into(),
            };
            let draw = draw_with(random, &case, shader);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: F1, O4, O9.
#[test]
fn shaders_that_write_depth() {
    check("depth/output", 60, |random| {
        let mut case = target(random);
        let given = [GivenDepth::Value, GivenDepth::Moved, GivenDepth::Nothing];
        for _ in 0..3 {
            let shader: TestShader = match random.below(4) {
                0 => Colored.into(),
                1 => CutoutDepth(random.pick(&given)).into(),
                _ => DepthGiven(random.pick(&given)).into(),
            };
            let draw = draw_with(random, &case, shader);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: F1, O4.
#[test]
fn nan_infinite_and_huge_written_depths() {
    check("depth/output_odd", 20, |random| {
        let mut case = target(random);
        let mut draw = draw_with(random, &case, DepthGiven(GivenDepth::Value));
        let mut vertices = triangles(random, Style::Large, case.size, 4);
        for vertex in &mut vertices {
            vertex.values[3] = random.odd_number();
        }
        draw.buffers[0].1 = estampe_tests::geometry::vertex_buffer(&vertices);
        draw.elements = 0..12;
        case.draws.push(draw);
        case
    });
}

/// Rows: F1, O4.
#[test]
fn targets_with_depth_alone() {
    check_paths(
        "depth/only",
        30,
        ExpectedPaths(&[TilePath::VisibilityDepthOnly]),
        |random| {
            let mut case = target(random);
            case.format = None;
            for _ in 0..2 {
                let draw = draw_with(random, &case, DepthOnly);
                case.draws.push(draw);
            }
            case
        },
    );
}

/// Rows: O4, O9.
#[test]
fn whole_blocks_are_hidden_only_where_nothing_passes() {
    // Many large triangles over a target of several tiles: hierarchical z rejects blocks.
    check("depth/hierarchy", 8, |random| {
        let mut case = Case::new([140, 75], random.pick(&[1, 4]));
        let is_nearer_less = random.once_in(2);
        case.clear_depth = if is_nearer_less { 1.0 } else { 0.0 };
        let compares = if is_nearer_less {
            [CompareFunction::Less, CompareFunction::LessEqual]
        } else {
            [CompareFunction::Greater, CompareFunction::GreaterEqual]
        };
        for _ in 0..4 {
            let shader: TestShader = match random.below(3) {
                0 => Cutout.into(),
                1 => Colored.into(),
                _ => FlatColored.into(),
            };
            let vertices = triangles(random, Style::Large, case.size, 3);
            let mut draw = CaseDraw::new(shader, &vertices);
            draw.depth = Some(DepthState {
                compare: random.pick(&compares),
                write_enabled: !random.once_in(4),
            });
            case.draws.push(draw);
        }
        case
    });
}
