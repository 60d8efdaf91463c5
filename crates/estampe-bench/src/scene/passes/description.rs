//! The description of a frame of several steps: plain data.

use crate::frame::FrameSize;
use estampe::state::{
    BlendState, ColorWrites, DepthStencilState, PrimitiveState, PrimitiveTopology, ScissorRect,
    VertexBufferLayout,
};
use estampe::{FilterMode, SamplerDescriptor, TextureFormat, ViewDimension};
use std::ops::Range;

/// The number of the image that a frame shows, which has one sample per pixel.
pub const PICTURE: usize = 0;

/// What a frame of several steps does. All bindings are in group 0.
#[derive(Debug, Clone)]
pub struct Frame {
    /// The WGSL module of all pipelines and dispatches.
    pub text: &'static str,
    /// The format of each of the scene's textures, and the dimension of its view.
    pub textures: Vec<(TextureFormat, ViewDimension)>,
    /// What passes draw into and dispatches write; number [`PICTURE`] is shown.
    pub images: Vec<FrameImage>,
    /// The render pipelines.
    pub pipelines: Vec<FramePipeline>,
    /// Passes and dispatches, in order.
    pub steps: Vec<Step>,
}

/// An image of one mip level and one layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameImage {
    /// The format of its texels.
    pub format: TextureFormat,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
}

/// A binding of group 0; its number is its place in the list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Binding {
    /// A whole uniform buffer.
    Uniform(usize),
    /// So many bytes of a uniform buffer, from the draw's dynamic offset on.
    UniformAtOffset(usize, u64),
    /// A whole storage buffer that is read.
    StorageRead(usize),
    /// A whole storage buffer that is read and written.
    Storage(usize),
    /// A texture of the scene.
    Texture(usize),
    /// A sampler.
    Sampler(SamplerDescriptor),
    /// An image that an earlier step wrote, sampled or loaded; of depth formats as a depth texture.
    Image(usize),
    /// An image as a storage texture that is written.
    StorageImage(usize),
}

impl Binding {
    /// A sampler that filters linearly within and between mip levels, clamped to the edge.
    #[must_use]
    pub fn trilinear_clamp() -> Self {
        Self::Sampler(SamplerDescriptor {
            mipmap_filter: FilterMode::Linear,
            ..SamplerDescriptor::linear()
        })
    }
}

/// A render pipeline. Formats and samples are those of the pass in which it is used.
#[derive(Debug, Clone)]
pub struct FramePipeline {
    /// The entry point of vertices. Default `vertex`.
    pub vertex: &'static str,
    /// The entry point of fragments. Default `fragment`.
    pub fragment: &'static str,
    /// The layouts of the vertex buffers. Default none.
    pub vertex_buffers: Vec<VertexBufferLayout>,
    /// Topology and culling. Default triangle lists without culling.
    pub primitive: PrimitiveState,
    /// The tests; without effect in passes without a depth image. Default less, written.
    pub depth_stencil: DepthStencilState,
    /// Blending of all targets. Default none.
    pub blend: Option<BlendState>,
    /// The channels of all targets that are written. Default all.
    pub write_mask: ColorWrites,
    /// If set, alpha becomes a mask of samples. Default not.
    pub alpha_to_coverage: bool,
    /// What the shaders bind. Default nothing.
    pub bindings: Vec<Binding>,
}

impl Default for FramePipeline {
    fn default() -> Self {
        Self {
            vertex: "vertex",
            fragment: "fragment",
            vertex_buffers: Vec::new(),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::LESS_WRITE,
            blend: None,
            write_mask: ColorWrites::ALL,
            alpha_to_coverage: false,
            bindings: Vec::new(),
        }
    }
}

/// A step of a frame.
#[derive(Debug, Clone)]
pub enum Step {
    /// A render pass.
    Pass(Pass),
    /// A dispatch.
    Dispatch(ComputeStep),
}

/// A render pass; all its images have the same size and samples.
#[derive(Debug, Clone)]
pub struct Pass {
    /// The colour attachments.
    pub colors: Vec<ColorTarget>,
    /// The depth attachment, cleared to 1, and its stencil to 0.
    pub depth: Option<usize>,
    /// The draws, in order.
    pub draws: Vec<FrameDraw>,
}

/// A colour attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorTarget {
    /// The image.
    pub image: usize,
    /// The colour to which it is cleared; `None` keeps its contents.
    pub clear: Option<[f64; 4]>,
    /// The image of one sample into which the samples are resolved at the end.
    pub resolve: Option<usize>,
}

impl ColorTarget {
    /// An image that is cleared.
    #[must_use]
    pub fn cleared(image: usize, color: [f64; 4]) -> Self {
        Self {
            image,
            clear: Some(color),
            resolve: None,
        }
    }
}

