//! 64-bit integers, as two words each: operations of the lane IR are on words of 32 bits.
//!
//! The values of an expression hold the low word of each integer, then the high one. Everything is
//! straight code without branches, as lanes differ in their operands. What is out of range is as
//! WGSL has it for 32 bits: sums wrap around, shifts are modulo 64, x ÷ 0 is x, x mod 0 is 0,
//! −2⁶³ ÷ −1 is −2⁶³ with the remainder 0, and floats become the nearest integer of the type that
//! is a float, NaN 0. Integers become the nearest float, to even in the middle.
//!
//! | file | does |
//! |---|---|
//! | `arithmetic` | sums, products, shifts, comparisons |
//! | `division` | quotients and remainders |
//! | `bits` | counts and parts of bits |
//! | `conversion` | to and from 32-bit integers, floats and booleans |

mod arithmetic;
mod bits;
mod conversion;
mod division;

use super::types::{is_wide, words};
use super::{LowerError, Lowered};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Compare, Unary};
use estampe_ir::tree::Builder;
use naga::{BinaryOperator, MathFunction, Scalar, ScalarKind, UnaryOperator};

/// A 64-bit integer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide {
    low: Value,
    high: Value,
}

impl Wide {
    /// An integer that is known.
    pub(super) fn constant(b: &mut Builder, number: u64) -> Self {
        let [low, high] = [(number & 0xFFFF_FFFF) as u32, (number >> 32) as u32];
        Self {
            low: b.word(low),
            high: b.word(high),
        }
    }

    /// The words, in the order of values and of memory.
    pub(super) fn to_vec(self) -> Vec<Value> {
        vec![self.low, self.high]
    }

    /// The integers that values are.
    fn list(values: &[Value]) -> Vec<Self> {
        let (pairs, _) = values.as_chunks();
        pairs
            .iter()
            .map(|&[low, high]| Self { low, high })
            .collect()
    }
}

/// The values that integers are.
fn values(integers: impl IntoIterator<Item = Wide>) -> Vec<Value> {
    integers.into_iter().flat_map(Wide::to_vec).collect()
}

/// The nearest 32-bit integers of 64-bit ones of this kind.
pub(super) fn nearest_words(b: &mut Builder, values: &[Value], kind: ScalarKind) -> Vec<Value> {
    let integers = Wide::list(values).into_iter();
    integers
        .map(|x| conversion::nearest_word(b, x, kind == ScalarKind::Sint))
        .collect()
}

/// The operator on each integer.
pub(super) fn unary(b: &mut Builder, operator: UnaryOperator, of: &[Value]) -> Vec<Value> {
    let one = |x: Wide| match operator {
        UnaryOperator::Negate => arithmetic::negate(b, x),
        UnaryOperator::LogicalNot | UnaryOperator::BitwiseNot => arithmetic::not(b, x),
    };
    values(Wide::list(of).into_iter().map(one))
}

/// The operator on pairs of integers; a single one goes with all of the other side. The amounts of
/// shifts are words.
pub(super) fn binary(
    b: &mut Builder,
    operator: BinaryOperator,
    kind: ScalarKind,
    [left, right]: [&[Value]; 2],
) -> Lowered<Vec<Value>> {
    use BinaryOperator as O;
    let is_signed = kind == ScalarKind::Sint;
    let left = Wide::list(left);
    if matches!(operator, O::ShiftLeft | O::ShiftRight) {
        let shift = |(&x, &amount): (&Wide, &Value)| match operator {
            O::ShiftLeft => arithmetic::shift_left(b, x, amount),
            _ => arithmetic::shift_right(b, x, amount, is_signed),
        };
        return Ok(values(left.iter().zip(right).map(shift)));
    }
    let right = Wide::list(right);
    let count = left.len().max(right.len());
    let mut results = Vec::new();
    for at in 0..count {
        let [x, y] = [&left, &right].map(|list| list[at.min(list.len() - 1)]);
        let number = match operator {
            O::Add => arithmetic::add(b, x, y),
            O::Subtract => arithmetic::subtract(b, x, y),
            O::Multiply => arithmetic::multiply(b, x, y),
            O::Divide => division::divide(b, [x, y], is_signed).quotient,
            O::Modulo => division::divide(b, [x, y], is_signed).remainder,
            O::And => arithmetic::each(b, Binary::And, x, y),
            O::InclusiveOr => arithmetic::each(b, Binary::Or, x, y),
            O::ExclusiveOr => arithmetic::each(b, Binary::Xor, x, y),
            _ => {
                results.push(comparison(b, operator, [x, y], is_signed)?);
                continue;
            }
        };
        results.extend(number.to_vec());
    }
    Ok(results)
}

fn comparison(
    b: &mut Builder,
    operator: BinaryOperator,
    [x, y]: [Wide; 2],
    is_signed: bool,
) -> Lowered<Value> {
    use BinaryOperator as O;
    Ok(match operator {
        O::Equal => arithmetic::is_equal(b, x, y),
        O::NotEqual => {
            let is_equal = arithmetic::is_equal(b, x, y);
            b.mask_not(is_equal)
        }
        O::Less => arithmetic::is_less(b, x, y, is_signed),
        O::Greater => arithmetic::is_less(b, y, x, is_signed),
        O::LessEqual => {
            let is_greater = arithmetic::is_less(b, y, x, is_signed);
            b.mask_not(is_greater)
        }
        O::GreaterEqual => {
            let is_less = arithmetic::is_less(b, x, y, is_signed);
            b.mask_not(is_less)
        }
        _ => return Err(LowerError::Unsupported("operators of this kind")),
    })
}

