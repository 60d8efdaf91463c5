//! The tests of a sample: depth bounds, stencil (O3), depth (O4), in this order, with the values
//! that they write.
//!
//! *In* depths of sixteen samples, a mask · *Out* the lanes that pass; depth and stencil
//! attachments · *Spec* Vulkan §Fragment Operations. State is data here: one function serves every
//! combination, because branches on state that is the same for a whole draw are predicted.

use super::compare::compare;
use super::stencil::{FaceLanes, StencilTest};
use crate::depth_format::{StoredDepth, clamp_depth};
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
    /// primitive faces the viewer: quads of both faces may share a packet.
    #[inline(always)]
    pub(crate) fn run<S: Lanes>(
        &self,
        s: S,
        new: f32x16<S>,
        lanes: u16,
        front: u16,
        stored: StoredSamples<'_>,
    ) -> u16 {
        outline!(s, {
            self.run_with(
                s,
                new,
                lanes,
                (stored, false),
                #[inline(always)]
                |[lanes, nearer], stencil| {
                    let test = self.stencil.as_ref()?;
                    let mut passed = 0;
                    for (face, of_face) in [(test.front(), front), (test.back(), !front)] {
                        let lanes = lanes & of_face;
                        if lanes != 0 {
                            passed |= test_stencil(s, &face.lanes(s), [lanes, nearer], stencil);
                        }
                    }
                    Some(passed)
                },
            )
        })
    }

    /// Sixteen interpolated depths as [`SampleTests::run_face`] takes them: as they are stored, or
    /// as [codes](crate::depth_format::DepthFormat::codes) if the draw does not store them.
    #[inline(always)]
    pub(crate) fn comparable<S: Lanes>(&self, s: S, depth: f32x16<S>) -> f32x16<S> {
        let StoredDepth { range, format } = self.stored;
        let depth = clamp_depth(s, depth, range);
        if self.writes_depth() {
            format.stored_lanes(s, depth)
        } else {
            format.codes(s, depth)
        }
    }

    /// [`SampleTests::run`] of one primitive, for whose face the stencil test was prepared, at
    /// [comparable](SampleTests::comparable) depths.
    #[inline(always)]
    pub(crate) fn run_face<S: Lanes>(
        &self,
        s: S,
        new: f32x16<S>,
        lanes: u16,
        face: Option<&FaceLanes<S>>,
        stored: StoredSamples<'_>,
    ) -> u16 {
        self.run_with(
            s,
            new,
            lanes,
            (stored, !self.writes_depth()),
            #[inline(always)]
            |lanes, stencil| Some(test_stencil(s, face?, lanes, stencil)),
        )
    }

    /// The tests around a stencil test, which gets the lanes that are tested and those that pass
    /// the depth test, and says which pass both; `None` if there is no stencil test. With `codes`,
    /// the new depths are codes.
    #[inline(always)]
    fn run_with<S: Lanes>(
        &self,
        s: S,
        new: f32x16<S>,
        mut lanes: u16,
        (stored, codes): (StoredSamples<'_>, bool),
        stencil_test: impl FnOnce([u16; 2], &mut [u8; LANES]) -> Option<u16>,
    ) -> u16 {
        let old = match &stored.depth {
            Some(depth) => f32x16::load_array_ref(s, depth),
            None => new,
        };
        if let (Some(range), Some(_)) = (self.bounds, &stored.depth) {
            lanes &= inside(s, old, range);
        }
        let depth_test = self.depth.filter(|_| stored.depth.is_some());
        let nearer = match depth_test {
            Some(state) => {
                let old = if codes {
                    self.stored.format.codes(s, old)
                } else {
                    old
                };
                s.bits_of_mask(compare(state.compare, new, old))
            }
            None => u16::MAX,
        };
        // Without closures around it, the test is inlined, and a face's lanes stay in registers.
        let passed = match stored.stencil {
            Some(stencil) => stencil_test([lanes, nearer], stencil),
            None => None,
        };
        let passed = passed.unwrap_or(lanes & nearer);
        if let (Some(depth), true) = (
            stored.depth,
            depth_test.is_some_and(|state| state.write_enabled),
        ) && passed != 0
        {
            s.mask_from_bits(passed).select(new, old).store_array(depth);
        }
        passed
    }

    /// [`SampleTests::run_face`] of samples that are known to fail the depth test: stencil values
    /// may change, nothing else.
    #[inline(always)]
    pub(crate) fn run_failing<S: Lanes>(
        &self,
        s: S,
        mut lanes: u16,
        face: &FaceLanes<S>,
        (depth, stencil): (Option<&[f32; LANES]>, &mut [u8; LANES]),
    ) {
        if let (Some(range), Some(depth)) = (self.bounds, depth) {
            lanes &= inside(s, f32x16::load_array_ref(s, depth), range);
        }
        test_stencil(s, face, [lanes, 0], stencil);
    }

    /// Returns true if of samples that fail the depth test each one's stencil value changes as a
    /// face's [`FaceLanes::count_failing`] says.
    #[inline(always)]
    pub(crate) fn failing_counts<S: Lanes>(&self, face: &FaceLanes<S>) -> bool {
        self.bounds.is_none() && face.passes_always()
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
                let face = test.face(front);
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

/// The stencil test between the depth bounds and the depth test, which `nearer` passes.
#[inline(always)]
fn test_stencil<S: Lanes>(
    s: S,
    face: &FaceLanes<S>,
    [lanes, nearer]: [u16; 2],
    stencil: &mut [u8; LANES],
) -> u16 {
    let values = u8x16::load_array_ref(s, stencil);
    let passes = lanes & face.passes(values);
    let outcomes = [lanes & !passes, passes & !nearer, passes & nearer];
    face.updated(s, values, outcomes).store_array(stencil);
    passes & nearer
}

/// The lanes whose stored depth lies in a range.
#[inline(always)]
fn inside<S: Lanes>(s: S, stored: f32x16<S>, [low, high]: [f32; 2]) -> u16 {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    s.bits_of_mask(stored.simd_ge(splat(low)) & stored.simd_le(splat(high)))
}
