//! The device: threads, a SIMD level and limits. It creates pipelines and targets, and draws.

use crate::{
    DepthTexture, Draw, Level, Limits, PipelineError, ReadbackError, RenderPass, RenderPassError,
    RenderPipeline, RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, ResolveError,
    Statistics, TargetError,
};
use estampe_core::Context;
use estampe_core::profile::JobTimings;

/// Threads, SIMD level and limits of a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceDescriptor {
    /// Number of threads that draw. Default 0: one for each processor. The image does not depend on
    /// it.
    pub threads: usize,
    /// SIMD level of the kernels. Default the widest that the processor supports. The image does
    /// not depend on it.
    pub level: Level,
    /// The largest sizes of resources and pipelines.
    pub limits: Limits,
}

/// Errors of [`Device::new`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// More than 1024 threads were requested.
    #[error("{0} threads: at most 1024 are possible")]
    TooManyThreads(usize),
    /// The system could not start the threads.
    #[error("the system gives no threads: {0}")]
    Threads(String),
}

/// Creates pipelines and targets, and draws. It is `Send + Sync`: share it by reference.
#[derive(Debug)]
pub struct Device {
    context: Context,
    limits: Limits,
}

impl Device {
    /// Creates a device.
    ///
    /// # Errors
    /// [`DeviceError`] if too many threads are requested, or the system cannot start them.
    pub fn new(descriptor: &DeviceDescriptor) -> Result<Self, DeviceError> {
        if descriptor.threads > 1024 {
            return Err(DeviceError::TooManyThreads(descriptor.threads));
        }
        let context = Context::new(descriptor.threads, descriptor.level)
            .map_err(|error| DeviceError::Threads(error.to_string()))?;
        Ok(Self {
            context,
            limits: descriptor.limits.clone(),
        })
    }

    /// A device for profiling: it draws on the calling thread alone and measures the time of each
    /// job.
    #[must_use]
    pub fn profiling(level: Level) -> Self {
        Self {
            context: Context::profiling(level),
            limits: Limits::default(),
        }
    }

    /// The times of all jobs since the last call. Empty unless the device was created by
    /// [`Device::profiling`].
    #[must_use]
    pub fn take_timings(&self) -> Vec<JobTimings> {
        self.context.take_timings()
    }

    /// Creates a pipeline. The descriptor is checked here, so that drawing cannot fail.
    ///
    /// # Errors
    /// [`PipelineError`] names the rule that the descriptor breaks.
    pub fn create_render_pipeline(
        &self,
        descriptor: &RenderPipelineDescriptor,
    ) -> Result<RenderPipeline, PipelineError> {
        RenderPipeline::new(descriptor, &self.limits)
    }

    /// Creates a render target.
    ///
    /// # Errors
    /// [`TargetError`] names the rule that the descriptor breaks, or reports that memory is short.
    pub fn create_render_target(
        &self,
        descriptor: &RenderTargetDescriptor,
    ) -> Result<RenderTarget, TargetError> {
        RenderTarget::new(descriptor, &self.limits)
    }

    /// Draws a pass into a target. Resources that a draw does not bind read as zeros.
    ///
    /// # Errors
    /// [`RenderPassError`] names the draw that does not fit the target (samples, formats, depth,
    /// stencil, viewport, occlusion query) and both sides; nothing is drawn or cleared then.
    pub fn render(
        &self,
        target: &mut RenderTarget,
        pass: &RenderPass<'_>,
    ) -> Result<Statistics, RenderPassError> {
        self.context.render(target, pass)
    }

    /// Draws a pass that first clears the target: colours to transparent black, depth to 1, stencil
    /// to 0. A second call therefore shows only its own draws; use [`Device::render`] to keep the
    /// contents.
    ///
    /// # Errors
    /// [`RenderPassError`], as of [`Device::render`].
    pub fn draw(
        &self,
        target: &mut RenderTarget,
        draws: &[Draw<'_>],
    ) -> Result<Statistics, RenderPassError> {
        self.render(
            target,
            &RenderPass {
                draws,
                ..RenderPass::default()
            },
        )
    }

    /// Multisample resolve: writes the mean of each pixel's samples to a target with one sample, of
    /// the same size and colour formats. Depth is not resolved.
    ///
    /// # Errors
    /// [`ResolveError`] names what the targets differ in; nothing is written then.
    pub fn resolve(
        &self,
        from: &RenderTarget,
        into: &mut RenderTarget,
    ) -> Result<(), ResolveError> {
        self.context.resolve(from, into)
    }

    /// A colour attachment's texels in the format's own bytes, row by row from the top; several
    /// samples are resolved to their mean. It equals [`RenderTarget::read_color`], but uses all of
    /// the device's threads. Empty if the target has no attachment `index`.
    #[must_use]
    pub fn read_color(&self, target: &RenderTarget, index: usize) -> Vec<u8> {
        let mut image = vec![0; target.color_len_bytes(index)];
        match self.read_color_into(target, index, &mut image) {
            Ok(()) => image,
            Err(_) => Vec::new(),
        }
    }

    /// [`Device::read_color`] into memory of [`RenderTarget::color_len_bytes`] bytes. Reused memory
    /// is written several times as fast as new memory, whose pages the system first has to map.
    ///
    /// # Errors
    /// [`ReadbackError`] if the target has no attachment `index`, or the memory has another length;
    /// nothing is written then.
    pub fn read_color_into(
        &self,
        target: &RenderTarget,
        index: usize,
        image: &mut [u8],
    ) -> Result<(), ReadbackError> {
        self.context.read_color_into(target, index, image)
    }

    /// The target's depth as a texture for comparisons in shaders, such as a shadow map. `None` if
    /// the target has no depth or several samples. The texture shares the target's memory: drop it,
    /// and bind groups that hold it, before the target is drawn again, or that draws into a copy.
    #[must_use]
    pub fn depth_texture(&self, target: &mut RenderTarget) -> Option<DepthTexture> {
        self.context.depth_texture(target)
    }

    /// The SIMD level of the kernels.
    #[must_use]
    pub fn level(&self) -> Level {
        self.context.level()
    }

    /// The number of threads that draw.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.context.threads()
    }

    /// The largest sizes of resources and pipelines.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }
}
