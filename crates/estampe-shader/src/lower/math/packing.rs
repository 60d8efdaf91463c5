//! Several numbers side by side in a word.

use crate::lower::Lowering;
use estampe_ir::Value;
use estampe_ir::op::{Binary, Unary};
use naga::MathFunction;

impl Lowering<'_> {
    /// Numbers of −1..=1 or 0..=1, or halves, side by side in a word, the first lowest.
    pub(super) fn pack(&mut self, function: MathFunction, values: &[Value]) -> Value {
        use MathFunction as F;
        let bits = u32::try_from(32 / values.len()).unwrap_or(16);
        let (low, scale) = match function {
            F::Pack4x8snorm => (-1.0, 127.0),
            F::Pack2x16snorm => (-1.0, 32_767.0),
            F::Pack4x8unorm => (0.0, 255.0),
            _ => (0.0, 65_535.0),
        };
        let mut word = self.builder.word(0);
        for (at, &value) in (0..).zip(values) {
            let code = if function == F::Pack2x16float {
                self.builder.unary(Unary::F16FromF32, value)
            } else {
                let limits = [low, 1.0].map(|limit| self.builder.float(limit));
                let held = self.clamp(value, limits);
                let (half, scaled) = (self.builder.float(0.5), self.times(held, scale));
                let raised = self.builder.binary(Binary::FAdd, half, scaled);
                let whole = self.builder.unary(Unary::FFloor, raised);
                let code = self.builder.unary(Unary::S32FromF32, whole);
                let mask = self.builder.word(u32::MAX >> (32 - bits));
                self.builder.binary(Binary::And, code, mask)
            };
            let by = self.builder.word(at * bits);
            let moved = self.builder.binary(Binary::Shl, code, by);
            word = self.builder.binary(Binary::Or, word, moved);
        }
        word
    }

    pub(super) fn unpack(&mut self, function: MathFunction, word: Value) -> Vec<Value> {
        use MathFunction as F;
        let (count, scale, is_signed) = match function {
            F::Unpack4x8snorm => (4, 127.0, true),
            F::Unpack4x8unorm => (4, 255.0, false),
            F::Unpack2x16snorm => (2, 32_767.0, true),
            _ => (2, 65_535.0, false),
        };
        let bits = 32 / count;
        let part = |at: u32| {
            let width = self.builder.word(bits);
            let offset = self.builder.word(at * bits);
            let code = self.extract_bits(word, [offset, width], is_signed);
            if function == F::Unpack2x16float {
                return self.builder.unary(Unary::F32FromF16, code);
            }
            let to_float = if is_signed {
                Unary::F32FromS32
            } else {
                Unary::F32FromU32
            };
            let number = self.builder.unary(to_float, code);
            let divisor = self.builder.float(scale);
            let quotient = self.builder.binary(Binary::FDiv, number, divisor);
            if is_signed {
                let low = self.builder.float(-1.0);
                self.builder.binary(Binary::FMax, quotient, low)
            } else {
                quotient
            }
        };
        (0..count).map(part).collect()
    }

    /// Four integers in the bytes of a word, the first in the lowest; clamped to their range, or
    /// their lowest bits.
    pub(super) fn pack_bytes(&mut self, function: MathFunction, values: &[Value]) -> Value {
        use MathFunction as F;
        let mut word = self.builder.word(0);
        for (at, &value) in (0..).zip(values) {
            let (limits, kinds) = match function {
                F::Pack4xI8Clamp => (Some([-128, 127]), [Binary::SMax, Binary::SMin]),
                F::Pack4xU8Clamp => (Some([0, 255]), [Binary::UMax, Binary::UMin]),
                _ => (None, [Binary::Or; 2]),
            };
            let mut code = value;
            for (kind, limit) in kinds.into_iter().zip(limits.into_iter().flatten()) {
                let limit = self.builder.word(i32::cast_unsigned(limit));
                code = self.builder.binary(kind, code, limit);
            }
            let [mask, by] = [0xFF, 8 * at].map(|word| self.builder.word(word));
            let code = self.builder.binary(Binary::And, code, mask);
            let moved = self.builder.binary(Binary::Shl, code, by);
            word = self.builder.binary(Binary::Or, word, moved);
        }
        word
    }

    /// The four bytes of a word as integers, the lowest first.
    pub(super) fn unpack_bytes(&mut self, word: Value, is_signed: bool) -> Vec<Value> {
        let byte = |at: u32| {
            let [offset, width] = [8 * at, 8].map(|word| self.builder.word(word));
            self.extract_bits(word, [offset, width], is_signed)
        };
        (0..4).map(byte).collect()
    }

    /// The sum of the products of two words' bytes.
    pub(super) fn dot_of_bytes(&mut self, words: [Value; 2], is_signed: bool) -> Value {
        let bytes = words.map(|word| self.unpack_bytes(word, is_signed));
        self.integer_dot(&bytes)
    }
}
