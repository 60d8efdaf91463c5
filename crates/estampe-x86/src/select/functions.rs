//! The functions of a kernel: one that computes hoisted values, and one that runs a pass. Basic
//! blocks, and a block of its own for every edge between two that needs one.

use super::schedule::Scheduler;
use super::{Place, Selector, calls};
use crate::machine::{Function, Instruction};
use crate::{CompileError, Isa, Tier};
use estampe_ir::lanes::{BlockId, Jump, Terminator};
use estampe_ir::{Op, Value};
use regalloc2::{Block, Operand};

impl Selector<'_> {
    /// The function that computes hoisted values; `None` if there are none.
    pub(super) fn prepare(&mut self) -> Result<Option<Function>, CompileError> {
        // Places that are known without the frame's layout stood before it.
        for place in &mut self.places {
            if let Place::Buffer { buffer, offset } = *place {
                if offset == u32::MAX {
                    let at = self.frame.buffer(buffer) + crate::frame::BUFFER_BYTES;
                    *place = Place::Frame(at);
                } else if let Some(words) = self.fixed_words.get_mut(buffer as usize) {
                    *words = (*words).max(offset / 4 + 1);
                }
            }
        }
        let block = self.function.new_block();
        self.function.start_block();
        let mut is_empty = true;
        let kernel = self.kernel;
        for (at, of_kernel) in kernel.blocks.iter().enumerate() {
            if !self.plan.is_reached[at] {
                continue;
            }
            for (op, first) in &of_kernel.ops {
                if matches!(op, Op::Input(_) | Op::InputMask(_)) {
                    continue;
                }
                let results = first.and_next(op.results().len());
                let place = |value: &Value| match self.places[value.index()] {
                    Place::Table(slot) => Some((*value, slot)),
                    _ => None,
                };
                let slots: Vec<(Value, u32)> = results.iter().filter_map(place).collect();
                if slots.is_empty() {
                    continue;
                }
                is_empty = false;
                self.operation(op, *first)?;
                for (value, slot) in slots {
                    self.keep(value, slot);
                }
            }
        }
        self.function.push(Instruction::Return, &[]);
        self.function.end_block(block, &[]);
        self.buffer_pointers.fill(None);
        let function = std::mem::replace(&mut self.function, Function::new(self.isa));
        Ok((!is_empty).then_some(function))
    }

    /// The function that runs a pass: a packet, or two where the halves are more than one's.
    pub(super) fn packet(&mut self, tier: Tier) -> Result<Function, CompileError> {
        let kernel = self.kernel;
        let layout = self.blocks_and_edges();
        let schedules = self.schedules(tier);
        let mut entries: Vec<Option<Block>> = vec![None; kernel.blocks.len()];
        for (position, part) in layout.iter().enumerate() {
            let made = self.function.new_block();
            debug_assert_eq!(made.index(), position);
            if let Part::Block(at) = part {
                entries[*at] = Some(made);
                for &parameter in &kernel.blocks[*at].parameters {
                    if !self.plan.is_value_needed(parameter) {
                        continue;
                    }
                    let registers = self.new_registers(parameter);
                    let count = self.register_count(parameter);
                    let of_block = &mut self.function.blocks[position].parameters;
                    of_block.extend(&registers[..count]);
                }
            }
        }
        let entry = |to: BlockId| entries[to.index()].ok_or(CompileError::TooLarge);
        for (position, part) in layout.iter().enumerate() {
            let block = Block::new(position);
            self.function.start_block();
            self.buffer_pointers.fill(None);
            match *part {
                Part::Block(at) => {
                    let of_kernel = &kernel.blocks[at];
                    self.find_groups(at);
                    self.find_uniform_loads(at);
                    let Schedule {
                        ref order,
                        in_stages,
                    } = schedules[at];
                    let ops = order.iter().map(|&index| &of_kernel.ops[index]);
                    let ops: Vec<&(Op, Value)> = ops.collect();
                    let mut left = &ops[..];
                    while let Some(&(op, first)) = left.first() {
                        let count = if in_stages { self.apart(left) } else { 0 };
                        if count > 0 {
                            let (apart, others) = left.split_at(count);
                            left = others;
                            self.in_stages(apart)?;
                            continue;
                        }
                        let count = calls::joined(&self.plan, left);
                        let (together, others) = left.split_at(count);
                        left = others;
                        if count == 1 {
                            self.operation(op, *first)?;
                            continue;
                        }
                        for group in calls::groups(together) {
                            self.call_joined(&group)?;
                        }
                    }
                    match &of_kernel.terminator {
                        Terminator::Jump(jump) => {
                            self.jump(block, at, jump, entry(jump.to)?);
                        }
                        Terminator::Branch { mask, any, none } => {
                            self.test(*mask);
                            // The edges of this block follow it, in this order.
                            let mut edge = position + 1;
                            let mut successor = |jump: &Jump, is_any: bool| {
                                if layout.get(edge) == Some(&Part::Edge { from: at, is_any }) {
                                    edge += 1;
                                    Ok(Block::new(edge - 1))
                                } else {
                                    entry(jump.to)
                                }
                            };
                            let successors = [successor(any, true)?, successor(none, false)?];
                            self.function.end_block(block, &successors);
                        }
                        Terminator::Return(values) => {
                            self.outputs(values);
                            self.function.push(Instruction::Return, &[]);
                            self.function.end_block(block, &[]);
                        }
                    }
                }
                Part::Edge { from, is_any } => {
                    if let Terminator::Branch { any, none, .. } = &kernel.blocks[from].terminator {
                        let jump = if is_any { any } else { none };
                        self.jump(block, from, jump, entry(jump.to)?);
                    }
                }
            }
        }
        Ok(std::mem::replace(
            &mut self.function,
            Function::new(self.isa),
        ))
    }

    /// How the operations of each block that is reached are done, without those that are hoisted
    /// and those that nothing needs.
    fn schedules(&self, tier: Tier) -> Vec<Schedule> {
        let mut scheduler = Scheduler::new(self.kernel, &self.plan, self.isa, self.halves);
        let blocks = 0..self.kernel.blocks.len();
        let has_pair = self.packets_of_pass().len() > 1;
        let of_block = |at: usize| {
            let in_stages = self.computes_in_stages(at);
            let order = match tier {
                _ if !self.plan.is_reached[at] => Vec::new(),
                // Fewer registers need fewer spills, of which the fast allocator makes many.
                Tier::Fast if self.isa == Isa::Avx2 => scheduler.as_written(at),
                // Stages need few registers.
                _ if self.isa == Isa::Avx2 && has_pair => scheduler.as_written(at),
                _ if self.in_order.contains(&at) => scheduler.as_written(at),
                _ => {
                    let (order, most_live) = scheduler.by_latency(at);
                    if self.computes_half_by_half(at, most_live) {
                        return Schedule {
                            order: scheduler.as_written(at),
                            in_stages: true,
                        };
                    }
                    order
                }
            };
            Schedule { order, in_stages }
        };
        blocks.map(of_block).collect()
    }

    /// The kernel's blocks in order; after those with branches the edges that need a block.
    fn blocks_and_edges(&self) -> Vec<Part> {
        let mut order = Vec::new();
        for (at, block) in self.kernel.blocks.iter().enumerate() {
            if !self.plan.is_reached[at] {
                continue;
            }
            order.push(Part::Block(at));
            if let Terminator::Branch { any, none, .. } = &block.terminator {
                for (jump, is_any) in [(any, true), (none, false)] {
                    let has_others = self.plan.predecessors[jump.to.index()] > 1;
                    if has_others || !jump.arguments.is_empty() || jump.to.index() <= at {
                        order.push(Part::Edge { from: at, is_any });
                    }
                }
            }
        }
        order
    }

    /// Ends a block with a jump that gives arguments.
    fn jump(&mut self, block: Block, from: usize, jump: &Jump, to: Block) {
        let mut arguments = Vec::new();
        let parameters = &self.kernel.blocks[jump.to.index()].parameters;
        for (&parameter, &argument) in parameters.iter().zip(&jump.arguments) {
            if !self.plan.is_value_needed(parameter) {
                continue;
            }
            for half in 0..self.register_count(parameter) {
                arguments.push(self.any_register(argument, half));
            }
        }
        self.function.blocks[block.index()].arguments = arguments;
        let is_back = jump.to.index() <= from;
        self.function.push(Instruction::Jump { is_back }, &[]);
        self.function.end_block(block, &[to]);
    }

    /// Ends a block with a branch.
    fn test(&mut self, mask: Value) {
        let mut tested = self.mask(mask, 0);
        for half in 1..self.register_count(mask) {
            let other = self.mask(mask, half);
            tested = self.mask_or(tested, other);
        }
        let mut operands = vec![Operand::reg_use(tested)];
        if self.isa == Isa::Avx2 {
            let temporary = self.function.register(crate::machine::GPR);
            operands.push(Operand::reg_temp(temporary));
        }
        self.function.push(Instruction::Branch, &operands);
    }
}

/// How the operations of a block are done.
#[derive(Debug)]
struct Schedule {
    /// Their places in the block.
    order: Vec<usize>,
    /// True if parts of a pass take turns: see [`stages`](super::stages).
    in_stages: bool,
}

/// A part of the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Block(usize),
    Edge { from: usize, is_any: bool },
}
