//! List scheduling: the order of a block's operations, by their latencies.
//!
//! Of the operations whose operands are ready, the one comes next from which the longest chain
//! depends: divisions and square roots start early, and others fill the time. If more values live
//! than there are registers, the operation that ends most of them comes next. That mixes sums that
//! do not depend on each other; where they live in registers one after the other, as they are
//! written, they stay so. Operations that touch memory which the kernel changes keep their order.
//!
//! Accesses to textures that need no other's result come together, because one call serves them:
//! first what they need, then they themselves, then the rest, of which few values live across the
//! call.

use super::plan::Plan;
use crate::Isa;
use estampe_ir::lanes::{Kernel, Terminator};
use estampe_ir::op::{Binary, Unary};
use estampe_ir::{Op, Type, Value};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Of the operations that are ready, so many are compared when registers run out.
const COMPARED: usize = 24;

/// What is known of a kernel for all of its blocks.
#[derive(Debug)]
pub(super) struct Scheduler<'a> {
    kernel: &'a Kernel,
    plan: &'a Plan,
    isa: Isa,
    /// The registers that a value takes.
    halves: usize,
    /// For each value the block that defines it.
    home: Vec<u32>,
    /// Values that other blocks than their own use, or jumps.
    is_used_elsewhere: Vec<bool>,
    /// Values that are parameters of a block.
    is_parameter: Vec<bool>,
    /// The number of each value in the block that is ordered; [`NOWHERE`] between blocks.
    numbers: Vec<u32>,
}

/// No block.
const NOWHERE: u32 = u32::MAX;

impl<'a> Scheduler<'a> {
    pub(super) fn new(kernel: &'a Kernel, plan: &'a Plan, isa: Isa, halves: usize) -> Self {
        let mut home = vec![NOWHERE; kernel.values.len()];
        let mut is_parameter = vec![false; kernel.values.len()];
        for (block, at) in kernel.blocks.iter().zip(0..) {
            for &parameter in &block.parameters {
                home[parameter.index()] = at;
                is_parameter[parameter.index()] = true;
            }
            for (op, first) in &block.ops {
                for value in first.and_next(op.results().len()) {
                    home[value.index()] = at;
                }
            }
        }
        let mut is_used_elsewhere = vec![false; kernel.values.len()];
        for (block, at) in kernel.blocks.iter().zip(0..) {
            for (op, first) in &block.ops {
                if plan.is_needed(op, *first) {
                    op.each_operand(|value, _| {
                        is_used_elsewhere[value.index()] |= home[value.index()] != at;
                    });
                }
            }
            let mut used = |value: Value| is_used_elsewhere[value.index()] = true;
            match &block.terminator {
                Terminator::Return(values) => values.iter().copied().for_each(&mut used),
                Terminator::Branch { mask, .. } => used(*mask),
                Terminator::Jump(_) => {}
            }
            for jump in block.terminator.jumps() {
                jump.arguments.iter().copied().for_each(&mut used);
            }
        }
        Self {
            kernel,
            plan,
            isa,
            halves,
            home,
            is_used_elsewhere,
            is_parameter,
            numbers: vec![NOWHERE; kernel.values.len()],
        }
    }

    /// The operations of a block as they are written, without those that need not be done there.
    pub(super) fn as_written(&self, at: usize) -> Vec<usize> {
        let ops = &self.kernel.blocks[at].ops;
        let is_done_here = |index: &usize| {
            let (op, first) = &ops[*index];
            let is_hoisted = !op.results().is_empty() && self.plan.is_hoisted(*first);
            !is_hoisted && self.plan.is_needed(op, *first)
        };
        (0..ops.len()).filter(is_done_here).collect()
    }

    /// The same in a good order, and the most values that live at once then.
    pub(super) fn by_latency(&mut self, at: usize) -> (Vec<usize>, usize) {
        let nodes = self.as_written(at);
        let mut list = List::new(self, at, &nodes);
        let start = (list.uses_left.clone(), list.waits.clone(), list.live);
        let (mut order, mut most_live) = list.order(self, Priority::Height);
        if most_live > self.limit() {
            (list.uses_left, list.waits, list.live) = start;
            let (written, live) = list.order(self, Priority::Written);
            if live <= self.limit() {
                (order, most_live) = (written, live);
            }
        }
        (
            order.into_iter().map(|node| nodes[node]).collect(),
            most_live,
        )
    }

    /// True if the value takes a register of which there are few.
    fn takes_register(&self, value: Value) -> bool {
        let is_vector =
            self.isa == Isa::Avx2 || self.kernel.values[value.index()].kind == Type::Word;
        is_vector && !self.plan.is_hoisted(value)
    }

    /// The values that may live at once before those come first that end some.
    fn limit(&self) -> usize {
        match self.isa {
            Isa::Avx2 => 13 / self.halves,
            Isa::Avx512 => 28 / self.halves,
        }
    }
}

