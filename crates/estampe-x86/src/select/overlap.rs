//! Software pipelining: in a loop whose body only computes, the first half of the next iteration
//! stands beside the second half of this one.
//!
//! ```text
//! header(k, sum)            header(k, sum, x of k)
//!   body: x = first(k)        body: x of k + 1 = first(k + 1)
//!         sum + second(x)           sum + second(x of k)
//! ```
//!
//! An iteration of a long chain of operations leaves the ports idle, and where it has many of them,
//! the next one is beyond the window from which the processor takes what is ready. Here each half
//! finds what it needs computed. Operations keep the place at which they are written, those of the
//! next iteration among those of this one: the halves of independent chains take turns.
//!
//! The first half of the first iteration is computed before the loop, that of the one after the
//! last one in vain. Nothing sees it: the operations that move have no effect but their results,
//! and loads are confined to their memory. A loop with an effect stays as it is, since its loads
//! may depend on it.

use super::plan::Plan;
use super::schedule::latency;
use estampe_ir::lanes::{BlockId, Kernel, Terminator, ValueInfo};
use estampe_ir::{Op, Type, Value};
use std::collections::HashMap;

/// The least operations of a body: the processor sees two iterations of a smaller one at once.
const LEAST_OPS: usize = 64;

/// The least cycles of a body's longest chain.
const LEAST_CYCLES: u32 = 64;

/// The most words that the first half hands over to the second.
const MOST_CARRIED: usize = 20;

/// A kernel with loops that are pipelined.
#[derive(Debug)]
pub(super) struct Overlapped {
    pub(super) kernel: Kernel,
    /// The bodies of those loops, whose operations are in order.
    pub(super) bodies: Vec<usize>,
}

/// A loop of a header, which decides whether there is another iteration, and a body.
#[derive(Debug, Clone, Copy)]
struct Loop {
    before: usize,
    header: usize,
    body: usize,
}

/// Pipelines the loops for which it is worth it; `None` if there are none.
pub(super) fn overlap(kernel: &Kernel, plan: &Plan) -> Option<Overlapped> {
    let loops = (0..kernel.blocks.len()).filter_map(|header| Loop::of(kernel, header));
    let mut overlapped: Option<Overlapped> = None;
    for found in loops {
        let Some(halves) = found.halves(kernel, plan) else {
            continue;
        };
        let to = overlapped.get_or_insert_with(|| Overlapped {
            kernel: kernel.clone(),
            bodies: Vec::new(),
        });
        found.overlap(&halves, &mut to.kernel);
        to.bodies.push(found.body);
    }
    overlapped
}

/// What an operation of a body becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// The same in every iteration.
    Invariant,
    /// Makes a parameter of the next iteration.
    Step,
    First,
    Second,
}

/// The halves of a body.
#[derive(Debug)]
struct Halves {
    /// The part of each operation.
    parts: Vec<Part>,
    /// What the first half hands over.
    carried: Vec<Value>,
}

impl Loop {
    /// The loop with this header, if it has one body, which is entered and left in one way.
    fn of(kernel: &Kernel, header: usize) -> Option<Self> {
        let jumps_to = |to: usize| {
            let of_block = move |(at, block): (usize, &estampe_ir::lanes::BasicBlock)| {
                let jumps = block.terminator.jumps();
                let count = jumps.filter(|jump| jump.to.index() == to).count();
                (count > 0).then_some((at, count))
            };
            let blocks = kernel.blocks.iter().enumerate();
            blocks.filter_map(of_block).collect::<Vec<_>>()
        };
        let Terminator::Branch { any, .. } = &kernel.blocks[header].terminator else {
            return None;
        };
        let [(before, 1), (last, 1)] = jumps_to(header)[..] else {
            return None;
        };
        let (mut body, mut from, mut jump) = (any.to.index(), header, any);
        // Blocks between that do nothing.
        while body != last {
            let block = &kernel.blocks[body];
            let Terminator::Jump(next) = &block.terminator else {
                return None;
            };
            if !block.ops.is_empty() || jumps_to(body)[..] != [(from, 1)] || body <= from {
                return None;
            }
            (from, body, jump) = (body, next.to.index(), next);
        }
        let is_simple = matches!(kernel.blocks[before].terminator, Terminator::Jump(_))
            && matches!(kernel.blocks[body].terminator, Terminator::Jump(_))
            && jumps_to(body)[..] == [(from, 1)]
            && jump.arguments.is_empty()
            && before < header
            && header < body;
        is_simple.then_some(Self {
            before,
            header,
            body,
        })
    }