/// A built-in function whose first argument is of 64-bit integers.
pub(super) fn math(
    b: &mut Builder,
    function: MathFunction,
    kind: ScalarKind,
    arguments: &[Vec<Value>],
) -> Lowered<Vec<Value>> {
    use MathFunction as F;
    let is_signed = kind == ScalarKind::Sint;
    let lists: Vec<_> = arguments.iter().map(|list| Wide::list(list)).collect();
    if function == F::Dot {
        let mut sum = Wide::constant(b, 0);
        for (&x, &y) in lists[0].iter().zip(&lists[1]) {
            let product = arithmetic::multiply(b, x, y);
            sum = arithmetic::add(b, sum, product);
        }
        return Ok(sum.to_vec());
    }
    let mut results = Vec::new();
    for (at, &x) in lists[0].iter().enumerate() {
        let integer = |argument: usize| lists[argument][at];
        // The offset and the count of bits are one word each.
        let range = |first: usize| [arguments[first][0], arguments[first + 1][0]];
        let result = match function {
            F::Abs if is_signed => arithmetic::magnitude(b, x),
            F::Abs => x,
            F::Min => arithmetic::lesser(b, x, integer(1), is_signed),
            F::Max => arithmetic::greater(b, x, integer(1), is_signed),
            F::Clamp => {
                let raised = arithmetic::greater(b, x, integer(1), is_signed);
                arithmetic::lesser(b, raised, integer(2), is_signed)
            }
            F::Sign => arithmetic::sign(b, x, is_signed),
            F::CountOneBits => bits::count_ones(b, x),
            F::CountLeadingZeros => bits::leading_zeros(b, x),
            F::CountTrailingZeros => bits::trailing_zeros(b, x),
            F::FirstLeadingBit => bits::first_leading(b, x, is_signed),
            F::FirstTrailingBit => bits::first_trailing(b, x),
            F::ReverseBits => bits::reverse(b, x),
            F::ExtractBits => bits::extract(b, x, range(1), is_signed),
            F::InsertBits => bits::insert(b, [x, integer(1)], range(2)),
            _ => return Err(LowerError::Unsupported("functions of this kind")),
        };
        results.extend(result.to_vec());
    }
    Ok(results)
}

/// Each scalar of one type as one of another, of which at least one is a 64-bit integer.
pub(super) fn convert(
    b: &mut Builder,
    of: &[Value],
    [from, to]: [Scalar; 2],
) -> Lowered<Vec<Value>> {
    use ScalarKind as K;
    if is_wide(from) && is_wide(to) {
        return Ok(of.to_vec());
    }
    // A 16-bit float is a word too, which is rounded after the conversion: only numbers that become
    // infinite have more bits than binary32.
    let is_word =
        |scalar: Scalar| scalar.kind == K::Bool || scalar.width == 4 || scalar == Scalar::F16;
    if !is_word(if is_wide(from) { to } else { from }) {
        return Err(LowerError::Unsupported("conversions of this kind"));
    }
    let mut results = Vec::new();
    for scalar in of.chunks_exact(words(from) as usize) {
        match *scalar {
            [low, high] => {
                let x = Wide { low, high };
                results.push(match to.kind {
                    K::Bool => arithmetic::is_not_zero(b, x),
                    K::Float => conversion::float_of(b, x, from.kind == K::Sint),
                    _ => low,
                });
            }
            [x] => {
                let result = match from.kind {
                    K::Bool => conversion::of_mask(b, x),
                    K::Float => conversion::of_float(b, x, to.kind == K::Sint),
                    kind => conversion::of_word(b, x, kind == K::Sint),
                };
                results.extend(result.to_vec());
            }
            _ => return Err(LowerError::Unsupported("conversions of this kind")),
        }
    }
    Ok(results)
}

/// `yes` where the mask is set, else `no`.
fn select(b: &mut Builder, mask: Value, yes: Wide, no: Wide) -> Wide {
    Wide {
        low: b.select(mask, yes.low, no.low),
        high: b.select(mask, yes.high, no.high),
    }
}

/// True where a word is 0.
fn is_zero(b: &mut Builder, word: Value) -> Value {
    let zero = b.word(0);
    b.compare(Compare::Eq, word, zero)
}

/// The words that are all ones where a number is negative, else zeros: of a signed number those
/// above it, too.
fn signs(b: &mut Builder, word: Value) -> Value {
    let last = b.word(31);
    b.binary(Binary::SShr, word, last)
}

/// A shift by a word that is known.
fn shifted(b: &mut Builder, kind: Binary, word: Value, amount: u32) -> Value {
    let amount = b.word(amount);
    b.binary(kind, word, amount)
}

/// A shift by 31 − n, for n of 0 to 31: shifts are modulo 32.
fn shifted_back(b: &mut Builder, kind: Binary, word: Value, n: Value) -> Value {
    let amount = b.unary(Unary::Not, n);
    b.binary(kind, word, amount)
}
