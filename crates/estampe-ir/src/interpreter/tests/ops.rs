//! Each operation against its definition, on special and random words, at every SIMD level, for
//! several numbers of packets, with operands that differ between lanes and that do not.

use super::{Lanes, run, straight};
use crate::interface::Input;
use crate::interpreter::Code;
use crate::op::{Axis, Binary, Compare, MaskBinary, Math, Math2, Precision, Unary, fma};
use crate::{Op, Type, Value};
use estampe_simd::{LANES, Level};

/// Words at which something changes, as floats or as integers.
const SPECIAL: [u32; 40] = [
    0,
    1,
    2,
    31,
    32,
    33,
    0x7F,
    0x80,
    0xFFFF,
    0x1_0000,
    0x7FFF_FFFF,
    0x8000_0000,
    0x8000_0001,
    0xFFFF_FFFE,
    0xFFFF_FFFF,
    0x0080_0000,
    0x007F_FFFF,
    0x7F7F_FFFF,
    0x7F80_0000,
    0xFF80_0000,
    0x7FC0_0000,
    0xFFC0_0001,
    0x7F80_0001,
    0x3F80_0000,
    0xBF80_0000,
    0x3F00_0000,
    0xBF00_0000,
    0x3FC0_0000,
    0x4020_0000,
    0x4B00_0001,
    0xCB00_0001,
    0x4EFF_FFFF,
    0x4F00_0000,
    0xCF00_0000,
    0xCF00_0001,
    0x4F7F_FFFF,
    0x4F80_0000,
    0x3380_0000,
    0x477F_F000,
    0x3F7F_FFFF,
];

fn words(random: &mut fastrand::Rng, count: usize) -> Vec<u32> {
    let mut word = || match random.u32(0..3) {
        0 => SPECIAL[random.usize(0..SPECIAL.len())],
        1 => random.u32(..),
        _ => ((random.f32() - 0.5) * 64.0).to_bits(),
    };
    (0..count).map(|_| word()).collect()
}

fn masks(random: &mut fastrand::Rng, count: usize) -> Vec<u32> {
    let whole = random.bool();
    let quads: Vec<u32> = (0..count / 4).map(|_| random.u32(0..16)).collect();
    (0..count)
        .map(|at| match quads[at / 4] {
            0..4 => 0,
            4..8 => 1,
            bits if whole => bits & 1,
            bits => bits >> (at % 4) & 1,
        })
        .collect()
}

/// Which operands are the same in all lanes: one bit each.
type Uniform = u32;

/// Checks an operation of so many words and masks, in all lanes, against its definition.
fn check(
    name: &str,
    (op, kinds): (Op, &[Type]),
    is_float: bool,
    defined: &dyn Fn(&Lanes, usize) -> u32,
) {
    let seed = name
        .bytes()
        .fold(5, |hash: u64, byte| hash.wrapping_mul(31) + u64::from(byte));
    let mut random = fastrand::Rng::with_seed(seed);
    let forms: Uniform = 1 << kinds.len();
    for level in Level::all_available() {
        for packets in [1, 3, 16, 37] {
            for form in 0..forms {
                let count = packets * LANES;
                let uniform = |at: usize| form >> at & 1 == 1;
                let inputs: Vec<Input> = (0..kinds.len())
                    .map(|at| match (kinds[at], uniform(at)) {
                        (Type::Word, true) => Input::PushConstant(u32::try_from(at).unwrap()),
                        (Type::Word, false) => Input::Varying(u32::try_from(at).unwrap()),
                        (Type::Mask, _) => Input::Cover,
                    })
                    .collect();
                let given: Lanes = (0..kinds.len())
                    .map(|at| match (kinds[at], uniform(at)) {
                        (Type::Word, true) => vec![words(&mut random, 1)[0]; count],
                        (Type::Word, false) => words(&mut random, count),
                        (Type::Mask, true) => vec![random.u32(0..2); count],
                        (Type::Mask, false) => masks(&mut random, count),
                    })
                    .collect();
                let kernel = straight(&inputs, vec![op.clone()]);
                let chunk = random.usize(1..=16);
                let code = Code::new(&kernel).with_chunk(chunk);
                let results = run(&code, &kernel, level, &given);
                for lane in 0..count {
                    let (found, expected) = (results[0][lane], defined(&given, lane));
                    let both_nan = is_float
                        && f32::from_bits(found).is_nan()
                        && f32::from_bits(expected).is_nan();
                    let operands: Vec<u32> = given.iter().map(|words| words[lane]).collect();
                    assert!(
                        found == expected || both_nan,
                        "{name} of {operands:08x?} is {found:08x}, not {expected:08x}, \
                         in lane {lane} of {packets} packets at {}, form {form:b}",
                        level.name(),
                    );
                }
            }
        }
    }
}

