//! Control flow and effects.

use super::pointer::{Base, Pointer};
use super::summary::{Root, Summary};
use super::types::{is_wide, kinds, scalars_of};
use super::{Frame, LowerError, Lowered, Lowering, MAX_CALLS, Operand};
use estampe_ir::interface::LocalArray;
use estampe_ir::op::{Atomic, Compare, MaskBinary, Memory};
use estampe_ir::tree::Label;
use estampe_ir::{Op, Type, Value};
use naga::{AtomicFunction, Barrier, Block, Expression, Handle, Statement, SwitchValue};
use std::collections::HashMap;

/// The end of a construct, to which branches go.
#[derive(Debug, Clone)]
pub(super) struct Exit {
    label: Label,
    /// The slots that branches hand over, after the results.
    slots: Vec<usize>,
}

impl<'a> Lowering<'a> {
    /// Begins a block to whose end slots are handed over, after results of these types.
    pub(super) fn begin(&mut self, slots: Vec<usize>, results: &[Type]) -> Exit {
        let of_slots = slots
            .iter()
            .map(|&slot| self.builder.kind(self.slots[slot]));
        let types: Vec<_> = results.iter().copied().chain(of_slots).collect();
        Exit {
            label: self.builder.block_of(&types),
            slots,
        }
    }

    /// Goes to the end of a block.
    pub(super) fn leave(&mut self, exit: &Exit, results: &[Value]) {
        let of_slots = exit.slots.iter().map(|&slot| self.slots[slot]);
        let arguments: Vec<_> = results.iter().copied().chain(of_slots).collect();
        self.builder.branch(exit.label, &arguments);
    }

    /// Ends a block. Returns its results.
    pub(super) fn end(&mut self, exit: &Exit) -> Vec<Value> {
        let mut results = self.builder.end_block();
        let of_slots = results.split_off(results.len() - exit.slots.len());
        for (&slot, value) in exit.slots.iter().zip(of_slots) {
            self.slots[slot] = value;
        }
        results
    }

    /// The slots that code changes, without those of the frame's own variables if it is a whole
    /// function.
    pub(super) fn changed(
        &self,
        frame: &Frame<'_>,
        summary: &Summary,
        with_locals: bool,
    ) -> Lowered<Vec<usize>> {
        let mut slots = Vec::new();
        for root in &summary.stored {
            let pointer = match *root {
                Root::Local(local) if with_locals => frame.locals.get(&local),
                Root::Local(_) => None,
                Root::Argument(at) => match frame.arguments.get(at as usize) {
                    Some(Operand::Pointer(pointer)) => Some(pointer),
                    _ => None,
                },
                Root::Global(global) => match self.globals.get(&global) {
                    Some(Operand::Pointer(pointer)) => Some(pointer),
                    _ => None,
                },
            };
            if let Some(Pointer {
                base: Base::Slots(first),
                inner,
            }) = pointer
            {
                let count = super::types::scalars(self.module, inner)?.len();
                slots.extend(*first..*first + count);
            }
        }
        if summary.kills {
            slots.push(self.cover);
        }
        slots.sort_unstable();
        slots.dedup();
        Ok(slots)
    }

    /// Inlines a function. Returns the scalars that it returns.
    pub(super) fn inline(
        &mut self,
        function: &'a naga::Function,
        info: &'a naga::valid::FunctionInfo,
        arguments: Vec<Operand>,
    ) -> Lowered<Vec<Value>> {
        self.calls += 1;
        if self.calls > MAX_CALLS {
            return Err(LowerError::TooLarge);
        }
        let result = function.result.as_ref();
        let types = result.map_or(Ok(Vec::new()), |result| kinds(self.module, result.ty))?;
        let summary = self.summaries.of(function, &function.body);
        let mut frame = Frame {
            function,
            info,
            arguments,
            locals: HashMap::new(),
            done: HashMap::new(),
            leave: Exit {
                label: Label(u32::MAX),
                slots: Vec::new(),
            },
            breaks: Vec::new(),
            continues: Vec::new(),
        };
        let changed = self.changed(&frame, &summary, false)?;
        frame.leave = self.begin(changed, &types);
        self.declare(&mut frame, &summary)?;
        self.block(&mut frame, &function.body)?;
        let leave = frame.leave.clone();
        if !self.builder.has_ended() {
            let nothing = self.zeros(&types);
            self.leave(&leave, &nothing);
        }
        self.calls -= 1;
        Ok(self.end(&leave))
    }

