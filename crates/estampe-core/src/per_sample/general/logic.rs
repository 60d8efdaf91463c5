//! Logic operations (O6): on channels' codes.

use estampe_types::state::LogicOperation;

/// The operation of a fragment's bits `s` and stored ones `d`; bits beyond the channel are the caller's to cut.
#[inline(always)]
pub(crate) fn combine(operation: LogicOperation, s: u32, d: u32) -> u32 {
    use LogicOperation as L;
    match operation {
        L::Clear => 0,
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
        L::Set => u32::MAX,
    }
}