/// The cycles after which the result of an operation can be used.
pub(super) fn latency(op: &Op) -> u32 {
    match op {
        Op::Constant(_) | Op::MaskConstant(_) => 0,
        Op::Unary(Unary::FSqrt, _) => 24,
        Op::Unary(
            Unary::S32FromF32
            | Unary::U32FromF32
            | Unary::RoundF16
            | Unary::F16FromF32
            | Unary::F32FromF16,
            _,
        ) => 12,
        Op::Unary(Unary::FFloor | Unary::FCeil | Unary::FTrunc | Unary::FRound, _) => 8,
        Op::Binary(Binary::FDiv, _) => 20,
        Op::Binary(Binary::SDiv | Binary::SRem | Binary::UDiv | Binary::URem, _) => 60,
        Op::Binary(Binary::Mul, _) => 10,
        Op::Binary(Binary::FAdd | Binary::FSub | Binary::FMul | Binary::FMin | Binary::FMax, _)
        | Op::Fma(_) => 4,
        Op::Compare(..) => 4,
        Op::Input(_) | Op::InputMask(_) | Op::Derivative { .. } => 7,
        Op::QuadLane { .. } => 3,
        Op::LoadBuffer { .. } | Op::LoadWorkgroup(_) | Op::LoadLocal { .. } => 20,
        _ => 2,
    }
}

/// The turn of an operation before others, of which the first has this turn. Accesses to textures
/// have even turns, twice the number of accesses in a chain of which each needs the one before;
/// what they need has the turn after.
fn turn(is_access: bool, after: u32) -> u32 {
    match (is_access, is_of_accesses(after)) {
        (true, true) => after + 2,
        (true, false) => after.saturating_sub(1) + 2,
        (false, true) => after + 1,
        (false, false) => after,
    }
}

/// True if accesses to textures have this turn.
fn is_of_accesses(turn: u32) -> bool {
    turn >= 2 && turn.is_multiple_of(2)
}

/// Which of the operations that are ready, and of one turn, comes next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Priority {
    /// The one from which the longest chain depends.
    Height,
    /// The one that is written first.
    Written,
}

/// The operations of a block.
#[derive(Default)]
struct List {
    /// The values that each needs and gives, of those that take registers.
    uses: Vec<Vec<u32>>,
    gives: Vec<u32>,
    /// The operations that need the result of each, or must come after it.
    followers: Vec<Vec<u32>>,
    /// The number of operations that must still come before each.
    waits: Vec<u32>,
    latencies: Vec<u32>,
    /// The cycles from the beginning of each to the end of the block.
    heights: Vec<u32>,
    /// Operations of a greater one come first: see [`turn`].
    turns: Vec<u32>,
    /// For each value of the block, by its number, the uses that are left, of those that take
    /// registers.
    uses_left: Vec<u32>,
    live: usize,
}

/// The values of a block, numbered as they are met.
struct Numbers<'a> {
    numbers: &'a mut [u32],
    met: Vec<u32>,
}

impl Numbers<'_> {
    fn of(&mut self, value: Value) -> u32 {
        let number = &mut self.numbers[value.index()];
        if *number == NOWHERE {
            *number = u32::try_from(self.met.len()).unwrap_or(NOWHERE);
            self.met.push(value.0);
        }
        *number
    }
}

impl List {
    fn new(scheduler: &mut Scheduler<'_>, at: usize, nodes: &[usize]) -> Self {
        let kernel = scheduler.kernel;
        let mut taken = std::mem::take(&mut scheduler.numbers);
        let mut numbers = Numbers {
            numbers: &mut taken,
            met: Vec::new(),
        };
        let ops = &kernel.blocks[at].ops;
        let count = nodes.len();
        let mut list = Self {
            uses: vec![Vec::new(); count],
            gives: vec![0; count],
            followers: vec![Vec::new(); count],
            waits: vec![0; count],
            latencies: vec![0; count],
            heights: vec![0; count],
            turns: vec![0; count],
            uses_left: Vec::new(),
            live: 0,
        };
        // The operation that makes each value, by the value's number.
        let mut made_by: Vec<usize> = Vec::new();
        let mut ordered: Option<usize> = None;
        for (node, &index) in nodes.iter().enumerate() {
            let (op, first) = &ops[index];
            let mut before = Vec::new();
            op.each_operand(|value, _| {
                let number = numbers.of(value);
                made_by.resize(numbers.met.len(), usize::MAX);
                let maker = made_by[number as usize];
                before.extend((maker != usize::MAX).then_some(maker));
                if scheduler.takes_register(value) {
                    list.uses[node].push(number);
                }
            });
            list.uses[node].sort_unstable();
            list.uses[node].dedup();
            let is_free = op.is_pure(|buffer| scheduler.plan.is_written(buffer))
                || scheduler.plan.can_join(op)
                || matches!(
                    op,
                    Op::Input(_)
                        | Op::InputMask(_)
                        | Op::Derivative { .. }
                        | Op::QuadLane { .. }
                        | Op::QuadAny(_)
                );
            if !is_free {
                before.extend(ordered);
                ordered = Some(node);
            }
            before.sort_unstable();
            before.dedup();
            for earlier in &before {
                list.followers[*earlier].push(u32::try_from(node).unwrap_or(u32::MAX));
            }
            list.waits[node] = u32::try_from(before.len()).unwrap_or(u32::MAX);
            list.latencies[node] = latency(op);
            for value in first.and_next(op.results().len()) {
                let number = numbers.of(value);
                made_by.resize(numbers.met.len(), usize::MAX);
                made_by[number as usize] = node;
                list.gives[node] += u32::from(scheduler.takes_register(value));
            }
        }
        let met = numbers.met;
        list.uses_left.resize(met.len(), 0);
        for uses in &list.uses {
            for &value in uses {
                let index = met[value as usize] as usize;
                let left = &mut list.uses_left[value as usize];
                let is_new = *left == 0;
                *left += 1;
                // Values of before the block live from its beginning on.
                let is_from_before =
                    scheduler.home[index] as usize != at || scheduler.is_parameter[index];
                list.live += usize::from(is_new && is_from_before);
                // Values that are used later do not end here.
                if is_new && scheduler.is_used_elsewhere[index] {
                    *left += 1;
                }
            }
        }
        for value in met {
            taken[value as usize] = NOWHERE;
        }
        scheduler.numbers = taken;
        for node in (0..count).rev() {
            let after = list.followers[node].iter();
            let after = after.map(|&follower| list.heights[follower as usize]).max();
            list.heights[node] = list.latencies[node] + after.unwrap_or(0);
            let after = list.followers[node].iter();
            let after = after.map(|&follower| list.turns[follower as usize]).max();
            let is_access = scheduler.plan.can_join(&ops[nodes[node]].0);
            list.turns[node] = turn(is_access, after.unwrap_or(0));
        }
        list
    }

