//! Sines of small angles in loops take fewer steps, with the same bits.
//!
//! The sine of x is that of r = x − k·π, with k the integer nearest to x ÷ π and π in two parts.
//! Where |k| < 2¹⁶, k times the first part, of eight bits, is exact, so that it may be subtracted
//! without being rounded before; and |r| < 2, so that r need not be clamped. Both stand in the
//! chain for which loops wait. A product x = v·s with a power of two s gives k by one step,
//! v·(s ÷ π), in place of two: without overflow, which k shows, and where k is not 0, both are
//! rounded alike.
//!
//! So a block of a loop that has several sines becomes three: what their angles need, and the test
//! of all k; the rest of the block for large angles, as it was; and the rest for small ones.
//! Together they end like the block.

use super::expand::{Known, insert};
use super::is_in_loop;
use estampe_ir::lanes::{BasicBlock, BlockId, Jump, Kernel, Terminator, ValueInfo};
use estampe_ir::op::{Binary, Compare, Math};
use estampe_ir::{Op, Type, Value};
use estampe_types::maths;
use estampe_types::maths::traced::{Shift, Step, Two, steps};
use std::collections::{HashMap, HashSet};

/// The fewest sines of a block: the test takes about as long as what one of them saves.
const FEWEST: usize = 2;

/// The most operations of a block, which is there twice.
const MOST: usize = 256;

/// 2³², the square of what all k are less than.
const BOUND: f32 = 4_294_967_296.0;

/// The exponents of the powers of two in products that are looked through.
const MOST_BITS: u32 = 60;

/// Splits blocks; `None` if there are none to split.
pub(crate) fn split(kernel: &Kernel) -> Option<Kernel> {
    let sine = Sine::of_definition()?;
    let constants = constants(kernel);
    let splits = (0..kernel.blocks.len()).map(|at| Split::of(kernel, at, &constants));
    let splits: Vec<Option<Split>> = splits.collect();
    if splits.iter().all(Option::is_none) {
        return None;
    }
    let mut numbers = Vec::new();
    let mut next = 0;
    for split in &splits {
        numbers.push(BlockId(next));
        next += if split.is_some() { 3 } else { 1 };
    }
    let mut made = Kernel {
        values: kernel.values.clone(),
        blocks: Vec::new(),
        ..kernel.clone()
    };
    for (block, split) in kernel.blocks.iter().zip(&splits) {
        let mut block = block.clone();
        for jump in block.terminator.jumps_mut() {
            jump.to = numbers[jump.to.index()];
        }
        match split {
            None => made.blocks.push(block),
            Some(split) => split.apply(&block, &sine, &mut made),
        }
    }
    Some(made)
}

/// The words that are known.
fn constants(kernel: &Kernel) -> HashMap<Value, u32> {
    let ops = kernel.blocks.iter().flat_map(|block| &block.ops);
    let word = |(op, value): &(Op, Value)| match op {
        Op::Constant(word) => Some((*value, *word)),
        _ => None,
    };
    ops.filter_map(word).collect()
}

/// The sine as steps, and what is known of them.
struct Sine {
    steps: Vec<Step>,
    /// The step that adds to x ÷ π what makes its last bit that of k.
    rounded: usize,
    /// The step that gives r in its bounds.
    clamped: usize,
    inverse_of_pi: f32,
    rounding: u32,
    parts_of_pi: [f32; 2],
}

