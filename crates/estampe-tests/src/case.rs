//! Test cases: a target and the draws into it.

use crate::geometry::{Vertex, vertex_buffer, vertex_layout};
use crate::{Random, TestShader};
use estampe_types::state::{
    BlendState, ColorWrites, DepthBiasState, DepthState, LogicOperation, PrimitiveState,
    ScissorRect, StencilState, VertexBufferLayout, Viewport,
};
use estampe_types::{Bindings, BufferData, IndexFormat, TextureFormat};
use std::fmt::Write;
use std::ops::Range;

/// A target and the draws into it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel: 1, 2, 4, 8 or 16.
    pub samples: u32,
    /// Format of the first colour attachment; `None` for a target without colour.
    pub format: Option<TextureFormat>,
    /// Clear colour of all colour attachments, linear.
    pub clear_color: [f32; 4],
    /// Clear depth, in 0..=1.
    pub clear_depth: f32,
    /// The draws of both passes, in order.
    pub draws: Vec<CaseDraw>,
    /// Index of the second pass's first draw; that pass loads what the first one stored.
    pub second_pass: usize,
    /// Formats of the colour attachments after the first.
    pub more_formats: Vec<TextureFormat>,
    /// Format of the depth-stencil attachment, if there is one.
    pub depth_stencil: Option<TextureFormat>,
    /// Clear value of stencil.
    pub clear_stencil: u8,
}

/// One draw.
#[derive(Debug, Clone)]
pub struct CaseDraw {
    /// The vertex and fragment shader.
    pub shader: TestShader,
    /// Vertex buffers with their layouts.
    pub buffers: Vec<(VertexBufferLayout, BufferData)>,
    /// The index buffer, if there is one.
    pub indices: Option<(IndexFormat, BufferData)>,
    /// Range of vertices, or of elements of the index buffer.
    pub elements: Range<u32>,
    /// Range of instances.
    pub instances: Range<u32>,
    /// Added to each index.
    pub base_vertex: i32,
    /// Topology, facing, culling, polygon mode.
    pub primitive: PrimitiveState,
    /// The depth test.
    pub depth: Option<DepthState>,
    /// Depth bias of triangles.
    pub depth_bias: DepthBiasState,
    /// Blending of the first colour attachment; `None` replaces.
    pub blend: Option<BlendState>,
    /// The blend constant.
    pub blend_constant: [f32; 4],
    /// The written channels of the first colour attachment.
    pub write_mask: ColorWrites,
    /// The viewport; `None` is the whole target.
    pub viewport: Option<Viewport>,
    /// The scissor rectangle; `None` is the whole target.
    pub scissor: Option<ScissorRect>,
    /// The shader's uniforms and textures.
    pub bindings: Bindings,
    /// The stencil test.
    pub stencil: Option<StencilState>,
    /// The stencil references of front and back.
    pub stencil_reference: [u8; 2],
    /// The depth-bounds test: least and greatest stored depth.
    pub depth_bounds: Option<[f32; 2]>,
    /// The sample mask.
    pub sample_mask: u32,
    /// If set, alpha to coverage is enabled.
    pub alpha_to_coverage: bool,
    /// If set, shading is per sample, even if the shader does not require it.
    pub sample_shading: bool,
    /// A logic operation, in place of blending.
    pub logic_operation: Option<LogicOperation>,
    /// Blending and write mask of the colour attachments after the first; those beyond the list are
    /// as the first.
    pub more_targets: Vec<(Option<BlendState>, ColorWrites)>,
    /// If set, passed samples are counted (an occlusion query).
    pub is_counted: bool,
}

impl Case {
    /// A target without draws, cleared to transparent black and depth 1.
    #[must_use]
    pub fn new(size: [u32; 2], samples: u32) -> Self {
        Self {
            size,
            samples,
            format: Some(TextureFormat::Rgba8Unorm),
            clear_color: [0.0; 4],
            clear_depth: 1.0,
            draws: Vec::new(),
            second_pass: usize::MAX,
            more_formats: Vec::new(),
            depth_stencil: Some(TextureFormat::Depth32Float),
            clear_stencil: 0,
        }
    }

    /// The formats of all colour attachments.
    #[must_use]
    pub fn formats(&self) -> Vec<TextureFormat> {
        let more = self.more_formats.iter().copied();
        self.format.into_iter().chain(more).collect()
    }

    /// A target of a random size, usually small, and a random number of samples.
    #[must_use]
    pub fn random_target(random: &mut Random) -> Self {
        let sizes = [[64, 64], [33, 20], [19, 21], [63, 65], [1, 1], [70, 5]];
        let size = random.pick(&sizes);
        Self::new(size, random.pick(&[1, 4]))
    }