    /// The number of values that an operation ends, less those that it gives.
    fn relief(&self, node: usize) -> i64 {
        let uses = self.uses[node].iter();
        let ends = uses.filter(|&&value| self.uses_left[value as usize] == 1);
        i64::try_from(ends.count()).unwrap_or(0) - i64::from(self.gives[node])
    }

    /// The operations in order, and the most values that live at once.
    fn order(&mut self, scheduler: &Scheduler<'_>, priority: Priority) -> (Vec<usize>, usize) {
        let count = self.waits.len();
        let limit = scheduler.limit();
        let mut order = Vec::with_capacity(count);
        let mut most_live = self.live;
        // Operations whose operands are ready, the highest last; of equal ones the earliest last.
        let mut ready: BTreeSet<(u32, u32, Reverse<usize>)> = BTreeSet::new();
        let key = |list: &Self, node: usize| {
            let height = match priority {
                Priority::Height => list.heights[node],
                Priority::Written => 0,
            };
            (list.turns[node], height, Reverse(node))
        };
        // Operations whose operands are computed, with the cycle in which they are ready.
        let mut pending: BinaryHeap<Reverse<(u32, usize)>> = BinaryHeap::new();
        let mut ready_at = vec![0_u32; count];
        for node in 0..count {
            if self.waits[node] == 0 {
                ready.insert(key(self, node));
            }
        }
        let mut cycle = 0_u32;
        while order.len() < count {
            // Accesses to textures wait for those that could come together with them.
            let waits = |ready: &BTreeSet<(u32, u32, Reverse<usize>)>| {
                ready.last().is_none_or(|(turn, ..)| is_of_accesses(*turn))
            };
            while let Some(&Reverse((at, node))) = pending.peek()
                && (at <= cycle || waits(&ready) || priority == Priority::Written)
            {
                cycle = cycle.max(at);
                pending.pop();
                ready.insert(key(self, node));
            }
            let Some(&next) = ready.last() else { break };
            let best = if self.live < limit || priority == Priority::Written {
                next
            } else {
                let compared = ready.iter().rev().take(COMPARED);
                let compared = compared.take_while(|(turn, ..)| *turn == next.0);
                let best =
                    compared.max_by_key(|(_, height, Reverse(node))| (self.relief(*node), *height));
                best.copied().unwrap_or(next)
            };
            ready.remove(&best);
            let Reverse(node) = best.2;
            order.push(node);
            self.begin(node);
            most_live = most_live.max(self.live);
            // More than one begins in a cycle, but counting so was measured to be no better.
            cycle += 1;
            let done = cycle + self.latencies[node];
            for at in 0..self.followers[node].len() {
                let follower = self.followers[node][at] as usize;
                ready_at[follower] = ready_at[follower].max(done);
                self.waits[follower] -= 1;
                if self.waits[follower] == 0 {
                    pending.push(Reverse((ready_at[follower], follower)));
                }
            }
        }
        (order, most_live)
    }

    /// Counts the values that live once an operation began.
    fn begin(&mut self, node: usize) {
        for value in &self.uses[node] {
            let left = &mut self.uses_left[*value as usize];
            *left -= 1;
            self.live -= usize::from(*left == 0 && self.live > 0);
        }
        self.live += self.gives[node] as usize;
    }
}
