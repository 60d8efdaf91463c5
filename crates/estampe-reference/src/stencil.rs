//! The stencil test and the stencil operations.
//!
//! In · Out: the state of one face, reference, stored value · the result of the test and the new
//! value. Exact. Spec: Vulkan 1.3, "Stencil Test"; WebGPU, `GPUStencilOperation`.

use crate::compare;
use estampe_types::state::{StencilFaceState, StencilOperation};

/// The greatest 8-bit stencil value.
const GREATEST: i32 = 255;

/// Returns true if the stencil test passes: `(reference & read_mask) OP (stored & read_mask)`.
#[must_use]
pub fn passes(face: &StencilFaceState, reference: u8, stored: u8) -> bool {
    let [new, old] = [reference, stored].map(|value| value & face.read_mask);
    compare::passes(face.compare, new, old)
}

/// The new stencil value. The depth test's result matters only if the stencil test passed.
#[must_use]
pub fn updated(
    face: &StencilFaceState,
    reference: u8,
    stored: u8,
    stencil_passes: bool,
    depth_passes: bool,
) -> u8 {
    let operation = match (stencil_passes, depth_passes) {
        (false, _) => face.fail_op,
        (true, false) => face.depth_fail_op,
        (true, true) => face.pass_op,
    };
    let new = operated(operation, reference, stored);
    (new & face.write_mask) | (stored & !face.write_mask)
}

/// The result of an operation before the write mask: computed as an integer, then clamped or
/// wrapped to 8 bits.
#[must_use]
pub fn operated(operation: StencilOperation, reference: u8, stored: u8) -> u8 {
    use StencilOperation as O;
    let old = i32::from(stored);
    let new = match operation {
        O::Keep => old,
        O::Zero => 0,
        O::Replace => i32::from(reference),
        O::Invert => GREATEST - old,
        O::IncrementClamp => Ord::min(old + 1, GREATEST),
        O::DecrementClamp => Ord::max(old - 1, 0),
        O::IncrementWrap => (old + 1).rem_euclid(GREATEST + 1),
        O::DecrementWrap => (old - 1).rem_euclid(GREATEST + 1),
    };
    u8::try_from(new).expect("within 0..=255")
}
