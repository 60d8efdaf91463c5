//! Colours: encoding, blending, write masks and resolve.

use super::*;
use crate::blending::{BlendInputs, blend};
use crate::channel::Channel;
use crate::per_sample::masked;
use crate::srgb;

const UNORM: TextureFormat = TextureFormat::Rgba8Unorm;
const SRGB: TextureFormat = TextureFormat::Rgba8UnormSrgb;

/// Rows: O8.
#[test]
fn unorm_codes_round_half_up_and_clamp() {
    let unorm_code = |value| Channel::Unorm(8).encode(value);
    assert_eq!(unorm_code(0.5), 128);
    assert_eq!(unorm_code(f32::NAN), 0);
    assert_eq!(unorm_code(-7.0), 0);
    assert_eq!(unorm_code(f32::INFINITY), 255);
    for code in 0..=255 {
        let decoded = color::decode(UNORM, [code; 4]);
        assert_eq!(color::encode(UNORM, decoded), [code; 4]);
        let decoded = color::decode(SRGB, [code; 4]);
        assert_eq!(color::encode(SRGB, decoded), [code; 4]);
    }
}

/// Rows: O8.
#[test]
fn srgb_follows_the_standard() {
    // IEC 61966-2-1: code 188 is linear 0.5029; middle grey 0.18 is code 118; alpha is linear.
    let [r, _, _, a] = color::decode(SRGB, [188, 0, 0, 188]);
    assert!((r - 0.502_886).abs() < 1e-6);
    assert_eq!(a, 188.0 * (1.0 / 255.0));
    assert_eq!(
        color::encode(SRGB, [0.18, 0.18, 0.18, 0.18]),
        [118, 118, 118, 46]
    );
}

/// Rows: O8.
#[test]
#[expect(clippy::cast_possible_truncation, reason = "rounds, once")]
fn srgb_tables_are_the_formula_in_f64() {
    let decoded = |encoded: f64| match encoded {
        e if e <= 0.040_45 => e / 12.92,
        e => libm::pow((e + 0.055) / 1.055, 2.4),
    };
    for code in 0..=255_u32 {
        let (got, exact) = (srgb::linear(code), decoded(f64::from(code) / 255.0));
        // The nearest f32: neither neighbour is nearer.
        let error = |value: f32| (f64::from(value) - exact).abs();
        assert!(error(got) <= error(got.next_up()), "{code}");
        assert!(error(got) <= error(got.next_down()), "{code}");
        assert_eq!(u32::from(srgb::code(got)), code);
    }
    for code in 0..255_u8 {
        // The least f32 that encodes to the next code.
        let boundary = decoded((f64::from(code) + 0.5) / 255.0);
        let mut first = boundary as f32;
        if f64::from(first) < boundary {
            first = first.next_up();
        }
        assert_eq!(srgb::code(first), code + 1);
        assert_eq!(srgb::code(first.next_down()), code);
    }
    assert_eq!(srgb::code(f32::NAN), 0);
    assert_eq!(srgb::code(-1.0), 0);
    assert_eq!(srgb::code(f32::INFINITY), 255);
}

