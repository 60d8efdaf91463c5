//! Conversions to and from 32-bit integers, floats and booleans.

use super::arithmetic::{magnitude, negate_where, shift_left};
use super::bits::leading_word;
use super::{Wide, is_zero, shifted, signs};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, Unary};
use estampe_ir::tree::Builder;

/// 2³² as a float.
const WORD: f32 = 4_294_967_296.0;

/// The greatest floats that are integers of the types: 2⁶³ − 2³⁹ and 2⁶⁴ − 2⁴⁰.
const MAX_SIGNED: f32 = 9_223_371_487_098_961_920.0;
const MAX_UNSIGNED: f32 = 18_446_742_974_197_923_840.0;

/// A 32-bit integer, with its sign.
pub(super) fn of_word(b: &mut Builder, low: Value, is_signed: bool) -> Wide {
    let high = if is_signed { signs(b, low) } else { b.word(0) };
    Wide { low, high }
}

pub(super) fn of_mask(b: &mut Builder, mask: Value) -> Wide {
    let (one, zero) = (b.word(1), b.word(0));
    Wide {
        low: b.select(mask, one, zero),
        high: zero,
    }
}

/// The nearest integer of 32 bits.
pub(super) fn nearest_word(b: &mut Builder, x: Wide, is_signed: bool) -> Value {
    if !is_signed {
        let (fits, most) = (is_zero(b, x.high), b.word(u32::MAX));
        return b.select(fits, x.low, most);
    }
    let sign = signs(b, x.low);
    let fits = b.compare(Compare::Eq, x.high, sign);
    let (above, most) = (signs(b, x.high), b.word(i32::MAX.cast_unsigned()));
    let nearest = b.binary(Binary::Xor, above, most);
    b.select(fits, x.low, nearest)
}

/// A float without its fraction; NaN is 0.
pub(super) fn of_float(b: &mut Builder, x: Value, is_signed: bool) -> Wide {
    let most = b.float(if is_signed { MAX_SIGNED } else { MAX_UNSIGNED });
    let x = b.binary(Binary::FMin, most, x);
    if !is_signed {
        return of_positive(b, x);
    }
    let least = b.float(-WORD * (WORD / 2.0));
    let x = b.binary(Binary::FMax, least, x);
    let magnitude = b.unary(Unary::FAbs, x);
    let magnitude = of_positive(b, magnitude);
    let sign = signs(b, x);
    negate_where(b, magnitude, sign)
}

/// A float below 2⁶⁴; 0 if it is negative or NaN. A float that is divided by 2³² is exact, its
/// whole part has at most 24 bits and is exact, and so is what is left.
fn of_positive(b: &mut Builder, x: Value) -> Wide {
    let (down, up) = (b.float(1.0 / WORD), b.float(WORD));
    let scaled = b.binary(Binary::FMul, x, down);
    let high = b.unary(Unary::U32FromF32, scaled);
    let whole = b.unary(Unary::F32FromU32, high);
    let whole = b.binary(Binary::FMul, whole, up);
    let rest = b.binary(Binary::FSub, x, whole);
    Wide {
        low: b.unary(Unary::U32FromF32, rest),
        high,
    }
}

/// The nearest float, of two that are as near the even one.
///
/// The integer is moved until its highest bit is that of the high word, and its lowest bit says
/// whether any is set below. A float has 24 bits, so that a word of 32 that ends so is rounded
/// once, as the whole integer would be; a power of 2 moves the float back without an error.
pub(super) fn float_of(b: &mut Builder, x: Wide, is_signed: bool) -> Value {
    let positive = if is_signed { magnitude(b, x) } else { x };
    let zeros = leading_word(b, positive);
    let moved = shift_left(b, positive, zeros);
    let (one, zero) = (b.word(1), b.word(0));
    let has_more = b.compare(Compare::Ne, moved.low, zero);
    let more = b.select(has_more, one, zero);
    let word = b.binary(Binary::Or, moved.high, more);
    let float = b.unary(Unary::F32FromU32, word);
    // The bits of 2^(32 − zeros).
    let bias = b.word(127 + 32);
    let exponent = b.binary(Binary::Sub, bias, zeros);
    let factor = shifted(b, Binary::Shl, exponent, 23);
    let float = b.binary(Binary::FMul, float, factor);
    if !is_signed {
        return float;
    }
    let sign = b.word(1 << 31);
    let sign = b.binary(Binary::And, x.high, sign);
    b.binary(Binary::Or, float, sign)
}
