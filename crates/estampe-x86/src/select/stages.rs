//! Stages: runs of operations that one part of a pass computes before the other one does.
//!
//! With AVX2 two packets of a pass have four registers a value, and there are sixteen. A stage has
//! them all for the two of one packet; what lives from a stage to the next is in memory. So blocks
//! are cut where few values live, and their operations stay as they are written, in which few live
//! at once. Stages are short: the processor must find those of both packets among the operations
//! that it looks ahead. Where both are there, the units that load are the limit: the registers of a
//! packet share a load of each constant of an operation.
//!
//! One packet, which has two registers a value, does the same register by register where far more
//! values live than there are registers, as in loops of many sums.

use super::plan::Plan;
use super::schedule::latency;
use super::{Selector, is_in_loop};
use crate::{CompileError, Isa};
use estampe_ir::lanes::{BasicBlock, Kernel};
use estampe_ir::{Op, Value};
use std::collections::HashMap;
use std::ops::Range;

/// The least operations of a stage, of which others follow, and the most.
const LEAST: usize = 12;
const MOST: usize = 24;

/// Operations of a block of a loop from which two packets of a pass are worth what they spill: one
/// iteration of a packet is more than the processor looks ahead. Its longest chain must take 1.25
/// cycles an operation: noise by hashes, with 1.2, took 1.04 to 1.1 of its time, `heavy_fs`, with
/// 1.4, 0.89, and sixteen lights, with 2.0, 0.79.
const LONG: usize = 64;

/// The values that live at once, of one register a value, beyond which the two registers of a
/// packet take turns with AVX2: twice as many as there are registers, so that most are in memory
/// whatever the order. `nbody_compute`, where 47 live, took 0.77 of its time, but `blur_compute`,
/// where 17 do, 1.19.
const MANY_LIVE: usize = 32;

/// True if a loop has a long block, most of whose time is that of its longest chain, and the kernel
/// accesses no textures, whose calls spill all.
pub(super) fn has_long_loop(kernel: &Kernel, plan: &Plan) -> bool {
    let ops = || kernel.blocks.iter().flat_map(|block| &block.ops);
    let has_textures = ops().any(|(op, _)| matches!(op, Op::Texture(_)));
    let is_long = |at: usize| {
        let (count, cycles) = count_and_chain(&kernel.blocks[at], plan);
        count >= LONG && cycles as usize * 4 >= count * 5
    };
    let mut blocks = 0..kernel.blocks.len();
    !has_textures && blocks.any(|at| plan.is_reached[at] && is_in_loop(kernel, at) && is_long(at))
}

/// The operations of a block, and the cycles of the longest chain of them.
fn count_and_chain(block: &BasicBlock, plan: &Plan) -> (usize, u32) {
    let mut done: HashMap<Value, u32> = HashMap::new();
    let (mut count, mut longest) = (0, 0);
    for (op, first) in &block.ops {
        let is_hoisted = !op.results().is_empty() && plan.is_hoisted(*first);
        if is_hoisted || !plan.is_needed(op, *first) {
            continue;
        }
        let mut end = 0;
        op.each_operand(|value, _| end = end.max(done.get(&value).copied().unwrap_or(0)));
        end += latency(op);
        let results = first.and_next(op.results().len());
        done.extend(results.into_iter().map(|result| (result, end)));
        (count, longest) = (count + 1, longest.max(end));
    }
    (count, longest)
}