impl Sine {
    /// Takes the definition apart; `None` if it is another one than the one above.
    fn of_definition() -> Option<Self> {
        let steps = steps(|[x, _]| maths::sin(x));
        let two = |at: u32, kind: Two| match steps.get(at as usize) {
            Some(Step::Two(found, pair)) if *found == kind => Some(*pair),
            _ => None,
        };
        let word = |at: u32| match steps.get(at as usize) {
            Some(Step::Word(word)) => Some(*word),
            _ => None,
        };
        let number = |at: u32| word(at).map(f32::from_bits);
        let rounded = steps.iter().find_map(|step| match step {
            Step::Shift(Shift::Left, rounded, 31) => Some(*rounded),
            _ => None,
        })?;
        let [quotient, rounding] = two(rounded, Two::Add)?;
        let [x, inverse_of_pi] = two(quotient, Two::Mul)?;
        let is_max = |step: &Step| matches!(step, Step::Two(Two::Max, _));
        let clamped = steps.iter().position(is_max)?;
        let [least, clamped_above] = two(u32::try_from(clamped).ok()?, Two::Max)?;
        let [most, r] = two(clamped_above, Two::Min)?;
        let [difference, second] = two(r, Two::Sub)?;
        let [minuend, first] = two(difference, Two::Sub)?;
        let [of_k, parts] = [two(first, Two::Mul)?, two(second, Two::Mul)?];
        let k = two(of_k[0], Two::Sub)?;
        let parts_of_pi = [number(of_k[1])?, number(parts[1])?];
        let is_known = steps.get(x as usize) == Some(&Step::Argument(0))
            && minuend == x
            && parts[0] == of_k[0]
            && k[0] == rounded
            && word(k[1])? == word(rounding)?
            && [number(least)?, number(most)?] == [-2.0, 2.0]
            && parts_of_pi[0].to_bits().trailing_zeros() >= 16;
        let rounding = word(rounding)?;
        let inverse_of_pi = number(inverse_of_pi)?;
        is_known.then_some(Self {
            rounded: rounded as usize,
            clamped,
            inverse_of_pi,
            rounding,
            parts_of_pi,
            steps,
        })
    }
}

/// A sine of a block.
struct OfBlock {
    result: Value,
    /// The angle is this value times a power of two, which may be 1.
    value: Value,
    scale: f32,
}

/// How a block is split.
struct Split {
    sines: Vec<OfBlock>,
    /// For each operation, whether an angle needs it.
    is_early: Vec<bool>,
}

impl Split {
    fn of(kernel: &Kernel, at: usize, constants: &HashMap<Value, u32>) -> Option<Self> {
        let block = &kernel.blocks[at];
        let is_barred = |op: &Op| op.has_effect() || matches!(op, Op::Texture(_) | Op::Any(_));
        let is_end = matches!(block.terminator, Terminator::Return(_));
        let is_taken = block.ops.len() <= MOST && !is_end && is_in_loop(kernel, at);
        if !is_taken || block.ops.iter().any(|(op, _)| is_barred(op)) {
            return None;
        }
        let mut made_by = HashMap::new();
        for (at, (op, first)) in block.ops.iter().enumerate() {
            made_by.extend(
                first
                    .and_next(op.results().len())
                    .into_iter()
                    .map(|value| (value, at)),
            );
        }
        // Constants stand before both, as other blocks may use them.
        let is_constant = |op: &Op| matches!(op, Op::Constant(_) | Op::MaskConstant(_));
        let mut is_early: Vec<bool> = block.ops.iter().map(|(op, _)| is_constant(op)).collect();
        let mut sines = Vec::new();
        for (op, result) in &block.ops {
            if let Op::Math(Math::Sin, angle) = op
                && !kernel.values[result.index()].is_uniform
            {
                let product = made_by.get(angle).map(|at| &block.ops[*at].0);
                let (value, scale) = factors(product, constants).unwrap_or((*angle, 1.0));
                let Some(needed) = needed(block, value, &made_by) else {
                    continue;
                };
                needed.into_iter().for_each(|at| is_early[at] = true);
                sines.push(OfBlock {
                    result: *result,
                    value,
                    scale,
                });
            }
        }
        let split = Self { sines, is_early };
        (split.sines.len() >= FEWEST && !split.is_seen(kernel, at)).then_some(split)
    }

    /// True if another block uses what the rest of the block computes.
    fn is_seen(&self, kernel: &Kernel, at: usize) -> bool {
        let mut late = HashSet::new();
        for ((op, first), is_early) in kernel.blocks[at].ops.iter().zip(&self.is_early) {
            if !is_early {
                late.extend(first.and_next(op.results().len()));
            }
        }
        let mut is_seen = false;
        let others = kernel.blocks.iter().enumerate();
        for (_, block) in others.filter(|(other, _)| *other != at) {
            for (op, _) in &block.ops {
                op.each_operand(|value, _| is_seen |= late.contains(&value));
            }
            is_seen |= operands(&block.terminator).any(|value| late.contains(&value));
        }
        is_seen
    }

