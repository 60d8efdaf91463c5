//! The stencil test (O3): sixteen bytes in lanes.
//!
//! *In* stored stencil values and the lanes that are tested · *Out* the lanes that pass, and new
//! values · *Spec* Vulkan §Stencil Test; WebGPU §Depth/Stencil State.

use super::compare::compare;
use estampe_simd::{LANES, Lanes, Select, SimdBase, SimdMask, mask8x16, u8x16};
use estampe_types::state::{CompareFunction, StencilFaceState, StencilOperation, StencilState};

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

    /// The test of one face.
    #[inline(always)]
    pub(crate) fn face(&self, is_front: bool) -> FaceTest {
        if is_front { self.front() } else { self.back() }
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
    /// The test in lanes, for many packets.
    #[inline(always)]
    pub(crate) fn lanes<S: Lanes>(&self, s: S) -> FaceLanes<S> {
        let Self { state, reference } = self;
        let update = |operation| Update::new(s, operation, *reference, state.write_mask);
        FaceLanes {
            compare: state.compare,
            reference: splat(s, *reference & state.read_mask),
            read_mask: splat(s, state.read_mask),
            writable: splat(s, state.write_mask),
            fail: update(state.fail_op),
            depth_fail: update(state.depth_fail_op),
            pass: update(state.pass_op),
        }
    }

    /// Returns true if `(reference & mask) OP (stored & mask)` holds of one value.
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
}

/// The stencil test of one face, prepared for many packets: every value is in its lanes.
#[derive(Clone, Copy)]
pub(crate) struct FaceLanes<S: Lanes> {
    compare: CompareFunction,
    /// Under the read mask.
    reference: u8x16<S>,
    read_mask: u8x16<S>,
    writable: u8x16<S>,
    fail: Update<S>,
    depth_fail: Update<S>,
    pass: Update<S>,
}

impl<S: Lanes> FaceLanes<S> {
    /// The lanes in which `(reference & mask) OP (stored & mask)` holds.
    #[inline(always)]
    pub(crate) fn passes(&self, stored: u8x16<S>) -> u16 {
        // Most tests, and most of all those of shadow volumes.
        if self.passes_always() {
            return u16::MAX;
        }
        bits(compare(
            self.compare,
            self.reference,
            stored & self.read_mask,
        ))
    }

    /// Returns true if every sample passes.
    #[inline(always)]
    pub(crate) fn passes_always(&self) -> bool {
        self.compare == CompareFunction::Always
    }

    /// Changes the stored values of lanes that pass this test and fail the depth test.
    #[inline(always)]
    pub(crate) fn count_failing(&self, s: S, lanes: u16, stored: &mut [u8; LANES]) {
        let values = u8x16::load_array_ref(s, stored);
        let new = self.depth_fail.results(s, self.writable, values);
        mask8x16::from_bitmask(s, u64::from(lanes))
            .select(new, values)
            .store_array(stored);
    }

    /// The stored values after a test: `failed`, `depth_failed` and `passed` are the lanes of each
    /// outcome.
    #[inline(always)]
    pub(crate) fn updated(
        &self,
        s: S,
        stored: u8x16<S>,
        [failed, depth_failed, passed]: [u16; 3],
    ) -> u8x16<S> {
        let stored = self.fail.apply(s, self.writable, failed, stored);
        let stored = self
            .depth_fail
            .apply(s, self.writable, depth_failed, stored);
        self.pass.apply(s, self.writable, passed, stored)
    }
}

/// A stencil operation as arithmetic that is the same for all operations, so that lanes need no
/// branch on it: `((v & kept) ^ flipped) +ₛ up −ₛ down + step`, where the first sum and the
/// difference saturate and the last sum wraps.
#[derive(Clone, Copy)]
struct Update<S: Lanes> {
    /// True if stored values do not change.
    keeps: bool,
    kept: u8x16<S>,
    flipped: u8x16<S>,
    up: u8x16<S>,
    down: u8x16<S>,
    step: u8x16<S>,
}

impl<S: Lanes> Update<S> {
    #[inline(always)]
    fn new(s: S, operation: StencilOperation, reference: u8, write_mask: u8) -> Self {
        let (kept, flipped, up, down, step) = match operation {
            StencilOperation::Keep => (0xFF, 0, 0, 0, 0),
            StencilOperation::Zero => (0, 0, 0, 0, 0),
            StencilOperation::Replace => (0, reference, 0, 0, 0),
            StencilOperation::Invert => (0xFF, 0xFF, 0, 0, 0),
            StencilOperation::IncrementClamp => (0xFF, 0, 1, 0, 0),
            StencilOperation::DecrementClamp => (0xFF, 0, 0, 1, 0),
            StencilOperation::IncrementWrap => (0xFF, 0, 0, 0, 1),
            StencilOperation::DecrementWrap => (0xFF, 0, 0, 0, 0xFF),
        };
        Self {
            keeps: operation == StencilOperation::Keep || write_mask == 0,
            kept: splat(s, kept),
            flipped: splat(s, flipped),
            up: splat(s, up),
            down: splat(s, down),
            step: splat(s, step),
        }
    }

    /// Applies the operation in the lanes of a mask.
    #[inline(always)]
    fn apply(&self, s: S, writable: u8x16<S>, lanes: u16, stored: u8x16<S>) -> u8x16<S> {
        if self.keeps {
            return stored;
        }
        let new = self.results(s, writable, stored);
        mask8x16::from_bitmask(s, u64::from(lanes)).select(new, stored)
    }

    /// The operation's results in all lanes.
    #[inline(always)]
    fn results(&self, s: S, writable: u8x16<S>, stored: u8x16<S>) -> u8x16<S> {
        let new = s.saturating_add_u8x16((stored & self.kept) ^ self.flipped, self.up);
        let new = s.saturating_sub_u8x16(new, self.down) + self.step;
        stored ^ ((stored ^ new) & writable)
    }
}

#[inline(always)]
fn splat<S: Lanes>(s: S, value: u8) -> u8x16<S> {
    SimdBase::splat(s, value)
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
        test.lanes(s).passes(u8x16::load_array_ref(s, stored))
    }

    #[inline(always)]
    fn updated<S: Lanes>(s: S, test: &FaceTest, stored: &[u8; 16], lanes: [u16; 3]) -> [u8; 16] {
        let stored = u8x16::load_array_ref(s, stored);
        test.lanes(s).updated(s, stored, lanes).to_array()
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
    fn sixteen_operations_are_sixteen_times_one() {
        use StencilOperation::*;
        let operations = [
            Keep,
            Zero,
            Replace,
            Invert,
            IncrementClamp,
            DecrementClamp,
            IncrementWrap,
            DecrementWrap,
        ];
        for (level, operation) in Level::all_available()
            .into_iter()
            .flat_map(|level| operations.map(|operation| (level, operation)))
        {
            for write_mask in [0xFF, 0x0F, 0x80, 0] {
                let state = StencilFaceState {
                    pass_op: operation,
                    write_mask,
                    ..StencilFaceState::default()
                };
                let test = FaceTest {
                    state,
                    reference: 0x5A,
                };
                for first in (0..=240u8).step_by(16) {
                    let stored: [u8; 16] =
                        std::array::from_fn(|lane| first + u8::try_from(lane).expect("below 16"));
                    let got = dispatch!(level, s => updated(s, &test, &stored, [0, 0, 0xF7FF]));
                    let mut one = stored.map(|stored| test.updated_one(stored, true, true));
                    one[11] = stored[11];
                    assert_eq!(got, one, "{level:?} {operation:?} {write_mask}");
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
