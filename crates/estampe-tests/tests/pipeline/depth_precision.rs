//! Depth formats with reversed, infinite and logarithmic depth mappings, and with limited depth
//! outputs of shaders.

use estampe_tests::geometry::{Style, Vertex, triangles};
use estampe_tests::shaders::{Colored, HeldDepth, LogarithmicDepth};
use estampe_tests::{Case, CaseDraw, Random, check};
use estampe_types::TextureFormat;
use estampe_types::state::{CompareFunction, DepthState, Viewport};

const FORMATS: [TextureFormat; 5] = [
    TextureFormat::Depth16Unorm,
    TextureFormat::Depth24Plus,
    TextureFormat::Depth24PlusStencil8,
    TextureFormat::Depth32Float,
    TextureFormat::Depth32FloatStencil8,
];

fn depth_state(random: &mut Random, compare: &[CompareFunction]) -> DepthState {
    DepthState {
        compare: random.pick(compare),
        write_enabled: !random.once_in(4),
    }
}

/// Two nearly coplanar walls and triangles between them, in perspective from near to far.
fn walls(random: &mut Random, clip_depth: impl Fn(f32) -> f32) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for _ in 0..6 {
        let distance = random.pick(&[0.02, 0.5, 3.0, 40.0, 900.0]) * random.range(0.9, 1.1);
        for _ in 0..3 {
            // Almost parallel to the window, slightly apart.
            let w = distance * random.range(1.0, 1.0001);
            let place = [random.range(-1.5, 1.5), random.range(-1.5, 1.5)];
            vertices.push(Vertex {
                position: [place[0] * w, place[1] * w, clip_depth(w), w],
                values: random.four(0.0, 1.0),
            });
        }
    }
    vertices
}

fn target(random: &mut Random) -> Case {
    let mut case = Case::random_target(random);
    case.depth_stencil = Some(random.pick(&FORMATS));
    case
}

/// Rows: D1.
#[test]
fn reversed_depth_with_an_infinite_far_plane() {
    use CompareFunction as C;
    check("depth_precision/reversed", 40, |random| {
        let mut case = target(random);
        case.clear_depth = 0.0;
        for _ in 0..3 {
            // z = near: depth is near ÷ w, 1 at the near plane and 0 infinitely far.
            let vertices = walls(random, |_| 0.01);
            let mut draw = CaseDraw::new(Colored, &vertices);
            draw.depth = Some(depth_state(random, &[C::Greater, C::GreaterEqual]));
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: D1.
#[test]
fn an_infinite_far_plane_and_a_reversed_viewport() {
    use CompareFunction as C;
    check("depth_precision/infinite", 40, |random| {
        let mut case = target(random);
        let is_reversed = random.once_in(2);
        case.clear_depth = if is_reversed { 0.0 } else { 1.0 };
        for _ in 0..3 {
            // z = w − near: 0 at the near plane, 1 infinitely far.
            let vertices = walls(random, |w| w - 0.01);
            let mut draw = CaseDraw::new(Colored, &vertices);
            let [width, height] = case.size.map(|side| side as f32);
            draw.viewport = Some(Viewport {
                x: 0.0,
                y: 0.0,
                width,
                height,
                min_depth: if is_reversed { 1.0 } else { 0.0 },
                max_depth: if is_reversed { 0.0 } else { 1.0 },
            });
            let nearer = if is_reversed {
                [C::Greater, C::GreaterEqual]
            } else {
                [C::Less, C::LessEqual]
            };
            draw.depth = Some(depth_state(random, &nearer));
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: D1, F1.
#[test]
fn logarithmic_depth_is_a_shaders_output() {
    check("depth_precision/logarithmic", 40, |random| {
        let mut case = target(random);
        for _ in 0..3 {
            let vertices = walls(random, |w| w - 0.01);
            let mut draw = CaseDraw::new(LogarithmicDepth(1000.0), &vertices);
            draw.depth = Some(DepthState::LESS_WRITE);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: F1, O4, O9.
#[test]
fn depths_with_declared_limits() {
    use CompareFunction as C;
    check("depth_precision/promised", 60, |random| {
        let mut case = target(random);
        case.clear_depth = random.pick(&[1.0, 0.5, 0.0]);
        for _ in 0..3 {
            let style = random.pick(&[Style::Large, Style::Small, Style::AcrossDepths]);
            let vertices = triangles(random, style, case.size, 4);
            let mut draw = if random.once_in(2) {
                CaseDraw::new(HeldDepth::<true>, &vertices)
            } else {
                CaseDraw::new(HeldDepth::<false>, &vertices)
            };
            let all = [
                C::Less,
                C::LessEqual,
                C::Greater,
                C::GreaterEqual,
                C::Equal,
                C::Always,
            ];
            draw.depth = Some(depth_state(random, &all));
            draw.is_counted = true;
            draw.sample_shading = random.once_in(4);
            case.draws.push(draw);
        }
        case
    });
}
