//! Loads of four words beside each other, in lanes that are four words apart, with AVX-512: four
//! vectors are read and transposed.

use super::emit::{Emitter, in_frame, number};
use super::strided::Registers;
use crate::encoder::{Address, Condition, Gpr, Rm, vector_op};
use crate::frame::{BUFFER_WORDS, PACKET, displacement};
use regalloc2::Allocation;

/// A load.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Quadruple {
    pub(crate) buffer: u32,
    /// Places are counted in bytes: numbers of words wrap at 2³⁰.
    pub(crate) is_in_bytes: bool,
    /// The words that are needed.
    pub(crate) needed: [bool; 4],
    /// If the numbers are four apart only perhaps, what the lanes are beyond the first: in the
    /// pool.
    pub(crate) steps: Option<u32>,
    /// The [orders](Self::orders), in the pool.
    pub(crate) orders: u32,
    /// 1, 2, 3 and 2³⁰ − 1, in the pool.
    pub(crate) constants: [u32; 4],
}

impl Quadruple {
    /// Where lanes come from, of two vectors: first and second words of eight lanes; third and
    /// fourth words; the lower halves; the upper halves.
    pub(crate) fn orders() -> [[u32; 16]; 4] {
        let words = |first: u32| {
            std::array::from_fn(|at| {
                let at = u32::try_from(at).unwrap_or(0);
                at % 8 * 4 + at / 8 + first
            })
        };
        let halves = |first: u32| {
            std::array::from_fn(|at| {
                let at = u32::try_from(at).unwrap_or(0);
                at % 8 + at / 8 * 16 + first
            })
        };
        [words(0), words(2), halves(0), halves(8)]
    }
}

impl Emitter<'_> {
    /// Loads four words.
    pub(super) fn quadruple(&mut self, of: Quadruple, found: &[Allocation]) {
        let words = std::array::from_fn(|at| number(found[at]));
        let registers = Registers::new(words[0], &found[4..]);
        let other = number(found[10]);
        let [outside, done] = [(); 2].map(|()| self.assembler.new_label());
        let Registers {
            base,
            first,
            address,
            index,
            order,
            ..
        } = registers;
        let count = displacement(self.frame.buffer(of.buffer) + BUFFER_WORDS);
        self.simple(&vector_op::STORE_LOWEST, index, Rm::Register(first.0));
        // In 64 bits, so that nothing wraps.
        self.assembler.lea(address, Address::at(first, 64));
        self.assembler.cmp_memory_wide(address, in_frame(count));
        self.assembler.jump_if(Condition::Above, outside);
        if let Some(steps) = of.steps {
            self.compare_steps(steps, registers, outside);
        }
        self.assembler.lea_element(address, base, first);
        for pair in [0, 1] {
            let [a, b] = [words[pair * 2], words[pair * 2 + 1]];
            if of.needed[pair * 2..pair * 2 + 2] == [false; 2] {
                continue;
            }
            self.order(of, pair, order);
            for (to, vectors) in [(a, [0, 1]), (other, [2, 3])] {
                self.simple(&vector_op::LOAD, to, vector(address, vectors[0]));
                let second = vector(address, vectors[1]);
                self.two(&vector_op::PERMUTE_TWO, [to, order], second);
            }
            if of.needed[pair * 2 + 1] {
                self.simple(&vector_op::MOVE, b, Rm::Register(a));
                self.order(of, 3, order);
                self.two(&vector_op::PERMUTE_TWO, [b, order], Rm::Register(other));
            }
            if of.needed[pair * 2] {
                self.order(of, 2, order);
                self.two(&vector_op::PERMUTE_TWO, [a, order], Rm::Register(other));
            }
        }
        self.assembler.jump(done);
        self.assembler.bind(outside);
        self.gather_each(of, (words, registers), count);
        self.assembler.bind(done);
    }

    /// Reads one of the orders.
    fn order(&mut self, of: Quadruple, number: usize, to: u8) {
        let number = i32::try_from(number).unwrap_or(0);
        let at = displacement(of.orders) + number * displacement(PACKET);
        let at = Rm::Memory(Address::in_pool(at));
        self.simple(&vector_op::LOAD, to, at);
    }

    /// Gathers the words that are inside, zeros for the others.
    fn gather_each(&mut self, of: Quadruple, (words, registers): ([u8; 4], Registers), count: i32) {
        let constant = |number: usize| {
            Rm::Memory(Address {
                is_broadcast: true,
                ..Address::in_pool(displacement(of.constants[number]))
            })
        };
        for (at, result) in words
            .into_iter()
            .enumerate()
            .filter(|(at, _)| of.needed[*at])
        {
            let mut of_word = Registers {
                result,
                ..registers
            };
            if at > 0 {
                let order = registers.order;
                self.two(&vector_op::ADD, [order, registers.index], constant(at - 1));
                if of.is_in_bytes {
                    self.two(&vector_op::AND, [order, order], constant(3));
                }
                of_word.index = order;
            }
            self.gather_inside(of_word, count);
        }
    }
}

/// One of the vectors from an address on.
fn vector(address: Gpr, number: i32) -> Rm {
    Rm::Memory(Address::at(address, number * displacement(PACKET)))
}
