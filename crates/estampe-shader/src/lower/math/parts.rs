//! Functions that take numbers apart.

use crate::lower::Lowering;
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, MaskBinary, Unary};

impl Lowering<'_> {
    /// The fraction and the whole part, each with the sign of the number.
    pub(super) fn modf(&mut self, x: &[Value]) -> Vec<Value> {
        let whole: Vec<_> = x
            .iter()
            .map(|&x| self.builder.unary(Unary::FTrunc, x))
            .collect();
        let mut parts = self.each(Binary::FSub, x, &whole);
        parts.extend(whole);
        parts
    }

    /// The fraction, from ½ to 1 with the sign of the number, and the exponent as an integer.
    /// Zeros, infinities and NaN are their own fraction, with the exponent 0.
    pub(super) fn frexp(&mut self, x: &[Value]) -> Vec<Value> {
        let (mut fractions, mut exponents) = (Vec::new(), Vec::new());
        for &x in x {
            let b = &mut self.builder;
            let [zero, infinity] = [0.0, f32::INFINITY].map(|number| b.float(number));
            let [no_exponent, shift, exponent_bits, bias] =
                [0, 23, 0xFF, 126].map(|word| b.word(word));
            // Subnormal numbers become normal ones.
            let (factor, of_factor) = (b.float(16_777_216.0), b.word(24));
            let magnitude = b.unary(Unary::FAbs, x);
            let least = b.float(f32::MIN_POSITIVE);
            let is_small = b.compare(Compare::FLt, magnitude, least);
            let scaled = b.binary(Binary::FMul, x, factor);
            let normal = b.select(is_small, scaled, x);
            let scale = b.select(is_small, of_factor, no_exponent);
            let high = b.binary(Binary::UShr, normal, shift);
            let biased = b.binary(Binary::And, high, exponent_bits);
            let exponent = b.binary(Binary::Sub, biased, bias);
            let exponent = b.binary(Binary::Sub, exponent, scale);
            let (sign_and_significand, of_half) = (b.word(0x807F_FFFF), b.word(0x3F00_0000));
            let kept = b.binary(Binary::And, normal, sign_and_significand);
            let fraction = b.binary(Binary::Or, kept, of_half);
            // NaN is not below infinity.
            let is_finite = b.compare(Compare::FLt, magnitude, infinity);
            let is_zero = b.compare(Compare::FEq, x, zero);
            let has_parts = b.mask_binary(MaskBinary::AndNot, is_finite, is_zero);
            fractions.push(b.select(has_parts, fraction, x));
            exponents.push(b.select(has_parts, exponent, no_exponent));
        }
        fractions.extend(exponents);
        fractions
    }
}