    /// Adds the blocks, of which jumps already have their new numbers.
    fn apply(&self, block: &BasicBlock, sine: &Sine, made: &mut Kernel) {
        let number = |at: usize| BlockId(u32::try_from(at).unwrap_or(u32::MAX));
        let [large, small] = [1, 2].map(|behind| number(made.blocks.len() + behind));
        let all = block.ops.iter().zip(&self.is_early);
        let early = all.clone().filter(|(_, is_early)| **is_early);
        let late = all.filter(|(_, is_early)| !**is_early);
        let mut ops: Vec<(Op, Value)> = early.map(|(op, _)| op.clone()).collect();
        let late: Vec<(Op, Value)> = late.map(|(op, _)| op.clone()).collect();
        let mut writer = Writer {
            values: &mut made.values,
            ops: &mut ops,
        };
        let found = writer.find_multiples(&self.sines, sine);
        let is_large = writer.test(&found);
        let jump = |to| Jump {
            to,
            arguments: Vec::new(),
        };
        let head = BasicBlock {
            parameters: block.parameters.clone(),
            ops,
            terminator: Terminator::Branch {
                mask: is_large,
                any: jump(large),
                none: jump(small),
            },
        };
        let of_small = self.rest_for_small(&late, &found, sine, &mut made.values);
        let (ops, renamed) = of_small;
        let mut terminator = block.terminator.clone();
        for operand in operands_mut(&mut terminator) {
            *operand = renamed.get(operand).copied().unwrap_or(*operand);
        }
        let rest = |ops, terminator| BasicBlock {
            parameters: Vec::new(),
            ops,
            terminator,
        };
        made.blocks.push(head);
        made.blocks.push(rest(late, block.terminator.clone()));
        made.blocks.push(rest(ops, terminator));
    }

    /// The rest of the block for small angles, and the new names of its values.
    fn rest_for_small(
        &self,
        late: &[(Op, Value)],
        found: &[Multiple],
        sine: &Sine,
        values: &mut Vec<ValueInfo>,
    ) -> (Vec<(Op, Value)>, HashMap<Value, Value>) {
        let (mut ops, mut renamed) = (Vec::new(), HashMap::new());
        for (op, first) in late {
            let mut op = op.clone();
            op.each_operand_mut(|value, _| {
                *value = renamed.get(value).copied().unwrap_or(*value);
            });
            let new = Value(u32::try_from(values.len()).unwrap_or(u32::MAX));
            let count = op.results().len();
            for (old, new) in first.and_next(count).into_iter().zip(new.and_next(count)) {
                values.push(values[old.index()]);
                renamed.insert(old, new);
            }
            let at = self.sines.iter().position(|sine| sine.result == *first);
            let (Some(multiple), Op::Math(_, angle)) = (at.map(|at| &found[at]), &op) else {
                ops.push((op, new));
                continue;
            };
            let mut writer = Writer {
                values,
                ops: &mut ops,
            };
            let r = writer.remainder(*angle, multiple, sine);
            let known: Known<'_> = &[(sine.rounded, multiple.rounded), (sine.clamped, r)];
            let result = (new, false);
            insert((&sine.steps, [*angle; 2], known), result, values, &mut ops);
        }
        (ops, renamed)
    }
}

/// The operations of a block that a value needs; `None` if one of them may not come first.
fn needed(
    block: &BasicBlock,
    value: Value,
    made_by: &HashMap<Value, usize>,
) -> Option<HashSet<usize>> {
    let (mut needed, mut left) = (HashSet::new(), vec![value]);
    while let Some(value) = left.pop() {
        let Some(at) = made_by.get(&value) else {
            continue;
        };
        let (op, _) = &block.ops[*at];
        // Loads stay behind, and sines, which would not be taken.
        if !op.is_pure(|_| true) || matches!(op, Op::Math(..) | Op::Math2(..)) {
            return None;
        }
        if needed.insert(*at) {
            op.each_operand(|value, _| left.push(value));
        }
    }
    Some(needed)
}

