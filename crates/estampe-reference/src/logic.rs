//! Logic operations on encoded values.
//!
//! In · Out: the codes of source and destination · the new code. Exact.

use crate::channel::Channel;
use estampe_types::state::LogicOperation;

/// Combines the bits of a source and of a stored code. Bits beyond the channel's width are combined
/// too; the caller drops them.
#[must_use]
pub fn combine(operation: LogicOperation, s: u32, d: u32) -> u32 {
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

/// Returns true if logic operations apply to an attachment with this red channel. They apply to
/// neither float nor sRGB attachments.
#[must_use]
pub fn concerns(red: Channel) -> bool {
    matches!(
        red,
        Channel::Unorm(_) | Channel::Snorm(_) | Channel::Uint(_) | Channel::Sint(_)
    )
}