    /// Makes the variables of a function.
    fn declare(&mut self, frame: &mut Frame<'a>, summary: &Summary) -> Lowered<()> {
        for (handle, local) in frame.function.local_variables.iter() {
            let initial = match local.init {
                Some(init) => self.values(frame, init)?,
                None => {
                    let types = kinds(self.module, local.ty)?;
                    self.zeros(&types)
                }
            };
            let is_indexed = summary.indexed.contains(&Root::Local(handle));
            let pointer = self.variable(local.ty, &initial, is_indexed)?;
            frame.locals.insert(handle, pointer);
        }
        Ok(())
    }

    /// Memory of the invocation: slots, or an array if it is indexed by computed numbers.
    pub(super) fn variable(
        &mut self,
        ty: Handle<naga::Type>,
        initial: &[Value],
        is_indexed: bool,
    ) -> Lowered<Pointer> {
        let inner = self.module.types[ty].inner.clone();
        if !is_indexed {
            let base = Base::Slots(self.slots.len());
            self.slots.extend(initial);
            return Ok(Pointer { base, inner });
        }
        let words = u32::try_from(scalars_of(self.module, ty)?.len()).unwrap_or(u32::MAX);
        let base = self.array(words);
        let pointer = Pointer { base, inner };
        self.store(&pointer, initial)?;
        Ok(pointer)
    }

    /// A new array of the invocation.
    pub(super) fn array(&mut self, words: u32) -> Base {
        let locals = &mut self.builder.interface_mut().locals;
        locals.push(LocalArray {
            words: words.max(1),
            init: Vec::new(),
        });
        let array = u32::try_from(locals.len() - 1).expect("fewer than 2^32 arrays");
        let word = self.builder.word(0);
        Base::Local { array, word }
    }

    pub(super) fn zeros(&mut self, types: &[Type]) -> Vec<Value> {
        let zero = |kind: &Type| match kind {
            Type::Word => self.builder.word(0),
            Type::Mask => self.builder.mask(false),
        };
        types.iter().map(zero).collect()
    }

    fn block(&mut self, frame: &mut Frame<'a>, block: &'a Block) -> Lowered<()> {
        for statement in block {
            if self.builder.has_ended() {
                return Ok(());
            }
            if self.builder.len() > super::MAX_VALUES {
                return Err(LowerError::TooLarge);
            }
            self.statement(frame, statement)?;
        }
        Ok(())
    }

