//! Blending, write masks, sRGB, clearing and loading.

use estampe::TilePath;
use estampe_reference::srgb::THRESHOLDS;
use estampe_tests::geometry::{Style, Vertex, clip_at, triangles};
use estampe_tests::shaders::{Colored, FlatColored, Probe, Sized};
use estampe_tests::{
    Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_one, check_paths,
};
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction,
    DepthState, PrimitiveTopology,
};

const FACTORS: [BlendFactor; 13] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::OneMinusSrc,
    BlendFactor::SrcAlpha,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Dst,
    BlendFactor::OneMinusDst,
    BlendFactor::DstAlpha,
    BlendFactor::OneMinusDstAlpha,
    BlendFactor::SrcAlphaSaturated,
    BlendFactor::Constant,
    BlendFactor::OneMinusConstant,
];

const OPERATIONS: [BlendOperation; 5] = [
    BlendOperation::Add,
    BlendOperation::Subtract,
    BlendOperation::ReverseSubtract,
    BlendOperation::Min,
    BlendOperation::Max,
];

fn component(random: &mut Random) -> BlendComponent {
    BlendComponent {
        operation: random.pick(&OPERATIONS),
        src_factor: random.pick(&FACTORS),
        dst_factor: random.pick(&FACTORS),
    }
}

fn blend_state(random: &mut Random) -> Option<BlendState> {
    match random.below(6) {
        0 => None,
        1 => Some(BlendState::ALPHA_BLENDING),
        2 => Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        3 => Some(BlendState::ADDITIVE),
        _ => Some(BlendState {
            color: component(random),
            alpha: component(random),
        }),
    }
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => FlatColored.into(),
        1 => Probe::random(random).into(),
        _ => Colored.into(),
    }
}

fn layers(random: &mut Random, format: TextureFormat) -> Case {
    let mut case = Case::random_target(random);
    case.format = Some(format);
    case.clear_color = random.four(-0.2, 1.2);
    if random.once_in(6) {
        case.clear_color[random.below(4) as usize] = random.odd_number();
    }
    for _ in 0..3 {
        let style = random.pick(&[Style::Large, Style::Large, Style::Small]);
        let mut vertices = triangles(random, style, case.size, 3);
        if random.once_in(5) {
            for vertex in &mut vertices {
                vertex.values[random.below(4) as usize] = random.odd_number();
            }
        }
        let mut draw = CaseDraw::new(shader(random), &vertices);
        draw.depth = None;
        draw.blend = blend_state(random);
        draw.blend_constant = random.four(-0.3, 1.3);
        draw.write_mask = match random.below(3) {
            0 => ColorWrites(random.byte() & 0xF),
            _ => ColorWrites::ALL,
        };
        case.draws.push(draw);
    }
    if random.once_in(2) {
        case.second_pass = random.below(4) as usize;
    }
    case
}

/// Rows: O5, O7, O8.
#[test]
fn unorm_targets() {
    check_paths(
        "colors/unorm",
        80,
        ExpectedPaths(&[TilePath::InOrderBlocks, TilePath::InOrderQuads]),
        |random| layers(random, TextureFormat::Rgba8Unorm),
    );
}

/// Rows: O5.
#[test]
fn layers_of_whole_blocks() {
    let statistics = check_paths(
        "colors/layers",
        24,
        ExpectedPaths(&[TilePath::InOrderBlocks]),
        |random| {
            let size = random.pick(&[[64, 64], [100, 70], [63, 65], [130, 40]]);
            let mut case = Case::new(size, 1);
            case.format = Some(random.pick(&[
                TextureFormat::Rgba8Unorm,
                TextureFormat::Bgra8Unorm,
                TextureFormat::Rgba8Unorm,
            ]));
            case.clear_color = random.four(0.0, 1.0);
            if random.once_in(2) {
                case.clear_color[3] = 1.0;
            }
            for _ in 0..1 + random.below(3) {
                case.draws.push(draw_of_layers(random, size));
            }
            case
        },
    );
    let [packets, layers, exact] = statistics.layers_blended;
    let wide = estampe_tests::fast_path::all_devices();
    if wide.iter().all(|device| device.level().is_scalar()) {
        return;
    }
    // Most layers are blended together with others, and estimates decide many of them: not where
    // the tile is larger than the triangle, nor where a half of alpha makes ties.
    assert!(
        packets > 0 && layers > packets * 3 / 2,
        "{layers} in {packets}"
    );
    assert!(
        exact > layers / 200 && exact < layers * 9 / 10,
        "{exact} of {layers}"
    );
}

