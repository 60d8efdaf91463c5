//! Divisions by words that are known become high words of products.
//!
//! n ÷ d is the high word of n · m, shifted: m is 2ᵖ ÷ d, rounded up. The product exceeds
//! 2ᵖ · n ÷ d by n times what rounding added, which does not reach the next whole number if it is
//! small enough (Granlund and Montgomery, *Division by Invariant Integers using Multiplication*,
//! 1994).

use estampe_ir::lanes::{Kernel, ValueInfo};
use estampe_ir::op::Binary;
use estampe_ir::{Op, Type, Value};
use std::collections::HashMap;

/// Replaces divisions by constants; `None` if the kernel has none.
pub(crate) fn replace(kernel: &Kernel) -> Option<Kernel> {
    let ops = || kernel.blocks.iter().flat_map(|block| &block.ops);
    if !ops().any(|(op, _)| matches!(op, Op::Binary(kind, _) if is_division(*kind))) {
        return None;
    }
    let constants = ops().filter_map(|(op, value)| match op {
        Op::Constant(word) => Some((*value, *word)),
        _ => None,
    });
    let constants: HashMap<Value, u32> = constants.collect();
    let mut made = kernel.clone();
    for (block, from) in made.blocks.iter_mut().zip(&kernel.blocks) {
        block.ops.clear();
        for (op, first) in &from.ops {
            let replaced = match op {
                Op::Binary(kind, [a, b]) if is_division(*kind) => {
                    let mut division = Division {
                        values: &mut made.values,
                        ops: &mut block.ops,
                        is_uniform: kernel.values[first.index()].is_uniform,
                    };
                    let divisor = constants.get(b).copied();
                    divisor.and_then(|divisor| division.result(*kind, *a, (*b, divisor)))
                }
                _ => None,
            };
            // The last operation gives what the division gave.
            match (replaced, block.ops.last_mut()) {
                (Some(_), Some((_, value))) => *value = *first,
                _ => block.ops.push((op.clone(), *first)),
            }
        }
    }
    Some(made)
}

fn is_division(kind: Binary) -> bool {
    matches!(
        kind,
        Binary::UDiv | Binary::URem | Binary::SDiv | Binary::SRem
    )
}

/// The operations of a division.
struct Division<'a> {
    values: &'a mut Vec<ValueInfo>,
    ops: &'a mut Vec<(Op, Value)>,
    /// True if the number that is divided is the same in all lanes.
    is_uniform: bool,
}

impl Division<'_> {
    /// The quotient or remainder, by the last operation that is added. `None`, and nothing added,
    /// for divisors 0 and 1, and among signed ones −1 and −2³¹.
    fn result(&mut self, kind: Binary, a: Value, (b, divisor): (Value, u32)) -> Option<Value> {
        let quotient = match kind {
            Binary::UDiv | Binary::URem if divisor > 1 => self.unsigned_quotient(a, divisor),
            Binary::SDiv | Binary::SRem => {
                let divisor = divisor.cast_signed();
                let is_kept = !(2..1 << 31).contains(&divisor.unsigned_abs());
                if is_kept {
                    return None;
                }
                self.signed_quotient(a, divisor)
            }
            _ => return None,
        };
        if matches!(kind, Binary::UDiv | Binary::SDiv) {
            return Some(quotient);
        }
        let whole = self.binary(Binary::Mul, [quotient, b]);
        Some(self.binary(Binary::Sub, [a, whole]))
    }

    fn unsigned_quotient(&mut self, a: Value, divisor: u32) -> Value {
        let zeros = divisor.trailing_zeros();
        if let Some(inverse) = Inverse::of(divisor, 32) {
            let product = self.with_word(Binary::UMulHigh, a, inverse.factor);
            return self.with_word(Binary::UShr, product, inverse.shift);
        }
        // Of an even divisor that of half the number.
        if let Some(inverse) = Inverse::of(divisor >> zeros, 32 - zeros).filter(|_| zeros > 0) {
            let part = self.with_word(Binary::UShr, a, zeros);
            let product = self.with_word(Binary::UMulHigh, part, inverse.factor);
            return self.with_word(Binary::UShr, product, inverse.shift);
        }
        // A factor of 33 bits: its highest one is the number itself, added and halved without
        // overflow.
        let bits = u32::BITS - (divisor - 1).leading_zeros();
        let divisor = u64::from(divisor);
        let lower = (((1 << bits) - divisor) << 32) / divisor + 1;
        let lower = u32::try_from(lower).unwrap_or(u32::MAX);
        let product = self.with_word(Binary::UMulHigh, a, lower);
        let rest = self.binary(Binary::Sub, [a, product]);
        let half = self.with_word(Binary::UShr, rest, 1);
        let sum = self.binary(Binary::Add, [half, product]);
        self.with_word(Binary::UShr, sum, bits - 1)
    }

    fn signed_quotient(&mut self, a: Value, divisor: i32) -> Value {
        let size = divisor.unsigned_abs();
        // The factor has 32 bits: as a signed word it is 2³² less.
        let bits = u32::BITS - (size - 1).leading_zeros();
        let factor = (1_u64 << (31 + bits)) / u64::from(size) + 1;
        let factor = u32::try_from(factor).unwrap_or(u32::MAX);
        let product = self.with_word(Binary::SMulHigh, a, factor);
        let product = self.binary(Binary::Add, [product, a]);
        let down = self.with_word(Binary::SShr, product, bits - 1);
        // Rounded down it is 1 less where the number is below 0.
        let sign = self.with_word(Binary::SShr, a, 31);
        let pair = if divisor > 0 {
            [down, sign]
        } else {
            [sign, down]
        };
        self.binary(Binary::Sub, pair)
    }

    fn with_word(&mut self, kind: Binary, a: Value, word: u32) -> Value {
        let word = self.add(Op::Constant(word), true);
        self.binary(kind, [a, word])
    }

    fn binary(&mut self, kind: Binary, pair: [Value; 2]) -> Value {
        self.add(Op::Binary(kind, pair), self.is_uniform)
    }

    fn add(&mut self, op: Op, is_uniform: bool) -> Value {
        let kind = Type::Word;
        self.values.push(ValueInfo { kind, is_uniform });
        let value = Value(u32::try_from(self.values.len() - 1).unwrap_or(u32::MAX));
        self.ops.push((op, value));
        value
    }
}

/// The inverse of a divisor, times 2 to the power of 32 and the shift.
struct Inverse {
    factor: u32,
    shift: u32,
}

impl Inverse {
    /// An inverse for numbers of so many bits, up to 32; `None` if its factor needs 33.
    fn of(divisor: u32, bits: u32) -> Option<Self> {
        (0..32).find_map(|shift| {
            let scale = 1_u128 << (32 + shift);
            let factor = scale.div_ceil(divisor.into());
            let added = factor * u128::from(divisor) - scale;
            let factor = u32::try_from(factor).ok()?;
            // Any number times what was added stays below the scale.
            (added << bits <= scale).then_some(Self { factor, shift })
        })
    }
}
