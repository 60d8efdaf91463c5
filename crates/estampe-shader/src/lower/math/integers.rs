//! Functions of integers, component by component.

use crate::lower::{LowerError, Lowered, Lowering};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, Unary};
use naga::MathFunction;

impl Lowering<'_> {
    pub(super) fn signed(&mut self, number: i32) -> Value {
        self.builder.word(number.cast_unsigned())
    }

    pub(super) fn of_integers(
        &mut self,
        function: MathFunction,
        is_signed: bool,
        values: &[Value],
    ) -> Lowered<Value> {
        use Binary as B;
        use MathFunction as F;
        let x = values[0];
        let [y, z, w] = [1, 2, 3].map(|at| values.get(at).copied().unwrap_or(x));
        let (min, max) = if is_signed {
            (B::SMin, B::SMax)
        } else {
            (B::UMin, B::UMax)
        };
        Ok(match function {
            F::Abs if is_signed => {
                let zero = self.builder.word(0);
                let negated = self.builder.binary(B::Sub, zero, x);
                self.builder.binary(B::SMax, x, negated)
            }
            F::Abs => x,
            F::Min => self.builder.binary(min, x, y),
            F::Max => self.builder.binary(max, x, y),
            F::Clamp => {
                let raised = self.builder.binary(max, x, y);
                self.builder.binary(min, raised, z)
            }
            F::Sign if !is_signed => {
                let one = self.builder.word(1);
                self.builder.binary(B::UMin, x, one)
            }
            F::Sign => {
                let (low, high) = (self.signed(-1), self.builder.word(1));
                let raised = self.builder.binary(B::SMax, x, low);
                self.builder.binary(B::SMin, raised, high)
            }
            F::FirstTrailingBit => {
                let zeros = self.builder.unary(Unary::TrailingZeros, x);
                self.or_none(x, zeros)
            }
            F::FirstLeadingBit => {
                let word = if is_signed {
                    let last = self.builder.word(31);
                    let sign = self.builder.binary(B::SShr, x, last);
                    self.builder.binary(B::Xor, x, sign)
                } else {
                    x
                };
                let zeros = self.builder.unary(Unary::LeadingZeros, word);
                let last = self.builder.word(31);
                let bit = self.builder.binary(B::Sub, last, zeros);
                self.or_none(word, bit)
            }
            F::ExtractBits => self.extract_bits(x, [y, z], is_signed),
            F::InsertBits => self.insert_bits([x, y], [z, w]),
            _ => return Err(LowerError::Unsupported("functions of this kind")),
        })
    }

    /// −1 where a word is 0.
    fn or_none(&mut self, word: Value, bit: Value) -> Value {
        let (zero, none) = (self.builder.word(0), self.signed(-1));
        let is_zero = self.builder.compare(Compare::Eq, word, zero);
        self.builder.select(is_zero, none, bit)
    }

    /// The offset and count of bits, held to those that a word has.
    fn bit_range(&mut self, [offset, count]: [Value; 2]) -> [Value; 2] {
        let bits = self.builder.word(32);
        let offset = self.builder.binary(Binary::UMin, offset, bits);
        let left = self.builder.binary(Binary::Sub, bits, offset);
        [offset, self.builder.binary(Binary::UMin, count, left)]
    }

    pub(super) fn extract_bits(&mut self, x: Value, range: [Value; 2], is_signed: bool) -> Value {
        let [offset, count] = self.bit_range(range);
        let (bits, zero) = (self.builder.word(32), self.builder.word(0));
        let end = self.builder.binary(Binary::Add, offset, count);
        let left = self.builder.binary(Binary::Sub, bits, end);
        let right = self.builder.binary(Binary::Sub, bits, count);
        let high = self.builder.binary(Binary::Shl, x, left);
        let shift = if is_signed {
            Binary::SShr
        } else {
            Binary::UShr
        };
        let part = self.builder.binary(shift, high, right);
        // Shifts by 32 are shifts by 0.
        let is_empty = self.builder.compare(Compare::Eq, count, zero);
        self.builder.select(is_empty, zero, part)
    }

    fn insert_bits(&mut self, [x, new]: [Value; 2], range: [Value; 2]) -> Value {
        let [offset, count] = self.bit_range(range);
        let (bits, zero) = (self.builder.word(32), self.builder.word(0));
        let ones = self.builder.word(u32::MAX);
        let right = self.builder.binary(Binary::Sub, bits, count);
        let low = self.builder.binary(Binary::UShr, ones, right);
        let mask = self.builder.binary(Binary::Shl, low, offset);
        let moved = self.builder.binary(Binary::Shl, new, offset);
        let moved = self.builder.binary(Binary::And, moved, mask);
        let others = self.builder.unary(Unary::Not, mask);
        let kept = self.builder.binary(Binary::And, x, others);
        let inserted = self.builder.binary(Binary::Or, kept, moved);
        let is_empty = self.builder.compare(Compare::Eq, count, zero);
        self.builder.select(is_empty, x, inserted)
    }
}
