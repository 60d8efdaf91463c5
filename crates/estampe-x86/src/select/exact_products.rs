//! Sums of exact products become one fused operation, with the same bits.
//!
//! A product with a power of two is exact, and then rounding once or twice is the same, unless the
//! product is subnormal or overflows. That cannot be, or does not show:
//!
//! * if the other summand is a constant c with 2⁻⁹⁰ ≤ |c| ≤ 2¹⁰⁰: a subnormal product, exact or
//!   rounded, is less than a quarter of the distance of c to the floats beside it, and from a
//!   product that overflows c takes less than would bring it back;
//! * if the other factor is a whole number that was made by rounding, and the power of two is at
//!   most 1, or no greater than one by which what was rounded had been divided before.
//!
//! Such sums are in `x * 0.5 + 0.5`, in `x * 2.0 - 1.0`, and in the remainder
//! `x - floor(x * 0.5 + 0.5) * 2.0`.

use estampe_ir::lanes::{Kernel, ValueInfo};
use estampe_ir::op::{Binary, Unary};
use estampe_ir::{Op, Type, Value};
use std::collections::HashMap;

/// Powers of two are from 2⁻⁹⁰ to 2⁹⁰.
const MOST_BITS: i32 = 90;

/// A number is halved so often at most, and so much is added to it, that it is known to be less
/// than the greatest number divided as often.
const MOST_HALVINGS: i32 = 60;
const MOST_ADDED: f32 = (1_u32 << 30) as f32;

/// Replaces sums and differences; `None` if there are none to replace.
pub(crate) fn fuse(kernel: &Kernel) -> Option<Kernel> {
    let mut known = Known::default();
    for (op, result) in kernel.blocks.iter().flat_map(|block| &block.ops) {
        match known.sum(op) {
            Some(sum) => {
                known.sums.insert(*result, sum);
            }
            None => known.keep(op, *result),
        }
    }
    if known.sums.is_empty() {
        return None;
    }
    let mut fused = kernel.clone();
    for block in &mut fused.blocks {
        let ops = std::mem::take(&mut block.ops);
        for (op, result) in ops {
            let Some(sum) = known.sums.get(&result) else {
                block.ops.push((op, result));
                continue;
            };
            let mut constant = |word: f32| {
                let (kind, is_uniform) = (Type::Word, true);
                fused.values.push(ValueInfo { kind, is_uniform });
                let new = Value(u32::try_from(fused.values.len() - 1).unwrap_or(u32::MAX));
                block.ops.push((Op::Constant(word.to_bits()), new));
                new
            };
            let scale = constant(sum.scale);
            let summand = match sum.summand {
                Summand::Value(value) => value,
                Summand::Constant(word) => constant(word),
            };
            block
                .ops
                .push((Op::Fma([scale, sum.factor, summand]), result));
        }
    }
    Some(fused)
}

/// A sum of a product with a power of two.
#[derive(Debug, Clone, Copy)]
struct Sum {
    scale: f32,
    factor: Value,
    summand: Summand,
}

#[derive(Debug, Clone, Copy)]
enum Summand {
    Value(Value),
    Constant(f32),
}

/// What is known of the values so far.
#[derive(Debug, Default)]
struct Known {
    constants: HashMap<Value, f32>,
    /// Products with powers of two.
    products: HashMap<Value, (f32, Value)>,
    /// Whole numbers, with what was rounded, or `None` if they are converted integers.
    whole: HashMap<Value, Option<Value>>,
    sums: HashMap<Value, Sum>,
}

impl Known {
    fn keep(&mut self, op: &Op, result: Value) {
        match *op {
            Op::Constant(word) => {
                self.constants.insert(result, f32::from_bits(word));
            }
            Op::Unary(Unary::FFloor | Unary::FCeil | Unary::FTrunc | Unary::FRound, rounded) => {
                self.whole.insert(result, Some(rounded));
            }
            Op::Unary(Unary::F32FromS32 | Unary::F32FromU32, _) => {
                self.whole.insert(result, None);
            }
            Op::Binary(Binary::FMul, [a, b]) => {
                for (factor, scale) in [(a, b), (b, a)] {
                    if let Some(scale) = self
                        .constants
                        .get(&scale)
                        .filter(|scale| bits(**scale).is_some())
                    {
                        self.products.insert(result, (*scale, factor));
                    }
                }
            }
            _ => {}
        }
    }

    /// The sum that an operation is, if its product is exact.
    fn sum(&self, op: &Op) -> Option<Sum> {
        let (kind, [a, b]) = match op {
            Op::Binary(kind @ (Binary::FAdd | Binary::FSub), pair) => (kind, *pair),
            _ => return None,
        };
        let is_difference = *kind == Binary::FSub;
        let of_first = self.products.get(&a).map(|product| (product, b, 1.0));
        let sign = if is_difference { -1.0 } else { 1.0 };
        let of_second = self.products.get(&b).map(|product| (product, a, sign));
        for (&(scale, factor), other, sign) in of_first.into_iter().chain(of_second) {
            let is_taken = is_difference && other == b;
            let constant = self.constants.get(&other).copied();
            let constant = constant.map(|word| if is_taken { -word } else { word });
            let summand = match constant {
                Some(word) if is_middling(word) => Summand::Constant(word),
                _ if !is_taken && self.is_whole(factor, bits(scale)?) => Summand::Value(other),
                _ => continue,
            };
            return Some(Sum {
                scale: scale * sign,
                factor,
                summand,
            });
        }
        None
    }

    /// True if a value is whole and its product with a power of two does not overflow.
    fn is_whole(&self, value: Value, scale_bits: i32) -> bool {
        match self.whole.get(&value) {
            None => false,
            Some(_) if scale_bits <= 0 => true,
            Some(None) => true,
            Some(Some(rounded)) => self.halvings(*rounded) >= scale_bits,
        }
    }

    /// How often the greatest number can be halved and still is not exceeded by a value.
    fn halvings(&self, value: Value) -> i32 {
        let (scale, added) = if let Some(sum) = self.sums.get(&value) {
            match sum.summand {
                Summand::Constant(added) => (sum.scale, added),
                Summand::Value(_) => return 0,
            }
        } else if let Some((scale, _)) = self.products.get(&value) {
            (*scale, 0.0)
        } else {
            return 0;
        };
        let halvings = bits(scale).map_or(0, |bits| -bits);
        if (1..=MOST_HALVINGS).contains(&halvings) && added.abs() <= MOST_ADDED {
            halvings
        } else {
            0
        }
    }
}

/// The exponent of a power of two, or of its negative.
fn bits(scale: f32) -> Option<i32> {
    let word = scale.to_bits();
    let exponent = i32::try_from(word >> 23 & 0xFF).ok()? - 127;
    (word & 0x7F_FFFF == 0 && exponent.abs() <= MOST_BITS).then_some(exponent)
}

/// True if a summand hides what becomes of products that are very small or very large.
fn is_middling(word: f32) -> bool {
    let exponent = (word.to_bits() >> 23 & 0xFF).cast_signed() - 127;
    (-MOST_BITS..100).contains(&exponent)
}
