//! 1 ÷ √x, both correctly rounded.
//!
//! A square root and a division of sixteen lanes occupy the divider for 17 cycles, and other units
//! hardly. An estimate that is refined by fused operations occupies the multipliers for 7, and
//! gives the same bits (Markstein, *Computation of elementary functions on the IBM RISC System/6000
//! processor*, 1990). So with AVX-512 every other reciprocal is made so, and both units work.
//!
//! ```text
//! y ≈ 1/√x                    relative error below 2⁻¹⁴
//! h = y ÷ 2,  g = x·y         halves and roots: 2·g·h ≈ 1
//! e = ½ − h·g                 exact but for one rounding
//! g = g + g·e,  h = h + h·e   errors below 2⁻²³
//! s = g + (x − g·g)·h         √x, correctly rounded
//! r = 2·h·(1 + 2⁻²³)
//! r = r + r·(1 − s·r)         twice: 1 ÷ s, correctly rounded
//! ```
//!
//! The factor 1 + 2⁻²³ is for the one significand, all ones, for which the last step needs a number
//! that is too large. That the bits are those of the two instructions was checked for every x from
//! 2⁻⁶⁰ to 2¹⁰⁰ (`inverse_square_roots_are_correctly_rounded`); other lanes take the instructions.

use super::Selector;
use super::operands::{Operands, Source};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::machine::inverse_sqrt::InverseSqrt;
use crate::machine::{Instruction, MASK, Role, VECTOR};
use estampe_ir::Value;
use regalloc2::{Operand, VReg};

impl Selector<'_> {
    pub(super) fn inverse_sqrt(&mut self, x: Value, half: usize) -> VReg {
        let x = self.word_register(x, half);
        let one = self.constant(1.0_f32.to_bits());
        self.is_divider_busy = !self.is_divider_busy;
        if self.isa == Isa::Avx2 || self.is_divider_busy {
            let root = self.one(&vector_op::SQRT_F, Source::Register(x));
            let one = self.in_register(one);
            return self.two(&vector_op::DIV_F, one, Source::Register(root));
        }
        let [fma, negated] = [&vector_op::FMA_F, &vector_op::FMA_NEGATED_F];
        let one_half = self.constant(0.5_f32.to_bits());
        let y = self.one(&vector_op::INVERSE_SQRT_ESTIMATE, Source::Register(x));
        let h = self.two(&vector_op::MUL_F, y, one_half);
        let g = self.two(&vector_op::MUL_F, x, Source::Register(y));
        let e = self.fused(negated, [h, g], one_half);
        let g = self.fused(fma, [g, e], Source::Register(g));
        let h = self.fused(fma, [h, e], Source::Register(h));
        let rest = self.fused(negated, [g, g], Source::Register(x));
        let s = self.fused(fma, [rest, h], Source::Register(g));
        let factor = self.constant((2.0 * (1.0 + f32::EPSILON)).to_bits());
        let mut r = self.two(&vector_op::MUL_F, h, factor);
        for _ in 0..2 {
            let e = self.fused(negated, [s, r], one);
            r = self.fused(fma, [e, r], Source::Register(r));
        }
        self.elsewhere(x, r)
    }

    /// `a·b + c`, or with the negated operation `−a·b + c`, rounded once.
    fn fused(&mut self, op: &'static VectorOp, [a, b]: [VReg; 2], c: Source) -> VReg {
        let result = self.function.register(VECTOR);
        // The first factor's register becomes the result.
        let operands = Operands::new()
            .with(Role::Reg, Operand::reg_reuse_def(result, 1))
            .with(Role::Silent, Operand::reg_use(a))
            .with(Role::Vvvv, Operand::reg_use(b));
        let (memory, operands) = match c {
            Source::Register(c) => (None, operands.with(Role::Rm, Operand::any_use(c))),
            Source::Memory(memory, _) => (Some(memory), operands),
        };
        self.push(op, (None, memory), &operands);
        result
    }

    /// The result `r`, in lanes for which it does not hold that of the instructions.
    fn elsewhere(&mut self, x: VReg, r: VReg) -> VReg {
        let constants = InverseSqrt {
            least: self.assembler.pool_splat(InverseSqrt::LEAST, 1),
            range: self.assembler.pool_splat(InverseSqrt::RANGE, 1),
            one: self.assembler.pool_splat(1.0_f32.to_bits(), 1),
        };
        let result = self.function.register(VECTOR);
        let operands = [
            Operand::reg_reuse_def(result, 1),
            Operand::reg_use(r),
            Operand::reg_use(x),
            self.temporary(VECTOR),
            self.temporary(VECTOR),
            self.temporary(MASK),
        ];
        let instruction = Instruction::InverseSqrtElsewhere(constants);
        self.function.push(instruction, &operands);
        result
    }
}
