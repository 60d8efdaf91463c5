//! Logic operations (O6): on the bits of encoded texels.

use std::ops::{BitAnd, BitOr, BitXor, Not};

use estampe_types::state::LogicOperation;

/// The operation of a fragment's bits `s` and stored bits `d`.
#[inline(always)]
pub(crate) fn combine<T>(operation: LogicOperation, s: T, d: T) -> T
where
    T: Copy + BitAnd<Output = T> + BitOr<Output = T> + BitXor<Output = T> + Not<Output = T>,
{
    use LogicOperation as L;
    match operation {
        L::Clear => s & !s,
        L::And => s & d,
        L::AndReverse => s & !d,
        L::Copy => s,
        L::AndInverted => !s & d,
        L::NoOp => d,
        L::Xor => s ^ d,
        L::Or => s | d,
        L::Nor => !(s | d),
        L::Equivalent => !(s ^ d),
        L::Invert => !d,
        L::OrReverse => s | !d,
        L::CopyInverted => !s,
        L::OrInverted => !s | d,
        L::Nand => !(s & d),
        L::Set => s | !s,
    }
}
