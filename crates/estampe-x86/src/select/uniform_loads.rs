//! Loads at places that are the same in all lanes and a few words apart: the members of a light, or
//! of a body, in a loop over an array of them.
//!
//! They are done together, where the first of them stands. The sums that only give their places are
//! not computed.

use super::Selector;
use super::operands::Source;
use crate::machine::scalars::Scalars;
use crate::machine::{GPR, Instruction, VECTOR};
use estampe_ir::lanes::Terminator;
use estampe_ir::op::{Binary, Memory as Shared};
use estampe_ir::{Op, Value};
use regalloc2::Operand;
use std::collections::{HashMap, HashSet};

/// Words after the place up to which loads are together: less than 2¹⁶ bytes.
const FURTHEST: u32 = 1 << 14;

/// Loads that are done together.
#[derive(Debug, Clone)]
pub(super) struct UniformLoads {
    memory: Shared,
    /// The place from which they count, as the operations count it.
    place: Value,
    /// How many words after it each is, and its result, in order.
    loads: Vec<(u32, Value)>,
}

/// A load whose place is the sum of a value and a constant.
#[derive(Debug, Clone, Copy)]
struct Load {
    memory: Shared,
    place: Value,
    after: u32,
    /// The sum, or the value itself if nothing is added.
    index: Value,
    result: Value,
}

/// The groups of a block.
#[derive(Debug, Default)]
pub(super) struct UniformGroups {
    /// By the results of their loads; `None` once they are done.
    pub(super) groups: HashMap<Value, Option<UniformLoads>>,
    /// Sums that nothing needs but these loads.
    pub(super) dropped: HashSet<Value>,
}

impl Selector<'_> {
    /// Finds the groups of a block that starts.
    pub(super) fn find_uniform_loads(&mut self, at: usize) {
        self.uniform = UniformGroups::default();
        let kernel = self.kernel;
        let mut runs: Vec<Vec<Load>> = vec![Vec::new()];
        for (op, result) in &kernel.blocks[at].ops {
            if let Some(load) = self.uniform_load(op, *result) {
                runs.last_mut().expect("there is one").push(load);
            } else if op.has_effect() {
                // Loads do not move across it.
                runs.push(Vec::new());
            }
        }
        for mut run in runs {
            run.sort_by_key(|load| (memory_key(load.memory), load.place, load.after));
            let mut left = &run[..];
            while let Some(first) = left.first() {
                let is_near = |load: &&Load| {
                    load.memory == first.memory
                        && load.place == first.place
                        && load.after - first.after < Scalars::MOST
                };
                let count = left.iter().take_while(is_near).count();
                let (together, others) = left.split_at(count);
                left = others;
                self.keep_together(together);
            }
        }
    }

    /// A load at a place that is the same in all lanes, if it is one that must be done.
    fn uniform_load(&self, op: &Op, result: Value) -> Option<Load> {
        let (memory, index, word) = match *op {
            Op::LoadBuffer { buffer, offset } => (Shared::Buffer(buffer), offset, 4),
            Op::LoadWorkgroup(index) => (Shared::Workgroup, index, 1),
            _ => return None,
        };
        let is_done = self.plan.is_hoisted(result) || !self.plan.is_needed(op, result);
        let stride = self.strides.of(index)?;
        if is_done || !stride.is_none() || self.plan.is_hoisted(index) {
            return None;
        }
        let sum = self.sums.get(&index).and_then(|&[a, b]| {
            let constants = [a, b].map(|value| self.plan.constant(value));
            match constants {
                [_, Some(words)] => Some((a, words)),
                [Some(words), _] => Some((b, words)),
                _ => None,
            }
        });
        let sum = sum.filter(|(_, words)| words % word == 0 && words / word < FURTHEST);
        let (place, after) = sum.map_or((index, 0), |(place, words)| (place, words / word));
        Some(Load {
            memory,
            place,
            after,
            index,
            result,
        })
    }

    /// Keeps loads of the same place for later, if they are several.
    fn keep_together(&mut self, loads: &[Load]) {
        let Some((first, [_, ..])) = loads.split_first() else {
            return;
        };
        let group = UniformLoads {
            memory: first.memory,
            place: first.place,
            loads: loads.iter().map(|load| (load.after, load.result)).collect(),
        };
        for load in loads {
            self.uniform.groups.insert(load.result, Some(group.clone()));
        }
        for load in loads {
            let of_loads = loads.iter().filter(|other| other.index == load.index);
            if load.index != load.place
                && self.use_counts[load.index.index()] as usize == of_loads.count()
            {
                self.uniform.dropped.insert(load.index);
            }
        }
    }

    /// Loads all words of the group of a load, if it has one and they are not there yet; returns
    /// false if it has none.
    pub(super) fn uniform_group(&mut self, result: Value) -> bool {
        let Some(group) = self.uniform.groups.get_mut(&result) else {
            return false;
        };
        let Some(group) = group.take() else {
            return true;
        };
        for (_, result) in &group.loads {
            self.uniform.groups.insert(*result, None);
        }
        let (buffer, shift) = match group.memory {
            Shared::Buffer(buffer) => (buffer, 2),
            Shared::Workgroup => (self.frame.workgroup, 0),
        };
        let place = self.word(group.place, 0);
        let place = match place {
            Source::Register(register) => register,
            Source::Memory(..) => self.in_register(place),
        };
        let first = group.loads.first().map_or(0, |(after, _)| *after);
        let mut needed = 0;
        let mut registers: HashMap<u32, regalloc2::VReg> = HashMap::new();
        let mut operands = Vec::new();
        for (after, result) in &group.loads {
            // In order; two loads of a word have one register.
            let register = *registers.entry(*after).or_insert_with(|| {
                let register = self.function.register(VECTOR);
                operands.push(Operand::reg_def(register));
                register
            });
            needed |= 1_u8 << (after - first);
            for half in 0..self.halves {
                self.define(*result, half, register);
            }
        }
        operands.push(Operand::reg_use(place));
        operands.extend([(); 4].map(|()| self.temporary(GPR)));
        let load = Scalars {
            buffer,
            shift,
            first,
            needed,
        };
        self.function
            .push(Instruction::LoadScalars(load), &operands);
        true
    }

    /// Finds what sums are of, and how often each value is used.
    pub(super) fn count_uses(&mut self) {
        let kernel = self.kernel;
        let mut count = |value: Value| self.use_counts[value.index()] += 1;
        for block in &kernel.blocks {
            for (op, result) in &block.ops {
                op.each_operand(|value, _| count(value));
                if let Op::Binary(Binary::Add, pair) = op {
                    self.sums.insert(*result, *pair);
                }
            }
            match &block.terminator {
                Terminator::Return(values) => values.iter().copied().for_each(&mut count),
                Terminator::Branch { mask, .. } => count(*mask),
                Terminator::Jump(_) => {}
            }
            for jump in block.terminator.jumps() {
                jump.arguments.iter().copied().for_each(&mut count);
            }
        }
    }
}

/// An order of memories.
fn memory_key(memory: Shared) -> u32 {
    match memory {
        Shared::Buffer(buffer) => buffer,
        Shared::Workgroup => u32::MAX,
    }
}
