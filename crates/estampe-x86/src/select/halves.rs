//! Conversions of binary16.
//!
//! Their instructions have half as many bits on one side, in the lower half of a register. They
//! round to nearest, ties to even, with denormals, whatever MXCSR says of denormal results.

use super::Selector;
use super::masks::UNORDERED;
use super::operands::{Operands, Source};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::machine::{Role, VECTOR};
use estampe_ir::Value;
use regalloc2::{Operand, VReg};

/// The binary16 of every NaN.
const NAN: u32 = 0x7E00;

/// To nearest, ties to even.
const NEAREST: u8 = 0;

impl Selector<'_> {
    pub(super) fn round_f16(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let codes = self.narrow(&vector_op::F16_FROM_F32, a, Some(NEAREST));
        self.widen(&vector_op::F32_FROM_F16, codes)
    }

    pub(super) fn f16_from_f32(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let codes = self.narrow(&vector_op::F16_FROM_F32, a, Some(NEAREST));
        let words = self.widen(&vector_op::WORDS_FROM_HALVES, codes);
        let is_nan = self.compare_floats(UNORDERED, a, Source::Register(a));
        let nan = self.constant(NAN);
        self.blend(is_nan, nan, words)
    }

    pub(super) fn f32_from_f16(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let codes = match self.isa {
            Isa::Avx512 => self.narrow(&vector_op::HALVES_FROM_WORDS, a, None),
            Isa::Avx2 => {
                let low = self.constant(0xFFFF);
                let low = self.two(&vector_op::AND, a, low);
                // Each half of the register is packed into both of its quarters.
                let packed = self.two(&vector_op::PACK_WORDS, low, Source::Register(low));
                let source = Source::Register(packed);
                let order = Some(0b00_00_10_00);
                self.emit((&vector_op::PERMUTE_64, VECTOR), None, source, order)
            }
        };
        self.widen(&vector_op::F32_FROM_F16, codes)
    }

    /// An operation of a register whose result has half as many bits, in ModRM.rm.
    fn narrow(&mut self, op: &'static VectorOp, from: VReg, immediate: Option<u8>) -> VReg {
        let result = self.function.register(VECTOR);
        let operands = Operands::new()
            .with(Role::Rm, Operand::reg_def(result))
            .with(Role::Reg, Operand::reg_use(from));
        self.push(op, (immediate, None), &operands);
        result
    }

    /// An operation of the lower half of a register.
    fn widen(&mut self, op: &'static VectorOp, from: VReg) -> VReg {
        let result = self.function.register(VECTOR);
        let operands = Operands::new()
            .with(Role::Reg, Operand::reg_def(result))
            .with(Role::Rm, Operand::reg_use(from));
        self.push(op, (None, None), &operands);
        result
    }
}
