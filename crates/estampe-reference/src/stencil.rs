//! The stencil test.
//!
//! In · Out: the state of one face, reference, stored value · what passed and what is stored then. Exact.

use estampe_types::state::StencilFaceState;

/// Whether a stored value passes: `(reference & read_mask) OP (stored & read_mask)`.
#[must_use]
pub fn passes(face: &StencilFaceState, reference: u8, stored: u8) -> bool {
    let [new, old] = [reference, stored].map(|value| value & face.read_mask);
    face.compare.passes_stencil(new, old)
}

/// What is stored after the tests, of which the depth test counts only where stencil passes.
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
    let new = operation.apply(stored, reference);
    (new & face.write_mask) | (stored & !face.write_mask)
}
