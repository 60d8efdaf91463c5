//! Counts and parts of bits.

use super::arithmetic::{each, not, shift_left, shift_right};
use super::{Wide, is_zero, select, signs};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Unary};
use estampe_ir::tree::Builder;

/// A count as an integer of the type that is counted in.
fn unsigned(b: &mut Builder, low: Value) -> Wide {
    Wide {
        low,
        high: b.word(0),
    }
}

pub(super) fn count_ones(b: &mut Builder, x: Wide) -> Wide {
    let [low, high] = [x.low, x.high].map(|word| b.unary(Unary::CountOnes, word));
    let sum = b.binary(Binary::Add, low, high);
    unsigned(b, sum)
}

/// The zeros above the highest one, 0 to 64.
pub(super) fn leading_zeros(b: &mut Builder, x: Wide) -> Wide {
    let zeros = leading_word(b, x);
    unsigned(b, zeros)
}

/// The zeros below the lowest one, 0 to 64.
pub(super) fn trailing_zeros(b: &mut Builder, x: Wide) -> Wide {
    let zeros = zeros_from(b, Unary::TrailingZeros, x.low, x.high);
    unsigned(b, zeros)
}

/// [`leading_zeros`] as a word.
pub(super) fn leading_word(b: &mut Builder, x: Wide) -> Value {
    zeros_from(b, Unary::LeadingZeros, x.high, x.low)
}

/// The zeros of a word, and of the one beyond where it has no ones.
fn zeros_from(b: &mut Builder, kind: Unary, near: Value, far: Value) -> Value {
    let [near_zeros, far_zeros] = [near, far].map(|word| b.unary(kind, word));
    let bits = b.word(32);
    let beyond = b.binary(Binary::Add, far_zeros, bits);
    let is_empty = is_zero(b, near);
    b.select(is_empty, beyond, near_zeros)
}

pub(super) fn reverse(b: &mut Builder, x: Wide) -> Wide {
    Wide {
        low: b.unary(Unary::ReverseBits, x.high),
        high: b.unary(Unary::ReverseBits, x.low),
    }
}

/// The highest bit that is set, or of signed numbers is not the sign; −1 if there is none.
pub(super) fn first_leading(b: &mut Builder, x: Wide, is_signed: bool) -> Wide {
    let word = if is_signed {
        let sign = signs(b, x.high);
        let sign = Wide {
            low: sign,
            high: sign,
        };
        each(b, Binary::Xor, x, sign)
    } else {
        x
    };
    // Without any, there are 64 zeros: 63 − 64 is −1.
    let (last, zeros) = (b.word(63), leading_word(b, word));
    let low = b.binary(Binary::Sub, last, zeros);
    Wide {
        low,
        high: signs(b, low),
    }
}

/// The lowest bit that is set; −1 if there is none.
pub(super) fn first_trailing(b: &mut Builder, x: Wide) -> Wide {
    let zeros = trailing_zeros(b, x);
    let none = Wide::constant(b, u64::MAX);
    let any = super::arithmetic::is_not_zero(b, x);
    select(b, any, zeros, none)
}

/// The offset and count of bits, held to those that there are.
fn bit_range(b: &mut Builder, [offset, count]: [Value; 2]) -> [Value; 2] {
    let bits = b.word(64);
    let offset = b.binary(Binary::UMin, offset, bits);
    let left = b.binary(Binary::Sub, bits, offset);
    [offset, b.binary(Binary::UMin, count, left)]
}

/// `count` bits from `offset` on, as a number.
pub(super) fn extract(b: &mut Builder, x: Wide, range: [Value; 2], is_signed: bool) -> Wide {
    let [offset, count] = bit_range(b, range);
    let bits = b.word(64);
    let end = b.binary(Binary::Add, offset, count);
    let left = b.binary(Binary::Sub, bits, end);
    let right = b.binary(Binary::Sub, bits, count);
    let high = shift_left(b, x, left);
    let part = shift_right(b, high, right, is_signed);
    // Shifts by 64 are shifts by 0.
    let (is_empty, zero) = (is_zero(b, count), Wide::constant(b, 0));
    select(b, is_empty, zero, part)
}

/// The first integer with `count` bits of the second one from `offset` on.
pub(super) fn insert(b: &mut Builder, [x, new]: [Wide; 2], range: [Value; 2]) -> Wide {
    let [offset, count] = bit_range(b, range);
    let (bits, ones) = (b.word(64), Wide::constant(b, u64::MAX));
    let right = b.binary(Binary::Sub, bits, count);
    let low = shift_right(b, ones, right, false);
    let mask = shift_left(b, low, offset);
    let moved = shift_left(b, new, offset);
    let moved = each(b, Binary::And, moved, mask);
    let others = not(b, mask);
    let kept = each(b, Binary::And, x, others);
    let inserted = each(b, Binary::Or, kept, moved);
    let is_empty = is_zero(b, count);
    select(b, is_empty, x, inserted)
}
