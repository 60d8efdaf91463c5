//! A depth attachment as a texture: the same memory, and the bounds of its packets beside it.

use super::texels::DepthStencilTexels;
use crate::layout::BLOCK;
use estampe_types::ShadowMap;
use std::sync::Arc;

/// A row of blocks whose bounds one worker finds.
#[derive(Debug)]
pub(crate) struct BoundsJob<'a> {
    depths: &'a [f32],
    bounds: &'a mut [u32],
}

impl BoundsJob<'_> {
    /// Finds the bounds.
    pub(crate) fn run(&mut self) {
        ShadowMap::bound(self.depths, self.bounds);
    }
}

impl DepthStencilTexels {
    /// The depths as a texture, its bounds found by `run_all`; `None` without depth or
    /// with several samples.
    pub(crate) fn depth_texture(
        &mut self,
        run_all: impl FnOnce(&mut [BoundsJob<'_>]),
    ) -> Option<ShadowMap> {
        if self.depth.is_empty() || self.size.samples != 1 {
            return None;
        }
        let (width, height) = (self.size.width, self.size.height);
        if Arc::get_mut(&mut self.depth_bounds).is_none() {
            self.depth_bounds = Arc::default();
        }
        // Not shared, as was just seen to.
        let bounds = Arc::make_mut(&mut self.depth_bounds);
        bounds.resize(ShadowMap::bounds_len(width, height), 0);
        let stride = ShadowMap::bounds_stride(width);
        let block = BLOCK as usize;
        let rows = self.depth.chunks_exact(stride * 4 * block);
        let mut jobs: Vec<BoundsJob<'_>> = rows
            .zip(bounds.chunks_exact_mut(stride * (block / 4)))
            .map(|(depths, bounds)| BoundsJob { depths, bounds })
            .collect();
        run_all(&mut jobs);
        let shared = (Arc::clone(&self.depth), Arc::clone(&self.depth_bounds));
        Some(ShadowMap::from_storage((width, height), shared.0, shared.1))
    }
}