impl Selector<'_> {
    /// True if a block computes parts of one packet of a pass before those of the other one.
    ///
    /// Where iterations wait for each other, one packet is then at the end of an iteration, which
    /// is often a single chain, while the other one is in the middle, and each has all registers
    /// for itself. Elsewhere operations of both packets alternate where there are registers.
    pub(super) fn computes_in_stages(&self, at: usize) -> bool {
        let has_pair = self.packets_of_pass().len() > 1;
        has_pair && (self.isa == Isa::Avx2 || is_in_loop(self.kernel, at))
    }

    /// True if a block of a loop in which so many values live at once computes parts of one half of
    /// a packet before those of the other one.
    pub(super) fn computes_half_by_half(&self, at: usize, most_live: usize) -> bool {
        self.halves_of_packet_take_turns() && most_live > MANY_LIVE && is_in_loop(self.kernel, at)
    }

    fn halves_of_packet_take_turns(&self) -> bool {
        self.isa == Isa::Avx2 && self.halves == self.isa.registers_of_packet()
    }

    /// The halves of each part of a pass that computes a stage by itself.
    fn turns(&self) -> Vec<Range<usize>> {
        if self.halves_of_packet_take_turns() {
            (0..self.halves).map(|half| half..half + 1).collect()
        } else {
            self.packets_of_pass()
        }
    }

    /// The number of operations, from the first on, that each part does by itself or all share.
    pub(super) fn apart(&self, ops: &[&(Op, Value)]) -> usize {
        let is_apart = |(op, first): &&&(Op, Value)| match op {
            Op::Unary(..)
            | Op::Binary(..)
            | Op::Fma(_)
            | Op::Select { .. }
            | Op::Derivative { .. }
            | Op::QuadLane { .. }
            | Op::Compare(..)
            | Op::MaskNot(_)
            | Op::MaskBinary(..)
            | Op::QuadAny(_) => true,
            Op::LoadBuffer { .. } => self.plan.is_splat(*first),
            _ => false,
        };
        ops.iter().take_while(is_apart).count()
    }

    /// Operations of one part of a pass after the other one: with AVX-512, where a value has one
    /// register a packet, all of them; with AVX2 stage by stage.
    pub(super) fn in_stages(&mut self, ops: &[&(Op, Value)]) -> Result<(), CompileError> {
        match self.isa {
            Isa::Avx512 => self.stage(ops),
            Isa::Avx2 => stages(ops).into_iter().try_for_each(|ops| self.stage(ops)),
        }
    }

    fn stage(&mut self, ops: &[&(Op, Value)]) -> Result<(), CompileError> {
        for halves in self.turns() {
            for (op, first) in ops {
                if self.plan.is_splat(*first) {
                    if halves.start == 0 {
                        self.operation(op, *first)?;
                    }
                    continue;
                }
                self.shared_constants = (halves.len() > 1).then(Vec::new);
                for half in halves.clone() {
                    let register = self.half_of(op, half).ok_or(CompileError::Unknown)?;
                    self.define(*first, half, register);
                }
                self.shared_constants = None;
            }
        }
        Ok(())
    }
}

/// Cuts operations where the fewest values live that one of them gives and a later one uses.
fn stages<'o, 'b>(ops: &'o [&'b (Op, Value)]) -> Vec<&'o [&'b (Op, Value)]> {
    let mut last_uses: HashMap<Value, usize> = HashMap::new();
    for (at, (op, _)) in ops.iter().enumerate() {
        op.each_operand(|value, _| {
            last_uses.insert(value, at);
        });
    }
    // The values that live before each operation: changes first, then their sums.
    let mut live = vec![0_i32; ops.len() + 1];
    for (at, (op, first)) in ops.iter().enumerate() {
        for value in first.and_next(op.results().len()) {
            if let Some(&last) = last_uses.get(&value).filter(|last| **last > at) {
                live[at + 1] += 1;
                live[last + 1] -= 1;
            }
        }
    }
    for at in 1..live.len() {
        live[at] += live[at - 1];
    }
    let mut stages = Vec::new();
    let mut start = 0;
    while ops.len() - start > MOST {
        let ends = start + LEAST..=start + MOST;
        // Of equal ones the last.
        let end = ends.rev().min_by_key(|end| live[*end]);
        let end = end.unwrap_or(start + MOST);
        stages.push(&ops[start..end]);
        start = end;
    }
    stages.push(&ops[start..]);
    stages
}

#[cfg(test)]
mod tests {
    use super::{LEAST, MOST, stages};
    use estampe_ir::op::Unary;
    use estampe_ir::{Op, Value};

    /// A chain of operations, of which every one uses the result of the one before.
    fn chain(count: u32) -> Vec<(Op, Value)> {
        let negated = |at: u32| (Op::Unary(Unary::FNeg, Value(at)), Value(at + 1));
        (0..count).map(negated).collect()
    }

    #[test]
    fn stages_have_all_operations_in_order() {
        for count in 1..100 {
            let ops = chain(count);
            let ops: Vec<&(Op, Value)> = ops.iter().collect();
            let found = stages(&ops);
            assert_eq!(found.concat(), ops);
            let (_, others) = found.split_last().unwrap();
            let is_whole = |stage: &&[&(Op, Value)]| (LEAST..=MOST).contains(&stage.len());
            assert!(others.iter().all(is_whole), "{count}");
        }
    }

    #[test]
    fn blocks_are_cut_where_few_values_live() {
        // Two independent chains: between them no value lives.
        let mut ops = chain(15);
        let second = chain(20).into_iter();
        ops.extend(second.map(|(_, Value(at))| {
            let from = Value(at + 99);
            (Op::Unary(Unary::FNeg, from), Value(at + 100))
        }));
        let ops: Vec<&(Op, Value)> = ops.iter().collect();
        assert_eq!(stages(&ops)[0].len(), 15);
    }
}
