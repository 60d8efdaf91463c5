//! Several colour attachments of different formats, integer attachments, dual-source blending,
//! targets without colour.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, DepthOnly, Layers, TwoColors};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction,
    DepthState, LogicOperation, StencilFaceState, StencilOperation, StencilState,
};
use estampe_types::{SampleType, TextureFormat};

const FACTORS: [BlendFactor; 12] = [
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Dst,
    BlendFactor::DstAlpha,
    BlendFactor::OneMinusDstAlpha,
    BlendFactor::SrcAlphaSaturated,
    BlendFactor::ConstantAlpha,
    BlendFactor::Src1,
    BlendFactor::OneMinusSrc1,
    BlendFactor::Src1Alpha,
    BlendFactor::OneMinusSrc1Alpha,
];

fn component(random: &mut Random, factors: &[BlendFactor]) -> BlendComponent {
    BlendComponent {
        operation: random.pick(&[
            BlendOperation::Add,
            BlendOperation::Subtract,
            BlendOperation::ReverseSubtract,
            BlendOperation::Min,
            BlendOperation::Max,
        ]),
        src_factor: random.pick(factors),
        dst_factor: random.pick(factors),
    }
}

fn blend(random: &mut Random, factors: &[BlendFactor]) -> BlendState {
    BlendState {
        color: component(random, factors),
        alpha: component(random, factors),
    }
}

fn renderable() -> Vec<TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    all.filter(|format| format.is_renderable()).collect()
}

/// A mask of the attachments with integer formats.
fn integers(formats: &[TextureFormat]) -> u8 {
    let is_integer = |format: &TextureFormat| format.sample_type() != SampleType::Float;
    let bits = formats.iter().enumerate();
    bits.fold(0, |bits, (k, format)| {
        bits | u8::from(is_integer(format)) << k
    })
}

/// A case of `count` attachments and some draws, with blending and write masks per attachment.
fn layers(random: &mut Random, count: usize, blended: bool) -> Case {
    let formats = renderable();
    let mut case = Case::random_target(random);
    case.samples = random.pick(&[1, 1, 2, 4]);
    let mut chosen: Vec<_> = (0..count).map(|_| random.pick(&formats)).collect();
    if blended {
        // A pipeline may not blend integer attachments: most formats here are not integers.
        let blendable: Vec<_> = formats
            .iter()
            .copied()
            .filter(|f| f.is_blendable())
            .collect();
        for format in chosen.iter_mut().skip(1) {
            *format = random.pick(&blendable);
        }
    }
    case.format = Some(chosen[0]);
    case.more_formats = chosen[1..].to_vec();
    case.clear_color = random.four(-0.5, 1.5);
    let shader: TestShader = match count {
        1 => Layers::<1>(integers(&chosen)).into(),
        3 => Layers::<3>(integers(&chosen)).into(),
        _ => Layers::<8>(integers(&chosen)).into(),
    };
    for _ in 0..3 {
        let style = random.pick(&[Style::Large, Style::Small, Style::OnGrid]);
        let vertices = triangles(random, style, case.size, 3);
        let mut draw = CaseDraw::new(shader.clone(), &vertices);
        draw.blend_constant = random.four(-0.5, 1.5);
        let mut state = |format: TextureFormat| {
            let blends = blended && format.is_blendable() && !random.once_in(3);
            let mask = random.pick(&[0xF, 0xF, random.clone().byte() & 0xF]);
            (
                blends.then(|| blend(random, &FACTORS[..8])),
                ColorWrites(mask),
            )
        };
        (draw.blend, draw.write_mask) = state(chosen[0]);
        draw.more_targets = chosen[1..].iter().map(|&format| state(format)).collect();
        if !blended && random.once_in(3) {
            draw.logic_operation = Some(random.pick(&LogicOperation::ALL));
        }
        draw.is_counted = random.once_in(2);
        case.draws.push(draw);
    }
    if random.once_in(3) {
        case.second_pass = random.index(4);
    }
    case
}

/// Rows: F1, O8.
#[test]
fn three_targets_of_any_formats() {
    check("attachments/three", 50, |random| layers(random, 3, false));
}

/// Rows: F1, O5, O7, O8.
#[test]
fn three_targets_blended_each_in_its_own_way() {
    check("attachments/blended", 40, |random| layers(random, 3, true));
}

/// Rows: F1, O8, N1.
#[test]
fn eight_targets() {
    check("attachments/eight", 25, |random| {
        let blended = random.once_in(2);
        layers(random, 8, blended)
    });
}

/// Rows: O6, O8.
#[test]
fn integers_reach_the_ends_of_their_ranges() {
    let of_integers = |format: &TextureFormat| format.sample_type() != SampleType::Float;
    let formats: Vec<_> = renderable().into_iter().filter(of_integers).collect();
    check("attachments/integers", 50, |random| {
        let mut case = layers(random, 1, false);
        let format = random.pick(&formats);
        case.format = Some(format);
        case.clear_color = random.four(-300.0, 300.0);
        for draw in &mut case.draws {
            draw.shader = Layers::<1>(1).into();
        }
        case
    });
}

