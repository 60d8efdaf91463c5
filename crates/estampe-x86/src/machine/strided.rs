//! Loads of words whose numbers grow by the same small number from lane to lane.
//!
//! Vectors that hold the words of all lanes are read one after the other, and each adds the lanes
//! that it has. A gather is done in their place if some word may be outside of the memory.

use super::emit::{Emitter, gpr, in_frame, number};
use crate::encoder::{Address, Condition, Gpr, Label, Rm, VectorInstruction, VectorOp, vector_op};
use crate::frame::{BUFFER_WORDS, displacement};
use crate::{Isa, frame};
use regalloc2::Allocation;

/// A load.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Strided {
    pub(crate) buffer: u32,
    /// From 1 to [`most`](Self::most).
    pub(crate) stride: u32,
    /// The first of the packets of the pool that say, for each vector after the first, where the
    /// lanes come from.
    pub(crate) orders: u32,
    /// If the numbers have the stride only perhaps, what the lanes are beyond the first: in the
    /// pool.
    pub(crate) steps: Option<u32>,
}

impl Strided {
    /// The largest stride that is loaded so: without permutations of two vectors it is 1.
    pub(crate) fn most(isa: Isa) -> u32 {
        match isa {
            Isa::Avx2 => 1,
            Isa::Avx512 => 4,
        }
    }

    /// Where each lane comes from when vector `at` is added: from what there is (below 16), or from
    /// the vector (from 16 on).
    pub(crate) fn order(stride: u32, at: u32) -> [u32; 16] {
        const LANES: u32 = 16;
        std::array::from_fn(|lane| {
            let lane = u32::try_from(lane).unwrap_or(0);
            let element = lane * stride;
            match element.checked_sub(at * LANES) {
                Some(of_vector) if of_vector < LANES => LANES + of_vector,
                // At first there is the first vector itself.
                None if at == 1 => element,
                // Lanes of vectors to come.
                _ => lane,
            }
        })
    }
}

/// The registers of a load.
#[derive(Debug, Clone, Copy)]
pub(super) struct Registers {
    pub(super) result: u8,
    pub(super) index: u8,
    pub(super) base: Gpr,
    pub(super) first: Gpr,
    pub(super) address: Gpr,
    /// A mask: of the gather.
    pub(super) mask: u8,
    /// A vector: where lanes come from.
    pub(super) order: u8,
}

impl Registers {
    /// Those that were found for the numbers, the pointer and the temporaries.
    pub(super) fn new(result: u8, found: &[Allocation]) -> Self {
        Self {
            result,
            index: number(found[0]),
            base: gpr(found[1]),
            first: gpr(found[2]),
            address: gpr(found[3]),
            mask: number(found[4]),
            order: found.get(5).map_or(0, |one| number(*one)),
        }
    }
}

impl Emitter<'_> {
    /// Loads words with a stride.
    pub(super) fn strided(&mut self, of: Strided, found: &[Allocation]) {
        let registers = Registers::new(number(found[0]), &found[1..]);
        let Registers {
            result,
            index,
            base,
            first,
            address,
            ..
        } = registers;
        let [outside, done] = [(); 2].map(|()| self.assembler.new_label());
        let words = displacement(self.frame.buffer(of.buffer) + BUFFER_WORDS);
        let length = i32::try_from(self.isa.lanes()).unwrap_or(0);
        let all = length * of.stride.cast_signed();
        self.simple(&vector_op::STORE_LOWEST, index, Rm::Register(first.0));
        // In 64 bits, so that nothing wraps.
        self.assembler.lea(address, Address::at(first, all));
        self.assembler.cmp_memory_wide(address, in_frame(words));
        self.assembler.jump_if(Condition::Above, outside);
        if let Some(steps) = of.steps {
            self.compare_steps(steps, registers, outside);
        }
        self.assembler.lea_element(address, base, first);
        let vector = |at: i32| Rm::Memory(Address::at(address, at * length * 4));
        self.simple(&vector_op::LOAD, result, vector(0));
        for at in 1..of.stride.cast_signed() {
            let order = displacement(of.orders) + (at - 1) * displacement(frame::PACKET);
            let order = Rm::Memory(Address::in_pool(order));
            self.simple(&vector_op::LOAD, registers.order, order);
            self.two(
                &vector_op::PERMUTE_TWO,
                [result, registers.order],
                vector(at),
            );
        }
        self.assembler.jump(done);
        self.assembler.bind(outside);
        self.gather_inside(registers, words);
        self.assembler.bind(done);
    }

    /// Jumps if the numbers do not grow by these steps.
    pub(super) fn compare_steps(&mut self, steps: u32, registers: Registers, otherwise: Label) {
        let Registers {
            index,
            address,
            mask,
            order,
            ..
        } = registers;
        let steps = Rm::Memory(Address::in_pool(displacement(steps)));
        self.simple(&vector_op::BROADCAST, order, Rm::Register(index));
        self.two(&vector_op::ADD, [order, order], steps);
        match self.isa {
            Isa::Avx512 => {
                let index = Rm::Register(index);
                let mut compare = self.row(&vector_op::COMPARE_U, [mask, order], index);
                compare.immediate = Some(4);
                self.assembler.vector(&compare);
                self.simple(&vector_op::MASK_TEST, mask, Rm::Register(mask));
            }
            Isa::Avx2 => {
                self.two(&vector_op::EQUAL, [order, order], Rm::Register(index));
                self.simple(&vector_op::SIGNS, address.0, Rm::Register(order));
                self.assembler.lea(address, Address::at(address, -0xFF));
                self.assembler.test(address);
            }
        }
        self.assembler.jump_if(Condition::NotZero, otherwise);
    }

    /// Gathers the words that are inside, zeros for the others.
    pub(super) fn gather_inside(&mut self, registers: Registers, words: i32) {
        let Registers {
            result,
            index,
            base,
            mask,
            ..
        } = registers;
        let words = Address {
            is_broadcast: self.isa == Isa::Avx512,
            ..in_frame(words)
        };
        match self.isa {
            Isa::Avx512 => {
                let mut compare = self.row(&vector_op::COMPARE_U, [mask, index], Rm::Memory(words));
                compare.immediate = Some(1);
                self.assembler.vector(&compare);
            }
            Isa::Avx2 => {
                self.simple(&vector_op::BROADCAST, mask, Rm::Memory(words));
                self.two(&vector_op::GREATER_S, [mask, mask], Rm::Register(index));
            }
        }
        self.zero(result);
        let element = Address {
            index: Some(index),
            ..Address::at(base, 0)
        };
        let mut gather = self.row(&vector_op::GATHER, [result, 0], Rm::Memory(element));
        match self.isa {
            Isa::Avx2 => gather.vvvv = mask,
            Isa::Avx512 => gather.mask = mask,
        }
        self.assembler.vector(&gather);
    }

    pub(super) fn two(&mut self, op: &'static VectorOp, to_and_first: [u8; 2], rm: Rm) {
        let row = self.row(op, to_and_first, rm);
        self.assembler.vector(&row);
    }

    fn row(&self, op: &'static VectorOp, [reg, vvvv]: [u8; 2], rm: Rm) -> VectorInstruction {
        VectorInstruction {
            op,
            is_evex: self.isa == Isa::Avx512 && op.evex_w.is_some(),
            length: self.length(),
            reg,
            vvvv,
            rm,
            mask: 0,
            immediate: None,
        }
    }
}
