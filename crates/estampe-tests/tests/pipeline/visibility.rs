//! The visibility path: many opaque triangles over each other, large and small, whose equal depths
//! are resolved by the order of drawing.

use estampe::TilePath;
use estampe_tests::geometry::{Style, Vertex, triangles, values, whole_target};
use estampe_tests::shaders::{Colored, FlatColored, Halved, Layers, Probe};
use estampe_tests::{Case, CaseDraw, ExpectedPaths, Random, TestShader, check_paths};
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendState, ColorWrites, CompareFunction, CullMode, DepthState, ScissorRect,
};

const ORDERED: [CompareFunction; 4] = [
    CompareFunction::Less,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::GreaterEqual,
];

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => FlatColored.into(),
        1 => Halved.into(),
        2 => Probe::random(random).into(),
        _ => Colored.into(),
    }
}

/// Sets whole triangles to one of a few depths, so that many depths are equal to the bit.
fn quantize(random: &mut Random, vertices: &mut [Vertex]) {
    for triangle in vertices.chunks_exact_mut(3) {
        if random.once_in(4) {
            continue;
        }
        let depth = random.pick(&[0.0, 0.25, 0.5, 0.75, 1.0]);
        for vertex in triangle {
            vertex.position[2] = depth * vertex.position[3];
        }
    }
}

/// A draw whose comparison orders depths; sometimes with any comparison.
fn opaque(random: &mut Random, vertices: &[Vertex]) -> CaseDraw {
    let mut draw = CaseDraw::new(shader(random), vertices);
    draw.depth = match random.below(8) {
        0 => None,
        1 => Some(DepthState {
            compare: random.pick(&[CompareFunction::Always, CompareFunction::Equal]),
            write_enabled: true,
        }),
        _ => Some(DepthState {
            compare: random.pick(&ORDERED),
            write_enabled: !random.once_in(6),
        }),
    };
    draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Back]);
    draw.is_counted = random.once_in(3);
    draw
}

fn target(random: &mut Random, size: [u32; 2]) -> Case {
    let mut case = Case::new(size, random.pick(&[1, 1, 1, 4, 4, 2, 8, 16]));
    case.clear_depth = random.pick(&[1.0, 0.0, 0.5]);
    case.clear_color = random.four(0.0, 1.0);
    case
}

/// Rows: O4, U3.
#[test]
fn large_triangles_over_each_other() {
    check_paths(
        "visibility/large",
        24,
        ExpectedPaths(&[
            TilePath::VisibilityPerPrimitive,
            TilePath::VisibilityCrossTriangle,
            TilePath::VisibilityQuads,
        ]),
        |random| {
            let mut case = target(random, [140, 75]);
            // Large triangles are sorted over draws in a row that test depth in the same way.
            let shared_depth = random.once_in(2).then(|| DepthState {
                compare: random.pick(&ORDERED),
                write_enabled: true,
            });
            let most = random.pick(&[2, 10]);
            for _ in 0..=random.below(most) {
                let count = 1 + random.below(14);
                let mut vertices = triangles(random, Style::Large, case.size, count);
                quantize(random, &mut vertices);
                let mut draw = opaque(random, &vertices);
                if shared_depth.is_some() && !random.once_in(6) {
                    draw.depth = shared_depth;
                    draw.is_counted = false;
                }
                if random.once_in(4) {
                    draw.scissor = Some(ScissorRect {
                        x: random.below(60),
                        y: random.below(40),
                        width: 70,
                        height: 30,
                    });
                }
                case.draws.push(draw);
            }
            case
        },
    );
}

/// Rows: O4, R5.
#[test]
fn blocks_that_show_one_triangle() {
    let paths = ExpectedPaths(&[TilePath::VisibilityQuads]);
    let statistics = check_paths("visibility/blocks", 60, paths, |random| {
        let mut case = target(random, [150, 90]);
        for draw in 0..=random.below(2) {
            let corner = values(random);
            let vertices = match draw {
                0 if random.once_in(3) => {
                    whole_target(case.size, |[x, y]| corner.map(|value| value + x - y))
                }
                _ => triangles(random, Style::Huge, case.size, 2),
            };
            let mut draw = opaque(random, &vertices);
            draw.shader = Probe::random(random).into();
            case.draws.push(draw);
        }
        case
    });
    assert!(statistics.blocks_queued > 0, "each packet came alone");
}