/// Triangles larger than the target, of smooth and of flat colours, with one alpha and with many;
/// some small ones between them.
fn draw_of_layers(random: &mut Random, size: [u32; 2]) -> CaseDraw {
    let [width, height] = size.map(|side| side as f32);
    let mut vertices = Vec::new();
    for _ in 0..1 + random.below(14) {
        let depth = random.pick(&[0.25, 0.5, 0.75]);
        let (is_flat, alpha) = (
            random.once_in(4),
            random.pick(&[0.0, 0.2, 0.5, 0.5, 0.8, 1.0]),
        );
        let has_many_alphas = random.once_in(3);
        let flat = random.four(0.0, 1.0);
        let reach = random.pick(&[1.0, 1.3, 4.0]);
        let corners = [[-0.1, -0.2], [2.2 * reach, -0.1], [-0.1, 2.3 * reach]];
        let mirror = random.once_in(2);
        for [x, y] in corners {
            let place = [
                x * width,
                if mirror {
                    height - y * height
                } else {
                    y * height
                },
            ];
            let mut values = if is_flat { flat } else { random.four(0.0, 1.0) };
            if !has_many_alphas {
                values[3] = alpha;
            }
            vertices.push(Vertex {
                position: clip_at(size, place, depth, 1.0),
                values,
            });
        }
        if random.once_in(6) {
            vertices.extend(triangles(random, Style::Small, size, 1));
        }
    }
    let mut draw = CaseDraw::new(Colored, &vertices);
    draw.blend = Some(BlendState::ALPHA_BLENDING);
    draw.depth = match random.below(3) {
        0 => None,
        _ => Some(DepthState {
            compare: random.pick(&[CompareFunction::Less, CompareFunction::LessEqual]),
            write_enabled: random.once_in(2),
        }),
    };
    draw
}

/// Rows: O5, O7, O8.
#[test]
fn srgb_targets() {
    check("colors/srgb", 60, |random| {
        layers(random, TextureFormat::Rgba8UnormSrgb)
    });
}

/// Rows: O5.
#[test]
fn overlapping_primitives_blend_in_order() {
    // More packets than one call of the shader takes, of many overlapping primitives.
    check("colors/order", 10, |random| {
        let mut case = Case::new([40, 36], random.pick(&[1, 4]));
        let vertices = triangles(random, Style::Small, case.size, 60);
        let shader: TestShader = if random.once_in(2) {
            Sized(Some(9.0)).into()
        } else {
            Colored.into()
        };
        let mut draw = CaseDraw::new(shader, &vertices);
        draw.depth = None;
        draw.blend = Some(BlendState::ALPHA_BLENDING);
        draw.primitive.topology = random.pick(&[
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleStrip,
            PrimitiveTopology::LineLoop,
            PrimitiveTopology::PointList,
        ]);
        case.draws.push(draw);
        case
    });
}

/// Rows: O8.
#[test]
fn srgb_codes_change_at_the_oracles_thresholds() {
    // One point for each threshold, and one for the f32 just below it.
    let size = [32, 16];
    let values = THRESHOLDS.iter().flat_map(|&at| [at.next_down(), at]);
    let vertices: Vec<_> = (0_u16..)
        .zip(values)
        .map(|(number, value)| {
            let place = [number % 32, number / 32].map(|along| f32::from(along) + 0.5);
            Vertex {
                position: clip_at(size, place, 0.5, 1.0),
                values: [value; 4],
            }
        })
        .collect();
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb] {
        let mut case = Case::new(size, 1);
        case.format = Some(format);
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.primitive.topology = PrimitiveTopology::PointList;
        case.draws.push(draw);
        let image = check_one("colors/srgb thresholds", &case);
        let reds = image.stored.texels[0].chunks(4).map(|texel| texel[0]);
        let expected = (0..255_u8).flat_map(|code| [code, code + 1]);
        assert!(reds.take(510).eq(expected));
    }
}

/// Rows: O5, O8.
#[test]
fn every_code_survives_blending_with_nothing() {
    // s·0 + d·1 gives each stored code again, in both formats.
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb] {
        let keep = BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::Zero,
            dst_factor: BlendFactor::One,
        };
        let mut random = Random::new("colors/keep", 1);
        let mut case = Case::new([64, 64], 1);
        case.format = Some(format);
        let vertices = triangles(&mut random, Style::Large, case.size, 8);
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.depth = None;
        case.draws.push(draw.clone());
        let before = check_one("colors/keep", &case);
        draw.blend = Some(BlendState {
            color: keep,
            alpha: keep,
        });
        case.draws.push(draw);
        let after = check_one("colors/keep", &case);
        assert_eq!(before.color, after.color);
    }
}
