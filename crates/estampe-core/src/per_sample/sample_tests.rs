//! The tests of a sample: depth bounds, stencil (O3), depth (O4), in this order, with the values
//! that they write.
//!
//! *In* depths of sixteen samples, a mask · *Out* the lanes that pass; depth and stencil
//! attachments · *Spec* Vulkan §Fragment Operations. State is data here: one function serves every
//! combination, because branches on state that is the same for a whole draw are predicted.

use super::compare::compare;
use super::stencil::StencilTest;
use crate::depth_format::StoredDepth;
use estampe_simd::{LANES, Lanes, Select, SimdBase, f32x16, outline, u8x16};
use estampe_types::state::{CompareFunction, DepthState};

/// All tests of a draw, where the target has the attachments that they need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SampleTests {
    /// The depth-bounds test: the range of stored depths, both ends included.
    pub(crate) bounds: Option<[f32; 2]>,
    pub(crate) stencil: Option<StencilTest>,
    pub(crate) depth: Option<DepthState>,
    /// The clamp and rounding of depths before they are compared.
    pub(crate) stored: StoredDepth,
}

/// The stored values of one sample of sixteen pixels; a target may lack either.
#[derive(Debug)]
pub(crate) struct StoredSamples<'a> {
    pub(crate) depth: Option<&'a mut [f32; LANES]>,
    pub(crate) stencil: Option<&'a mut [u8; LANES]>,
}

impl SampleTests {
    /// Returns true if there is nothing to test or write.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.bounds.is_none() && self.stencil.is_none() && self.depth.is_none()
    }

    /// Returns true if depth is all that is tested: there is no depth-bounds test and no stencil
    /// test.
    #[inline(always)]
    pub(crate) fn is_depth_alone(&self) -> bool {
        self.bounds.is_none() && self.stencil.is_none()
    }

    /// Returns true if samples that pass store their depth.
    #[inline(always)]
    pub(crate) fn writes_depth(&self) -> bool {
        self.depth.is_some_and(|state| state.write_enabled)
    }

    /// Tests sixteen samples whose depths are `new`, [as they are stored](StoredDepth::of). Returns
    /// the lanes that pass; their depth and stencil values are written. `front` has the lanes whose
    /// primitive faces the viewer.
    #[inline(always)]
    pub(crate) fn run<S: Lanes>(
        &self,
        s: S,
        new: f32x16<S>,
        mut lanes: u16,
        front: u16,
        stored: StoredSamples<'_>,
    ) -> u16 {
        outline!(s, {
            let old = match &stored.depth {
                Some(depth) => f32x16::load_array_ref(s, depth),
                None => new,
            };
            if let (Some(range), Some(_)) = (self.bounds, &stored.depth) {
                lanes &= inside(s, old, range);
            }
            let depth_test = self.depth.filter(|_| stored.depth.is_some());
            let nearer = match depth_test {
                Some(state) => s.bits_of_mask(compare(state.compare, new, old)),
                None => u16::MAX,
            };
            let passed = match (&self.stencil, stored.stencil) {
                (Some(test), Some(stencil)) => {
                    test_stencil(s, test, [lanes, nearer, front], stencil)
                }
                _ => lanes & nearer,
            };
            if let (Some(depth), true) = (
                stored.depth,
                depth_test.is_some_and(|state| state.write_enabled),
            ) && passed != 0
            {
                s.mask_from_bits(passed).select(new, old).store_array(depth);
            }
            passed
        })
    }

    /// [`SampleTests::run`] of samples that are known to fail the depth test: stencil values may
    /// change, nothing else.
    #[inline(always)]
    pub(crate) fn run_failing<S: Lanes>(
        &self,
        s: S,
        mut lanes: u16,
        front: u16,
        stored: StoredSamples<'_>,
    ) {
        if let (Some(range), Some(depth)) = (self.bounds, &stored.depth) {
            lanes &= inside(s, f32x16::load_array_ref(s, depth), range);
        }
        if let (Some(test), Some(stencil)) = (&self.stencil, stored.stencil) {
            test_stencil(s, test, [lanes, 0, front], stencil);
        }
    }

    /// Returns true if a sample that passes its depth test changes neither depth nor stencil.
    pub(crate) fn passing_keeps(&self, front: bool) -> bool {
        !self.writes_depth() && self.stencil.is_none_or(|test| test.passing_keeps(front))
    }

    /// The lanes that the depth test would let pass as things stand; nothing is written.
    #[inline(always)]
    pub(crate) fn would_pass<S: Lanes>(
        &self,
        s: S,
        new: f32x16<S>,
        stored: Option<&mut [f32; LANES]>,
    ) -> u16 {
        outline!(s, {
            match (self.depth, stored) {
                (Some(state), Some(stored)) => {
                    let stored = f32x16::load_array_ref(s, stored);
                    s.bits_of_mask(compare(state.compare, new, stored))
                }
                _ => u16::MAX,
            }
        })
    }

    /// [`SampleTests::run`] of one sample.
    #[inline(always)]
    pub(crate) fn run_one(
        &self,
        new: f32,
        front: bool,
        (depth, stencil): (Option<&mut f32>, Option<&mut u8>),
    ) -> bool {
        if let (Some([low, high]), Some(stored)) = (self.bounds, &depth)
            && !(low <= **stored && **stored <= high)
        {
            return false;
        }
        let passes_depth = match (self.depth, &depth) {
            (Some(state), Some(stored)) => compare(state.compare, new, **stored),
            _ => true,
        };
        let passes = match (&self.stencil, stencil) {
            (Some(test), Some(stencil)) => {
                let face = if front { test.front() } else { test.back() };
                let passes = face.passes_one(*stencil);
                *stencil = face.updated_one(*stencil, passes, passes_depth);
                passes && passes_depth
            }
            _ => passes_depth,
        };
        if let (true, true, Some(stored)) = (passes, self.writes_depth(), depth) {
            *stored = new;
        }
        passes
    }

    /// Returns true if a fragment that fails the depth test now would fail it after shading too,
    /// and write nothing (O9).
    ///
    /// Fragments that wait in the queue may have changed the stored depth by then, but only in the
    /// direction that the comparison allows: towards depths at which fewer fragments pass. This
    /// does not hold for "not equal".
    pub(crate) fn early_failure_is_final(&self) -> bool {
        let keeps = self
            .stencil
            .is_none_or(|test| StencilTest::failing_keeps(&test.state));
        keeps
            && self
                .depth
                .is_some_and(|depth| depth.compare != CompareFunction::NotEqual)
    }
}

/// The stencil test between the depth bounds and the depth test. Front and back faces are tested
/// apart where quads of both share a packet.
#[inline(always)]
fn test_stencil<S: Lanes>(
    s: S,
    test: &StencilTest,
    [lanes, nearer, front]: [u16; 3],
    stencil: &mut [u8; LANES],
) -> u16 {
    let mut values = u8x16::load_array_ref(s, stencil);
    let mut passed = 0;
    for (face, lanes) in [(test.front(), lanes & front), (test.back(), lanes & !front)] {
        if lanes == 0 {
            continue;
        }
        let passes = lanes & face.passes(s, values);
        let outcomes = [lanes & !passes, passes & !nearer, passes & nearer];
        values = face.updated(s, values, outcomes);
        passed |= passes & nearer;
    }
    values.store_array(stencil);
    passed
}

/// The lanes whose stored depth lies in a range.
#[inline(always)]
fn inside<S: Lanes>(s: S, stored: f32x16<S>, [low, high]: [f32; 2]) -> u16 {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    s.bits_of_mask(stored.simd_ge(splat(low)) & stored.simd_le(splat(high)))
}
