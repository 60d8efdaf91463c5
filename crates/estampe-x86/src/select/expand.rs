//! Functions become operations: those of `estampe_types::maths`, of the definition that lanes use.

use crate::CompileError;
use estampe_ir::lanes::{Kernel, ValueInfo};
use estampe_ir::op::{Binary, Compare, MaskBinary, Math, Math2, Unary};
use estampe_ir::{Op, Type, Value};
use estampe_types::maths;
use estampe_types::maths::traced::{One, Shift, Step, Two, steps};
use std::collections::HashMap;

/// A function of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Function {
    One(Math),
    Two(Math2),
}

impl Function {
    fn steps(self) -> Vec<Step> {
        match self {
            Self::One(Math::Sin) => steps(|[x, _]| maths::sin(x)),
            Self::One(Math::Cos) => steps(|[x, _]| maths::cos(x)),
            Self::One(Math::Tan) => steps(|[x, _]| maths::tan(x)),
            Self::One(Math::Asin) => steps(|[x, _]| maths::asin(x)),
            Self::One(Math::Acos) => steps(|[x, _]| maths::acos(x)),
            Self::One(Math::Atan) => steps(|[x, _]| maths::atan(x)),
            Self::One(Math::Sinh) => steps(|[x, _]| maths::sinh(x)),
            Self::One(Math::Cosh) => steps(|[x, _]| maths::cosh(x)),
            Self::One(Math::Tanh) => steps(|[x, _]| maths::tanh(x)),
            Self::One(Math::Exp) => steps(|[x, _]| maths::exp(x)),
            Self::One(Math::Exp2) => steps(|[x, _]| maths::exp2(x)),
            Self::One(Math::Log) => steps(|[x, _]| maths::log(x)),
            Self::One(Math::Log2) => steps(|[x, _]| maths::log2(x)),
            Self::Two(Math2::Pow) => steps(|[x, y]| maths::pow(x, y)),
            Self::Two(Math2::Atan2) => steps(|[y, x]| maths::atan2(y, x)),
        }
    }
}

/// Replaces functions by operations. `None` if the kernel has none.
///
/// # Errors
/// [`CompileError::TooLarge`] if they are more than so many operations.
pub(crate) fn expand(kernel: &Kernel, limit: usize) -> Result<Option<Kernel>, CompileError> {
    let mut ops = kernel.blocks.iter().flat_map(|block| &block.ops);
    if !ops.any(|(op, _)| matches!(op, Op::Math(..) | Op::Math2(..))) {
        return Ok(None);
    }
    let mut left = limit;
    let mut expanded = kernel.clone();
    let mut known: HashMap<Function, Vec<Step>> = HashMap::new();
    for (block, from) in expanded.blocks.iter_mut().zip(&kernel.blocks) {
        block.ops.clear();
        for (op, first) in &from.ops {
            let (function, arguments) = match op {
                Op::Math(function, x) => (Function::One(*function), [*x; 2]),
                Op::Math2(function, pair) => (Function::Two(*function), *pair),
                _ => {
                    block.ops.push((op.clone(), *first));
                    continue;
                }
            };
            // Each step makes two operations at most.
            let steps = known.entry(function).or_insert_with(|| function.steps());
            let is_uniform = kernel.values[first.index()].is_uniform;
            let made = left.checked_sub(steps.len() * 2);
            left = made.ok_or(CompileError::TooLarge)?;
            let values = &mut expanded.values;
            let ops = &mut block.ops;
            insert((steps, arguments, &[]), (*first, is_uniform), values, ops);
        }
    }
    Ok(Some(expanded))
}

/// Steps whose results are values that are there: what they alone need is not needed.
pub(super) type Known<'a> = &'a [(usize, Value)];

/// Adds the steps of a function, whose last one gives `result`.
pub(super) fn insert(
    (steps, arguments, known): (&[Step], [Value; 2], Known<'_>),
    (result, is_uniform): (Value, bool),
    values: &mut Vec<ValueInfo>,
    ops: &mut Vec<(Op, Value)>,
) {
    let mut new = |kind: Type, is_uniform: bool| {
        values.push(ValueInfo { kind, is_uniform });
        Value(u32::try_from(values.len() - 1).unwrap_or(u32::MAX))
    };
    let mut places: Vec<Value> = Vec::with_capacity(steps.len());
    for (at, step) in steps.iter().enumerate() {
        if let Some((_, value)) = known.iter().find(|(known, _)| *known == at) {
            places.push(*value);
            continue;
        }
        let place = |at: u32| places[at as usize];
        let op = match *step {
            Step::Argument(at) => {
                places.push(arguments[at as usize & 1]);
                continue;
            }
            Step::Word(word) => Op::Constant(word),
            Step::Mask(is_set) => Op::MaskConstant(is_set),
            Step::Select([mask, yes, no]) => Op::Select {
                mask: place(mask),
                yes: place(yes),
                no: place(no),
            },
            Step::One(One::Not, a) => Op::MaskNot(place(a)),
            Step::One(kind, a) => Op::Unary(unary(kind), place(a)),
            Step::Two(kind, pair) => two(kind, pair.map(place)),
            Step::Shift(kind, a, by) => {
                let bits = new(Type::Word, true);
                ops.push((Op::Constant(by), bits));
                Op::Binary(shift(kind), [place(a), bits])
            }
        };
        let value = if at + 1 == steps.len() {
            result
        } else {
            // Constants are the same in all lanes whatever they are for.
            let is_constant = matches!(step, Step::Word(_) | Step::Mask(_));
            new(op.results()[0], is_uniform || is_constant)
        };
        ops.push((op, value));
        places.push(value);
    }
}

fn shift(kind: Shift) -> Binary {
    match kind {
        Shift::Left => Binary::Shl,
        Shift::Right => Binary::SShr,
        Shift::RightUnsigned => Binary::UShr,
    }
}

fn unary(kind: One) -> Unary {
    match kind {
        One::Neg => Unary::FNeg,
        One::Sqrt => Unary::FSqrt,
        One::Abs => Unary::FAbs,
        One::Floor => Unary::FFloor,
        One::ToInt | One::ToIntWithinRange => Unary::S32FromF32,
        One::ToReal => Unary::F32FromS32,
        One::Not => Unary::Not,
    }
}

fn two(kind: Two, pair: [Value; 2]) -> Op {
    let binary = |kind| Op::Binary(kind, pair);
    let compare = |kind| Op::Compare(kind, pair);
    match kind {
        Two::Add => binary(Binary::FAdd),
        Two::Sub => binary(Binary::FSub),
        Two::Mul => binary(Binary::FMul),
        Two::Div => binary(Binary::FDiv),
        Two::Min => binary(Binary::FMin),
        Two::Max => binary(Binary::FMax),
        Two::IntAdd => binary(Binary::Add),
        Two::IntSub => binary(Binary::Sub),
        Two::IntMul => binary(Binary::Mul),
        Two::IntAnd => binary(Binary::And),
        Two::IntOr => binary(Binary::Or),
        Two::IntXor => binary(Binary::Xor),
        Two::IntMin => binary(Binary::SMin),
        Two::IntMax => binary(Binary::SMax),
        Two::Lt => compare(Compare::FLt),
        Two::Le => compare(Compare::FLe),
        Two::Eq => compare(Compare::FEq),
        Two::IntLt => compare(Compare::SLt),
        Two::IntEq => compare(Compare::Eq),
        Two::MaskAnd => Op::MaskBinary(MaskBinary::And, pair),
        Two::MaskOr => Op::MaskBinary(MaskBinary::Or, pair),
    }
}