/// The factors of a product with a power of two.
fn factors(product: Option<&Op>, constants: &HashMap<Value, u32>) -> Option<(Value, f32)> {
    let Op::Binary(Binary::FMul, [a, b]) = product? else {
        return None;
    };
    let mut pairs = [(a, b), (b, a)].into_iter();
    pairs.find_map(|(value, scale)| {
        let word = *constants.get(scale)?;
        let exponents = 127 - MOST_BITS..=127 + MOST_BITS;
        let is_power = word.trailing_zeros() >= 23 && exponents.contains(&(word >> 23));
        is_power.then(|| (*value, f32::from_bits(word)))
    })
}

/// The values that a terminator uses.
fn operands(terminator: &Terminator) -> impl Iterator<Item = Value> {
    let mut copy = terminator.clone();
    let values: Vec<Value> = operands_mut(&mut copy).map(|value| *value).collect();
    values.into_iter()
}

/// The operands of a terminator, to replace them.
fn operands_mut(terminator: &mut Terminator) -> impl Iterator<Item = &mut Value> {
    let (mask, first, second, values) = match terminator {
        Terminator::Jump(jump) => (None, Some(jump), None, None),
        Terminator::Branch { mask, any, none } => (Some(mask), Some(any), Some(none), None),
        Terminator::Return(values) => (None, None, None, Some(values)),
    };
    let jumps = first.into_iter().chain(second);
    let arguments = jumps.flat_map(|jump| &mut jump.arguments);
    mask.into_iter()
        .chain(arguments)
        .chain(values.into_iter().flatten())
}

/// The multiple of π that is nearest to an angle.
struct Multiple {
    rounded: Value,
    k: Value,
}

/// Adds operations.
struct Writer<'a> {
    values: &'a mut Vec<ValueInfo>,
    ops: &'a mut Vec<(Op, Value)>,
}

impl Writer<'_> {
    fn push(&mut self, op: Op) -> Value {
        let is_uniform = matches!(op, Op::Constant(_));
        let kind = op.results().first().copied().unwrap_or(Type::Word);
        self.values.push(ValueInfo { kind, is_uniform });
        let value = Value(u32::try_from(self.values.len() - 1).unwrap_or(u32::MAX));
        self.ops.push((op, value));
        value
    }

    fn number(&mut self, number: f32) -> Value {
        self.push(Op::Constant(number.to_bits()))
    }

    /// The multiples of π that are nearest to the sines' angles.
    fn find_multiples(&mut self, sines: &[OfBlock], sine: &Sine) -> Vec<Multiple> {
        let mut found = Vec::new();
        for OfBlock { value, scale, .. } in sines {
            let factor = self.number(sine.inverse_of_pi * scale);
            let rounding = self.push(Op::Constant(sine.rounding));
            let quotient = self.push(Op::Binary(Binary::FMul, [*value, factor]));
            let rounded = self.push(Op::Binary(Binary::FAdd, [quotient, rounding]));
            let k = self.push(Op::Binary(Binary::FSub, [rounded, rounding]));
            found.push(Multiple { rounded, k });
        }
        found
    }

    /// Where an angle is large.
    fn test(&mut self, multiples: &[Multiple]) -> Value {
        let mut squares = None;
        for Multiple { k, .. } in multiples {
            squares = Some(match squares {
                None => self.push(Op::Binary(Binary::FMul, [*k, *k])),
                Some(sum) => self.push(Op::Fma([*k, *k, sum])),
            });
        }
        let squares = squares.unwrap_or_else(|| self.number(0.0));
        // As integers, so that infinity and NaN are large.
        let bound = self.number(BOUND);
        self.push(Op::Compare(Compare::ULe, [bound, squares]))
    }

    /// The rest of a small angle.
    fn remainder(&mut self, angle: Value, multiple: &Multiple, sine: &Sine) -> Value {
        let [first, second] = sine.parts_of_pi;
        let [first, second] = [self.number(-first), self.number(second)];
        let rest = self.push(Op::Fma([multiple.k, first, angle]));
        let less = self.push(Op::Binary(Binary::FMul, [multiple.k, second]));
        self.push(Op::Binary(Binary::FSub, [rest, less]))
    }
}

#[cfg(test)]
mod tests {
    use super::Sine;

    #[test]
    fn the_sine_is_taken_apart() {
        assert!(Sine::of_definition().is_some());
    }
}
