//! Per-sample operations: order of the tests, stencil, logic operations, dual-source blending,
//! alpha to coverage.

use super::*;
use crate::cull::Face;
use crate::fragment::{Fragment, sample_depth};
use crate::per_sample::{Outcome, alpha_coverage, kept_samples, store_sample};
use TextureFormat as F;
use estampe_types::shader::DepthOutput;

fn fragment(color: [f32; 4]) -> Fragment {
    Fragment {
        colors: vec![color],
        second: [0.0; 4],
        depth: None,
        sample_mask: u16::MAX,
        is_discarded: false,
    }
}

fn pixel(color: F, depth_stencil: F) -> Target {
    Target::with_attachments([1, 1], 1, &[color], Some(depth_stencil))
}

const OPERATIONS: StencilFaceState = StencilFaceState {
    compare: CompareFunction::LessEqual,
    fail_op: StencilOperation::Zero,
    depth_fail_op: StencilOperation::IncrementWrap,
    pass_op: StencilOperation::Replace,
    read_mask: 0x0F,
    write_mask: 0xFF,
};

/// Rows: O3, O4.
#[test]
fn stencil_operations_depend_on_the_first_failing_test() {
    let state = State {
        depth: Some(DepthState::LESS_WRITE),
        stencil: Some(StencilState {
            front: OPERATIONS,
            back: StencilFaceState {
                compare: CompareFunction::Never,
                fail_op: StencilOperation::Invert,
                write_mask: 0xF0,
                ..OPERATIONS
            },
        }),
        stencil_reference: [0x25, 0],
        ..State::new(1, 1)
    };
    let mut target = pixel(F::Rgba8Unorm, F::Depth32FloatStencil8);
    let mut store = |face, depth, stencil: u8, state: &State| {
        target.clear([0.0; 4], 0.5);
        target.clear_stencil(stencil);
        let outcome = store_sample(&mut target, 0, state, face, depth, &fragment([1.0; 4]));
        (
            outcome == Outcome::Passed,
            target.stencil[0],
            target.depth[0],
            target.color[0][0],
        )
    };
    // 5 ≤ 7: passes, and then the depth test decides; 5 ≤ 3 fails.
    assert_eq!(
        store(Face::Front, 0.25, 0x37, &state),
        (true, 0x25, 0.25, 255)
    );
    assert_eq!(
        store(Face::Front, 0.75, 0xFF, &state),
        (false, 0x00, 0.5, 0)
    );
    assert_eq!(store(Face::Front, 0.25, 0xF3, &state), (false, 0, 0.5, 0));
    assert_eq!(store(Face::Back, 0.25, 0x37, &state), (false, 0xC7, 0.5, 0));
    // Outside the depth bounds the stencil does not change either; at their ends it does.
    let bounded = |depth_bounds| State {
        depth_bounds: Some(depth_bounds),
        ..state.clone()
    };
    let untouched = (false, 0x37, 0.5, 0);
    assert_eq!(
        store(Face::Back, 0.25, 0x37, &bounded([0.6, 1.0])),
        untouched
    );
    assert_eq!(
        store(Face::Back, 0.25, 0x37, &bounded([f32::NAN, 1.0])),
        untouched
    );
    assert_eq!(store(Face::Back, 0.25, 0x37, &bounded([0.5, 0.5])).1, 0xC7);
    // Without a depth test, depth passes and is not written.
    let no_depth = State {
        depth: None,
        ..state.clone()
    };
    assert_eq!(
        store(Face::Front, 0.75, 0x37, &no_depth),
        (true, 0x25, 0.5, 255)
    );
}

/// Rows: O3, O4.
#[test]
fn comparisons_are_new_against_stored() {
    use CompareFunction as C;
    // Against 5: 4, 5, 6 and NaN.
    for (function, passes) in [
        (C::Never, [false, false, false, false]),
        (C::Less, [true, false, false, false]),
        (C::Equal, [false, true, false, false]),
        (C::LessEqual, [true, true, false, false]),
        (C::Greater, [false, false, true, false]),
        (C::NotEqual, [true, false, true, true]),
        (C::GreaterEqual, [false, true, true, false]),
        (C::Always, [true, true, true, true]),
    ] {
        let numbers = [4.0, 5.0, 6.0, f32::NAN];
        let got = numbers.map(|new| compare::passes(function, new, 5.0));
        assert_eq!(got, passes, "{function:?}");
        let stored_nan = compare::passes(function, 5.0, f32::NAN);
        assert_eq!(stored_nan, passes[3], "{function:?}");
        for (new, passes) in [4_u8, 5, 6].into_iter().zip(passes) {
            assert_eq!(compare::passes(function, new, 5), passes, "{function:?}");
        }
        // As a signed byte, 200 would be −56, which is less.
        let is_greater = compare::passes(function, 200_u8, 5);
        assert_eq!(is_greater, passes[2], "{function:?}");
    }
}