const V: [Value; 3] = [Value(0), Value(1), Value(2)];
const WORDS: [Type; 3] = [Type::Word; 3];

#[test]
fn unary_operations_are_as_defined() {
    for &kind in Unary::ALL {
        let is_float = matches!(
            kind,
            Unary::FSqrt
                | Unary::FFloor
                | Unary::FCeil
                | Unary::FTrunc
                | Unary::FRound
                | Unary::RoundF16
                | Unary::F32FromF16
        );
        let op = (Op::Unary(kind, V[0]), &WORDS[..1]);
        check(kind.name(), op, is_float, &|given, lane| {
            kind.evaluate(given[0][lane])
        });
    }
}

#[test]
fn binary_operations_are_as_defined() {
    for &kind in Binary::ALL {
        let is_float = kind.name().starts_with('f');
        let op = (Op::Binary(kind, [V[0], V[1]]), &WORDS[..2]);
        check(kind.name(), op, is_float, &|given, lane| {
            kind.evaluate([given[0][lane], given[1][lane]])
        });
    }
}

#[test]
fn comparisons_and_masks_are_as_defined() {
    for &kind in Compare::ALL {
        let op = (Op::Compare(kind, [V[0], V[1]]), &WORDS[..2]);
        check(kind.name(), op, false, &|given, lane| {
            u32::from(kind.evaluate([given[0][lane], given[1][lane]]))
        });
    }
    let masks = [Type::Mask; 2];
    for &kind in MaskBinary::ALL {
        let op = (Op::MaskBinary(kind, [V[0], V[1]]), &masks[..]);
        check(kind.name(), op, false, &|given, lane| {
            u32::from(kind.evaluate([given[0][lane] != 0, given[1][lane] != 0]))
        });
    }
    let op = (Op::MaskNot(V[0]), &masks[..1]);
    check("mnot", op, false, &|given, lane| 1 - given[0][lane]);
    let op = (Op::QuadAny(V[0]), &masks[..1]);
    check("quad_any", op, false, &|given, lane| {
        u32::from(given[0][lane & !3..][..4].contains(&1))
    });
}

#[test]
fn select_and_fma_are_as_defined() {
    let select = Op::Select {
        mask: V[0],
        yes: V[1],
        no: V[2],
    };
    let kinds = [Type::Mask, Type::Word, Type::Word];
    check("select", (select, &kinds), false, &|given, lane| {
        given[if given[0][lane] == 1 { 1 } else { 2 }][lane]
    });
    check("fma", (Op::Fma(V), &WORDS), true, &|given, lane| {
        fma([given[0][lane], given[1][lane], given[2][lane]])
    });
}

#[test]
fn functions_are_those_of_maths() {
    for &function in Math::ALL {
        let op = (Op::Math(function, V[0]), &WORDS[..1]);
        check(function.name(), op, true, &|given, lane| {
            function.evaluate(f32::from_bits(given[0][lane])).to_bits()
        });
    }
    for &function in Math2::ALL {
        let op = (Op::Math2(function, [V[0], V[1]]), &WORDS[..2]);
        check(function.name(), op, true, &|given, lane| {
            let pair = [given[0][lane], given[1][lane]].map(f32::from_bits);
            function.evaluate(pair).to_bits()
        });
    }
}

#[test]
fn derivatives_are_differences_in_whole_quads() {
    for &axis in Axis::ALL {
        for &precision in Precision::ALL {
            let op = Op::Derivative {
                axis,
                precision,
                value: V[0],
                mask: V[1],
            };
            let name = format!("derivative {} {}", axis.name(), precision.name());
            let kinds = [Type::Word, Type::Mask];
            check(&name, (op, &kinds), true, &|given, lane| {
                let quad = lane & !3;
                if given[1][quad..][..4].contains(&0) {
                    return 0;
                }
                let column_or_row = match (axis, precision) {
                    (_, Precision::Coarse) => 0,
                    (Axis::X, Precision::Fine) => lane & 2,
                    (Axis::Y, Precision::Fine) => lane & 1,
                };
                let step = if axis == Axis::X { 1 } else { 2 };
                let [to, from] = [step, 0].map(|at| given[0][quad + column_or_row + at]);
                Binary::FSub.evaluate([to, from])
            });
        }
    }
}

#[test]
fn a_lane_of_a_quad_is_seen_by_all_four() {
    for lane in 0..4 {
        let op = Op::QuadLane {
            lane,
            value: V[0],
            mask: V[1],
        };
        let kinds = [Type::Word, Type::Mask];
        check(
            &format!("quad_lane {lane}"),
            (op, &kinds),
            false,
            &|given, at| {
                let from = at & !3 | usize::from(lane);
                given[0][from] * given[1][from]
            },
        );
    }
}
