//! Counts of bits, and their order reversed, where there is no instruction.
//!
//! What half a byte has is looked up by a shuffle of bytes. The highest or the lowest bit that is
//! set is the exponent of a float.

use super::Selector;
use super::operands::Source;
use crate::encoder::vector_op;
use estampe_ir::Value;
use regalloc2::VReg;

/// The lower half of each byte.
const LOW_HALVES: u32 = 0x0F0F_0F0F;

/// Of half a byte: its ones, its bits in reverse order, and those as the upper half.
const ONES: [u32; 4] = bytes([0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4]);
const REVERSED: [u32; 4] = bytes([0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15]);
const REVERSED_ABOVE: [u32; 4] = [
    REVERSED[0] << 4,
    REVERSED[1] << 4,
    REVERSED[2] << 4,
    REVERSED[3] << 4,
];
/// The bytes of each word in reverse order.
const LAST_BYTE_FIRST: [u32; 4] = bytes([3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12]);

const fn bytes(of: [u8; 16]) -> [u32; 4] {
    let mut words = [0; 4];
    let mut at = 0;
    while at < 16 {
        words[at / 4] |= (of[at] as u32) << (8 * (at % 4));
        at += 1;
    }
    words
}

impl Selector<'_> {
    pub(super) fn count_ones(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let [of_low, of_high] = self.looked_up(a, [ONES, ONES]);
        let of_bytes = self.two(&vector_op::ADD, of_low, Source::Register(of_high));
        // The highest byte of the product is the sum of all four.
        let ones = self.constant(0x0101_0101);
        let sums = self.two(&vector_op::MUL, of_bytes, ones);
        self.shift_by(&vector_op::SHR_U_BY, sums, 24)
    }

    /// Of the word without the ones that follow a one, so that the float is not rounded up to the
    /// next power of two.
    pub(super) fn leading_zeros(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let next = self.shift_by(&vector_op::SHR_U_BY, a, 1);
        let thinned = self.two(&vector_op::AND_NOT, next, Source::Register(a));
        let exponents = self.exponents(thinned);
        // The biased exponent of 2³¹ is 158; that of 0 is 0.
        let zeros = self.in_constant_register(158);
        let zeros = self.two(&vector_op::SUB, zeros, Source::Register(exponents));
        let most = self.constant(32);
        let zeros = self.two(&vector_op::MIN_U, zeros, most);
        // The float of a word with the highest bit is negative.
        let has_highest = self.shift_by(&vector_op::SHR_S_BY, a, 31);
        self.two(&vector_op::AND_NOT, has_highest, Source::Register(zeros))
    }

    pub(super) fn trailing_zeros(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let zero = self.zero();
        let minus = self.two(&vector_op::SUB, zero, Source::Register(a));
        let lowest = self.two(&vector_op::AND, minus, Source::Register(a));
        let exponents = self.exponents(lowest);
        // The lowest bit may be the sign.
        let without_sign = self.constant(0xFF);
        let exponents = self.two(&vector_op::AND, exponents, without_sign);
        let bias = self.constant(127);
        let zeros = self.two(&vector_op::SUB, exponents, bias);
        let most = self.constant(32);
        self.two(&vector_op::MIN_U, zeros, most)
    }

    pub(super) fn reverse_bits(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let [above, below] = self.looked_up(a, [REVERSED_ABOVE, REVERSED]);
        let of_bytes = self.two(&vector_op::OR, above, Source::Register(below));
        let order = self.repeated(LAST_BYTE_FIRST);
        self.two(&vector_op::SHUFFLE_BYTES, of_bytes, order)
    }

    /// What two tables have for the lower and for the upper half of each byte.
    fn looked_up(&mut self, words: VReg, tables: [[u32; 4]; 2]) -> [VReg; 2] {
        let low = self.in_constant_register(LOW_HALVES);
        let upper = self.shift_by(&vector_op::SHR_U_BY, words, 4);
        let mut halves = [words, upper].into_iter();
        tables.map(|table| {
            let words = halves.next().unwrap_or(upper);
            let half = self.two(&vector_op::AND, words, Source::Register(low));
            let table = self.repeated(table);
            let table = self.in_register(table);
            self.two(&vector_op::SHUFFLE_BYTES, table, Source::Register(half))
        })
    }

    /// The signs and biased exponents of words as floats.
    fn exponents(&mut self, words: VReg) -> VReg {
        let floats = self.one(&vector_op::F32_FROM_S32, Source::Register(words));
        self.shift_by(&vector_op::SHR_U_BY, floats, 23)
    }

    fn in_constant_register(&mut self, word: u32) -> VReg {
        let word = self.constant(word);
        self.in_register(word)
    }

    /// Four words, again and again.
    fn repeated(&mut self, four: [u32; 4]) -> Source {
        let words: Vec<u32> = four.into_iter().cycle().take(self.isa.lanes()).collect();
        self.constant_lanes(&words)
    }
}
