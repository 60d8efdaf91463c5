//! What is needed of a kernel.

use crate::lanes::{Kernel, Terminator};
use crate::op::Binary;
use crate::{Op, Value};

/// How far a product may stand before the sum that it is fused with: its factors live on until
/// then.
const FUSION_DISTANCE: usize = 16;

pub(super) struct Plan {
    /// For each value, whether it is used by something that is needed.
    is_needed: Vec<bool>,
    /// For each value, whether it is a product that the sum after it computes.
    is_fused: Vec<bool>,
}

/// Where a value is defined: block and operation.
type Place = (u32, u32);

impl Plan {
    pub(super) fn new(kernel: &Kernel) -> Self {
        let defined = defined(kernel);
        let mut plan = Self {
            is_needed: vec![false; kernel.values.len()],
            is_fused: vec![false; kernel.values.len()],
        };
        plan.mark(kernel, &defined);
        plan.fuse(kernel, &defined);
        plan
    }

    pub(super) fn is_needed(&self, op: &Op, first: Value) -> bool {
        let mut results = first.and_next(op.results().len()).into_iter();
        op.has_effect() || results.any(|value| self.is_needed[value.index()])
    }

    pub(super) fn is_fused(&self, value: Value) -> bool {
        self.is_fused[value.index()]
    }

    fn mark(&mut self, kernel: &Kernel, defined: &[Option<Place>]) {
        let mut open: Vec<Value> = Vec::new();
        for block in &kernel.blocks {
            for (op, _) in &block.ops {
                if op.has_effect() {
                    op.each_operand(|value, _| open.push(value));
                }
            }
            match &block.terminator {
                Terminator::Return(values) => open.extend(values),
                Terminator::Branch { mask, .. } => open.push(*mask),
                Terminator::Jump(_) => {}
            }
            for jump in block.terminator.jumps() {
                open.extend(&jump.arguments);
            }
        }
        while let Some(value) = open.pop() {
            if std::mem::replace(&mut self.is_needed[value.index()], true) {
                continue;
            }
            if let Some((block, at)) = defined[value.index()] {
                let (op, _) = &kernel.blocks[block as usize].ops[at as usize];
                op.each_operand(|value, _| open.push(value));
            }
        }
    }

    fn fuse(&mut self, kernel: &Kernel, defined: &[Option<Place>]) {
        let uses = self.uses(kernel);
        for (of_block, block) in (0..).zip(&kernel.blocks) {
            for (at, (op, first)) in block.ops.iter().enumerate() {
                let Op::Binary(Binary::FAdd | Binary::FSub, pair) = op else {
                    continue;
                };
                let of_product = |value: Value| {
                    let (block, place) = defined[value.index()]?;
                    let place = place as usize;
                    let distance = at.checked_sub(place);
                    let is_near = distance.is_some_and(|distance| distance <= FUSION_DISTANCE);
                    if block != of_block || !is_near || uses[value.index()] != 1 {
                        return None;
                    }
                    let (op, _) = &kernel.blocks[block as usize].ops[place];
                    matches!(op, Op::Binary(Binary::FMul, _)).then_some((place, value))
                };
                let last = pair.iter().filter_map(|&value| of_product(value)).max();
                if let Some((_, product)) = last
                    && self.is_needed[first.index()]
                {
                    self.is_fused[product.index()] = true;
                }
            }
        }
    }

    /// The number of times that each value is used.
    fn uses(&self, kernel: &Kernel) -> Vec<u32> {
        let mut uses = vec![0; kernel.values.len()];
        for block in &kernel.blocks {
            for (op, first) in &block.ops {
                if self.is_needed(op, *first) {
                    op.each_operand(|value, _| uses[value.index()] += 1);
                }
            }
            if let Terminator::Return(values) = &block.terminator {
                values.iter().for_each(|value| uses[value.index()] += 1);
            }
            for jump in block.terminator.jumps() {
                let arguments = &jump.arguments;
                arguments.iter().for_each(|value| uses[value.index()] += 1);
            }
        }
        uses
    }
}

fn defined(kernel: &Kernel) -> Vec<Option<Place>> {
    let mut defined = vec![None; kernel.values.len()];
    for (of_block, block) in (0..).zip(&kernel.blocks) {
        for (at, (op, first)) in (0..).zip(&block.ops) {
            for value in first.and_next(op.results().len()) {
                defined[value.index()] = Some((of_block, at));
            }
        }
    }
    defined
}
