//! 1 ÷ √x by a square root and a division, in the lanes that need it.

use super::emit::{Emitter, number};
use crate::encoder::{Address, Condition, Rm, vector_op};
use crate::frame::displacement;
use regalloc2::Allocation;

/// The constants, in the pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct InverseSqrt {
    pub(crate) least: u32,
    pub(crate) range: u32,
    pub(crate) one: u32,
}

impl InverseSqrt {
    /// The bits of 2⁻⁶⁰, the least x for which the sequence before holds.
    pub(crate) const LEAST: u32 = (127 - 60) << 23;
    /// From there to the bits of 2¹⁰⁰: so many numbers.
    pub(crate) const RANGE: u32 = 160 << 23;
}

/// The predicate of comparisons: not less.
const NOT_LESS: u8 = 5;

impl Emitter<'_> {
    /// Computes the lanes whose x is not in the range; the others keep what they have.
    pub(super) fn inverse_sqrt_elsewhere(&mut self, of: InverseSqrt, found: &[Allocation]) {
        let [result, x, root, one, mask] = [0, 2, 3, 4, 5].map(|at: usize| number(found[at]));
        let constant = |offset: u32| {
            Rm::Memory(Address {
                is_broadcast: true,
                ..Address::in_pool(displacement(offset))
            })
        };
        let done = self.assembler.new_label();
        self.two(&vector_op::SUB, [root, x], constant(of.least));
        let mut compare = self.row(&vector_op::COMPARE_U, [mask, root], constant(of.range));
        compare.immediate = Some(NOT_LESS);
        self.assembler.vector(&compare);
        self.simple(&vector_op::MASK_TEST, mask, Rm::Register(mask));
        self.assembler.jump_if(Condition::Zero, done);
        self.simple(&vector_op::SQRT_F, root, Rm::Register(x));
        let word = Rm::Memory(Address::in_pool(displacement(of.one)));
        self.simple(&vector_op::BROADCAST, one, word);
        let mut division = self.row(&vector_op::DIV_F, [result, one], Rm::Register(root));
        division.mask = mask;
        self.assembler.vector(&division);
        self.assembler.bind(done);
    }
}
