//! The stencil test (O3): sixteen bytes at a time.

use estampe_simd::LANES;
use estampe_types::state::{CompareFunction, StencilFaceState, StencilOperation};

/// The lanes in which `(reference & mask) OP (stored & mask)` holds.
#[inline(always)]
pub(super) fn compare(face: &StencilFaceState, reference: u8, stored: &[u8; LANES]) -> u16 {
    let mask = face.read_mask;
    let new = reference & mask;
    match face.compare {
        CompareFunction::Never => 0,
        CompareFunction::Less => lanes_where(|old| new < (old & mask), stored),
        CompareFunction::Equal => lanes_where(|old| new == (old & mask), stored),
        CompareFunction::LessEqual => lanes_where(|old| new <= (old & mask), stored),
        CompareFunction::Greater => lanes_where(|old| new > (old & mask), stored),
        CompareFunction::NotEqual => lanes_where(|old| new != (old & mask), stored),
        CompareFunction::GreaterEqual => lanes_where(|old| new >= (old & mask), stored),
        CompareFunction::Always => u16::MAX,
    }
}

#[inline(always)]
fn lanes_where(holds: impl Fn(u8) -> bool, stored: &[u8; LANES]) -> u16 {
    let mut lanes = 0;
    for (lane, stored) in stored.iter().enumerate() {
        lanes |= u16::from(holds(*stored)) << lane;
    }
    lanes
}

/// Applies an operation in the lanes of a mask.
#[inline(always)]
pub(super) fn apply(
    operation: StencilOperation,
    (reference, write_mask): (u8, u8),
    lanes: u16,
    stored: &mut [u8; LANES],
) {
    if lanes == 0 || operation == StencilOperation::Keep || write_mask == 0 {
        return;
    }
    for (lane, stored) in stored.iter_mut().enumerate() {
        let new = operation.apply(*stored, reference);
        let mask = if lanes >> lane & 1 == 1 {
            write_mask
        } else {
            0
        };
        *stored = new & mask | *stored & !mask;
    }
}