    fn statement(&mut self, frame: &mut Frame<'a>, statement: &'a Statement) -> Lowered<()> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    // naga names each member of GLSL's uniforms in every function.
                    if frame.info[handle].ref_count == 0 {
                        continue;
                    }
                    let operand = self.evaluate(frame, handle)?;
                    frame.done.insert(handle, operand);
                }
            }
            Statement::Block(block) => self.block(frame, block)?,
            Statement::If {
                condition,
                accept,
                reject,
            } => {
                let condition = self.value(frame, *condition)?;
                self.if_else(frame, condition, [accept, reject])?;
            }
            Statement::Switch { selector, cases } => {
                if is_wide(self.scalar(frame, *selector)?) {
                    return Err(LowerError::Unsupported("switches on 64-bit integers"));
                }
                let selector = self.value(frame, *selector)?;
                self.switch(frame, selector, cases)?;
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => self.repeat(frame, body, (continuing, *break_if))?,
            Statement::Break => {
                let exit = frame.breaks.last().cloned();
                self.leave(&exit.ok_or(LowerError::Unsupported("stray breaks"))?, &[]);
            }
            Statement::Continue => {
                let exit = frame.continues.last().cloned();
                self.leave(
                    &exit.ok_or(LowerError::Unsupported("stray continues"))?,
                    &[],
                );
            }
            Statement::Return { value } => {
                let values = match value {
                    Some(value) => self.values(frame, *value)?,
                    None => Vec::new(),
                };
                let exit = frame.leave.clone();
                self.leave(&exit, &values);
            }
            Statement::Kill => self.slots[self.cover] = self.builder.mask(false),
            // The lanes of a quad are always at the same place, and see each other's stores at
            // once, in order.
            Statement::ControlBarrier(Barrier::SUB_GROUP) | Statement::MemoryBarrier(_) => {}
            Statement::ControlBarrier(_) => {
                self.builder.op(Op::Barrier);
            }
            Statement::Store { pointer, value } => {
                let pointer = self.pointer(frame, *pointer)?;
                let values = self.values(frame, *value)?;
                self.store(&pointer, &values)?;
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => {
                let operands = arguments.iter().map(|one| self.operand(frame, *one));
                let operands = operands.collect::<Lowered<Vec<_>>>()?;
                let (callee, info) = (&self.module.functions[*function], &self.info[*function]);
                let returned = self.inline(callee, info, operands)?;
                if let Some(result) = result {
                    frame.done.insert(*result, Operand::Scalars(returned));
                }
            }
            Statement::Atomic {
                pointer,
                fun,
                value,
                result,
            } => {
                let results = self.atomic(frame, *pointer, fun, *value)?;
                if let Some(result) = result {
                    frame.done.insert(*result, Operand::Scalars(results));
                }
            }
            Statement::WorkGroupUniformLoad { pointer, result } => {
                self.builder.op(Op::Barrier);
                let pointer = self.pointer(frame, *pointer)?;
                let loaded = self.load(&pointer)?;
                self.builder.op(Op::Barrier);
                frame.done.insert(*result, Operand::Scalars(loaded));
            }
            Statement::ImageStore {
                image,
                coordinate,
                array_index,
                value,
            } => self.image_store(frame, *image, (*coordinate, *array_index), *value)?,
            _ => self.subgroup(frame, statement)?,
        }
        Ok(())
    }

    fn if_else(
        &mut self,
        frame: &mut Frame<'a>,
        condition: Value,
        sides: [&'a Block; 2],
    ) -> Lowered<()> {
        let mut changed = Vec::new();
        for side in sides {
            let summary = self.summaries.of(frame.function, side);
            changed.extend(self.changed(frame, &summary, true)?);
        }
        changed.sort_unstable();
        changed.dedup();
        let exit = self.begin(changed, &[]);
        let before = self.slots.clone();
        self.builder.start_if(condition);
        self.side(frame, sides[0], &exit)?;
        self.slots.truncate(before.len());
        self.slots.copy_from_slice(&before);
        self.builder.start_else();
        self.side(frame, sides[1], &exit)?;
        self.slots.truncate(before.len());
        self.slots.copy_from_slice(&before);
        self.builder.end_if();
        self.end(&exit);
        Ok(())
    }

    fn side(&mut self, frame: &mut Frame<'a>, block: &'a Block, exit: &Exit) -> Lowered<()> {
        self.block(frame, block)?;
        if !self.builder.has_ended() {
            self.leave(exit, &[]);
        }
        Ok(())
    }

    fn repeat(
        &mut self,
        frame: &mut Frame<'a>,
        body: &'a Block,
        (continuing, break_if): (&'a Block, Option<Handle<Expression>>),
    ) -> Lowered<()> {
        let mut changed = Vec::new();
        for block in [body, continuing] {
            let summary = self.summaries.of(frame.function, block);
            changed.extend(self.changed(frame, &summary, true)?);
        }
        changed.sort_unstable();
        changed.dedup();
        let done = self.begin(changed.clone(), &[]);
        let initial: Vec<_> = changed.iter().map(|&slot| self.slots[slot]).collect();
        let again = self.builder.start_loop(&initial);
        for (&slot, &value) in changed.iter().zip(&again.parameters) {
            self.slots[slot] = value;
        }
        let next = self.begin(changed.clone(), &[]);
        frame.breaks.push(done.clone());
        frame.continues.push(next.clone());
        self.side(frame, body, &next)?;
        frame.continues.pop();
        self.end(&next);
        self.block(frame, continuing)?;
        frame.breaks.pop();
        if !self.builder.has_ended() {
            if let Some(condition) = break_if {
                let condition = self.value(frame, condition)?;
                self.builder.start_if(condition);
                self.leave(&done, &[]);
                self.builder.end_if();
            }
            let arguments: Vec<_> = changed.iter().map(|&slot| self.slots[slot]).collect();
            self.builder.branch(again.label, &arguments);
        }
        self.builder.end_loop();
        self.end(&done);
        Ok(())
    }

    /// A switch as one `if` for each case. A case also runs if the one before falls through to it.
    fn switch(
        &mut self,
        frame: &mut Frame<'a>,
        selector: Value,
        cases: &'a [naga::SwitchCase],
    ) -> Lowered<()> {
        let mut changed = Vec::new();
        for case in cases {
            let summary = self.summaries.of(frame.function, &case.body);
            changed.extend(self.changed(frame, &summary, true)?);
        }
        changed.sort_unstable();
        changed.dedup();
        let mut matches = Vec::new();
        let mut any = self.builder.mask(false);
        for case in cases {
            let of_case = match case.value {
                SwitchValue::I32(value) => Some(value.cast_unsigned()),
                SwitchValue::U32(value) => Some(value),
                SwitchValue::Default => None,
            };
            let is_selected = of_case.map(|value| {
                let value = self.builder.word(value);
                self.builder.compare(Compare::Eq, selector, value)
            });
            if let Some(is_selected) = is_selected {
                any = self.builder.mask_binary(MaskBinary::Or, any, is_selected);
            }
            matches.push(is_selected);
        }
        let none = self.builder.mask_not(any);
        let done = self.begin(changed.clone(), &[]);
        frame.breaks.push(done.clone());
        let mut falls = self.builder.mask(false);
        for (case, is_selected) in cases.iter().zip(matches) {
            let is_selected = is_selected.unwrap_or(none);
            let enters = self.builder.mask_binary(MaskBinary::Or, is_selected, falls);
            let after = self.begin(changed.clone(), &[Type::Mask]);
            let before = self.slots.clone();
            self.builder.start_if(enters);
            self.block(frame, &case.body)?;
            if !self.builder.has_ended() {
                if case.fall_through {
                    let falls = self.builder.mask(true);
                    self.leave(&after, &[falls]);
                } else {
                    self.leave(&done, &[]);
                }
            }
            self.builder.end_if();
            self.slots.truncate(before.len());
            self.slots.copy_from_slice(&before);
            if !self.builder.has_ended() {
                let stays = self.builder.mask(false);
                self.leave(&after, &[stays]);
            }
            falls = self.end(&after)[0];
        }
        frame.breaks.pop();
        if !self.builder.has_ended() {
            self.leave(&done, &[]);
        }
        self.end(&done);
        Ok(())
    }

    fn atomic(
        &mut self,
        frame: &mut Frame<'a>,
        pointer: Handle<Expression>,
        function: &AtomicFunction,
        value: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        let pointer = self.pointer(frame, pointer)?;
        let is_signed = match pointer.inner {
            naga::TypeInner::Atomic(scalar) if is_wide(scalar) => {
                return Err(LowerError::Unsupported("64-bit atomics"));
            }
            naga::TypeInner::Atomic(scalar) => scalar.kind == naga::ScalarKind::Sint,
            _ => false,
        };
        let (memory, offset) = match pointer.base {
            Base::Buffer { buffer, byte, .. } => (Memory::Buffer(buffer), byte),
            Base::Workgroup(word) => (Memory::Workgroup, word),
            _ => return Err(LowerError::Unsupported("atomics in this memory")),
        };
        let value = self.value(frame, value)?;
        let mask = self.slots[self.cover];
        let kind = match function {
            AtomicFunction::Add => Atomic::Add,
            AtomicFunction::Subtract => Atomic::Sub,
            AtomicFunction::And => Atomic::And,
            AtomicFunction::InclusiveOr => Atomic::Or,
            AtomicFunction::ExclusiveOr => Atomic::Xor,
            AtomicFunction::Min if is_signed => Atomic::SMin,
            AtomicFunction::Min => Atomic::UMin,
            AtomicFunction::Max if is_signed => Atomic::SMax,
            AtomicFunction::Max => Atomic::UMax,
            AtomicFunction::Exchange { compare: None } => Atomic::Exchange,
            AtomicFunction::Exchange {
                compare: Some(expected),
            } => {
                let expected = self.value(frame, *expected)?;
                return Ok(self.builder.op(Op::CompareExchange {
                    memory,
                    offset,
                    expected,
                    value,
                    mask,
                }));
            }
        };
        Ok(self.builder.op(Op::Atomic {
            kind,
            memory,
            offset,
            value,
            mask,
        }))
    }
}
