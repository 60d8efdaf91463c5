//! Draws: a pipeline, the data that it reads, and how much of it.

use crate::{
    BindGroup, Buffer, BufferError, BufferSlice, BufferUsages, IndexFormat, RenderPipeline,
};
use estampe_core::ViewportScissor;
use estampe_types::state::{ScissorRect, Viewport};
use std::ops::Range;

/// One draw: a pipeline, the data that it reads, and how much of it.
///
/// It borrows the handles of its objects, so that a function can return the draws of a scene that
/// owns them:
///
/// ```
/// use estampe::{BindGroup, BufferSlice, Draw, IndexFormat, RenderPipeline};
///
/// struct Object {
///     vertices: BufferSlice,
///     indices: BufferSlice,
///     count: u32,
///     groups: [BindGroup; 2],
/// }
///
/// fn draws<'a>(objects: &'a [Object], pipeline: &'a RenderPipeline) -> Vec<Draw<'a>> {
///     let draws = objects.iter().map(|object| Draw {
///         vertex_buffers: std::slice::from_ref(&object.vertices),
///         index_buffer: Some((&object.indices, IndexFormat::Uint32)),
///         bind_groups: &object.groups,
///         ..Draw::new(pipeline, 0..object.count)
///     });
///     draws.collect()
/// }
/// ```
#[derive(Debug, Clone)]
pub struct Draw<'a> {
    /// The validated state.
    pub pipeline: &'a RenderPipeline,
    /// The vertex buffers, one for each of the pipeline's layouts. Vertices beyond a buffer's end
    /// read zeros. Default none.
    pub vertex_buffers: &'a [BufferSlice],
    /// The index buffer and the width of its indices, if vertices are to be found by index. Indices
    /// beyond the buffer's end read zero. Default none.
    pub index_buffer: Option<(&'a BufferSlice, IndexFormat)>,
    /// The range of indices to draw, or of vertices if there is no index buffer.
    pub elements: Range<u32>,
    /// The range of instances to draw. Default one.
    pub instances: Range<u32>,
    /// Added to every index. Default 0.
    pub base_vertex: i32,
    /// The bind groups, by group number. Default none.
    pub bind_groups: &'a [BindGroup],
    /// The dynamic offsets in bytes, each a multiple of 4: those of the first group in the order of
    /// its binding numbers, then those of the next. Default none.
    pub dynamic_offsets: &'a [u32],
    /// The immediates (WebGPU's `setImmediates`, Vulkan's push constants): bytes that are part of
    /// the draw itself, as a uniform block without a buffer. A multiple of 4 bytes, at least as
    /// many as the pipeline's shaders read and at most
    /// [`max_immediate_size`](crate::Limits::max_immediate_size). Default none.
    ///
    /// ```
    /// use estampe::{ColorAttachment, Device, DeviceDescriptor, Draw, RenderPass};
    /// use estampe::{RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource};
    /// use estampe::{TextureDescriptor, TextureFormat, bytes_of};
    ///
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let module = device.create_shader_module(&ShaderModuleDescriptor::new(ShaderSource::Wgsl(
    ///     "struct Rect { at: vec2f, size: vec2f, color: vec4f }
    ///      var<immediate> rect: Rect;
    ///      @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    ///          let corner = vec2f(f32(i & 1u), f32(i >> 1u));
    ///          return vec4f(rect.at + corner * rect.size, 0.0, 1.0);
    ///      }
    ///      @fragment fn fs() -> @location(0) vec4f { return rect.color; }",
    /// )))?;
    /// let mut descriptor =
    ///     RenderPipelineDescriptor::with_program(device.create_program(&module.program())?);
    /// descriptor.depth_stencil = None;
    /// descriptor.primitive.topology = estampe::state::PrimitiveTopology::TriangleStrip;
    /// let pipeline = device.create_render_pipeline(&descriptor)?;
    /// let descriptor = TextureDescriptor::new_2d(8, 8, TextureFormat::Rgba8Unorm);
    /// let image = device.create_texture(&descriptor)?;
    /// let left = [-1.0_f32, -1.0, 1.0, 2.0, 1.0, 0.0, 0.0, 1.0];
    /// let right = [0.0_f32, -1.0, 1.0, 2.0, 0.0, 0.0, 1.0, 1.0];
    /// let draw = |rect| Draw {
    ///     immediates: bytes_of(rect),
    ///     ..Draw::new(&pipeline, 0..4)
    /// };
    /// device.render(&RenderPass {
    ///     color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
    ///     draws: &[draw(&left), draw(&right)],
    ///     ..RenderPass::default()
    /// })?;
    /// let texels = device.read_texture(&image)?;
    /// assert_eq!(texels[..4], [255, 0, 0, 255]);
    /// assert_eq!(texels[7 * 4..8 * 4], [0, 0, 255, 255]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub immediates: &'a [u8],
    /// The rectangle that NDC is mapped to, and the range of depths. Default the whole attachment,
    /// depth 0..1.
    pub viewport: Option<Viewport>,
    /// The rectangle of pixels that may change. Default all.
    pub scissor: Option<ScissorRect>,
    /// The viewports and scissors that a geometry shader's viewport index selects: 0 is that of
    /// `viewport` and `scissor`, i is number i − 1 of these. Default none.
    pub more_viewports: &'a [ViewportScissor],
    /// The constant of blending. Default zeros.
    pub blend_constant: [f32; 4],
    /// The stencil references of front-facing and back-facing primitives. Default zeros.
    pub stencil_reference: [u8; 2],
    /// The range, both ends included, in which the *stored* depth must lie for a sample to be drawn
    /// (Vulkan's depth-bounds test). Default none.
    pub depth_bounds: Option<[f32; 2]>,
    /// The index of the pass's counter to which the samples that pass all tests are added. Default
    /// none.
    pub occlusion_query: Option<u32>,
}

impl<'a> Draw<'a> {
    /// A draw of one instance without buffers, over the whole attachment.
    #[must_use]
    pub fn new(pipeline: &'a RenderPipeline, elements: Range<u32>) -> Self {
        Self {
            pipeline,
            vertex_buffers: &[],
            index_buffer: None,
            elements,
            instances: 0..1,
            base_vertex: 0,
            bind_groups: &[],
            dynamic_offsets: &[],
            immediates: &[],
            viewport: None,
            scissor: None,
            more_viewports: &[],
            blend_constant: [0.0; 4],
            stencil_reference: [0; 2],
            depth_bounds: None,
            occlusion_query: None,
        }
    }

    /// The most vertices of an indirect draw, counted over all instances: 2²⁷.
    pub const INDIRECT_LIMIT: u64 = estampe_core::Draw::INDIRECT_LIMIT as u64;

    /// A draw whose ranges are read from a buffer now, at an offset in bytes, as four 32-bit
    /// numbers (WebGPU's `drawIndirect`): the number of vertices, the number of instances, the
    /// first vertex, the first instance.
    ///
    /// Vertices beyond [`Draw::INDIRECT_LIMIT`], counted over all instances, are not drawn, so that
    /// no buffer keeps a program busy for hours.
    ///
    /// # Errors
    /// [`BufferError`] if the numbers are not in the buffer, or it has no
    /// [`BufferUsages::INDIRECT`].
    pub fn indirect(
        pipeline: &'a RenderPipeline,
        parameters: &Buffer,
        offset: u64,
    ) -> Result<Self, BufferError> {
        let [count, instances, first, first_instance] = words(parameters, offset)?;
        let draw =
            estampe_core::Draw::limited(pipeline, [first, count], [first_instance, instances]);
        Ok(Self {
            instances: draw.instances,
            ..Self::new(pipeline, draw.elements)
        })
    }

    /// A draw like [`Draw::indirect`] with an index buffer. The buffer holds five numbers (WebGPU's
    /// `drawIndexedIndirect`): the number of indices, the number of instances, the first index, the
    /// base vertex, the first instance.
    ///
    /// # Errors
    /// [`BufferError`] as for [`Draw::indirect`].
    pub fn indexed_indirect(
        pipeline: &'a RenderPipeline,
        index_buffer: (&'a BufferSlice, IndexFormat),
        parameters: &Buffer,
        offset: u64,
    ) -> Result<Self, BufferError> {
        let [count, instances, first, base, first_instance] = words(parameters, offset)?;
        let draw =
            estampe_core::Draw::limited(pipeline, [first, count], [first_instance, instances]);
        Ok(Self {
            index_buffer: Some(index_buffer),
            base_vertex: base.cast_signed(),
            instances: draw.instances,
            ..Self::new(pipeline, draw.elements)
        })
    }
}

fn words<const N: usize>(buffer: &Buffer, offset: u64) -> Result<[u32; N], BufferError> {
    buffer.require(BufferUsages::INDIRECT)?;
    let range = buffer.range(offset, 4 * N as u64)?;
    let data = buffer.lock();
    Ok(std::array::from_fn(|k| data.word_at(range.start + 4 * k)))
}
