//! Integer division by binary64: eight lanes at a time with AVX-512, [four](super::pair_division)
//! with AVX2.
//!
//! A quotient of two 32-bit integers, rounded to binary64 and then towards 0, is exact. Below a
//! whole number n, a ÷ b ends at least 1 ÷ b before it, while the rounding moves it by at most
//! a ÷ b · 2⁻⁵³, which is less, as a < 2⁵³.
//!
//! A divisor that is the same in all lanes is divided by once: a is multiplied with a number that
//! exceeds 1 ÷ b by a factor of at most 1 + 2⁻⁵¹. So products are not less than a ÷ b, and exceed
//! it by less than 1 ÷ b, as a · 2⁻⁵¹ < 1, with the rounding of the product, too.

use super::Selector;
use super::operands::{Operands, Source};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::machine::{MASK, Role, VECTOR};
use estampe_ir::Value;
use estampe_ir::op::Binary;
use regalloc2::{Operand, VReg};

/// The lower halves of two vectors, and the upper half of one.
const LOWER: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23];
const UPPER: [u32; 16] = [8, 9, 10, 11, 12, 13, 14, 15, 8, 9, 10, 11, 12, 13, 14, 15];

/// The words of eight ones in binary64, and of eight integers of 64 bits that are 1.
const ONES: [u32; 16] = [
    0, ONE, 0, ONE, 0, ONE, 0, ONE, 0, ONE, 0, ONE, 0, ONE, 0, ONE,
];
const ONE: u32 = 0x3FF0_0000;
const NEXT: [u32; 16] = [1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0];

/// The conversions to binary64 and from it.
fn conversions(is_signed: bool) -> (&'static VectorOp, &'static VectorOp) {
    if is_signed {
        (&vector_op::F64_FROM_S32, &vector_op::S32_FROM_F64)
    } else {
        (&vector_op::F64_FROM_U32, &vector_op::U32_FROM_F64)
    }
}

impl Selector<'_> {
    /// A quotient or remainder.
    pub(super) fn divide(&mut self, kind: Binary, [a, b]: [Value; 2], half: usize) -> VReg {
        let is_signed = matches!(kind, Binary::SDiv | Binary::SRem);
        let is_remainder = matches!(kind, Binary::SRem | Binary::URem);
        let is_splat = self.plan.is_splat(b);
        let [a, b] = [a, b].map(|value| self.word_register(value, half));
        let quotient = match (self.isa, is_splat) {
            (Isa::Avx2, true) => self.quotients_of_pairs_by_one([a, b], is_signed),
            (Isa::Avx2, false) => self.quotients_of_pairs([a, b], is_signed),
            (Isa::Avx512, true) => self.quotients_by_one([a, b], is_signed),
            (Isa::Avx512, false) => self.quotients([a, b], is_signed),
        };
        // Nothing is divided by 0: the quotient is then a, and the remainder 0.
        let zero = self.zero();
        let is_zero = self.compare_equal(b, zero);
        if !is_remainder {
            return self.blend(is_zero, Source::Register(a), quotient);
        }
        let whole = self.two(&vector_op::MUL, quotient, Source::Register(b));
        let rest = self.two(&vector_op::SUB, a, Source::Register(whole));
        self.blend(is_zero, Source::Register(zero), rest)
    }

    /// The quotients of sixteen lanes by a word that is the same in all.
    fn quotients_by_one(&mut self, [a, b]: [VReg; 2], is_signed: bool) -> VReg {
        let (to, from) = conversions(is_signed);
        let b = self.in_registers(to, b);
        let inverse = self.above_inverse(b);
        let upper = self.two_vectors(a, UPPER, a);
        let [lower, upper] = [a, upper].map(|a| {
            let a = self.in_registers(to, a);
            let quotient = self.two(&vector_op::MUL_F64, a, Source::Register(inverse));
            self.in_registers(from, quotient)
        });
        self.two_vectors(lower, LOWER, upper)
    }

    /// 1 ÷ b in binary64, and the next number away from 0.
    pub(super) fn above_inverse(&mut self, b: VReg) -> VReg {
        let lanes = self.isa.lanes();
        let one = self.constant_lanes(&ONES[..lanes]);
        let one = self.in_register(one);
        let inverse = self.two(&vector_op::DIV_F64, one, Source::Register(b));
        let next = self.constant_lanes(&NEXT[..lanes]);
        self.two(&vector_op::ADD_64, inverse, next)
    }

    /// The quotients of sixteen lanes.
    fn quotients(&mut self, pair: [VReg; 2], is_signed: bool) -> VReg {
        let lower = self.quotient(pair, is_signed);
        let uppers = pair.map(|vector| self.two_vectors(vector, UPPER, vector));
        let upper = self.quotient(uppers, is_signed);
        self.two_vectors(lower, LOWER, upper)
    }

    /// The quotients of the lower eight lanes.
    fn quotient(&mut self, pair: [VReg; 2], is_signed: bool) -> VReg {
        let (to, from) = conversions(is_signed);
        let [a, b] = pair.map(|vector| self.in_registers(to, vector));
        let quotient = self.two(&vector_op::DIV_F64, a, Source::Register(b));
        self.in_registers(from, quotient)
    }

    /// An operation on a register.
    fn in_registers(&mut self, op: &'static VectorOp, from: VReg) -> VReg {
        let result = self.function.register(VECTOR);
        let operands = Operands::new()
            .with(Role::Reg, Operand::reg_def(result))
            .with(Role::Rm, Operand::reg_use(from));
        self.push(op, (None, None), &operands);
        result
    }

    /// Lanes of two vectors.
    fn two_vectors(&mut self, first: VReg, order: [u32; 16], second: VReg) -> VReg {
        let order = self.constant_lanes(&order);
        let order = self.in_register(order);
        let result = self.function.register(VECTOR);
        let operands = Operands::new()
            .with(Role::Reg, Operand::reg_reuse_def(result, 1))
            .with(Role::Silent, Operand::reg_use(first))
            .with(Role::Vvvv, Operand::reg_use(order))
            .with(Role::Rm, Operand::reg_use(second));
        self.push(&vector_op::PERMUTE_TWO, (None, None), &operands);
        result
    }

    fn compare_equal(&mut self, a: VReg, b: VReg) -> VReg {
        let b = Source::Register(b);
        match self.isa {
            Isa::Avx2 => self.two(&vector_op::EQUAL, a, b),
            Isa::Avx512 => self.emit((&vector_op::COMPARE_U, MASK), Some(a), b, Some(0)),
        }
    }
}
