//! The stencil test (O3): sixteen bytes in lanes.
//!
//! *In* stored stencil values and the lanes that are tested · *Out* the lanes that pass, and new
//! values · *Spec* Vulkan §Stencil Test; WebGPU §Depth/Stencil State.

use super::compare::compare;
use estampe_simd::{LANES, Lanes, Select, SimdBase, SimdMask, mask8x16, u8x16};
use estampe_types::state::{StencilFaceState, StencilOperation, StencilState};

/// The stencil test of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StencilTest {
    pub(crate) state: StencilState,
    /// Front, back.
    pub(crate) reference: [u8; 2],
}

/// The stencil test of one face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceTest {
    state: StencilFaceState,
    reference: u8,
}

impl StencilTest {
    pub(crate) fn front(&self) -> FaceTest {
        FaceTest {
            state: self.state.front,
            reference: self.reference[0],
        }
    }

    pub(crate) fn back(&self) -> FaceTest {
        FaceTest {
            state: self.state.back,
            reference: self.reference[1],
        }
    }

    /// Returns true if the stored value is kept when the stencil test, or the depth test after it,
    /// fails.
    pub(crate) fn failing_keeps(state: &StencilState) -> bool {
        use StencilOperation::Keep;
        [state.front, state.back]
            .iter()
            .all(|face| face.fail_op == Keep && face.depth_fail_op == Keep)
    }

    /// Returns true if the stored value is kept when the depth test passes, whatever the stencil
    /// test says of a triangle that faces the viewer, or not.
    pub(crate) fn passing_keeps(&self, front: bool) -> bool {
        let StencilState {
            front: of_front,
            back,
        } = &self.state;
        let face = if front { of_front } else { back };
        [face.fail_op, face.pass_op] == [StencilOperation::Keep; 2]
    }
}

impl FaceTest {
    /// The lanes in which `(reference & mask) OP (stored & mask)` holds.
    #[inline(always)]
    pub(crate) fn passes<S: Lanes>(&self, s: S, stored: u8x16<S>) -> u16 {
        let splat = |value| <u8x16<S> as SimdBase<S>>::splat(s, value);
        let mask = self.state.read_mask;
        let reference = splat(self.reference & mask);
        bits(compare(self.state.compare, reference, stored & splat(mask)))
    }

    /// The stored values after a test: `failed`, `depth_failed` and `passed` are the lanes of each
    /// outcome.
    #[inline(always)]
    pub(crate) fn updated<S: Lanes>(
        &self,
        s: S,
        stored: u8x16<S>,
        [failed, depth_failed, passed]: [u16; 3],
    ) -> u8x16<S> {
        let state = &self.state;
        let stored = self.apply(s, state.fail_op, failed, stored);
        let stored = self.apply(s, state.depth_fail_op, depth_failed, stored);
        self.apply(s, state.pass_op, passed, stored)
    }

    /// [`FaceTest::passes`] of one value.
    #[inline(always)]
    pub(crate) fn passes_one(&self, stored: u8) -> bool {
        let mask = self.state.read_mask;
        compare(self.state.compare, self.reference & mask, stored & mask)
    }

    /// The stored value after a test of one sample.
    #[inline(always)]
    pub(crate) fn updated_one(&self, stored: u8, passes: bool, passes_depth: bool) -> u8 {
        let operation = match (passes, passes_depth) {
            (false, _) => self.state.fail_op,
            (true, false) => self.state.depth_fail_op,
            (true, true) => self.state.pass_op,
        };
        let new = match operation {
            StencilOperation::Keep => return stored,
            StencilOperation::Zero => 0,
            StencilOperation::Replace => self.reference,
            StencilOperation::Invert => !stored,
            StencilOperation::IncrementClamp => stored.saturating_add(1),
            StencilOperation::DecrementClamp => stored.saturating_sub(1),
            StencilOperation::IncrementWrap => stored.wrapping_add(1),
            StencilOperation::DecrementWrap => stored.wrapping_sub(1),
        };
        new & self.state.write_mask | stored & !self.state.write_mask
    }

