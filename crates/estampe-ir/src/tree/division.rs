//! Divisions by powers of two as shifts and masks: back ends divide lane after lane.

use super::Builder;
use crate::Value;
use crate::op::Binary;

impl Builder {
    /// The quotient or remainder of a division by a word that is known, a power of two from 2 to
    /// 2³⁰; `None` for other operations and divisors.
    pub(super) fn division(&mut self, kind: Binary, a: Value, b: Value) -> Option<Value> {
        let divisor = self.constant_of(b)?;
        if !divisor.is_power_of_two() || !(2..=1 << 30).contains(&divisor) {
            return None;
        }
        let bits = divisor.trailing_zeros();
        match kind {
            Binary::UDiv => Some(self.shifted(Binary::UShr, a, bits)),
            Binary::URem => {
                let mask = self.word(divisor - 1);
                Some(self.binary(Binary::And, a, mask))
            }
            Binary::SDiv => Some(self.quotient(a, bits)),
            Binary::SRem => {
                let quotient = self.quotient(a, bits);
                let whole = self.shifted(Binary::Shl, quotient, bits);
                Some(self.binary(Binary::Sub, a, whole))
            }
            _ => None,
        }
    }

    /// a ÷ 2ⁿ, rounded towards 0: 2ⁿ − 1 is added to numbers below 0 before they are shifted.
    fn quotient(&mut self, a: Value, bits: u32) -> Value {
        let sign = self.shifted(Binary::SShr, a, 31);
        let added = self.shifted(Binary::UShr, sign, 32 - bits);
        let sum = self.binary(Binary::Add, a, added);
        self.shifted(Binary::SShr, sum, bits)
    }

    fn shifted(&mut self, kind: Binary, a: Value, bits: u32) -> Value {
        let bits = self.word(bits);
        self.binary(kind, a, bits)
    }
}

#[cfg(test)]
mod tests {
    use crate::interface::{Input, Output, Stage};
    use crate::op::Binary;
    use crate::tree::{Builder, Node};
    use crate::{Op, Value};

    /// Divides by a constant; the tree's operations on two words, and their results.
    fn operations(kind: Binary, divisor: u32, a: u32) -> (Vec<Binary>, u32) {
        let mut b = Builder::new(Stage::Vertex);
        let x = b.input(Input::VertexIndex);
        let word = b.word(divisor);
        let result = b.binary(kind, x, word);
        let tree = b.finish(vec![(Output::Varying(0), result)]);
        let mut values = vec![0; tree.len()];
        let mut kinds = Vec::new();
        for node in &tree.body {
            let Node::Op { op, first } = node else {
                continue;
            };
            let of = |value: Value| values[value.index()];
            values[first.index()] = match op {
                Op::Input(_) => a,
                Op::Constant(word) => *word,
                Op::Binary(kind, pair) => {
                    kinds.push(*kind);
                    kind.evaluate(pair.map(of))
                }
                other => panic!("{other:?} in a division"),
            };
        }
        (kinds, values[result.index()])
    }

    #[test]
    fn divisions_by_powers_of_two_are_shifts() {
        let mut random = fastrand::Rng::with_seed(3);
        let kinds = [Binary::UDiv, Binary::URem, Binary::SDiv, Binary::SRem];
        for (kind, bits) in kinds
            .iter()
            .flat_map(|kind| (0..32).map(move |bits| (*kind, bits)))
        {
            let special = [
                0,
                1,
                7,
                8,
                u32::MAX,
                1 << 31,
                (1 << 31) + 1,
                i32::MAX.cast_unsigned(),
            ];
            let others = (0..20).map(|_| random.u32(..));
            for a in special.into_iter().chain(others) {
                let divisor = 1 << bits;
                let (made, result) = operations(kind, divisor, a);
                assert_eq!(
                    result,
                    kind.evaluate([a, divisor]),
                    "{a} {kind:?} {divisor}"
                );
                let is_division = made.iter().any(|made| kinds.contains(made));
                assert_eq!(is_division, bits == 31);
            }
        }
    }
}