/// A draw.
#[derive(Debug, Clone)]
pub struct FrameDraw {
    /// The pipeline.
    pub pipeline: usize,
    /// The vertex buffers, one for each of the pipeline's layouts.
    pub vertices: Vec<usize>,
    /// The buffer of 32-bit indices.
    pub indices: Option<usize>,
    /// The indices, or the vertices of a draw without them.
    pub elements: Range<u32>,
    /// The number of instances.
    pub instances: u32,
    /// Offset in bytes of [`Binding::UniformAtOffset`].
    pub dynamic_offset: Option<u32>,
    /// The pixels that may change; `None` is all.
    pub scissor: Option<ScissorRect>,
}

impl FrameDraw {
    /// One instance of vertices 0 to `count` without buffers.
    #[must_use]
    pub fn without_buffers(pipeline: usize, count: u32) -> Self {
        Self {
            pipeline,
            vertices: Vec::new(),
            indices: None,
            elements: 0..count,
            instances: 1,
            dynamic_offset: None,
            scissor: None,
        }
    }

    /// One instance of indices 0 to `count`.
    #[must_use]
    pub fn indexed(pipeline: usize, vertices: usize, indices: usize, count: u32) -> Self {
        Self {
            vertices: vec![vertices],
            indices: Some(indices),
            ..Self::without_buffers(pipeline, count)
        }
    }
}

/// A dispatch.
#[derive(Debug, Clone)]
pub struct ComputeStep {
    /// The entry point.
    pub entry_point: &'static str,
    /// What it binds.
    pub bindings: Vec<Binding>,
    /// The number of work-groups along x, y and z.
    pub workgroups: [u32; 3],
}

impl Frame {
    /// A frame without steps, whose picture has a format.
    #[must_use]
    pub fn new(size: FrameSize, format: TextureFormat, text: &'static str) -> Self {
        let mut frame = Self {
            text,
            textures: Vec::new(),
            images: Vec::new(),
            pipelines: Vec::new(),
            steps: Vec::new(),
        };
        frame.image(format, [size.width, size.height]);
        frame
    }

    /// Adds an image of one sample; returns its number.
    pub fn image(&mut self, format: TextureFormat, size: [u32; 2]) -> usize {
        self.images.push(FrameImage {
            format,
            size,
            samples: 1,
        });
        self.images.len() - 1
    }

    /// Adds a pipeline; returns its number.
    pub fn pipeline(&mut self, pipeline: FramePipeline) -> usize {
        self.pipelines.push(pipeline);
        self.pipelines.len() - 1
    }

    /// Adds a pass in which a pipeline draws one triangle, of three vertices without buffers, over
    /// an image that is cleared to zeros, or kept if the pipeline blends.
    pub fn screen_pass(&mut self, pipeline: usize, image: usize) {
        let blends = self.pipelines[pipeline].blend.is_some();
        self.steps.push(Step::Pass(Pass {
            colors: vec![ColorTarget {
                clear: (!blends).then_some([0.0; 4]),
                ..ColorTarget::cleared(image, [0.0; 4])
            }],
            depth: None,
            draws: vec![FrameDraw::without_buffers(pipeline, 3)],
        }));
    }

    /// Adds the pass of most scenes: into the picture and a depth image, both cleared; of several
    /// samples into an image that is resolved into the picture.
    pub fn picture_pass(
        &mut self,
        samples: u32,
        depth: TextureFormat,
        clear: [f64; 4],
        draws: Vec<FrameDraw>,
    ) {
        let FrameImage { format, size, .. } = self.images[PICTURE];
        let (image, resolve) = match samples {
            1 => (PICTURE, None),
            _ => (self.image(format, size), Some(PICTURE)),
        };
        let depth = self.image(depth, size);
        self.images[image].samples = samples;
        self.images[depth].samples = samples;
        self.steps.push(Step::Pass(Pass {
            colors: vec![ColorTarget {
                resolve,
                ..ColorTarget::cleared(image, clear)
            }],
            depth: Some(depth),
            draws,
        }));
    }

    /// The number of triangles that the passes submit.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        let of_draw = |draw: &FrameDraw| {
            let count = u64::from(draw.elements.end - draw.elements.start);
            let triangles = match self.pipelines[draw.pipeline].primitive.topology {
                PrimitiveTopology::TriangleList => count / 3,
                PrimitiveTopology::TriangleStrip => count.saturating_sub(2),
                _ => 0,
            };
            triangles * u64::from(draw.instances)
        };
        let passes = self.passes();
        passes.flat_map(|pass| &pass.draws).map(of_draw).sum()
    }

    /// The render passes.
    pub(crate) fn passes(&self) -> impl Iterator<Item = &Pass> {
        self.steps.iter().filter_map(|step| match step {
            Step::Pass(pass) => Some(pass),
            Step::Dispatch(_) => None,
        })
    }
}