    /// Applies an operation in the lanes of a mask.
    #[inline(always)]
    fn apply<S: Lanes>(
        &self,
        s: S,
        operation: StencilOperation,
        lanes: u16,
        stored: u8x16<S>,
    ) -> u8x16<S> {
        if lanes == 0 || operation == StencilOperation::Keep {
            return stored;
        }
        let splat = |value| <u8x16<S> as SimdBase<S>>::splat(s, value);
        let new = match operation {
            StencilOperation::Keep => stored,
            StencilOperation::Zero => splat(0),
            StencilOperation::Replace => splat(self.reference),
            StencilOperation::Invert => !stored,
            StencilOperation::IncrementClamp => s.saturating_add_u8x16(stored, splat(1)),
            StencilOperation::DecrementClamp => s.saturating_sub_u8x16(stored, splat(1)),
            StencilOperation::IncrementWrap => stored + splat(1),
            StencilOperation::DecrementWrap => stored - splat(1),
        };
        let writable = splat(self.state.write_mask);
        let new = (new & writable) | (stored & !writable);
        mask8x16::from_bitmask(s, u64::from(lanes)).select(new, stored)
    }
}

#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a mask of 16 lanes has 16 bits"
)]
fn bits<S: Lanes>(mask: mask8x16<S>) -> u16 {
    const { assert!(LANES == 16) };
    mask.to_bitmask() as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};
    use estampe_types::state::CompareFunction;

    const FUNCTIONS: [CompareFunction; 8] = [
        CompareFunction::Never,
        CompareFunction::Less,
        CompareFunction::Equal,
        CompareFunction::LessEqual,
        CompareFunction::Greater,
        CompareFunction::NotEqual,
        CompareFunction::GreaterEqual,
        CompareFunction::Always,
    ];

    #[inline(always)]
    fn passing<S: Lanes>(s: S, test: &FaceTest, stored: &[u8; 16]) -> u16 {
        test.passes(s, u8x16::load_array_ref(s, stored))
    }

    #[inline(always)]
    fn updated<S: Lanes>(s: S, test: &FaceTest, stored: &[u8; 16], lanes: [u16; 3]) -> [u8; 16] {
        test.updated(s, u8x16::load_array_ref(s, stored), lanes)
            .to_array()
    }

    /// Returns true if a reference passes against a stored value, by the definition.
    fn holds(function: CompareFunction, reference: u8, stored: u8) -> bool {
        match function {
            CompareFunction::Never => false,
            CompareFunction::Less => reference < stored,
            CompareFunction::Equal => reference == stored,
            CompareFunction::LessEqual => reference <= stored,
            CompareFunction::Greater => reference > stored,
            CompareFunction::NotEqual => reference != stored,
            CompareFunction::GreaterEqual => reference >= stored,
            CompareFunction::Always => true,
        }
    }

    #[test]
    fn sixteen_comparisons_are_sixteen_times_one() {
        for level in Level::all_available() {
            for compare in FUNCTIONS {
                for (reference, read_mask) in [(0, 0xFF), (7, 0x0F), (200, 0xF8), (255, 0xFF)] {
                    for first in (0..=240u8).step_by(16) {
                        let stored: [u8; 16] = std::array::from_fn(|lane| {
                            first + u8::try_from(lane).expect("below 16")
                        });
                        let test = FaceTest {
                            state: StencilFaceState {
                                compare,
                                read_mask,
                                ..StencilFaceState::default()
                            },
                            reference,
                        };
                        let got = dispatch!(level, s => passing(s, &test, &stored));
                        for (lane, stored) in stored.iter().enumerate() {
                            let expected =
                                holds(compare, reference & read_mask, stored & read_mask);
                            assert_eq!(got >> lane & 1 == 1, expected, "{compare:?} {stored}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn each_outcome_has_its_operation_under_the_write_mask() {
        let state = StencilFaceState {
            fail_op: StencilOperation::IncrementWrap,
            depth_fail_op: StencilOperation::DecrementClamp,
            pass_op: StencilOperation::Invert,
            write_mask: 0x3F,
            ..StencilFaceState::default()
        };
        let test = FaceTest {
            state,
            reference: 9,
        };
        for level in Level::all_available() {
            let stored = [0x7F, 0, 0xFF, 5, 0x80, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
            let got =
                dispatch!(level, s => updated(s, &test, &stored, [0b0_0001, 0b0_0110, 0b1_1000]));
            // 7F + 1 = 80, of which the write mask lets 00 through: 40. 0 − 1 stays 0. FF − 1 = FE:
            // FE. !5 = FA: 3A. !80 = 7F: BF.
            assert_eq!(got[..6], [0x40, 0, 0xFE, 0x3A, 0xBF, 1], "{level:?}");
            assert_eq!(got[6..], stored[6..], "{level:?}");
        }
    }
}
