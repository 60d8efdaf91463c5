//! What a device does with objects: passes, copies, clears, mip levels, blits.

use super::Device;
use crate::texture::{self, TexelCopyLayout, Texture, TextureCopy};
use crate::{
    BlitError, BlitRegion, Buffer, Command, CopyError, Dispatch, DispatchError, Extent3d,
    FilterMode, InspectError, PassStages, PixelHistory, RenderPass, RenderPassError, Statistics,
    SubmitError, TextureError, TextureView, blit, command, compute, copy, inspect, pass,
};

impl Device {
    /// Draws a pass.
    ///
    /// # Errors
    /// [`RenderPassError`] names the pass, the attachment or draw that does not fit, and both
    /// sides; nothing is drawn or cleared then.
    pub fn render(&self, pass: &RenderPass<'_>) -> Result<Statistics, RenderPassError> {
        pass::render(self, pass)
    }

    /// The history of one pixel (column and row, from the top left) in a pass: every primitive that
    /// covers it, with its vertices, edge functions, depth and varyings as interpolated, the
    /// shader's result, the outcome of each sample's tests, and the stored values before and after.
    ///
    /// The pass is run with the reference pipeline, one primitive after the other. The history ends
    /// with the pixel that [`render`](Self::render) draws, bit for bit; nothing is drawn or stored.
    /// It takes about a microsecond for each vertex that a primitive names.
    ///
    /// ```
    /// use estampe::{ColorAttachment, Device, DeviceDescriptor, RenderPass};
    /// use estampe::{TextureDescriptor, TextureFormat};
    ///
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let descriptor = TextureDescriptor::new_2d(4, 4, TextureFormat::Rgba8Unorm);
    /// let image = device.create_texture(&descriptor)?;
    /// let pass = RenderPass {
    ///     color_attachments: &[Some(ColorAttachment::clear(&image.view(), [1.0, 0.5, 0.0, 1.0]))],
    ///     ..RenderPass::default()
    /// };
    /// let history = device.inspect(&pass, [2, 3])?;
    /// assert!(history.primitives.is_empty());
    /// assert_eq!(history.texels, [Some(vec![255, 128, 0, 255])]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`InspectError`] if the pass does not fit, as of [`render`](Self::render); if the pixel lies
    /// outside; or if shaders store, so that all pixels are drawn, and these are too many.
    pub fn inspect(
        &self,
        pass: &RenderPass<'_>,
        pixel: [u32; 2],
    ) -> Result<PixelHistory, InspectError> {
        self.inspect_layer(pass, pixel, 0)
    }

    /// Everything that happens to one pixel of one layer, in a pass whose attachments are views of
    /// several layers: see [`inspect`](Self::inspect), which is that of layer 0.
    ///
    /// # Errors
    /// [`InspectError`] as of [`inspect`](Self::inspect), or if there is no such layer.
    pub fn inspect_layer(
        &self,
        pass: &RenderPass<'_>,
        pixel: [u32; 2],
        layer: u32,
    ) -> Result<PixelHistory, InspectError> {
        inspect::inspect(self, pass, pixel, layer)
    }

    /// What each stage of the pipeline makes of a pass: the vertices after the vertex shader, what
    /// clipping leaves of the primitives, the tiles that the pieces are binned to, counts of what
    /// covers, is shaded at, fails at and is stored to each pixel, the blocks that hierarchical z
    /// rejects, and the depths.
    ///
    /// The pass is run with the reference pipeline over all pixels, in bands on the device's
    /// threads; the result does not depend on their number, and nothing is drawn or stored. A pass
    /// whose shaders store is run by one thread. It takes about a microsecond for each covered
    /// pixel of a primitive, and for each vertex that a primitive names and each thread.
    ///
    /// ```
    /// use estampe::{ColorAttachment, Device, DeviceDescriptor, RenderPass};
    /// use estampe::{TextureDescriptor, TextureFormat};
    ///
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let descriptor = TextureDescriptor::new_2d(100, 70, TextureFormat::Rgba8Unorm);
    /// let image = device.create_texture(&descriptor)?;
    /// let pass = RenderPass {
    ///     color_attachments: &[Some(ColorAttachment::clear(&image.view(), [1.0, 0.5, 0.0, 1.0]))],
    ///     ..RenderPass::default()
    /// };
    /// let stages = device.inspect_stages(&pass)?;
    /// assert!(stages.pieces.is_empty());
    /// assert_eq!((stages.tile_side, stages.tile_columns_rows()), (64, [2, 2]));
    /// assert_eq!(stages.pixel([99, 69]).map(|pixel| pixel.covered), Some(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`InspectError`] if the pass does not fit, as of [`render`](Self::render), or if pixels and
    /// primitives need more than a gigabyte.
    pub fn inspect_stages(&self, pass: &RenderPass<'_>) -> Result<PassStages, InspectError> {
        inspect::inspect_stages(self, pass)
    }

    /// Runs work-groups of a compute shader. The results do not depend on threads: work-groups
    /// whose [order](crate::ComputeProgram::order) could be seen run one after the other.
    ///
    /// # Errors
    /// [`DispatchError`] names the rule that the dispatch breaks; nothing has run then. If it is
    /// [stopped](crate::DispatchErrorKind::Stopped), what was stored until then stays.
    pub fn dispatch(&self, dispatch: &Dispatch<'_>) -> Result<(), DispatchError> {
        compute::dispatch(self, dispatch)
    }

    /// Runs commands in order, after all of them were checked. Returns the sum of the passes'
    /// statistics.
    ///
    /// Small passes that follow one another are drawn side by side, one on each thread, if none
    /// changes a texture that another uses, their shaders store nothing, and they have no queries
    /// and no [control](RenderPass::control). They draw what they draw one after the other.
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
    /// a command can fail later only for want of memory, if a pass is cancelled, if a dispatch is
    /// stopped, or if a buffer asks for too many work-groups: those before it are done then, and of
    /// passes that are drawn side by side with it also others.
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
        let _reserved = texture.reserve();
        texture::read_tight(&self.context, &texture.into(), size)
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
    /// are copied, not colours. Of multisampled textures whole images are copied, to one with as
    /// many samples.
    ///
    /// # Errors
    /// [`CopyError`] if the formats or samples differ, a region is not in its texture or a part of
    /// a multisampled image, or a texture lacks the usage.
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
    /// [`BufferUsages::COPY_DST`](crate::BufferUsages).
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
}
