//! Passes: the loop over packets that stands around a function's blocks, its calls, barriers and
//! its end.
//!
//! In a work-group each packet has a *state* in the frame: its pointers, its arrays, the registers
//! that live across a barrier, which are all spilled there, and the place where it goes on. A
//! barrier keeps that place and goes on with the next packet; after the last one the first follows.

use super::emit::{Emitter, in_frame};
use super::{Function, Instruction};
use crate::encoder::{Address, Condition, Gpr, Label, Rm, scalar::Width, vector_op};
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
    /// Once for each packet of a work-group, each of which has a state.
    Workgroup {
        /// Arrays are set to their words at the start of each packet.
        resets_locals: bool,
    },
}

impl Emitter<'_> {
    pub(super) fn start(&mut self) {
        self.assembler.push(Gpr::RBX);
        if self.has_states {
            // Twice, as the stack is aligned to 16 bytes where calls are made.
            self.assembler.push(Gpr::R12);
            self.assembler.push(Gpr::R12);
        }
        self.assembler.mov(Width::Qword, Gpr::RBX, Gpr::RDI);
    }

    pub(super) fn call(&mut self, at: u32) {
        if self.has_states {
            self.assembler
                .store(Width::Qword, in_frame(frame::STATE), Gpr::R12);
        }
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

    /// All packets of the work-group start at the same place.
    pub(super) fn start_workgroup(&mut self, resets_locals: bool) {
        let [each, first] = [(); 2].map(|()| self.assembler.new_label());
        let [state, resume] = [self.state_bytes(), self.resume()];
        let assembler = &mut *self.assembler;
        let [from, to] = [frame::PASS_BUDGET, frame::BUDGET].map(in_frame);
        assembler.load(Width::Qword, Gpr::RAX, from);
        assembler.store(Width::Qword, to, Gpr::RAX);
        assembler.load(Width::Qword, Gpr::RAX, in_frame(frame::PACKETS));
        for counter in [frame::LEFT, frame::LIVE] {
            assembler.store(Width::Qword, in_frame(counter), Gpr::RAX);
        }
        assembler.mov(Width::Qword, Gpr::R12, Gpr::RBX);
        assembler.lea_label(Gpr::RAX, first);
        assembler.bind(each);
        assembler.store(Width::Qword, resume, Gpr::RAX);
        assembler.lea(Gpr::R12, state);
        assembler.sub_memory(in_frame(frame::LEFT), 1);
        let ready = assembler.new_label();
        assembler.jump_if(Condition::Zero, ready);
        assembler.jump(each);
        assembler.bind(ready);
        self.first_packet();
        self.assembler.bind(first);
        if resets_locals {
            self.call(frame::RESET_LOCALS);
        }
    }

    /// The packet goes on here when all others have been there.
    pub(super) fn barrier(&mut self) {
        let after = self.assembler.new_label();
        self.assembler.lea_label(Gpr::RAX, after);
        let resume = self.resume();
        self.assembler.store(Width::Qword, resume, Gpr::RAX);
        self.assembler.jump(self.next);
        self.assembler.bind(after);
    }

    /// The end of a packet: the next one goes on from where it waits.
    pub(super) fn end_packet(&mut self) {
        let [done, first] = [(); 2].map(|()| self.assembler.new_label());
        let [state, resume] = [self.state_bytes(), self.resume()];
        // A packet that has ended hands over to the next one each time.
        self.assembler.lea_label(Gpr::RAX, self.next);
        self.assembler.store(Width::Qword, resume, Gpr::RAX);
        self.assembler.sub_memory(in_frame(frame::LIVE), 1);
        self.assembler.jump_if(Condition::Zero, done);
        self.assembler.bind(self.next);
        self.assembler.sub_memory(in_frame(frame::LEFT), 1);
        self.assembler.jump_if(Condition::Zero, first);
        self.assembler.lea(Gpr::R12, state);
        self.assembler.jump_to(resume);
        self.assembler.bind(first);
        self.first_packet();
        self.assembler.jump_to(resume);
        self.assembler.bind(done);
    }

    /// Goes to the first packet of the work-group.
    fn first_packet(&mut self) {
        let assembler = &mut *self.assembler;
        assembler.load(Width::Qword, Gpr::RAX, in_frame(frame::PACKETS));
        assembler.store(Width::Qword, in_frame(frame::LEFT), Gpr::RAX);
        assembler.mov(Width::Qword, Gpr::R12, Gpr::RBX);
    }

    /// The next packet's state.
    fn state_bytes(&self) -> Address {
        Address::at(Gpr::R12, displacement(self.frame.state_bytes()))
    }

    /// Where the packet goes on.
    fn resume(&self) -> Address {
        Address::at(Gpr::R12, self.frame.resume())
    }

    pub(super) fn end(&mut self, result: u32) {
        self.assembler.vzeroupper();
        self.assembler.mov_immediate(Gpr::RAX, result);
        if self.has_states {
            self.assembler.pop(Gpr::R12);
            self.assembler.pop(Gpr::R12);
        }
        self.assembler.pop(Gpr::RBX);
        self.assembler.ret();
    }
}
