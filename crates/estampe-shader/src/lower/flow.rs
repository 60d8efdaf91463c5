//! Control flow: `if`, loops and switches, and the slots that they hand over to their ends.

use super::pointer::{Base, Pointer};
use super::summary::{Root, Summary};
use super::{Frame, Lowered, Lowering, Operand};
use estampe_ir::op::{Compare, MaskBinary};
use estampe_ir::tree::Label;
use estampe_ir::{Type, Value};
use naga::{Block, Expression, Handle, SwitchValue};

/// The end of a construct, to which branches go.
#[derive(Debug, Clone)]
pub(super) struct Exit {
    pub(super) label: Label,
    /// The slots that branches hand over, after the results.
    pub(super) slots: Vec<usize>,
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

    pub(super) fn if_else(
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

    pub(super) fn repeat(
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
    pub(super) fn switch(
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
}