/// Rows: O3.
#[test]
fn stencil_operations_stop_or_wrap_at_the_ends() {
    use StencilOperation as O;
    for (operation, at_0, at_255) in [
        (O::Keep, 0, 255),
        (O::Zero, 0, 0),
        (O::Replace, 9, 9),
        (O::Invert, 255, 0),
        (O::IncrementClamp, 1, 255),
        (O::DecrementClamp, 0, 254),
        (O::IncrementWrap, 1, 0),
        (O::DecrementWrap, 255, 254),
    ] {
        let face = StencilFaceState {
            pass_op: operation,
            ..StencilFaceState::default()
        };
        let got = [0, 255].map(|stored| stencil::updated(&face, 9, stored, true, true));
        assert_eq!(got, [at_0, at_255], "{operation:?}");
        let face = StencilFaceState {
            write_mask: 0x0F,
            ..face
        };
        assert_eq!(
            stencil::updated(&face, 9, 255, true, true),
            at_255 & 0x0F | 0xF0
        );
    }
}

/// Rows: D1, O4.
#[test]
fn depths_are_compared_as_the_format_holds_them() {
    let state = |compare| State {
        depth: Some(DepthState {
            write_enabled: true,
            compare,
        }),
        ..State::new(1, 1)
    };
    let mut target = pixel(F::Rgba8Unorm, F::Depth16Unorm);
    target.clear([0.0; 4], 0.5);
    let near = 0.5 + 1.0 / 200_000.0;
    let mut passes = |compare, depth| {
        store_sample(
            &mut target,
            0,
            &state(compare),
            Face::Front,
            depth,
            &fragment([0.0; 4]),
        ) == Outcome::Passed
    };
    assert!(passes(CompareFunction::Equal, near));
    assert!(!passes(CompareFunction::Greater, near));
    assert!(passes(CompareFunction::Greater, 32_769.0 / 65_535.0));
    assert_eq!(target.depth[0], 32_769.0 / 65_535.0);
}

/// Rows: O6.
#[test]
fn logic_operations_are_their_truth_tables() {
    // Vulkan numbers the operations so that the number is the table: s = 0011, d = 0101.
    for (number, operation) in (0..).zip(LogicOperation::ALL) {
        assert_eq!(
            logic::combine(operation, 0b0011, 0b0101) & 0xF,
            number,
            "{operation:?}"
        );
    }
    let stored_as = |format: F, operation, source: [f32; 4], clear: f64| {
        let mut target = pixel(format, F::Depth32Float);
        target.clear_color(0, [clear; 4]);
        let state = State {
            logic_operation: Some(operation),
            targets: vec![TargetState {
                blend: Some(BlendState::ADDITIVE),
                write_mask: ColorWrites::COLOR,
            }],
            ..State::new(1, 1)
        };
        store_sample(&mut target, 0, &state, Face::Front, 0.5, &fragment(source));
        target.color[0]
    };
    let half = [0.5; 4];
    use LogicOperation as L;
    // 128 ⊕ 255 = 127, and alpha is masked; two bits of alpha invert within two bits.
    assert_eq!(
        stored_as(F::Rgba8Unorm, L::Xor, half, 1.0),
        [127, 127, 127, 255]
    );
    assert_eq!(
        stored_as(F::Rgb10a2Unorm, L::Invert, half, 0.0),
        [1023, 1023, 1023, 0]
    );
    assert_eq!(
        stored_as(F::R8Snorm, L::CopyInverted, [-1.0; 4], 0.0),
        [0x7E, 0, 0, 0]
    );
    let bits = [f32::from_bits(0xF0F0); 4];
    assert_eq!(
        stored_as(F::Rg16Uint, L::And, bits, 4080.0),
        [0x00F0, 0x00F0, 0, 0]
    );
    // Float and sRGB formats: neither the logic operation nor blending.
    assert_eq!(
        stored_as(F::R16Float, L::Clear, half, 1.0),
        [0x3800, 0, 0, 0]
    );
    assert_eq!(
        stored_as(F::Rgba8UnormSrgb, L::NoOp, half, 1.0),
        [188, 188, 188, 255]
    );
}

