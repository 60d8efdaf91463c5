//! The device: threads, a SIMD level and limits. It creates pipelines and targets, and draws.

use crate::texture::{self, Sampler, TexelCopyLayout, Texture, TextureCopy, TextureDescriptor};
use crate::{
    BindGroup, BindGroupDescriptor, BindGroupError, BindGroupLayout, BindGroupLayoutEntry,
    BlitError, BlitRegion, Buffer, BufferDescriptor, BufferError, BufferUsages, Command, CopyError,
    Extent3d, FilterMode, Level, Limits, PipelineError, RenderPass, RenderPassError,
    RenderPipeline, RenderPipelineDescriptor, SampledTexture, SamplerDescriptor, Statistics,
    SubmitError, TextureError, TextureView, blit, command, copy, pass,
};
use estampe_core::Context;
use estampe_core::ThreadPool;
use estampe_core::profile::JobTimings;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Threads, SIMD level and limits of a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceDescriptor {
    /// Number of threads that draw. Default 0: one for each processor. The image does not depend on
    /// it.
    pub threads: usize,
    /// A pool whose threads draw, beside the caller; several devices may share it. Default none:
    /// the device starts [`threads`](Self::threads) of its own.
    pub pool: Option<Arc<ThreadPool>>,
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

/// Creates all objects, and draws. A call is done when it returns: there is nothing to wait for.
/// [`Device::submit`] takes a list of commands, and checks all of it first.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, Level};
///
/// // Every processor, the widest SIMD level; neither changes an image.
/// let device = Device::new(&DeviceDescriptor::default())?;
/// assert_eq!(device.level(), Level::best());
/// # Ok::<(), estampe::DeviceError>(())
/// ```
///
/// It is `Send + Sync`: share it by reference. Passes of several
/// threads are drawn side by side; those that use the same texture wait for each other.
#[derive(Debug)]
pub struct Device {
    context: Context,
    limits: Limits,
    created: Instant,
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
        let context = match &descriptor.pool {
            Some(pool) => Context::on_pool(Arc::clone(pool), descriptor.level),
            None => Context::new(descriptor.threads, descriptor.level)
                .map_err(|error| DeviceError::Threads(error.to_string()))?,
        };
        Ok(Self {
            context,
            limits: descriptor.limits.clone(),
            created: Instant::now(),
        })
    }

    /// A device for profiling: it draws on the calling thread alone and measures the time of each
    /// job.
    #[must_use]
    pub fn profiling(level: Level) -> Self {
        Self {
            context: Context::profiling(level),
            limits: Limits::default(),
            created: Instant::now(),
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

    /// Creates a buffer of zeros.
    ///
    /// # Errors
    /// [`BufferError`] if the size exceeds [`Limits::max_buffer_size`], or memory is short.
    pub fn create_buffer(&self, descriptor: &BufferDescriptor<'_>) -> Result<Buffer, BufferError> {
        Buffer::new(descriptor, &self.limits)
    }

    /// Creates a buffer with these bytes, for all uses; [`bytes_of`](crate::bytes_of) makes bytes
    /// of numbers.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Device::create_buffer`].
    pub fn create_buffer_with_contents(&self, contents: &[u8]) -> Result<Buffer, BufferError> {
        Buffer::with_contents(None, BufferUsages::all(), contents, &self.limits)
    }

    /// Creates a buffer of 32-bit words, for all uses, without a copy.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Device::create_buffer`].
    pub fn create_buffer_of_words(&self, words: Vec<u32>) -> Result<Buffer, BufferError> {
        Buffer::of_words(words, &self.limits)
    }

    /// Creates a texture of zeros, of a compressed format of blocks of zero bytes, which shaders
    /// sample as such blocks are decoded (BC1's are black, those of ASTC its error colour). Its
    /// memory is allocated when it is first used.
    ///
    /// # Errors
    /// [`TextureError`] names the rule or limit that the descriptor breaks.
    pub fn create_texture(
        &self,
        descriptor: &TextureDescriptor<'_>,
    ) -> Result<Texture, TextureError> {
        Texture::new(descriptor, &self.limits)
    }

    /// Creates a texture from the bytes of its first mip levels, each without padding: layer after
    /// layer, row after row from the top. The other levels are generated, as by
    /// [`Device::generate_mips`]; those of compressed formats must all be given.
    ///
    /// # Errors
    /// [`TextureError`] names the rule or limit that the descriptor breaks, or the level with
    /// another number of bytes.
    pub fn create_texture_with_data(
        &self,
        descriptor: &TextureDescriptor<'_>,
        levels: &[&[u8]],
    ) -> Result<Texture, TextureError> {
        Texture::with_data(descriptor, levels, &self.limits)
    }

    /// Creates a sampler.
    ///
    /// # Errors
    /// [`TextureError`] names the rule that the descriptor breaks.
    pub fn create_sampler(&self, descriptor: &SamplerDescriptor) -> Result<Sampler, TextureError> {
        Sampler::new(descriptor)
    }

    /// Creates the layout of bind groups. Layouts with the same entries are compatible.
    ///
    /// # Errors
    /// [`BindGroupError`] if two entries have the same binding number, or there are too many.
    pub fn create_bind_group_layout(
        &self,
        entries: &[BindGroupLayoutEntry],
    ) -> Result<BindGroupLayout, BindGroupError> {
        crate::bind_group::create_layout(entries, &self.limits)
    }

    /// Creates a bind group.
    ///
    /// # Errors
    /// [`BindGroupError`] names the binding that does not fit the layout, and both sides.
    pub fn create_bind_group(
        &self,
        descriptor: &BindGroupDescriptor<'_>,
    ) -> Result<BindGroup, BindGroupError> {
        BindGroup::new(descriptor, &self.limits)
    }

    /// Draws a pass.
    ///
    /// # Errors
    /// [`RenderPassError`] names the pass, the attachment or draw that does not fit, and both
    /// sides; nothing is drawn or cleared then.
    pub fn render(&self, pass: &RenderPass<'_>) -> Result<Statistics, RenderPassError> {
        pass::render(self, pass)
    }

    /// Runs commands in order, after all of them were checked. Returns the sum of the passes'
    /// statistics.
    ///
    /// ```
    /// use estampe::{ColorAttachment, Command, Device, DeviceDescriptor, RenderPass};
    /// use estampe::{TextureDescriptor, TextureFormat};
    ///
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let descriptor = TextureDescriptor::new_2d(8, 8, TextureFormat::Rgba8Unorm);
    /// let image = device.create_texture(&descriptor.with_all_levels())?;
    /// let base = image.image(0, 0)?;
    /// let attachments = [Some(ColorAttachment::clear(&base, [0.0, 1.0, 0.0, 1.0]))];
    /// device.submit(&[
    ///     Command::Render(RenderPass {
    ///         color_attachments: &attachments,
    ///         ..RenderPass::default()
    ///     }),
    ///     Command::GenerateMips(&image),
    /// ])?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SubmitError`] names the command and the reason. If the check fails, nothing has been done;
    /// a command can fail later only for want of memory, or if a pass is cancelled: those before it
    /// are done then.
    pub fn submit(&self, commands: &[Command<'_>]) -> Result<Statistics, SubmitError> {
        command::submit(self, commands)
    }

    /// Writes texels from the host's bytes (WebGPU's `writeTexture`).
    ///
    /// # Errors
    /// [`TextureError`] if the region is not in the texture, the bytes do not hold it, or the
    /// texture has no [`TextureUsages::COPY_DST`](crate::TextureUsages).
    pub fn write_texture<'t>(
        &self,
        to: impl Into<TextureCopy<'t>>,
        bytes: &[u8],
        layout: &TexelCopyLayout,
        size: Extent3d,
    ) -> Result<(), TextureError> {
        let to = to.into();
        let _reserved = to.texture.reserve();
        texture::write(&self.context, &to, bytes, layout, size)
    }

    /// Reads the first mip level and layer of a texture as rows of the format's own bytes, from the
    /// top, without padding.
    ///
    /// # Errors
    /// [`TextureError`] as for [`Device::read_texture_into`].
    pub fn read_texture(&self, texture: &Texture) -> Result<Vec<u8>, TextureError> {
        let size = Extent3d::new_2d(texture.width(), texture.height());
        let len = texture::tight_len(&texture.into(), size);
        let mut bytes = vec![0; usize::try_from(len).unwrap_or(usize::MAX)];
        self.read_texture_into(texture, &mut bytes, &TexelCopyLayout::default(), size)?;
        Ok(bytes)
    }

    /// Reads one sample of each texel of a view of one level of one layer, as rows of the format's
    /// own bytes without padding; of one aspect of a depth-stencil format four bytes of depth (two
    /// of 16 bits), one of stencil.
    ///
    /// # Errors
    /// [`TextureError`] if the view has several levels or layers, or the texture does not have the
    /// sample or [`TextureUsages::COPY_SRC`](crate::TextureUsages).
    pub fn read_sample(&self, view: &TextureView, sample: u32) -> Result<Vec<u8>, TextureError> {
        let _reserved = view.texture().reserve();
        texture::read_sample(&self.context, view, sample)
    }

    /// Reads texels into the host's bytes. Memory that is used again is filled several times as
    /// fast as new memory, whose pages the system first has to map.
    ///
    /// # Errors
    /// [`TextureError`] if the region is not in the texture, the bytes do not hold it, or the
    /// texture has several samples or no [`TextureUsages::COPY_SRC`](crate::TextureUsages).
    pub fn read_texture_into<'t>(
        &self,
        from: impl Into<TextureCopy<'t>>,
        bytes: &mut [u8],
        layout: &TexelCopyLayout,
        size: Extent3d,
    ) -> Result<(), TextureError> {
        let from = from.into();
        let _reserved = from.texture.reserve();
        texture::read(&self.context, &from, bytes, layout, size)
    }

    /// Copies bytes between buffers, or inside one.
    ///
    /// # Errors
    /// [`CopyError`] if a range ends beyond its buffer, or a buffer lacks the usage.
    pub fn copy_buffer_to_buffer(
        &self,
        (from, from_offset): (&Buffer, u64),
        (into, into_offset): (&Buffer, u64),
        size: u64,
    ) -> Result<(), CopyError> {
        copy::buffer_to_buffer((from, from_offset), (into, into_offset), size)
    }

    /// Copies texels out of a buffer.
    ///
    /// # Errors
    /// [`CopyError`] if the region is not in the texture, the buffer does not hold it, or one of
    /// them lacks the usage.
    pub fn copy_buffer_to_texture<'t>(
        &self,
        from: (&Buffer, &TexelCopyLayout),
        into: impl Into<TextureCopy<'t>>,
        size: Extent3d,
    ) -> Result<(), CopyError> {
        copy::buffer_to_texture(&self.context, from, &into.into(), size)
    }

    /// Copies texels into a buffer.
    ///
    /// # Errors
    /// [`CopyError`] as for [`Device::copy_buffer_to_texture`].
    pub fn copy_texture_to_buffer<'t>(
        &self,
        from: impl Into<TextureCopy<'t>>,
        into: (&Buffer, &TexelCopyLayout),
        size: Extent3d,
    ) -> Result<(), CopyError> {
        copy::texture_to_buffer(&self.context, &from.into(), into, size)
    }

    /// Copies texels between textures whose formats differ at most in sRGB, or inside one. Codes
    /// are copied, not colours.
    ///
    /// # Errors
    /// [`CopyError`] if the formats differ, a region is not in its texture, or a texture lacks the
    /// usage.
    pub fn copy_texture_to_texture<'t, 'u>(
        &self,
        from: impl Into<TextureCopy<'t>>,
        into: impl Into<TextureCopy<'u>>,
        size: Extent3d,
    ) -> Result<(), CopyError> {
        copy::texture_to_texture(&self.context, &from.into(), &into.into(), size)
    }

    /// Sets bytes of a buffer to zero.
    ///
    /// # Errors
    /// [`CopyError`] if the range ends beyond the buffer, or it has no
    /// [`BufferUsages::COPY_DST`].
    pub fn clear_buffer(&self, buffer: &Buffer, offset: u64, size: u64) -> Result<(), CopyError> {
        copy::clear_buffer(buffer, offset, size)
    }

    /// Sets all texels of a view to zero, compressed ones to blocks of zero bytes. A pass clears to
    /// other values.
    ///
    /// # Errors
    /// [`TextureError`] if the texture has no [`TextureUsages::COPY_DST`](crate::TextureUsages).
    pub fn clear_texture(&self, view: &TextureView) -> Result<(), TextureError> {
        copy::clear_texture(&self.context, view)
    }

    /// Makes each mip level of a texture from the one above, from level 1 on. A side is halved and
    /// rounded down; a texel is the mean of the 2×2 texels above it (2×2×2 of 3D textures), linear
    /// for sRGB; the last row or column of an odd side is left out.
    ///
    /// # Errors
    /// [`TextureError`] if the format cannot be filtered, or memory is short.
    pub fn generate_mips(&self, texture: &Texture) -> Result<(), TextureError> {
        copy::generate_mips(&self.context, texture)
    }

    /// Copies a rectangle of an image into a rectangle of another one, scaled, filtered and
    /// converted to its format (Vulkan's `vkCmdBlitImage`).
    ///
    /// # Errors
    /// [`BlitError`] if a rectangle is empty or not in its image, the source cannot be sampled with
    /// the filter, or the destination cannot be rendered to.
    pub fn blit<'v, 'w>(
        &self,
        from: impl Into<BlitRegion<'v>>,
        into: impl Into<BlitRegion<'w>>,
        filter: FilterMode,
    ) -> Result<(), BlitError> {
        blit::blit(self, &from.into(), &into.into(), filter)
    }

    /// The texels of a view as they are now, with a sampler: for a shader that owns its textures.
    /// Later changes of the texture do not reach it; while it lives, they are made in a copy.
    ///
    /// # Errors
    /// [`TextureError`] if the sampler cannot sample the view, or memory is short.
    pub fn sampled_texture(
        &self,
        view: &TextureView,
        sampler: &Sampler,
    ) -> Result<SampledTexture, TextureError> {
        view.texture()
            .require(crate::TextureUsages::TEXTURE_BINDING)?;
        let _reserved = view.texture().reserve();
        texture::sampled_texture(&self.context, view, sampler)
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

    /// The time since the device was created: the clock of
    /// [timestamps](crate::RangeResult::begin).
    #[must_use]
    pub fn age(&self) -> Duration {
        self.created.elapsed()
    }

    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    /// The largest sizes of resources and pipelines.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }
}
