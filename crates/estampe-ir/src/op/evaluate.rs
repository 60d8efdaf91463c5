//! The results of operations on words, one lane at a time: their definition.

use super::{Atomic, Binary, Compare, MaskBinary, Math, Math2, Unary};
use estampe_format::half;
use estampe_types::maths;

/// The bits of the NaN that stands for all of them.
pub const NAN: u32 = 0x7FC0_0000;

impl Unary {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, a: u32) -> u32 {
        let x = f32::from_bits(a);
        match self {
            Self::FNeg => a ^ 1 << 31,
            Self::FAbs => a & !(1 << 31),
            Self::FSqrt => x.sqrt().to_bits(),
            Self::FFloor => x.floor().to_bits(),
            Self::FCeil => x.ceil().to_bits(),
            Self::FTrunc => x.trunc().to_bits(),
            Self::FRound => x.round_ties_even().to_bits(),
            Self::Canonical => {
                if x.is_nan() {
                    NAN
                } else {
                    a
                }
            }
            Self::RoundF16 => half::decode(half::encode(x)).to_bits(),
            Self::F16FromF32 => half::encode(x),
            Self::F32FromF16 => half::decode(a & 0xFFFF).to_bits(),
            Self::S32FromF32 => s32_from_f32(x).cast_unsigned(),
            Self::U32FromF32 => u32_from_f32(x),
            Self::F32FromS32 => (a.cast_signed() as f32).to_bits(),
            Self::F32FromU32 => (a as f32).to_bits(),
            Self::Not => !a,
            Self::CountOnes => a.count_ones(),
            Self::ReverseBits => a.reverse_bits(),
            Self::LeadingZeros => a.leading_zeros(),
            Self::TrailingZeros => a.trailing_zeros(),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates; NaN gives 0"
)]
fn s32_from_f32(x: f32) -> i32 {
    x as i32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates; NaN gives 0"
)]
fn u32_from_f32(x: f32) -> u32 {
    x as u32
}

impl Binary {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, [a, b]: [u32; 2]) -> u32 {
        let [x, y] = [a, b].map(f32::from_bits);
        let [s, t] = [a, b].map(u32::cast_signed);
        match self {
            Self::FAdd => (x + y).to_bits(),
            Self::FSub => (x - y).to_bits(),
            Self::FMul => (x * y).to_bits(),
            Self::FDiv => (x / y).to_bits(),
            Self::FMin => (if x < y { x } else { y }).to_bits(),
            Self::FMax => (if x > y { x } else { y }).to_bits(),
            Self::Add => a.wrapping_add(b),
            Self::Sub => a.wrapping_sub(b),
            Self::Mul => a.wrapping_mul(b),
            Self::UMulHigh => high(u64::from(a) * u64::from(b)),
            Self::SMulHigh => high((i64::from(s) * i64::from(t)).cast_unsigned()),
            Self::SDiv => s.checked_div(t).unwrap_or(s).cast_unsigned(),
            Self::SRem => s.checked_rem(t).unwrap_or(0).cast_unsigned(),
            Self::UDiv => a.checked_div(b).unwrap_or(a),
            Self::URem => a.checked_rem(b).unwrap_or(0),
            Self::And => a & b,
            Self::Or => a | b,
            Self::Xor => a ^ b,
            Self::Shl => a.wrapping_shl(b),
            Self::UShr => a.wrapping_shr(b),
            Self::SShr => s.wrapping_shr(b).cast_unsigned(),
            Self::SMin => s.min(t).cast_unsigned(),
            Self::SMax => s.max(t).cast_unsigned(),
            Self::UMin => a.min(b),
            Self::UMax => a.max(b),
        }
    }
}

fn high(product: u64) -> u32 {
    (product >> 32) as u32
}

impl Compare {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, [a, b]: [u32; 2]) -> bool {
        let [x, y] = [a, b].map(f32::from_bits);
        let [s, t] = [a, b].map(u32::cast_signed);
        match self {
            Self::FEq => x == y,
            Self::FNe => x != y,
            Self::FLt => x < y,
            Self::FLe => x <= y,
            Self::Eq => a == b,
            Self::Ne => a != b,
            Self::SLt => s < t,
            Self::SLe => s <= t,
            Self::ULt => a < b,
            Self::ULe => a <= b,
        }
    }
}

impl MaskBinary {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, [a, b]: [bool; 2]) -> bool {
        match self {
            Self::And => a & b,
            Self::Or => a | b,
            Self::Xor => a ^ b,
            Self::AndNot => a & !b,
        }
    }
}

impl Math {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, x: f32) -> f32 {
        match self {
            Self::Sin => maths::sin(x),
            Self::Cos => maths::cos(x),
            Self::Tan => maths::tan(x),
            Self::Asin => maths::asin(x),
            Self::Acos => maths::acos(x),
            Self::Atan => maths::atan(x),
            Self::Sinh => maths::sinh(x),
            Self::Cosh => maths::cosh(x),
            Self::Tanh => maths::tanh(x),
            Self::Exp => maths::exp(x),
            Self::Exp2 => maths::exp2(x),
            Self::Log => maths::log(x),
            Self::Log2 => maths::log2(x),
        }
    }
}

impl Math2 {
    /// The result.
    #[must_use]
    #[inline]
    pub fn evaluate(self, [x, y]: [f32; 2]) -> f32 {
        match self {
            Self::Pow => maths::pow(x, y),
            Self::Atan2 => maths::atan2(x, y),
        }
    }
}

/// a · b + c, rounded once.
#[must_use]
pub fn fma([a, b, c]: [u32; 3]) -> u32 {
    let [a, b, c] = [a, b, c].map(f32::from_bits);
    // Correctly rounded on every machine, with or without the instruction.
    a.mul_add(b, c).to_bits()
}

impl Atomic {
    /// The word that is stored, from the stored word and the operand.
    #[must_use]
    #[inline]
    pub fn evaluate(self, [a, b]: [u32; 2]) -> u32 {
        match self {
            Self::Add => Binary::Add.evaluate([a, b]),
            Self::Sub => Binary::Sub.evaluate([a, b]),
            Self::And => a & b,
            Self::Or => a | b,
            Self::Xor => a ^ b,
            Self::SMin => Binary::SMin.evaluate([a, b]),
            Self::SMax => Binary::SMax.evaluate([a, b]),
            Self::UMin => a.min(b),
            Self::UMax => a.max(b),
            Self::Exchange | Self::Store => b,
            Self::StoreHalf if b >> 31 == 1 => b << 16 | a & 0xFFFF,
            Self::StoreHalf => a & 0xFFFF_0000 | b & 0xFFFF,
            Self::Load => a,
        }
    }
}
