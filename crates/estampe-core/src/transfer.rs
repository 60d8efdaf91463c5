//! Work on images outside of passes, on all threads: resolves, read-back, and the change between
//! storage order and row order.

use crate::attachment::resolve::ResolveJob;
use crate::attachment::resolve_depth::ResolveDepthJob;
use crate::attachment::{ColorTexels, DepthStencilTexels, ResolveMode};
use crate::draw::Context;
use estampe_types::ShadowMap;

impl Context {
    /// Writes the mean of each pixel's samples to an image of one sample, of the same width, height
    /// and format.
    pub fn resolve_color(&self, from: &ColorTexels, into: &mut ColorTexels) {
        let mut jobs: Vec<_> = ResolveJob::of_image(from, into).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// Resolves depth and stencil, each by its mode or not at all, to an image of one sample, of
    /// the same width, height and format.
    pub fn resolve_depth_stencil(
        &self,
        from: &DepthStencilTexels,
        into: &mut DepthStencilTexels,
        [depth, stencil]: [Option<ResolveMode>; 2],
    ) {
        let mut jobs = ResolveDepthJob::all(from, into, [depth, stencil]);
        self.executor()
            .for_each_alone(&mut jobs, ResolveDepthJob::run);
    }

    /// Fills rows with an image's texels in the format's own bytes, of several samples their mean.
    /// `bytes` must have width · height · the format's bytes.
    pub fn read_color_texels(&self, texels: &ColorTexels, bytes: &mut [u8]) {
        let mut jobs: Vec<_> = texels.byte_rows_jobs(bytes).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// Fills `rows` with a colour image in row order, which has
    /// [`row_order_words`](crate::attachment::row_order_words) words.
    pub fn color_to_rows(&self, texels: &ColorTexels, rows: &mut [u32]) {
        let mut jobs: Vec<_> = texels.row_jobs(rows).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// Fills a colour image from rows: the inverse of [`Context::color_to_rows`].
    pub fn rows_to_color(&self, rows: &[u32], texels: &mut ColorTexels) {
        let mut jobs: Vec<_> = texels.storage_jobs(rows).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// Fills `rows` with a depth and stencil image in row order, which has
    /// [`row_order_words`](crate::attachment::row_order_words) words.
    pub fn depth_stencil_to_rows(&self, texels: &DepthStencilTexels, rows: &mut [u32]) {
        let mut jobs: Vec<_> = texels.row_jobs(rows).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// Fills a depth and stencil image from rows: the inverse of
    /// [`Context::depth_stencil_to_rows`]. Depths are clamped to 0..=1, −0 stays, NaN becomes 0.
    pub fn rows_to_depth_stencil(&self, rows: &[u32], texels: &mut DepthStencilTexels) {
        let mut jobs: Vec<_> = texels.storage_jobs(rows).collect();
        let level = self.level();
        self.executor()
            .for_each_alone(&mut jobs, |job| job.run(level));
    }

    /// The depths of an image as a texture, without a copy; `None` without depth or with several
    /// samples.
    pub fn shadow_map_of(&self, texels: &mut DepthStencilTexels) -> Option<ShadowMap> {
        let level = self.level();
        texels.depth_texture(|jobs| self.executor().for_each_alone(jobs, |job| job.run(level)))
    }
}
