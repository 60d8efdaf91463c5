//! Passes: the loop over packets that stands around a function's blocks, its calls and its end.

use super::emit::{Emitter, in_frame};
use super::{Function, Instruction};
use crate::encoder::{Condition, Gpr, Label, Rm, scalar::Width, vector_op};
use crate::frame::{self, displacement};

/// How often a function runs when it is called.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Passes {
    Once,
    /// As often as the frame says. Pointers make a step after each pass.
    Many {
        /// Arrays are set to their words at the start of each pass.
        resets_locals: bool,
    },
}

impl Emitter<'_> {
    pub(super) fn call(&mut self, at: u32) {
        self.assembler.vzeroupper();
        self.assembler.mov(Width::Qword, Gpr::RDI, Gpr::RBX);
        self.assembler.mov_immediate(Gpr::RSI, at);
        self.assembler.call(in_frame(frame::SERVE));
    }

    pub(super) fn start_pass(&mut self, function: &Function, resets_locals: bool) {
        if resets_locals {
            self.call(frame::RESET_LOCALS);
        }
        let mut instructions = function.instructions.iter();
        if instructions.any(|one| matches!(one, Instruction::Jump { is_back: true })) {
            let [from, to] = [frame::PASS_BUDGET, frame::BUDGET].map(in_frame);
            self.assembler.load(Width::Qword, Gpr::RAX, from);
            self.assembler.store(Width::Qword, to, Gpr::RAX);
        }
    }

    /// If passes are left, moves the pointers and goes on with the next one.
    pub(super) fn end_pass(&mut self, again: Label) {
        let done = self.assembler.new_label();
        self.assembler.sub_memory(in_frame(frame::LEFT), 1);
        self.assembler.jump_if(Condition::Zero, done);
        let bytes = self.frame.pointer_bytes();
        for offset in (0..bytes).step_by(self.isa.lanes() * 4) {
            let step = in_frame(displacement(self.frame.steps + offset));
            let pointers = in_frame(displacement(self.frame.pointers + offset));
            self.simple(&vector_op::LOAD, 0, Rm::Memory(step));
            self.simple(&vector_op::ADD_64, 0, Rm::Memory(pointers));
            self.simple(&vector_op::STORE, 0, Rm::Memory(pointers));
        }
        self.assembler.jump(again);
        self.assembler.bind(done);
    }

    pub(super) fn end(&mut self, result: u32) {
        self.assembler.vzeroupper();
        self.assembler.mov_immediate(Gpr::RAX, result);
        self.assembler.pop(Gpr::RBX);
        self.assembler.ret();
    }
}
