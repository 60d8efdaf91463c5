//! The device: threads, a SIMD level and limits; it makes and draws everything.

use crate::{
    DepthTexture, Draw, Level, Limits, PipelineError, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, Statistics, TargetError,
};
use estampe_core::Context;
use estampe_core::recording::Phase;

/// What a device is made of.
#[derive(Debug, Clone, Default)]
pub struct DeviceDescriptor {
    /// How many threads draw. Default 0: one for each processor. The image does not depend on it.
    pub threads: usize,
    /// The SIMD level of the kernels. Default the widest that the processor has. The image does not
    /// depend on it.
    pub level: Level,
    /// How large things may be.
    pub limits: Limits,
}

/// Why there is no device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// More threads than make sense.
    #[error("{0} threads: at most 1024 are possible")]
    TooManyThreads(usize),
    /// The system gives no threads.
    #[error("the system gives no threads: {0}")]
    Threads(String),
}

/// Makes pipelines and targets, and draws. It is `Send + Sync`: share it by reference.
#[derive(Debug)]
pub struct Device {
    context: Context,
    limits: Limits,
}

impl Device {
    /// Makes a device.
    ///
    /// # Errors
    /// [`DeviceError`] when the system gives no threads.
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

    /// A device for those who measure: it draws on the calling thread alone and notes what each job took.
    #[must_use]
    pub fn recording(level: Level) -> Self {
        Self {
            context: Context::recording(level),
            limits: Limits::default(),
        }
    }

    /// What each job took since the last call; nothing unless the device is one that
    /// [records](Device::recording).
    #[must_use]
    pub fn take_phases(&self) -> Vec<Phase> {
        self.context.take_phases()
    }

    /// Makes a pipeline: checks the descriptor once, so that drawing cannot fail.
    ///
    /// # Errors
    /// [`PipelineError`] names the rule that the descriptor breaks.
    pub fn create_render_pipeline(
        &self,
        descriptor: &RenderPipelineDescriptor,
    ) -> Result<RenderPipeline, PipelineError> {
        RenderPipeline::new(descriptor, &self.limits)
    }

    /// Makes a render target.
    ///
    /// # Errors
    /// [`TargetError`] names the rule that the descriptor breaks, or that memory is short.
    pub fn create_render_target(
        &self,
        descriptor: &RenderTargetDescriptor,
    ) -> Result<RenderTarget, TargetError> {
        RenderTarget::new(descriptor, &self.limits)
    }

    /// Draws a pass into a target. It cannot fail: what a draw lacks reads as zeros, and a draw whose
    /// pipeline does not fit the target (samples, formats, depth) draws nothing.
    pub fn render(&self, target: &mut RenderTarget, pass: &RenderPass<'_>) -> Statistics {
        self.context.render(target, pass)
    }

    /// Clears a target to black and depth 1, and draws: the short way.
    pub fn draw(&self, target: &mut RenderTarget, draws: &[Draw<'_>]) -> Statistics {
        self.render(
            target,
            &RenderPass {
                draws,
                ..RenderPass::default()
            },
        )
    }

    /// Resolves: writes the mean of each pixel's samples to a target of one sample. The targets have the
    /// same size and colour formats; others are left alone. Depth is not resolved.
    pub fn resolve(&self, from: &RenderTarget, into: &mut RenderTarget) {
        self.context.resolve(from, into);
    }

    /// The target's depth as a texture that shaders compare with, such as a shadow map; `None` without
    /// depth or with several samples. It shares the target's memory: drop it, and bind groups that hold it,
    /// before the target is drawn again, or that will draw into a copy.
    #[must_use]
    pub fn depth_texture(&self, target: &mut RenderTarget) -> Option<DepthTexture> {
        self.context.depth_texture(target)
    }

    /// The SIMD level of the kernels.
    #[must_use]
    pub fn level(&self) -> Level {
        self.context.level()
    }

    /// How many threads draw.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.context.threads()
    }

    /// How large things may be.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }
}