/// Rows: O5.
#[test]
fn blending_agrees_with_f64() {
    use BlendFactor as F;
    let factors = [
        F::Zero,
        F::One,
        F::Src,
        F::OneMinusSrc,
        F::SrcAlpha,
        F::OneMinusSrcAlpha,
        F::Dst,
        F::OneMinusDst,
        F::DstAlpha,
        F::OneMinusDstAlpha,
        F::SrcAlphaSaturated,
        F::Constant,
        F::OneMinusConstant,
        F::ConstantAlpha,
        F::OneMinusConstantAlpha,
        F::Src1,
        F::OneMinusSrc1,
        F::Src1Alpha,
        F::OneMinusSrc1Alpha,
    ];
    let operations = [
        BlendOperation::Add,
        BlendOperation::Subtract,
        BlendOperation::ReverseSubtract,
        BlendOperation::Min,
        BlendOperation::Max,
    ];
    let mut random = Random::new(41);
    for _ in 0..5000 {
        let mut colour = || [0; 4].map(|_: i32| random.unit());
        let (s, d, k, m) = (colour(), colour(), colour(), colour());
        let mut component = || BlendComponent {
            operation: operations[random.below(5) as usize],
            src_factor: factors[random.below(19) as usize],
            dst_factor: factors[random.below(19) as usize],
        };
        let state = BlendState {
            color: component(),
            alpha: component(),
        };
        let result = blend(
            &state,
            &BlendInputs {
                source: s,
                second: m,
                constant: k,
                destination: d,
            },
        );
        for channel in 0..4 {
            let component = [state.color, state.alpha][usize::from(channel == 3)];
            let factor = |which: F| {
                let [s, d, k, m] = [s, d, k, m].map(|colour| colour.map(f64::from));
                match which {
                    F::Zero => 0.0,
                    F::One => 1.0,
                    F::Src => s[channel],
                    F::OneMinusSrc => 1.0 - s[channel],
                    F::SrcAlpha => s[3],
                    F::OneMinusSrcAlpha => 1.0 - s[3],
                    F::Dst => d[channel],
                    F::OneMinusDst => 1.0 - d[channel],
                    F::DstAlpha => d[3],
                    F::OneMinusDstAlpha => 1.0 - d[3],
                    F::SrcAlphaSaturated if channel < 3 => s[3].min(1.0 - d[3]),
                    F::Constant => k[channel],
                    F::OneMinusConstant => 1.0 - k[channel],
                    F::ConstantAlpha => k[3],
                    F::OneMinusConstantAlpha => 1.0 - k[3],
                    F::Src1 => m[channel],
                    F::OneMinusSrc1 => 1.0 - m[channel],
                    F::Src1Alpha => m[3],
                    F::OneMinusSrc1Alpha => 1.0 - m[3],
                    _ => 1.0,
                }
            };
            let (source, destination) = (f64::from(s[channel]), f64::from(d[channel]));
            let scaled = source * factor(component.src_factor);
            let kept = destination * factor(component.dst_factor);
            let exact = match component.operation {
                BlendOperation::Add => scaled + kept,
                BlendOperation::Subtract => scaled - kept,
                BlendOperation::ReverseSubtract => kept - scaled,
                BlendOperation::Min => source.min(destination),
                BlendOperation::Max => source.max(destination),
            };
            // Each term is rounded twice, the sum once: five halves of an ulp of at most 2.
            let error = (f64::from(result[channel]) - exact).abs();
            assert!(
                error <= 5.0 * exact::UNIT_ROUNDOFF * 1.01,
                "{component:?}: {error:e}"
            );
        }
    }
}

/// Rows: O5, O7, O8.
#[test]
fn a_draw_blends_masks_and_decodes_srgb() {
    let full = [[-1.0, 1.0], [-1.0, -3.0], [3.0, 1.0]];
    let vertices = |value: f32| full.map(|[x, y]| ([x, y, 0.0, 1.0], [value; 3]));
    let state = State {
        targets: vec![TargetState {
            blend: Some(BlendState::ADDITIVE),
            write_mask: ColorWrites(0b1011),
        }],
        ..State::new(1, 1)
    };
    let mut target = Target::new(1, 1, 1, SRGB);
    target.clear([0.2, 0.2, 0.2, 0.0], 1.0);
    let stored = color::decode(SRGB, target.color[0])[0];
    let untouched = target.color[0][2];
    draw_plain(&mut target, &state, &vertices(0.3));
    let expected = u32::from(srgb::code(0.3 + stored));
    assert_eq!(target.color[0], [expected, expected, untouched, 255]);
    assert_eq!(masked(ColorWrites::NONE, [1; 4], [2; 4]), [2; 4]);

    // Sources are clamped before blending: 5 counts as 1, NaN as 0.
    let state = State {
        targets: vec![TargetState {
            blend: Some(BlendState {
                color: BlendComponent {
                    operation: BlendOperation::ReverseSubtract,
                    src_factor: BlendFactor::One,
                    dst_factor: BlendFactor::One,
                },
                alpha: BlendComponent::REPLACE,
            }),
            ..TargetState::default()
        }],
        ..State::new(1, 1)
    };
    for (source, left) in [(5.0, 0), (f32::NAN, 255), (0.2, 204)] {
        let mut target = Target::new(1, 1, 1, UNORM);
        target.clear([1.0; 4], 1.0);
        draw_plain(&mut target, &state, &vertices(source));
        assert_eq!(target.color[0][0], left, "1 − {source}");
    }
}

/// Rows: R6.
#[test]
fn resolving_takes_the_mean_in_linear_light() {
    let codes = [
        [0, 1, 10, 255],
        [0, 2, 20, 255],
        [255, 2, 30, 0],
        [255, 2, 41, 0],
    ];
    let unorm = color::resolve(UNORM, &codes);
    assert_eq!(unorm, [128, 2, 25, 128]); // 127.5, 1.75, 25.25, 127.5 with ½ added, floored
    let srgb = color::resolve(SRGB, &codes);
    assert_eq!((srgb[0], srgb[3]), (188, 128)); // half the light, half the alpha

    let mut target = Target::new(1, 1, 4, UNORM);
    target.color.copy_from_slice(&codes);
    assert_eq!(target.resolve(0), [unorm]);
    assert_eq!(color::resolve(SRGB, &[[7, 99, 200, 3]]), [7, 99, 200, 3]);
}
