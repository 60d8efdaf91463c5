//! Loads of the components of a vector: up to four words beside each other, in lanes that are four
//! words apart.
//!
//! Four vectors hold them all, and are transposed. The loads of a group have no effect on memory
//! between them.

use super::Selector;
use super::plan::Plan;
use super::strides::Strides;
use crate::Isa;
use crate::machine::quadruple::Quadruple;
use crate::machine::{GPR, Instruction, MASK, VECTOR};
use estampe_ir::lanes::BasicBlock;
use estampe_ir::op::Memory as Shared;
use estampe_ir::{Op, Value};
use regalloc2::Operand;
use std::collections::HashMap;

/// Loads that are done together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    memory: Shared,
    /// The place of the first word, as the operations count it.
    place: Value,
    /// The result of each load.
    results: [Option<Value>; 4],
}

/// The groups of a block by the results of their loads.
pub(super) fn groups_of(
    block: &BasicBlock,
    sums: &HashMap<Value, [Value; 2]>,
    (plan, strides): (&Plan, &Strides),
) -> HashMap<Value, Option<Group>> {
    let (mut open, mut done): (Vec<Group>, Vec<Group>) = (Vec::new(), Vec::new());
    for (op, result) in &block.ops {
        let (memory, index, word) = match *op {
            Op::LoadBuffer { buffer, offset } => (Shared::Buffer(buffer), offset, 4),
            Op::LoadWorkgroup(index) => (Shared::Workgroup, index, 1),
            _ => {
                if op.has_effect() {
                    done.append(&mut open);
                }
                continue;
            }
        };
        let is_done = plan.is_hoisted(*result) || !plan.is_needed(op, *result);
        let stride = strides.of(index).map(|stride| stride.words);
        if is_done || stride != Some(word * 4) {
            continue;
        }
        let added = match sums.get(&index) {
            Some(&[a, b]) => match [a, b].map(|value| plan.constant(value)) {
                [_, Some(words)] => Some((a, words)),
                [Some(words), _] => Some((b, words)),
                _ => None,
            },
            _ => None,
        };
        let (place, at) = match added {
            Some((place, words)) if words % word == 0 && words / word < 4 => {
                (place, (words / word) as usize)
            }
            _ => (index, 0),
        };
        let known = open.iter_mut().find(|group| {
            group.memory == memory && group.place == place && group.results[at].is_none()
        });
        if let Some(group) = known {
            group.results[at] = Some(*result);
        } else {
            let mut results = [None; 4];
            results[at] = Some(*result);
            open.push(Group {
                memory,
                place,
                results,
            });
        }
    }
    done.append(&mut open);
    done.retain(|group| group.results.iter().flatten().count() > 1);
    let of_result = |group: Group| {
        let results = group.results.into_iter().flatten();
        results.map(move |result| (result, Some(group)))
    };
    done.into_iter().flat_map(of_result).collect()
}

impl Selector<'_> {
    /// Finds the groups of a block that starts.
    pub(super) fn find_groups(&mut self, at: usize) {
        self.groups.clear();
        if self.isa == Isa::Avx2 {
            return;
        }
        let block = &self.kernel.blocks[at];
        self.groups = groups_of(block, &self.sums, (&self.plan, &self.strides));
    }

    /// Loads all words of the group of a load, if it has one and they are not there yet; returns
    /// false if it has none.
    pub(super) fn group(&mut self, result: Value) -> bool {
        let Some(group) = self.groups.get_mut(&result) else {
            return false;
        };
        let Some(group) = group.take() else {
            return true;
        };
        for result in group.results.iter().flatten() {
            self.groups.insert(*result, None);
        }
        for half in 0..self.halves {
            self.load_group(group, half);
        }
        true
    }

    fn load_group(&mut self, group: Group, half: usize) {
        let (buffer, is_in_bytes) = match group.memory {
            Shared::Buffer(buffer) => (buffer, true),
            Shared::Workgroup => (self.frame.workgroup, false),
        };
        let index = if is_in_bytes {
            self.number_of_word(group.place, half)
        } else {
            self.workgroup_index(group.place, half)
        };
        let is_certain = self.strides.of(group.place);
        let is_certain = is_certain.is_some_and(|stride| stride.is_certain);
        let steps = (!is_certain).then(|| {
            let steps: Vec<u32> = (0..16).map(|lane| lane * 4).collect();
            self.assembler.pool_lanes(&steps)
        });
        let orders = self.assembler.pool_lanes(&Quadruple::orders().concat());
        let constants = [1, 2, 3, (1 << 30) - 1];
        let constants = constants.map(|word| self.assembler.pool_splat(word, 1));
        let base = self.buffer_pointer(buffer);
        let words = [(); 4].map(|()| self.function.register(VECTOR));
        let mut operands = words.map(Operand::reg_def_at_start).to_vec();
        operands.extend([
            Operand::reg_use_at_end(index),
            Operand::reg_use_at_end(base),
            self.temporary(GPR),
            self.temporary(GPR),
            self.temporary(MASK),
            self.temporary(VECTOR),
            self.temporary(VECTOR),
        ]);
        let needed = group.results.map(|result| result.is_some());
        let instruction = Instruction::LoadQuadruple(Quadruple {
            buffer,
            is_in_bytes,
            needed,
            steps,
            orders,
            constants,
        });
        self.function.push(instruction, &operands);
        for (result, word) in group.results.into_iter().zip(words) {
            if let Some(result) = result {
                self.define(result, half, word);
            }
        }
    }
}
