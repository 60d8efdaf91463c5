//! What a SIMD level must do.

use super::super::instruction::Product;
use super::state::{MaskOperand, Masks, Operand, Words};
use crate::op::{Axis, Binary, Compare, Math, Math2, Precision, Unary};

/// Operations on registers. The result may be one of the operands.
pub(super) trait Arithmetic: Copy + 'static {
    /// Runs a function with the instructions of the SIMD level.
    fn enter(self, work: impl FnOnce());
    fn unary(self, kind: Unary, to: Words<'_>, a: Words<'_>);
    /// At least one operand is not the same in all lanes.
    fn binary(self, kind: Binary, to: Words<'_>, pair: [Operand<'_>; 2]);
    /// The first factor is not the same in all lanes.
    fn product(self, kind: Product, to: Words<'_>, three: [Operand<'_>; 3]);
    fn fma(self, to: Words<'_>, three: [Words<'_>; 3]);
    /// At least one operand is not the same in all lanes.
    fn compare(self, kind: Compare, to: Masks<'_>, pair: [Operand<'_>; 2]);
    fn select(self, to: Words<'_>, mask: MaskOperand<'_>, pair: [Operand<'_>; 2]);
    fn math(self, function: Math, to: Words<'_>, x: Words<'_>);
    fn math2(self, function: Math2, to: Words<'_>, pair: [Words<'_>; 2]);
    fn derivative(
        self,
        way: (Axis, Precision),
        to: Words<'_>,
        value: Words<'_>,
        mask: MaskOperand<'_>,
    );
    /// Elements of a table. Indices beyond the end read the last element where `is_clamped`, else
    /// 0.
    fn gather(self, to: Words<'_>, table: &[u32], index: Words<'_>, shift: u32, is_clamped: bool);
}