/// Rows: F1, O5.
#[test]
fn two_sources() {
    let blendable: Vec<_> = renderable()
        .into_iter()
        .filter(|f| f.is_blendable())
        .collect();
    check("attachments/dual source", 50, |random| {
        let mut case = Case::random_target(random);
        case.format = Some(random.pick(&blendable));
        case.clear_color = random.four(-0.5, 1.5);
        for _ in 0..3 {
            let vertices = triangles(random, Style::Large, case.size, 3);
            let mut draw = CaseDraw::new(TwoColors, &vertices);
            draw.blend = (!random.once_in(6)).then(|| blend(random, &FACTORS));
            draw.blend_constant = random.four(-0.5, 1.5);
            draw.depth = None;
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: O5, O8.
#[test]
fn nan_infinite_and_huge_numbers() {
    // Integers would show a NaN's bits, which depend on the processor.
    let blendable: Vec<_> = renderable()
        .into_iter()
        .filter(|f| f.is_blendable())
        .collect();
    check("attachments/odd numbers", 60, |random| {
        let mut case = Case::random_target(random);
        case.samples = random.pick(&[1, 1, 2, 4]);
        case.format = Some(random.pick(&blendable));
        case.clear_color = random.four(-0.5, 1.5);
        if random.once_in(2) {
            case.clear_color[random.index(4)] = random.odd_number();
        }
        for _ in 0..3 {
            let mut vertices = triangles(random, Style::Large, case.size, 3);
            for triangle in vertices.chunks_mut(3) {
                // The same at all corners, so that interpolation does not lose it.
                let values = [0; 4].map(|_| match random.below(3) {
                    0 => random.odd_number(),
                    1 => random.range(-1e5, 1e5),
                    _ => random.unit(),
                });
                for vertex in triangle {
                    vertex.values = values;
                }
            }
            let shader: TestShader = match random.below(3) {
                0 => TwoColors.into(),
                1 => Colored.into(),
                _ => Layers::<1>(0).into(),
            };
            let is_dual = matches!(shader, TestShader::TwoColors(_));
            let mut draw = CaseDraw::new(shader, &vertices);
            let factors = if is_dual { &FACTORS[..] } else { &FACTORS[..8] };
            draw.blend = (!random.once_in(3)).then(|| blend(random, factors));
            draw.blend_constant = [0; 4].map(|_| match random.below(2) {
                0 => random.odd_number(),
                _ => random.unit(),
            });
            draw.alpha_to_coverage = random.once_in(4);
            draw.depth = None;
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: O3, O4, O10, D1.
#[test]
fn targets_without_colours() {
    use TextureFormat as F;
    check("attachments/none", 60, |random| {
        let mut case = Case::random_target(random);
        case.samples = random.pick(&[1, 2, 4, 8]);
        case.format = None;
        case.depth_stencil = random.pick(&[
            None,
            Some(F::Stencil8),
            Some(F::Depth16Unorm),
            Some(F::Depth24Plus),
            Some(F::Depth24PlusStencil8),
            Some(F::Depth32Float),
            Some(F::Depth32FloatStencil8),
        ]);
        case.clear_depth = random.pick(&[1.0, 0.3, f32::NAN, 7.0]);
        case.clear_stencil = random.byte();
        let has = |what: fn(F) -> bool| case.depth_stencil.is_some_and(what);
        let (has_depth, has_stencil) = (has(F::has_depth), has(F::has_stencil));
        for _ in 0..4 {
            let style = random.pick(&[Style::Large, Style::Small, Style::AcrossDepths]);
            let vertices = triangles(random, style, case.size, 4);
            let mut draw = CaseDraw::new(DepthOnly, &vertices);
            draw.depth = (has_depth && !random.once_in(4)).then(|| DepthState {
                write_enabled: !random.once_in(3),
                compare: random.pick(&[
                    CompareFunction::Less,
                    CompareFunction::GreaterEqual,
                    CompareFunction::NotEqual,
                    CompareFunction::Always,
                ]),
            });
            draw.stencil = (has_stencil && !random.once_in(4)).then(|| {
                StencilState::from(StencilFaceState {
                    compare: random.pick(&[CompareFunction::Less, CompareFunction::Always]),
                    fail_op: StencilOperation::DecrementClamp,
                    depth_fail_op: StencilOperation::Invert,
                    pass_op: random
                        .pick(&[StencilOperation::IncrementWrap, StencilOperation::Replace]),
                    read_mask: random.pick(&[0xFF, 0x7F]),
                    write_mask: random.pick(&[0xFF, 0x3C]),
                })
            });
            draw.stencil_reference = [random.byte(); 2];
            draw.depth_bounds = random.once_in(3).then(|| match random.below(3) {
                0 => [random.odd_number(), random.odd_number()],
                1 => [0.3, random.odd_number()],
                _ => [0.2, 0.7],
            });
            draw.is_counted = true;
            case.draws.push(draw);
        }
        if random.once_in(3) {
            case.second_pass = random.index(5);
        }
        case
    });
}
