//! Packets that share their colours: nothing varies over their primitive, so the program is run for
//! one of them.
//!
//! Windows and panels of user interfaces are such primitives: one colour, at one place of a
//! texture. Only whole packets share colours, so that the same lanes run for each.

use super::FragmentQueue;
use crate::fragment::place::Place;
use estampe_simd::LANES;

/// What is known of the primitive that is being queued.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ConstantPrimitive {
    /// Colours vary over it.
    No,
    /// Its packets have one colour, but no whole packet is in the queue yet.
    Unshaded,
    /// Whole packets share the colours at this place.
    At(usize),
}

impl ConstantPrimitive {
    /// The queue was emptied.
    #[inline(always)]
    pub(super) fn forget_colors(&mut self) {
        if *self != Self::No {
            *self = Self::Unshaded;
        }
    }
}

impl<const N: usize> FragmentQueue<N> {
    /// Says if nothing varies over the primitive that comes next.
    #[inline(always)]
    pub(crate) fn begin_primitive(&mut self, is_constant: bool) {
        self.constant = if is_constant {
            ConstantPrimitive::Unshaded
        } else {
            ConstantPrimitive::No
        };
    }

    /// The queued fragments whose colours are those of others: their packets are whole.
    #[inline(always)]
    pub(crate) fn sharing_fragments(&self) -> u64 {
        self.len.saturating_sub(self.shaded_len) as u64 * LANES as u64
    }

    /// Queues a whole packet of a constant primitive without its inputs, if another one is in the
    /// queue; otherwise false is returned, and the packet must be queued as any other.
    #[inline(always)]
    pub(super) fn shares_colors(&mut self, place: Place, masks: [u16; N]) -> bool {
        if self.constant == ConstantPrimitive::No {
            return false;
        }
        let any = masks.iter().fold(0, |any, mask| any | mask);
        if any != u16::MAX {
            return false;
        }
        let ConstantPrimitive::At(shaded) = self.constant else {
            self.constant = ConstantPrimitive::At(self.shaded_len);
            return false;
        };
        self.take_slot(place, masks, shaded);
        true
    }
}
