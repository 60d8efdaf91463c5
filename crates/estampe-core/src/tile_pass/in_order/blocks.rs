//! Whole blocks of the in-order path, blended from the planes of their colours.

use super::{InOrder, WholeBlocks};
use crate::fragment::interpolate::{DepthPlane, TriangleInterpolant};
use crate::per_sample::source_over::{ColorPlanes, TileBlock, blend_block, test_block};
use estampe_simd::{LANES, Lanes, dispatch};

impl<const N: usize> InOrder<'_, '_, '_, N> {
    /// Blends a triangle over blocks that it covers whole.
    pub(super) fn blend_blocks(
        &mut self,
        triangle: &TriangleInterpolant<'_>,
        coverage: WholeBlocks,
    ) {
        // The queued packets lie below.
        self.flush();
        let codec = self.work.plan.pipeline.color_targets()[0].codec;
        let colors = ColorPlanes::new(
            triangle.origin,
            &triangle.planes,
            self.work.shape,
            codec.format().is_bgra(),
        );
        let plane = DepthPlane {
            origin: triangle.origin,
            z: triangle.z,
        };
        dispatch!(@wide self.work.level, s => self.blend_lanes(s, &plane, &colors, coverage),
            scalar => unreachable!("the scalar level blends packet by packet"));
    }

    #[inline(always)]
    fn blend_lanes<S: Lanes>(
        &mut self,
        s: S,
        plane: &DepthPlane,
        colors: &ColorPlanes,
        coverage: WholeBlocks,
    ) {
        let WholeBlocks { mut whole, certain } = coverage;
        let tests = &self.work.plan.tests;
        if tests.writes_depth() {
            self.scratch.hiz.invalidate(whole);
        }
        while whole != 0 {
            let number = whole.trailing_zeros();
            whole &= whole - 1;
            let block = TileBlock::new(self.work.shape, number);
            let (mut masks, mut fragments) = ([u16::MAX; LANES], 256);
            if !tests.is_empty() && (tests.writes_depth() || certain >> number & 1 == 0) {
                masks = test_block(s, tests, plane, block, self.job.depth);
                let counts = masks.iter().map(|mask| u64::from(mask.count_ones()));
                fragments = counts.sum();
            }
            self.scratch.statistics.fragments_shaded += fragments;
            blend_block(s, colors, block, &masks, self.job.colors[0]);
        }
    }
}