/// Rows: O5, F1.
#[test]
fn the_second_colour_and_clamping_by_format() {
    let blended =
        |format: F, source: f32, second: f32, constant: f32, component: BlendComponent| {
            let mut target = pixel(format, F::Depth32Float);
            target.clear_color(0, [0.5; 4]);
            let state = State {
                targets: vec![TargetState {
                    blend: Some(BlendState {
                        color: component,
                        alpha: component,
                    }),
                    ..TargetState::default()
                }],
                blend_constant: [constant; 4],
                ..State::new(1, 1)
            };
            let fragment = Fragment {
                second: [second; 4],
                ..fragment([source; 4])
            };
            store_sample(&mut target, 0, &state, Face::Front, 0.5, &fragment);
            color::decode(format, target.color[0])[0]
        };
    let component = |src_factor, dst_factor, operation| BlendComponent {
        operation,
        src_factor,
        dst_factor,
    };
    use BlendFactor as B;
    let dual = component(B::Src1, B::OneMinusSrc1Alpha, BlendOperation::Add);
    assert_eq!(
        blended(F::R32Float, 2.0, 0.25, 0.0, dual),
        2.0 * 0.25 + 0.5 * 0.75
    );
    // Unorm clamps the source (2 to 1) and the second colour (4 to 1); float formats do not clamp.
    assert_eq!(blended(F::R8Unorm, 2.0, 4.0, 0.0, dual), 1.0);
    assert_eq!(
        blended(F::R32Float, 2.0, 4.0, 0.0, dual),
        2.0 * 4.0 + 0.5 * -3.0
    );
    let constant = component(B::ConstantAlpha, B::Zero, BlendOperation::Subtract);
    assert_eq!(blended(F::R32Float, 3.0, 0.0, -2.0, constant), -6.0);
    assert_eq!(blended(F::R16Snorm, -3.0, 0.0, -2.0, constant), 1.0);
    let least = component(B::Zero, B::Zero, BlendOperation::Min);
    assert_eq!(blended(F::R32Float, f32::NAN, 0.0, 0.0, least), 0.5);
    // Alpha that a format lacks is 1.
    let by_alpha = component(B::DstAlpha, B::Zero, BlendOperation::Add);
    assert_eq!(blended(F::Rg11b10Ufloat, 0.75, 0.0, 0.0, by_alpha), 0.75);
}

/// Rows: R6.
#[test]
fn alpha_keeps_the_first_samples() {
    let table = [
        (0.0, 0),
        (0.124, 0),
        (0.125, 0b1),
        (0.5, 0b11),
        (0.9, 0b1111),
        (7.0, 0b1111),
        (f32::NAN, 0),
    ];
    for (alpha, kept) in table {
        assert_eq!(alpha_coverage(alpha, 4), kept, "{alpha}");
    }
    assert_eq!(alpha_coverage(1.0, 16), u16::MAX);
    assert_eq!([0.49, 0.5].map(|alpha| alpha_coverage(alpha, 1)), [0, 1]);
    let state = State {
        alpha_to_coverage: true,
        ..State::new(1, 1)
    };
    let half = Fragment {
        sample_mask: 0b1010,
        ..fragment([1.0, 1.0, 1.0, 0.5])
    };
    let kept_in = |format| kept_samples(&half, &state, &Target::new(1, 1, 4, format));
    assert_eq!(kept_in(F::Rgba8Unorm), 0b0010);
    assert_eq!(kept_in(F::Rgba8Uint), 0b1010, "integers have no alpha");
}

/// Rows: F1.
#[test]
fn declared_depth_limits_are_enforced() {
    use DepthOutput as D;
    for (output, low, high) in [
        (D::Any, 0.2, 0.8),
        (D::Greater, 0.5, 0.8),
        (D::Less, 0.2, 0.5),
    ] {
        let got = [0.2, 0.8].map(|written| sample_depth(output, Some(written), 0.5));
        assert_eq!(got, [low, high], "{output:?}");
    }
    assert_eq!(sample_depth(D::None, Some(0.2), 0.5), 0.5);
}
