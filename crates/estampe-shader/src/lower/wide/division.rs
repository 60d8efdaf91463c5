//! Quotients and remainders.
//!
//! A quotient of 64 bits is put together from quotients of 32 bits, as in *Hacker's Delight*
//! (H. S. Warren, chapter 9) after Knuth's algorithm D: three divisions of words and about 115
//! other operations. A loop of 64 steps that gives one bit each would be 640 operations, and its
//! jumps would count as those of the shader.

use super::arithmetic::{
    is_less, is_not_zero, magnitude, multiply, negate_where, shift_left_short, shift_right,
    subtract,
};
use super::{Wide, is_zero, select, shifted, shifted_back, signs};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, MaskBinary, Unary};
use estampe_ir::tree::Builder;

/// What a division gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Division {
    pub(super) quotient: Wide,
    pub(super) remainder: Wide,
}

/// n ÷ d towards zero, with a remainder of the sign of n. Where d is 0, n and 0.
pub(super) fn divide(b: &mut Builder, [n, d]: [Wide; 2], is_signed: bool) -> Division {
    if !is_signed {
        return divide_unsigned(b, n, d);
    }
    // −2⁶³ ÷ −1 is 2⁶³ ÷ 1, whose bits are those of −2⁶³.
    let [sign_n, sign_d] = [n, d].map(|x| signs(b, x.high));
    let sign = b.binary(Binary::Xor, sign_n, sign_d);
    let [n, d] = [n, d].map(|x| magnitude(b, x));
    let division = divide_unsigned(b, n, d);
    Division {
        quotient: negate_where(b, division.quotient, sign),
        remainder: negate_where(b, division.remainder, sign_n),
    }
}

fn divide_unsigned(b: &mut Builder, n: Wide, d: Wide) -> Division {
    let zero = b.word(0);
    // A divisor of one word: two digits of 32 bits, of which the first is a division of words.
    let is_short = is_zero(b, d.high);
    let first = b.binary(Binary::UDiv, n.high, d.low);
    let product = b.binary(Binary::Mul, first, d.low);
    let rest = b.binary(Binary::Sub, n.high, product);
    // A longer one: the quotient has one digit, n/2 ÷ the upper 32 bits of d without its leading
    // zeros. It is at most 1 too large: less 1, it is right or 1 too small.
    let zeros = b.unary(Unary::LeadingZeros, d.high);
    let upper = shift_left_short(b, d, zeros).high;
    let one = b.word(1);
    let half = shift_right(b, n, one, false);
    let digits = Wide {
        low: b.select(is_short, n.low, half.low),
        high: b.select(is_short, rest, half.high),
    };
    let divisor = b.select(is_short, d.low, upper);
    let last = digit(b, digits, divisor);
    let estimate = shifted_back(b, Binary::UShr, last, zeros);
    let decrement = b.binary(Binary::UMin, estimate, one);
    let estimate = b.binary(Binary::Sub, estimate, decrement);
    let quotient = Wide {
        low: b.select(is_short, last, estimate),
        high: b.select(is_short, first, zero),
    };
    let product = multiply(b, quotient, d);
    let rest = subtract(b, n, product);
    // Quotients by divisors of one word are right already.
    let is_right = is_less(b, rest, d, false);
    let more = b.binary(Binary::Add, quotient.low, one);
    let quotient = Wide {
        low: b.select(is_right, quotient.low, more),
        high: quotient.high,
    };
    let less = subtract(b, rest, d);
    let remainder = select(b, is_right, rest, less);
    let has_divisor = is_not_zero(b, d);
    let nothing = Wide::constant(b, 0);
    Division {
        quotient: select(b, has_divisor, quotient, n),
        remainder: select(b, has_divisor, remainder, nothing),
    }
}

/// n ÷ d where n.high < d, as two digits of 16 bits.
fn digit(b: &mut Builder, n: Wide, d: Value) -> Value {
    let zeros = b.unary(Unary::LeadingZeros, d);
    let d = b.binary(Binary::Shl, d, zeros);
    let n = shift_left_short(b, n, zeros);
    let low = b.word(0xFFFF);
    let next = [
        shifted(b, Binary::UShr, n.low, 16),
        b.binary(Binary::And, n.low, low),
    ];
    let mut rest = n.high;
    let [upper, lower] = next.map(|next| {
        let quotient = half_digit(b, [rest, next], d);
        // The remainder, a word, is not changed by what overflows.
        let above = shifted(b, Binary::Shl, rest, 16);
        let above = b.binary(Binary::Add, above, next);
        let product = b.binary(Binary::Mul, quotient, d);
        rest = b.binary(Binary::Sub, above, product);
        quotient
    });
    let upper = shifted(b, Binary::Shl, upper, 16);
    b.binary(Binary::Add, upper, lower)
}

/// (2¹⁶·n + next) ÷ d, of 16 bits, where 2³¹ ≤ d and n < d: n ÷ the upper half of d is at most 2
/// too large.
fn half_digit(b: &mut Builder, [n, next]: [Value; 2], d: Value) -> Value {
    let (base, low) = (b.word(1 << 16), b.word(0xFFFF));
    let upper = shifted(b, Binary::UShr, d, 16);
    let lower = b.binary(Binary::And, d, low);
    let mut quotient = b.binary(Binary::UDiv, n, upper);
    let product = b.binary(Binary::Mul, quotient, upper);
    let mut rest = b.binary(Binary::Sub, n, product);
    for _ in 0..2 {
        // The product overflows only where the quotient has more than 16 bits.
        let product = b.binary(Binary::Mul, quotient, lower);
        let most = shifted(b, Binary::Shl, rest, 16);
        let most = b.binary(Binary::Add, most, next);
        let is_above = b.compare(Compare::ULt, most, product);
        let is_long = b.compare(Compare::ULe, base, quotient);
        let is_too_large = b.mask_binary(MaskBinary::Or, is_above, is_long);
        // From 2¹⁶ on, the rest times 2¹⁶ is more than any product.
        let has_half = b.compare(Compare::ULt, rest, base);
        let is_too_large = b.mask_binary(MaskBinary::And, is_too_large, has_half);
        let one = b.word(1);
        let (less, more) = (
            b.binary(Binary::Sub, quotient, one),
            b.binary(Binary::Add, rest, upper),
        );
        quotient = b.select(is_too_large, less, quotient);
        rest = b.select(is_too_large, more, rest);
    }
    quotient
}
