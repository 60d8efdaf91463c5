//! Statements and their effects.

use super::pointer::Base;
use super::types::is_wide;
use super::{Frame, LowerError, Lowered, Lowering, Operand};
use estampe_ir::op::{Atomic, Memory};
use estampe_ir::{Op, Value};
use naga::{AtomicFunction, Barrier, Block, Expression, Handle, Statement};

impl<'a> Lowering<'a> {
    pub(super) fn block(&mut self, frame: &mut Frame<'a>, block: &'a Block) -> Lowered<()> {
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
