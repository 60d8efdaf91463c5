//! The reciprocal of a square root with AVX-512, by an estimate and fused steps.
//!
//! Division and square root share the divider, which takes new vectors of 512 bits at intervals of
//! about ten cycles for each; code that has little else to do waits for it. The root stays there;
//! its reciprocal is computed beside it, to the same bits as by division:
//!
//! * y₀ is within 2⁻¹⁴ of 1 ÷ s, relatively, so y₁ = y₀ + y₀·(1 − s·y₀), whose error without
//!   rounding is 2⁻²⁸, is one of the floats beside 1 ÷ s.
//! * From such a float y₂ = y₁ + y₁·(1 − s·y₁) is correctly rounded (Markstein 1990, Computation of
//!   elementary functions on the IBM RISC System/6000 processor, theorem 8), unless all bits of the
//!   significand of s are ones: there 1 ÷ s lies just above the middle of two floats, and it must
//!   be reached from above. So y₁ is rounded up.
//!
//! Nothing of it can overflow or be subnormal, as s is a square root. Zeros and infinity, from
//! which the steps make NaN, are mended last.

use super::Selector;
use super::operands::{Operands, Source};
use crate::Isa;
use crate::encoder::vector_op;
use crate::machine::{Role, VECTOR};
use estampe_ir::Value;
use estampe_ir::op::Binary;
use regalloc2::{Operand, VReg};

/// The bits of 1.
const ONE: u32 = 0x3F80_0000;

/// What the last instruction makes of each class of numbers, four bits each: of zeros, class 2,
/// infinity with their sign; of positive infinity, class 5, zero; it keeps all others.
const MENDED: u32 = 6 << (2 * 4) | 8 << (5 * 4);

impl Selector<'_> {
    /// True if an operation is 1 ÷ √x, and its steps are better than a division.
    pub(super) fn is_inverse_root(&self, kind: Binary, [a, b]: [Value; 2]) -> bool {
        self.isa == Isa::Avx512
            && kind == Binary::FDiv
            && self.plan.constant(a) == Some(ONE)
            && self.plan.is_root(b)
    }

    /// 1 ÷ s, rounded to nearest, of a square root s.
    pub(super) fn inverse_of_root(&mut self, root: Value, half: usize) -> VReg {
        let s = self.word_register(root, half);
        let one = self.constant(ONE);
        let y = self.one(&vector_op::RECIPROCAL_ESTIMATE, Source::Register(s));
        let error = self.fma_of(&vector_op::MINUS_FMA_F, [s, y], one);
        let y = self.fma_of(&vector_op::FMA_F_UP, [error, y], Source::Register(y));
        let error = self.fma_of(&vector_op::MINUS_FMA_F, [s, y], one);
        let y = self.fma_of(&vector_op::FMA_F, [error, y], Source::Register(y));
        let mended = self.function.register(VECTOR);
        let mut operands = Operands::new()
            .with(Role::Reg, Operand::reg_reuse_def(mended, 1))
            .with(Role::Silent, Operand::reg_use(y))
            .with(Role::Vvvv, Operand::reg_use(s));
        let memory = match self.constant(MENDED) {
            Source::Memory(memory, _) => Some(memory),
            Source::Register(table) => {
                operands = operands.with(Role::Rm, Operand::any_use(table));
                None
            }
        };
        self.push(&vector_op::FIX_UP_F, (Some(0), memory), &operands);
        mended
    }
}
