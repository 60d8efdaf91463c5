//! Loops over the lanes of a packet that change words of memory, in the order of the lanes.
//!
//! The lanes that act are bits in the frame, those of calls; the numbers of the words, the operands
//! and the results are packets among the arguments of calls. The numbers have been compared with
//! the length of the memory.

use super::emit::{Emitter, in_frame};
use crate::encoder::element::{Arithmetic, Element};
use crate::encoder::{Address, Condition, Gpr, scalar::Width};
use crate::frame::{self, PACKET, displacement};
use estampe_ir::op::Atomic;

/// What a loop does with a word of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LaneLoop {
    pub(crate) kind: Atomic,
    /// Other threads may change the word meanwhile.
    pub(crate) is_shared: bool,
    /// The word that was there is a result.
    pub(crate) gives: bool,
}

impl LaneLoop {
    /// True if there is code for it: of words that threads share not for all operations.
    pub(crate) fn is_compiled(self) -> bool {
        match self.kind {
            Atomic::Store | Atomic::Exchange | Atomic::Add | Atomic::Sub => true,
            Atomic::Load => false,
            Atomic::And | Atomic::Or | Atomic::Xor => !(self.is_shared && self.gives),
            Atomic::UMin | Atomic::UMax | Atomic::SMin | Atomic::SMax => !self.is_shared,
            Atomic::StoreHalf => !self.gives,
        }
    }
}

/// The lanes of a packet.
const LANES: i32 = 16;

impl LaneLoop {
    /// True if there is code for the lanes of a full packet one by one: what is one instruction.
    fn is_unrolled(self) -> bool {
        let is_simple = matches!(
            self.kind,
            Atomic::Store | Atomic::Add | Atomic::Sub | Atomic::And | Atomic::Or | Atomic::Xor
        );
        is_simple && !self.gives && !self.is_shared
    }
}

impl Emitter<'_> {
    /// A loop; the registers are the address of the memory, and five that it may change.
    pub(super) fn each_lane(
        &mut self,
        of: LaneLoop,
        [base, bits, lane, index, value, old]: [Gpr; 6],
    ) {
        let arguments = displacement(self.frame.arguments);
        let packet = |number: i32| Element {
            base: Gpr::RBX,
            index: lane,
            displacement: arguments + number * displacement(PACKET),
        };
        let word = Element {
            base,
            index,
            displacement: 0,
        };
        let [again, done, some] = [(); 3].map(|()| self.assembler.new_label());
        self.assembler
            .load(Width::Dword, bits, in_frame(frame::MASK_ARGUMENT));
        if of.is_unrolled() {
            // All lanes act, as most often: their places are known.
            self.assembler.lea(lane, Address::at(bits, -0xFFFF));
            self.assembler.test(lane);
            self.assembler.jump_if(Condition::NotZero, some);
            for lane in 0..LANES {
                let place =
                    |number: i32| in_frame(arguments + number * displacement(PACKET) + lane * 4);
                self.assembler.load(Width::Dword, index, place(0));
                self.assembler.load(Width::Dword, value, place(1));
                self.change(of, word, [value, old]);
            }
            self.assembler.jump(done);
            self.assembler.bind(some);
        }
        let assembler = &mut *self.assembler;
        assembler.test(bits);
        assembler.jump_if(Condition::Zero, done);
        assembler.bind(again);
        assembler.lowest_bit(lane, bits);
        assembler.load_element(index, packet(0));
        assembler.load_element(value, packet(1));
        self.change(of, word, [value, old]);
        let assembler = &mut *self.assembler;
        if of.gives {
            assembler.store_element(packet(2), value);
        }
        // The lowest bit is cleared.
        assembler.lea(lane, Address::at(bits, -1));
        assembler.arithmetic(Arithmetic::And, bits, lane);
        assembler.jump_if(Condition::NotZero, again);
        assembler.bind(done);
    }

    /// Changes a word; the register of the operand is given the word that was there, if that is a
    /// result.
    fn change(&mut self, of: LaneLoop, word: Element, [value, old]: [Gpr; 2]) {
        let assembler = &mut *self.assembler;
        let simple = match of.kind {
            Atomic::Add => Some(Arithmetic::Add),
            Atomic::Sub => Some(Arithmetic::Sub),
            Atomic::And => Some(Arithmetic::And),
            Atomic::Or => Some(Arithmetic::Or),
            Atomic::Xor => Some(Arithmetic::Xor),
            _ => None,
        };
        match (of.kind, simple) {
            (_, Some(kind)) if !of.gives => {
                assembler.update_element(kind, of.is_shared, (word, value));
            }
            (Atomic::Add | Atomic::Sub, _) => {
                if of.kind == Atomic::Sub {
                    assembler.neg(value);
                }
                assembler.exchange_and_add(of.is_shared, word, value);
            }
            (Atomic::Exchange, _) => assembler.exchange_element(word, value),
            (Atomic::StoreHalf, _) => {
                // The number of the half: twice that of the word, and the operand's highest bit.
                assembler.mov(Width::Dword, old, value);
                assembler.shr(old, 31);
                assembler.arithmetic(Arithmetic::Add, word.index, word.index);
                assembler.arithmetic(Arithmetic::Add, word.index, old);
                assembler.store_half_element(word, value);
            }
            (_, Some(kind)) => {
                assembler.load_element(old, word);
                assembler.arithmetic(kind, value, old);
                assembler.store_element(word, value);
                assembler.mov(Width::Dword, value, old);
            }
            (Atomic::UMin | Atomic::UMax | Atomic::SMin | Atomic::SMax, _) => {
                let keeps_old = match of.kind {
                    Atomic::UMin => Condition::Below,
                    Atomic::UMax => Condition::Above,
                    Atomic::SMin => Condition::Less,
                    _ => Condition::Greater,
                };
                assembler.load_element(old, word);
                assembler.cmp(old, value);
                assembler.cmov_word(keeps_old, value, old);
                assembler.store_element(word, value);
                assembler.mov(Width::Dword, value, old);
            }
            _ => assembler.store_element(word, value),
        }
    }
}
