//! Operations that are added, most of them on masks.

use super::Lowering;
use crate::lanes::ValueInfo;
use crate::op::MaskBinary;
use crate::{Op, Type, Value};

impl Lowering<'_> {
    pub(super) fn define(&mut self, infos: &[ValueInfo]) -> Value {
        let first = u32::try_from(self.kernel.values.len()).expect("fewer than 2^32 values");
        self.kernel.values.extend_from_slice(infos);
        Value(first)
    }

    /// Adds an operation with results of these kinds. Returns the first.
    pub(super) fn push(&mut self, op: Op, results: &[ValueInfo]) -> Value {
        let first = self.define(results);
        if let Some(block) = self.current {
            self.kernel.blocks[block.index()].ops.push((op, first));
        }
        first
    }

    /// Adds an operation on values and returns its result, which is uniform if they are.
    pub(super) fn emit(&mut self, op: Op) -> Value {
        let mut is_uniform = true;
        op.each_operand(|value, _| is_uniform &= self.kernel.values[value.index()].is_uniform);
        let kind = op.results()[0];
        self.push(op, &[ValueInfo { kind, is_uniform }])
    }

    /// An operation on masks, or the mask that is known to be its result.
    pub(super) fn mask_binary(&mut self, kind: MaskBinary, a: Value, b: Value) -> Value {
        use MaskBinary as M;
        let (none, all) = (self.constants.none, self.constants.all);
        match kind {
            M::And if a == all || a == b => b,
            M::And if b == all => a,
            M::And if a == none || b == none => none,
            M::Or if a == none || a == b => b,
            M::Or if b == none => a,
            M::Or if a == all || b == all => all,
            M::AndNot if b == none => a,
            M::AndNot if a == none || b == all || a == b => none,
            M::AndNot if a == all => self.emit(Op::MaskNot(b)),
            _ => self.emit(Op::MaskBinary(kind, [a, b])),
        }
    }

    /// `yes` where the mask is set, else `no`.
    pub(super) fn select(&mut self, mask: Value, yes: Value, no: Value) -> Value {
        if yes == no || mask == self.constants.all {
            return yes;
        }
        match self.kernel.values[yes.index()].kind {
            Type::Word => self.emit(Op::Select { mask, yes, no }),
            Type::Mask if yes == self.constants.all => self.mask_binary(MaskBinary::Or, no, mask),
            Type::Mask => {
                let yes = self.mask_binary(MaskBinary::And, mask, yes);
                let no = self.mask_binary(MaskBinary::AndNot, no, mask);
                self.mask_binary(MaskBinary::Or, yes, no)
            }
        }
    }
}
