//! Layers of the in-order path: triangles that are blended from the planes of their colours.

use super::InOrder;
use super::triangle::WholeBlocks;
use crate::fragment::interpolate::{DepthPlane, TriangleInterpolant};
use crate::per_sample::source_over::{ColorPlanes, TileBlock, test_block};
use estampe_simd::{Lanes, dispatch};

/// Lines of the next tile that are prefetched for each block.
const AHEAD: usize = 8;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Adds a triangle to the layers that will be blended together: the packets of the list, which
    /// are tested, and the blocks that it covers whole.
    pub(super) fn add_layer(&mut self, triangle: &TriangleInterpolant<'_>, coverage: WholeBlocks) {
        // The queued packets lie below.
        self.flush();
        if self.scratch.in_order.layers.is_full() {
            self.blend_layers();
        }
        let codec = self.work.plan.pipeline.color_targets()[0].codec;
        let is_bgra = codec.format().is_bgra();
        let colors = ColorPlanes::new(triangle.origin, &triangle.planes, is_bgra);
        let layers = &mut self.scratch.in_order.layers;
        layers.begin(colors, self.work.shape);
        let mut fragments = 0;
        for covered in self.scratch.in_order.list.items() {
            layers.add_packet(covered.packet, covered.masks[0]);
            fragments += u64::from(covered.masks[0].count_ones());
        }
        self.scratch.statistics.fragments_shaded += fragments;
        let plane = DepthPlane {
            origin: triangle.origin,
            z: triangle.z,
        };
        dispatch!(@wide self.work.level, s => self.test_blocks(s, &plane, coverage),
            scalar => unreachable!("the scalar level blends packet by packet"));
    }

    #[inline(always)]
    fn test_blocks<S: Lanes>(&mut self, s: S, plane: &DepthPlane, coverage: WholeBlocks) {
        let WholeBlocks { whole, certain } = coverage;
        let tests = &self.work.plan.tests;
        let mut tested = whole;
        if tests.is_empty() {
            tested = 0;
        } else if tests.writes_depth() {
            self.scratch.hiz.invalidate(whole);
        } else {
            tested = whole & !certain;
        }
        let layers = &mut self.scratch.in_order.layers;
        layers.add_whole(whole & !tested);
        let mut fragments = u64::from((whole & !tested).count_ones()) * 256;
        while tested != 0 {
            let number = tested.trailing_zeros();
            tested &= tested - 1;
            let block = TileBlock::new(self.work.shape, number);
            let masks = test_block(s, tests, plane, block, self.job.depth);
            let counts = masks.iter().map(|mask| u64::from(mask.count_ones()));
            fragments += counts.sum::<u64>();
            layers.add_tested(number, &masks);
        }
        self.scratch.statistics.fragments_shaded += fragments;
    }

    /// Blends the layers that wait: what is drawn next lies above them.
    pub(super) fn blend_layers(&mut self) {
        let layers = &mut self.scratch.in_order.layers;
        if layers.is_empty() {
            return;
        }
        let (tile, stored) = (self.work.shape, &mut *self.job.colors[0]);
        let next = &mut self.job.next;
        let counts = dispatch!(@wide self.work.level, s =>
                layers.blend(s, tile, stored, #[inline(always)] || next.step(s, AHEAD)),
            scalar => unreachable!("the scalar level blends packet by packet"));
        let statistics = &mut self.scratch.statistics;
        for (sum, count) in
            statistics
                .layers_blended
                .iter_mut()
                .zip([counts.packets, counts.layers, counts.exact])
        {
            *sum += count;
        }
    }
}
