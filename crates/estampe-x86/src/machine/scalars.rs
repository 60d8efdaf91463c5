//! Loads of words near each other at a place that is the same in all lanes, each broadcast to all
//! lanes: the place is looked up once.

use super::emit::{Emitter, gpr, in_frame, number};
use crate::encoder::{Address, Condition, Gpr, Rm, scalar::Width, vector_op};
use crate::frame::{BUFFER_WORDS, displacement};
use regalloc2::Allocation;

/// A load.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Scalars {
    pub(crate) buffer: u32,
    /// Places are numbers of words, shifted to the left by so many bits.
    pub(crate) shift: u8,
    /// How many words after the place the first of them is.
    pub(crate) first: u32,
    /// Those that are needed of [`Self::MOST`] words, one bit each.
    pub(crate) needed: u8,
}

impl Scalars {
    /// The most words of a load.
    pub(crate) const MOST: u32 = u8::BITS;
}

impl Emitter<'_> {
    /// Loads the words that are needed, in order.
    pub(super) fn scalars(&mut self, of: Scalars, found: &[Allocation]) {
        let (results, others) = found.split_at(of.needed.count_ones() as usize);
        let [place, index, address, outside] = [1, 2, 3, 4].map(|at| gpr(others[at]));
        let words: Vec<u32> = (0..Scalars::MOST)
            .filter(|word| of.needed >> word & 1 == 1)
            .collect();
        let last = of.first + words.last().copied().unwrap_or(0);
        let base = in_frame(displacement(self.frame.buffer(of.buffer)));
        let count = displacement(self.frame.buffer(of.buffer) + BUFFER_WORDS);
        let [apart, done] = [(); 2].map(|()| self.assembler.new_label());
        self.simple(
            &vector_op::STORE_LOWEST,
            number(others[0]),
            Rm::Register(place.0),
        );
        self.assembler.mov(Width::Dword, index, place);
        if of.shift > 0 {
            self.assembler.shr(index, of.shift);
        }
        // In 64 bits, so that nothing wraps.
        self.assembler
            .lea(address, Address::at(index, displacement(last)));
        self.assembler.cmp_memory_wide(address, in_frame(count));
        self.assembler.jump_if(Condition::NotBelow, apart);
        self.assembler.load(Width::Qword, address, base);
        self.assembler.lea_element(address, address, index);
        for (&result, word) in results.iter().zip(&words) {
            let at = Address::at(address, displacement((of.first + word) * 4));
            self.simple(&vector_op::BROADCAST, number(result), Rm::Memory(at));
        }
        self.assembler.jump(done);
        self.assembler.bind(apart);
        for (&result, word) in results.iter().zip(&words) {
            // The number of each word wraps as that of a load alone.
            let after = displacement((of.first + word) << of.shift);
            self.assembler.lea(index, Address::at(place, after));
            self.assembler.mov(Width::Dword, index, index);
            self.scalar((of.buffer, of.shift), [index, address, outside], result);
        }
        self.assembler.bind(done);
    }

    /// Loads the word at a place, or a 0 outside of the buffer.
    pub(super) fn scalar(
        &mut self,
        (buffer, shift): (u32, u8),
        [index, address, outside]: [Gpr; 3],
        result: Allocation,
    ) {
        let buffer = displacement(self.frame.buffer(buffer));
        // Outside of the buffer the word is read from a 0 in the frame.
        self.assembler
            .lea(outside, in_frame(displacement(self.frame.zero())));
        if shift > 0 {
            self.assembler.shr(index, shift);
        }
        self.assembler.load(Width::Qword, address, in_frame(buffer));
        self.assembler.lea_element(address, address, index);
        let words = in_frame(buffer + displacement(BUFFER_WORDS));
        self.assembler.cmp_memory(index, words);
        self.assembler.cmov(Condition::NotBelow, address, outside);
        self.simple(
            &vector_op::BROADCAST,
            number(result),
            Rm::Memory(Address::at(address, 0)),
        );
    }
}
