//! The tests of a sample: depth bounds, stencil, depth, in this order, with what they write.

use super::stencil;
use estampe_simd::LANES;
use estampe_types::TexelEncoding;
use estampe_types::TextureFormat;
use estampe_types::state::{CompareFunction, DepthState, StencilFaceState, StencilState};

/// How an attachment stores depth: as f32 in memory, of fixed-point formats the number nearest to the code's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DepthFormat {
    Float,
    /// 2ⁿ − 1.
    Fixed {
        most: f32,
    },
}

impl DepthFormat {
    pub(crate) fn new(format: Option<TextureFormat>) -> Self {
        match format.map(TextureFormat::encoding) {
            Some(TexelEncoding::Depth16) => Self::Fixed { most: 65_535.0 },
            Some(TexelEncoding::Depth24) => Self::Fixed { most: 16_777_215.0 },
            _ => Self::Float,
        }
    }

    /// A depth in 0..=1 as it is stored. Different codes have different numbers, in the same order.
    #[inline(always)]
    pub(crate) fn stored(self, depth: f32) -> f32 {
        match self {
            Self::Float => depth,
            Self::Fixed { most } => {
                let code = (depth * most).round_ties_even();
                code / most
            }
        }
    }
}

/// The stencil test of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StencilTest {
    pub(crate) state: StencilState,
    /// Front, back.
    pub(crate) reference: [u8; 2],
}

impl StencilTest {
    fn face(&self, front: bool) -> (&StencilFaceState, u8) {
        if front {
            (&self.state.front, self.reference[0])
        } else {
            (&self.state.back, self.reference[1])
        }
    }

    /// Whether failing the stencil test, or the depth test after it, leaves what is stored.
    pub(crate) fn failing_keeps(&self) -> bool {
        use estampe_types::state::StencilOperation::Keep;
        [self.state.front, self.state.back]
            .iter()
            .all(|face| face.fail_op == Keep && face.depth_fail_op == Keep)
    }
}

/// All tests of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SampleTests {
    pub(crate) bounds: Option<[f32; 2]>,
    pub(crate) stencil: Option<StencilTest>,
    pub(crate) depth: Option<DepthState>,
    pub(crate) format: DepthFormat,
}

impl SampleTests {
    /// Whether there is nothing to test or write.
    pub(crate) fn is_empty(&self) -> bool {
        self.bounds.is_none() && self.stencil.is_none() && self.depth.is_none()
    }

    /// Tests one packet of one sample: `depth` as it would be [stored](DepthFormat::stored). Returns the lanes
    /// that pass, whose depth and stencil are written.
    #[inline(always)]
    pub(crate) fn run(
        &self,
        depth: &[f32; LANES],
        mut lanes: u16,
        front: bool,
        (stored_depth, stored_stencil): (Option<&mut [f32; LANES]>, Option<&mut [u8; LANES]>),
    ) -> u16 {
        let mut nothing = [0.0; LANES];
        let has_depth = stored_depth.is_some();
        let stored_depth = stored_depth.unwrap_or(&mut nothing);
        if let (Some(range), true) = (self.bounds, has_depth) {
            lanes &= inside(stored_depth, range);
        }
        let depth_test = self.depth.filter(|_| has_depth);
        let passes_depth = |lanes: u16, stored: &[f32; LANES]| match depth_test {
            Some(state) => lanes & compare(state.compare, depth, stored),
            None => lanes,
        };
        let passed = match (&self.stencil, stored_stencil) {
            (Some(test), Some(stored)) => {
                let (face, reference) = test.face(front);
                let operands = (reference, face.write_mask);
                let passes = lanes & stencil::compare(face, reference, stored);
                let passed = passes_depth(passes, stored_depth);
                stencil::apply(face.fail_op, operands, lanes & !passes, stored);
                stencil::apply(face.depth_fail_op, operands, passes & !passed, stored);
                stencil::apply(face.pass_op, operands, passed, stored);
                passed
            }
            _ => passes_depth(lanes, stored_depth),
        };
        if depth_test.is_some_and(|state| state.write_enabled) {
            for (lane, (stored, new)) in stored_depth.iter_mut().zip(depth).enumerate() {
                if passed >> lane & 1 == 1 {
                    *stored = *new;
                }
            }
        }
        passed
    }

    /// The lanes that the depth test would let pass as things stand; nothing is written.
    #[inline(always)]
    pub(crate) fn would_pass(&self, depth: &[f32; LANES], stored: &[f32; LANES]) -> u16 {
        match self.depth {
            Some(state) => compare(state.compare, depth, stored),
            None => u16::MAX,
        }
    }
}

#[inline(always)]
fn inside(stored: &[f32; LANES], [low, high]: [f32; 2]) -> u16 {
    let mut lanes = 0;
    for (lane, stored) in stored.iter().enumerate() {
        lanes |= u16::from(low <= *stored && *stored <= high) << lane;
    }
    lanes
}

/// The lanes in which `new OP stored` holds.
#[inline(always)]
fn compare(function: CompareFunction, new: &[f32; LANES], stored: &[f32; LANES]) -> u16 {
    match function {
        CompareFunction::Never => 0,
        CompareFunction::Less => lanes_where(|new, old| new < old, new, stored),
        CompareFunction::Equal => lanes_where(|new, old| new == old, new, stored),
        CompareFunction::LessEqual => lanes_where(|new, old| new <= old, new, stored),
        CompareFunction::Greater => lanes_where(|new, old| new > old, new, stored),
        CompareFunction::NotEqual => lanes_where(|new, old| new != old, new, stored),
        CompareFunction::GreaterEqual => lanes_where(|new, old| new >= old, new, stored),
        CompareFunction::Always => u16::MAX,
    }
}

#[inline(always)]
fn lanes_where(holds: impl Fn(f32, f32) -> bool, new: &[f32; LANES], stored: &[f32; LANES]) -> u16 {
    let mut lanes = 0;
    for (lane, (new, stored)) in new.iter().zip(stored).enumerate() {
        lanes |= u16::from(holds(*new, *stored)) << lane;
    }
    lanes
}
