//! Several targets of different formats, integers, and two colours for one target.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Layers, TwoColors};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, LogicOperation,
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

/// The targets of integers, bit by bit.
fn integers(formats: &[TextureFormat]) -> u8 {
    let is_integer = |format: &TextureFormat| format.sample_type() != SampleType::Float;
    let bits = formats.iter().enumerate();
    bits.fold(0, |bits, (k, format)| {
        bits | u8::from(is_integer(format)) << k
    })
}

/// A case of so many attachments, with some draws, each target blended and masked in its own way.
fn layers(random: &mut Random, count: usize, blended: bool) -> Case {
    let formats = renderable();
    let mut case = Case::random_target(random);
    case.samples = random.pick(&[1, 1, 2, 4]);
    let mut chosen: Vec<_> = (0..count).map(|_| random.pick(&formats)).collect();
    if blended {
        // A blended pipeline may not have integers where it blends: most are numbers.
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

/// Rows: F1, O8, L.
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