/// Rows: R1, O4, U3.
#[test]
fn many_small_triangles() {
    check_paths(
        "visibility/small",
        24,
        ExpectedPaths(&[
            TilePath::VisibilityPerPrimitive,
            TilePath::VisibilityCrossTriangle,
            TilePath::VisibilityQuads,
        ]),
        |random| {
            let mut case = target(random, [40, 36]);
            for _ in 0..=random.below(2) {
                let style = random.pick(&[Style::Tiny, Style::Small, Style::OnGrid]);
                let count = 40 + random.below(60);
                let mut vertices = triangles(random, style, case.size, count);
                if random.once_in(2) {
                    vertices.extend(triangles(random, Style::Large, case.size, 2));
                    vertices.extend(triangles(random, style, case.size, 20));
                }
                quantize(random, &mut vertices);
                case.draws.push(opaque(random, &vertices));
            }
            case
        },
    );
}

/// Rows: O4, O5, U3.
#[test]
fn opaque_and_blended_draws_in_turn() {
    check_paths(
        "visibility/turns",
        24,
        ExpectedPaths(&[
            TilePath::VisibilityPerPrimitive,
            TilePath::VisibilityCrossTriangle,
            TilePath::VisibilityQuads,
            TilePath::InOrderBlocks,
            TilePath::InOrderQuads,
        ]),
        |random| {
            let mut case = target(random, [100, 70]);
            for turn in 0..4 {
                let style = random.pick(&[Style::Large, Style::Small]);
                let mut vertices = triangles(random, style, case.size, 5);
                quantize(random, &mut vertices);
                if random.once_in(2) {
                    for vertex in &mut vertices {
                        // The same alpha everywhere, and all values in 0..1.
                        vertex.values = vertex.values.map(|value| value.clamp(0.0, 1.0));
                        vertex.values[3] = 0.25;
                        vertex.position[3] = 1.0;
                    }
                }
                let mut draw = opaque(random, &vertices);
                if turn % 2 == 1 {
                    draw.shader = Colored.into();
                    draw.blend = Some(BlendState::ALPHA_BLENDING);
                }
                case.draws.push(draw);
            }
            if random.once_in(3) {
                case.clear_color[3] = 1.0;
            }
            case
        },
    );
}

/// Colours and depths wait to be cleared until it is known where triangles are shown.
///
/// Rows: O7, U3.
#[test]
fn packets_that_triangles_cover_are_not_cleared() {
    let paths = ExpectedPaths(&[
        TilePath::VisibilityPerPrimitive,
        TilePath::VisibilityCrossTriangle,
        TilePath::VisibilityQuads,
        TilePath::InOrderQuads,
    ]);
    let statistics = check_paths("visibility/uncleared", 120, paths, |random| {
        let mut case = Case::new([128, 70], random.pick(&[1, 1, 1, 4]));
        let formats = [
            TextureFormat::Rgba16Float,
            TextureFormat::Rgba32Float,
            TextureFormat::Bgra8Unorm,
        ];
        case.format = Some(random.pick(&formats));
        if random.once_in(2) {
            case.more_formats
                .push(random.pick(&[TextureFormat::Rgba8Unorm, TextureFormat::Rgba16Float]));
        }
        case.clear_color = random.four(0.0, 1.0);
        for draw in 0..=random.below(3) {
            let corner = values(random);
            let vertices = match (draw, random.below(4)) {
                (_, 0) => triangles(random, Style::Small, case.size, 9),
                // One triangle in each tile may replace its blocks.
                (0, 1) => triangles(random, Style::Huge, case.size, 2),
                (0, _) => whole_target(case.size, |[x, y]| corner.map(|value| value + x - y)),
                _ => triangles(random, Style::Large, case.size, 2),
            };
            let mut draw = opaque(random, &vertices);
            if !case.more_formats.is_empty() {
                draw.shader = Layers::<2>(0).into();
            }
            draw.write_mask = random.pick(&[
                ColorWrites::ALL,
                ColorWrites::ALL,
                ColorWrites::COLOR,
                ColorWrites::NONE,
            ]);
            draw.blend = random.pick(&[None, None, None, Some(BlendState::ALPHA_BLENDING)]);
            case.draws.push(draw);
        }
        case
    });
    assert!(statistics.packets_shown_uncleared > 0, "all were cleared");
    let blocks = statistics.blocks_uncleared;
    assert!(blocks > 0, "no triangle replaced all of a block");
    let level = statistics.blocks_of_one_depth;
    assert!(level > 0, "no triangle in whole blocks was level");
}
