//! Sums, products, shifts and comparisons.

use super::{Wide, select, shifted, shifted_back, signs};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, MaskBinary, Unary};
use estampe_ir::tree::Builder;

/// An operation on both words apart.
pub(super) fn each(b: &mut Builder, kind: Binary, x: Wide, y: Wide) -> Wide {
    Wide {
        low: b.binary(kind, x.low, y.low),
        high: b.binary(kind, x.high, y.high),
    }
}

pub(super) fn not(b: &mut Builder, x: Wide) -> Wide {
    Wide {
        low: b.unary(Unary::Not, x.low),
        high: b.unary(Unary::Not, x.high),
    }
}

/// x + y. The low words overflow where their sum is less than one of them.
pub(super) fn add(b: &mut Builder, x: Wide, y: Wide) -> Wide {
    let sum = each(b, Binary::Add, x, y);
    let overflows = b.compare(Compare::ULt, sum.low, x.low);
    let carry = one_where(b, overflows);
    Wide {
        low: sum.low,
        high: b.binary(Binary::Add, sum.high, carry),
    }
}

/// x − y.
pub(super) fn subtract(b: &mut Builder, x: Wide, y: Wide) -> Wide {
    let difference = each(b, Binary::Sub, x, y);
    let borrows = b.compare(Compare::ULt, x.low, y.low);
    let borrow = one_where(b, borrows);
    Wide {
        low: difference.low,
        high: b.binary(Binary::Sub, difference.high, borrow),
    }
}

fn one_where(b: &mut Builder, mask: Value) -> Value {
    let (one, zero) = (b.word(1), b.word(0));
    b.select(mask, one, zero)
}

/// −x.
pub(super) fn negate(b: &mut Builder, x: Wide) -> Wide {
    let zero = Wide::constant(b, 0);
    subtract(b, zero, x)
}

/// −x where `sign` is all ones, x where it is zeros: ~x + 1 is (x ⊕ −1) − (−1).
pub(super) fn negate_where(b: &mut Builder, x: Wide, sign: Value) -> Wide {
    let sign = Wide {
        low: sign,
        high: sign,
    };
    let flipped = each(b, Binary::Xor, x, sign);
    subtract(b, flipped, sign)
}

/// |x|; that of −2⁶³ is 2⁶³, as an unsigned number.
pub(super) fn magnitude(b: &mut Builder, x: Wide) -> Wide {
    let sign = signs(b, x.high);
    negate_where(b, x, sign)
}

/// x·y modulo 2⁶⁴: the product of the low words, and above it the low words of the mixed ones.
pub(super) fn multiply(b: &mut Builder, x: Wide, y: Wide) -> Wide {
    let low = b.binary(Binary::Mul, x.low, y.low);
    let above = b.binary(Binary::UMulHigh, x.low, y.low);
    let mixed = [(x.low, y.high), (x.high, y.low)].map(|(x, y)| b.binary(Binary::Mul, x, y));
    let high = mixed
        .into_iter()
        .fold(above, |sum, one| b.binary(Binary::Add, sum, one));
    Wide { low, high }
}

/// x to the left by an amount modulo 32.
pub(super) fn shift_left_short(b: &mut Builder, x: Wide, amount: Value) -> Wide {
    // The upper bits of the low word: a shift by 32 − amount as two, as one by 32 is one by 0.
    let half = shifted(b, Binary::UShr, x.low, 1);
    let over = shifted_back(b, Binary::UShr, half, amount);
    let high = b.binary(Binary::Shl, x.high, amount);
    Wide {
        low: b.binary(Binary::Shl, x.low, amount),
        high: b.binary(Binary::Or, high, over),
    }
}

/// x to the left by an amount modulo 64.
pub(super) fn shift_left(b: &mut Builder, x: Wide, amount: Value) -> Wide {
    let near = shift_left_short(b, x, amount);
    let far = Wide {
        low: b.word(0),
        high: near.low,
    };
    let is_far = is_far(b, amount);
    select(b, is_far, far, near)
}

/// x to the right by an amount modulo 64, with zeros or copies of the sign from the left.
pub(super) fn shift_right(b: &mut Builder, x: Wide, amount: Value, is_signed: bool) -> Wide {
    let (kind, above) = if is_signed {
        (Binary::SShr, signs(b, x.high))
    } else {
        (Binary::UShr, b.word(0))
    };
    let double = shifted(b, Binary::Shl, x.high, 1);
    let over = shifted_back(b, Binary::Shl, double, amount);
    let low = b.binary(Binary::UShr, x.low, amount);
    let near = Wide {
        low: b.binary(Binary::Or, low, over),
        high: b.binary(kind, x.high, amount),
    };
    let far = Wide {
        low: near.high,
        high: above,
    };
    let is_far = is_far(b, amount);
    select(b, is_far, far, near)
}

/// True where a shift moves one word to the place of the other.
fn is_far(b: &mut Builder, amount: Value) -> Value {
    let (bit, zero) = (b.word(32), b.word(0));
    let far = b.binary(Binary::And, amount, bit);
    b.compare(Compare::Ne, far, zero)
}

pub(super) fn is_equal(b: &mut Builder, x: Wide, y: Wide) -> Value {
    let low = b.compare(Compare::Eq, x.low, y.low);
    let high = b.compare(Compare::Eq, x.high, y.high);
    b.mask_binary(MaskBinary::And, low, high)
}

pub(super) fn is_not_zero(b: &mut Builder, x: Wide) -> Value {
    let (any, zero) = (b.binary(Binary::Or, x.low, x.high), b.word(0));
    b.compare(Compare::Ne, any, zero)
}

/// x < y: the high words are less, or equal and the low ones are less.
pub(super) fn is_less(b: &mut Builder, x: Wide, y: Wide, is_signed: bool) -> Value {
    let kind = if is_signed {
        Compare::SLt
    } else {
        Compare::ULt
    };
    let high = b.compare(kind, x.high, y.high);
    let same = b.compare(Compare::Eq, x.high, y.high);
    let low = b.compare(Compare::ULt, x.low, y.low);
    let by_low = b.mask_binary(MaskBinary::And, same, low);
    b.mask_binary(MaskBinary::Or, high, by_low)
}

pub(super) fn lesser(b: &mut Builder, x: Wide, y: Wide, is_signed: bool) -> Wide {
    let is_less = is_less(b, y, x, is_signed);
    select(b, is_less, y, x)
}

pub(super) fn greater(b: &mut Builder, x: Wide, y: Wide, is_signed: bool) -> Wide {
    let is_less = is_less(b, x, y, is_signed);
    select(b, is_less, y, x)
}

/// 1, 0 or −1.
pub(super) fn sign(b: &mut Builder, x: Wide, is_signed: bool) -> Wide {
    let any = is_not_zero(b, x);
    let one = one_where(b, any);
    let above = if is_signed {
        signs(b, x.high)
    } else {
        b.word(0)
    };
    Wide {
        low: b.binary(Binary::Or, one, above),
        high: above,
    }
}
