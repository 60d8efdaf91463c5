//! The end of the in-order path: shading the queue, late tests, colours.

use super::InOrder;
use crate::raster::packet_origin;
use crate::tile_pass::write_colors;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Shades the queued packets and writes them, in order.
    pub(super) fn flush(&mut self) {
        if self.scratch.queue.is_empty() {
            return;
        }
        if self.is_shown() {
            return self.scratch.shade_shown(self.work.plan, self.work.level);
        }
        // They were drawn before anything was queued.
        self.blend_layers();
        let (plan, level) = (self.work.plan, self.work.level);
        let queue = &mut self.scratch.queue;
        let fragments = queue.shade(level, plan.pipeline, plan.bindings);
        self.scratch.statistics.fragments_shaded += fragments;
        if let Some(line) = &self.smooth {
            let (x, y) = (self.work.shape.x, self.work.shape.y);
            self.scratch.queue.scale_alpha(|packet| {
                let (right, below) = packet_origin(u32::from(packet));
                line.coverage([x + right, y + below])
            });
        }
        if !plan.pipeline.key().tests_early {
            dispatch_samples!(N, level, s => self.test_late(s));
        }
        let batch = self.scratch.queue.batch();
        write_colors(plan, level, &batch, &mut self.job.colors);
        self.scratch.queue.clear();
    }
}