    /// The draws of the first and of the second pass.
    #[must_use]
    pub fn passes(&self) -> [&[CaseDraw]; 2] {
        let (first, second) = self.draws.split_at(self.second_pass.min(self.draws.len()));
        [first, second]
    }

    /// The case as text, for failure messages.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = format!(
            "target {:?}, {} samples, {:?}, {:?}, cleared to {:?}, {} and {}; second pass from draw {}",
            self.size,
            self.samples,
            self.formats(),
            self.depth_stencil,
            self.clear_color,
            self.clear_depth,
            self.clear_stencil,
            self.second_pass
        );
        for draw in &self.draws {
            // Writing to a string cannot fail.
            let _ = write!(text, "\n  {}", draw.describe());
        }
        text
    }
}

impl CaseDraw {
    /// A draw of a triangle list of vertices with the standard layout.
    #[must_use]
    pub fn new(shader: impl Into<TestShader>, vertices: &[Vertex]) -> Self {
        Self {
            shader: shader.into(),
            buffers: vec![(vertex_layout(), vertex_buffer(vertices))],
            indices: None,
            elements: 0..u32::try_from(vertices.len()).expect("few vertices"),
            instances: 0..1,
            base_vertex: 0,
            primitive: PrimitiveState::default(),
            depth: Some(DepthState::LESS_WRITE),
            depth_bias: DepthBiasState::default(),
            blend: None,
            blend_constant: [0.0; 4],
            write_mask: ColorWrites::ALL,
            viewport: None,
            scissor: None,
            bindings: Bindings::default(),
            stencil: None,
            stencil_reference: [0; 2],
            depth_bounds: None,
            sample_mask: u32::MAX,
            alpha_to_coverage: false,
            sample_shading: false,
            logic_operation: None,
            more_targets: Vec::new(),
            is_counted: false,
        }
    }

    /// Blending and write mask of a colour attachment.
    #[must_use]
    pub fn target(&self, attachment: usize) -> (Option<BlendState>, ColorWrites) {
        let first = (self.blend, self.write_mask);
        match attachment.checked_sub(1) {
            Some(after) => self.more_targets.get(after).copied().unwrap_or(first),
            None => first,
        }
    }

    /// All that a pipeline is made of, as text: equal texts are of equal states.
    pub(crate) fn pipeline_state(&self) -> String {
        let layouts: Vec<_> = self.buffers.iter().map(|(layout, _)| layout).collect();
        format!(
            "{:?} {layouts:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
            self.shader,
            self.primitive,
            self.depth,
            self.depth_bias,
            self.blend,
            self.write_mask,
            self.stencil,
            self.sample_mask,
            self.alpha_to_coverage,
            self.sample_shading,
            self.logic_operation,
            self.more_targets
        )
    }

    fn describe(&self) -> String {
        let mut text = format!(
            "{:?}\n    elements {:?} of {:?}, instances {:?}, base vertex {}, {:?}\n    {:?} {:?} {:?} \
             constant {:?} {:?}\n    viewport {:?} scissor {:?}",
            self.shader,
            self.elements,
            self.indices,
            self.instances,
            self.base_vertex,
            self.primitive,
            self.depth,
            self.depth_bias,
            self.blend,
            self.blend_constant,
            self.write_mask,
            self.viewport,
            self.scissor
        );
        let _ = write!(
            text,
            "\n    {:?} reference {:?} bounds {:?}\n    sample mask {:#x}, alpha to coverage {}, by sample {}, \
             {:?}, more targets {:?}",
            self.stencil,
            self.stencil_reference,
            self.depth_bounds,
            self.sample_mask,
            self.alpha_to_coverage,
            self.sample_shading,
            self.logic_operation,
            self.more_targets
        );
        for (layout, buffer) in &self.buffers {
            let _ = write!(text, "\n    {layout:?}, {} bytes", buffer.len_bytes());
        }
        let Some((layout, buffer)) = self.buffers.first() else {
            return text;
        };
        for element in self.elements.clone().take(8) {
            let index = match &self.indices {
                Some((format, indices)) => {
                    estampe_reference::fetch::index(*format, indices, element, self.base_vertex)
                }
                None => element,
            };
            let start = (index as usize).saturating_mul(layout.array_stride as usize);
            let words = (0..layout.array_stride as usize / 4).take(8);
            let word = |at: usize| f32::from_bits(buffer.word_at(start.saturating_add(at * 4)));
            let numbers: Vec<_> = words.map(word).collect();
            let _ = write!(text, "\n    vertex {index}: {numbers:?}");
        }
        text
    }
}
