//! Operations whose result is known before the shader runs.

use crate::op::{Binary, Compare, MaskBinary, fma};
use crate::{Op, Value};

/// What is known of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Known {
    /// Nothing.
    Nothing,
    /// It is this word.
    Word(u32),
    /// It is this mask.
    Mask(bool),
    /// It is the opposite of a mask.
    Not(Value),
}

/// The value that an operation gives, if an operand is it; else the operation, perhaps a simpler
/// one: constants for those that are known.
pub(crate) fn fold(op: Op, known: &[Known]) -> Result<Value, Op> {
    let word = |value: Value| match known[value.index()] {
        Known::Word(word) => Some(word),
        _ => None,
    };
    let mask = |value: Value| match known[value.index()] {
        Known::Mask(mask) => Some(mask),
        _ => None,
    };
    match op {
        Op::Unary(kind, a) => Err(match word(a) {
            Some(a) => Op::Constant(kind.evaluate(a)),
            None => op,
        }),
        Op::Binary(kind, pair) => match pair.map(word) {
            [Some(a), Some(b)] => Err(Op::Constant(kind.evaluate([a, b]))),
            words => binary(kind, pair, words),
        },
        Op::Fma(three) => Err(match three.map(word) {
            [Some(a), Some(b), Some(c)] => Op::Constant(fma([a, b, c])),
            _ => op,
        }),
        Op::Compare(kind, pair) => Err(match pair.map(word) {
            [Some(a), Some(b)] => Op::MaskConstant(kind.evaluate([a, b])),
            [_, Some(0)] if kind == Compare::ULt => Op::MaskConstant(false),
            [Some(0), _] if kind == Compare::ULe => Op::MaskConstant(true),
            _ if pair[0] == pair[1] && kind.is_of_integers() => {
                Op::MaskConstant(kind.evaluate([0, 0]))
            }
            _ => op,
        }),
        Op::MaskNot(a) => match known[a.index()] {
            Known::Mask(mask) => Err(Op::MaskConstant(!mask)),
            Known::Not(of) => Ok(of),
            _ => Err(op),
        },
        Op::MaskBinary(kind, pair) => mask_binary(kind, pair, pair.map(mask)),
        Op::Select { mask: m, yes, no } => match mask(m) {
            Some(true) => Ok(yes),
            Some(false) => Ok(no),
            None if yes == no => Ok(yes),
            None => match known[m.index()] {
                Known::Not(of) => Err(Op::Select {
                    mask: of,
                    yes: no,
                    no: yes,
                }),
                _ => Err(op),
            },
        },
        Op::Math(function, x) => Err(match word(x) {
            Some(x) => Op::Constant(function.evaluate(f32::from_bits(x)).to_bits()),
            None => op,
        }),
        Op::Math2(function, pair) => Err(match pair.map(word) {
            [Some(x), Some(y)] => {
                Op::Constant(function.evaluate([x, y].map(f32::from_bits)).to_bits())
            }
            _ => op,
        }),
        _ => Err(op),
    }
}

impl Compare {
    fn is_of_integers(self) -> bool {
        !matches!(self, Self::FEq | Self::FNe | Self::FLt | Self::FLe)
    }
}

/// Operations of which one operand is known. Floats keep the sign of zero: x + 0 is not x for −0.
fn binary(kind: Binary, [a, b]: [Value; 2], words: [Option<u32>; 2]) -> Result<Value, Op> {
    use Binary as B;
    let op = Op::Binary(kind, [a, b]);
    const ONE: u32 = 1.0_f32.to_bits();
    const NEGATIVE_ZERO: u32 = 1 << 31;
    match (kind, words) {
        (B::Add | B::Or | B::Xor, [Some(0), _]) => Ok(b),
        (B::Add | B::Sub | B::Or | B::Xor | B::Shl | B::UShr | B::SShr, [_, Some(0)]) => Ok(a),
        (B::Mul, [Some(1), _]) => Ok(b),
        (B::Mul | B::SDiv | B::UDiv, [_, Some(1)]) => Ok(a),
        (B::Mul | B::And, [Some(0), _] | [_, Some(0)]) => Err(Op::Constant(0)),
        (B::SRem | B::URem, [_, Some(1)]) => Err(Op::Constant(0)),
        (B::And, [Some(u32::MAX), _]) => Ok(b),
        (B::And, [_, Some(u32::MAX)]) => Ok(a),
        (B::FMul, [Some(ONE), _]) => Ok(b),
        (B::FMul | B::FDiv, [_, Some(ONE)]) => Ok(a),
        (B::FAdd, [Some(NEGATIVE_ZERO), _]) => Ok(b),
        (B::FAdd, [_, Some(NEGATIVE_ZERO)]) | (B::FSub, [_, Some(0)]) => Ok(a),
        (B::Sub | B::Xor, _) if a == b => Err(Op::Constant(0)),
        (B::And | B::Or | B::SMin | B::SMax | B::UMin | B::UMax, _) if a == b => Ok(a),
        _ => Err(op),
    }
}

fn mask_binary(
    kind: MaskBinary,
    [a, b]: [Value; 2],
    known: [Option<bool>; 2],
) -> Result<Value, Op> {
    use MaskBinary as M;
    match (kind, known) {
        (_, [Some(a), Some(b)]) => Err(Op::MaskConstant(kind.evaluate([a, b]))),
        (M::And, [Some(true), _]) | (M::Or | M::Xor, [Some(false), _]) => Ok(b),
        (M::And, [_, Some(true)]) | (M::Or | M::Xor | M::AndNot, [_, Some(false)]) => Ok(a),
        (M::And, [Some(false), _] | [_, Some(false)])
        | (M::AndNot, [Some(false), _] | [_, Some(true)]) => Err(Op::MaskConstant(false)),
        (M::Or, [Some(true), _] | [_, Some(true)]) => Err(Op::MaskConstant(true)),
        (M::Xor, [Some(true), _]) => Err(Op::MaskNot(b)),
        (M::Xor, [_, Some(true)]) => Err(Op::MaskNot(a)),
        (M::AndNot, [Some(true), _]) => Err(Op::MaskNot(b)),
        (M::And | M::Or, _) if a == b => Ok(a),
        (M::Xor | M::AndNot, _) if a == b => Err(Op::MaskConstant(false)),
        _ => Err(Op::MaskBinary(kind, [a, b])),
    }
}