    /// How the body is divided; `None` if that is not worth it.
    fn halves(self, kernel: &Kernel, plan: &Plan) -> Option<Halves> {
        let [header, body] = [self.header, self.body].map(|at| &kernel.blocks[at]);
        let mut ops = header.ops.iter().chain(&body.ops);
        if ops.any(|(op, _)| op.has_effect()) || body.ops.len() < LEAST_OPS {
            return None;
        }
        // The operation of each value of the loop, and what the next iteration has in its place.
        let mut made_by: HashMap<Value, Option<usize>> = HashMap::new();
        for (op, first) in &header.ops {
            made_by.extend(
                first
                    .and_next(op.results().len())
                    .into_iter()
                    .map(|value| (value, None)),
            );
        }
        made_by.extend(header.parameters.iter().map(|&parameter| (parameter, None)));
        for (at, (op, first)) in body.ops.iter().enumerate() {
            made_by.extend(
                first
                    .and_next(op.results().len())
                    .into_iter()
                    .map(|value| (value, Some(at))),
            );
        }
        let mut parts = vec![Part::Second; body.ops.len()];
        for (part, (op, first)) in parts.iter_mut().zip(&body.ops) {
            if op.is_pure(|_| true) && plan.is_hoisted(*first) {
                *part = Part::Invariant;
            }
        }
        let is_invariant = |parts: &[Part], value: Value| match made_by.get(&value) {
            None => true,
            Some(at) => at.is_some_and(|at| parts[at] == Part::Invariant),
        };
        // Parameters that grow by what is the same in every iteration.
        let mut steps: Vec<Value> = Vec::new();
        for (&parameter, argument) in header.parameters.iter().zip(self.next(kernel)) {
            let Some(&Some(at)) = made_by.get(argument) else {
                continue;
            };
            if let Op::Binary(_, [a, b]) = body.ops[at].0
                && (a == parameter && is_invariant(&parts, b)
                    || b == parameter && is_invariant(&parts, a))
            {
                parts[at] = Part::Step;
                steps.push(parameter);
            }
        }
        // What can be computed ahead, and when each operation can begin.
        let mut begins = vec![0; body.ops.len()];
        let mut is_ahead = vec![false; body.ops.len()];
        let mut cycles = 0;
        for (at, (op, _)) in body.ops.iter().enumerate() {
            let is_load = matches!(op, Op::LoadBuffer { .. } | Op::LoadWorkgroup(_));
            is_ahead[at] = parts[at] == Part::Second
                && (is_load || op.is_pure(|_| true))
                && op.results().len() == 1;
            op.each_operand(|value, _| {
                let maker = made_by.get(&value).copied().flatten();
                if let Some(maker) = maker.filter(|&maker| parts[maker] == Part::Second) {
                    begins[at] = begins[at].max(begins[maker] + latency(&body.ops[maker].0));
                    is_ahead[at] &= is_ahead[maker];
                } else {
                    is_ahead[at] &= is_invariant(&parts, value) || steps.contains(&value);
                }
            });
            cycles = cycles.max(begins[at] + latency(op));
        }
        for (at, part) in parts.iter_mut().enumerate() {
            if is_ahead[at] && begins[at] * 2 < cycles {
                *part = Part::First;
            }
        }
        let mut carried: Vec<Value> = Vec::new();
        let mut hand_over = |value: Value| {
            let maker = made_by.get(&value).copied().flatten();
            if maker.is_some_and(|at| parts[at] == Part::First) && !carried.contains(&value) {
                carried.push(value);
            }
        };
        for (part, (op, _)) in parts.iter().zip(&body.ops) {
            if *part != Part::First {
                op.each_operand(|value, _| hand_over(value));
            }
        }
        self.next(kernel).iter().for_each(|value| hand_over(*value));
        let are_words = carried
            .iter()
            .all(|value| kernel.values[value.index()].kind == Type::Word);
        let is_worth_it = (1..=MOST_CARRIED).contains(&carried.len()) && are_words;
        (is_worth_it && cycles >= LEAST_CYCLES).then_some(Halves { parts, carried })
    }

    /// The arguments of the next iteration.
    fn next(self, kernel: &Kernel) -> &[Value] {
        match &kernel.blocks[self.body].terminator {
            Terminator::Jump(jump) => &jump.arguments,
            _ => &[],
        }
    }

    /// Moves the first half.
    fn overlap(self, halves: &Halves, kernel: &mut Kernel) {
        let next = self.next(kernel).to_vec();
        let ops = std::mem::take(&mut kernel.blocks[self.body].ops);
        let parts = || halves.parts.iter().zip(&ops);
        let parameters = kernel.blocks[self.header].parameters.clone();
        // Before the loop: of the first iteration.
        let Terminator::Jump(jump) = &kernel.blocks[self.before].terminator else {
            return;
        };
        let first = parameters
            .iter()
            .copied()
            .zip(jump.arguments.iter().copied());
        let mut of_first: HashMap<Value, Value> = first.collect();
        let ahead = parts().filter(|(part, _)| matches!(part, Part::Invariant | Part::First));
        let mut copies = Vec::new();
        for (_, (op, result)) in ahead {
            copies.push(copy(op, *result, &mut of_first, &mut kernel.values));
        }
        kernel.blocks[self.before].ops.extend(copies);
        // In the loop: of the next one, which begins with the steps of its parameters.
        let mut of_next: HashMap<Value, Value> = parameters.into_iter().zip(next).collect();
        let early = |part: Part| matches!(part, Part::Invariant | Part::Step);
        let start = parts().filter(|(part, _)| early(**part));
        let mut body: Vec<(Op, Value)> = start.map(|(_, one)| one.clone()).collect();
        for (part, (op, result)) in parts().filter(|(part, _)| !early(**part)) {
            body.push(match part {
                Part::First => copy(op, *result, &mut of_next, &mut kernel.values),
                _ => (op.clone(), *result),
            });
        }
        kernel.blocks[self.body].ops = body;
        // What was computed in the body is a parameter now.
        for (from, made) in [(self.before, &of_first), (self.body, &of_next)] {
            if let Terminator::Jump(jump) = &mut kernel.blocks[from].terminator {
                debug_assert_eq!(jump.to, BlockId(u32::try_from(self.header).unwrap_or(0)));
                jump.arguments
                    .extend(halves.carried.iter().map(|value| made[value]));
            }
        }
        kernel.blocks[self.header]
            .parameters
            .extend(&halves.carried);
    }
}

/// An operation of another iteration, with a result of its own.
fn copy(
    op: &Op,
    result: Value,
    known: &mut HashMap<Value, Value>,
    values: &mut Vec<ValueInfo>,
) -> (Op, Value) {
    let mut op = op.clone();
    op.each_operand_mut(|operand, _| {
        if let Some(other) = known.get(operand) {
            *operand = *other;
        }
    });
    values.push(values[result.index()]);
    let own = Value(u32::try_from(values.len() - 1).unwrap_or(u32::MAX));
    known.insert(result, own);
    (op, own)
}
