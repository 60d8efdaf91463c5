//! A case: what is drawn into one target.

use crate::geometry::{Vertex, vertex_buffer, vertex_layout};
use crate::{Random, TestShader};
use estampe_types::state::{
    BlendState, ColorWrites, DepthBiasState, DepthState, LogicOperation, PrimitiveState,
    ScissorRect, StencilState, VertexBufferLayout, Viewport,
};
use estampe_types::{Bindings, Buffer, IndexFormat, TextureFormat};
use std::fmt::Write;
use std::ops::Range;

/// A target and all that is drawn into it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// 1, 2, 4, 8 or 16.
    pub samples: u32,
    /// The first colour attachment's, if there is one.
    pub format: Option<TextureFormat>,
    /// Linear.
    pub clear_color: [f32; 4],
    /// In 0..=1.
    pub clear_depth: f32,
    /// In order.
    pub draws: Vec<CaseDraw>,
    /// The first draw of a second pass, which keeps what the first one drew.
    pub second_pass: usize,
    /// Those of the colour attachments after the first.
    pub more_formats: Vec<TextureFormat>,
    /// Of depth and stencil.
    pub depth_stencil: Option<TextureFormat>,
    /// What the stencil is cleared to.
    pub clear_stencil: u8,
}

/// One draw.
#[derive(Debug, Clone)]
pub struct CaseDraw {
    /// The program.
    pub shader: TestShader,
    /// Buffers and how they lie.
    pub buffers: Vec<(VertexBufferLayout, Buffer)>,
    /// Indices, if there are any.
    pub indices: Option<(IndexFormat, Buffer)>,
    /// Elements or vertices.
    pub elements: Range<u32>,
    /// Instances.
    pub instances: Range<u32>,
    /// Added to indices.
    pub base_vertex: i32,
    /// Topology, facing, culling, polygon mode.
    pub primitive: PrimitiveState,
    /// The depth test.
    pub depth: Option<DepthState>,
    /// What is added to the depth of triangles.
    pub depth_bias: DepthBiasState,
    /// Blending.
    pub blend: Option<BlendState>,
    /// Its constant.
    pub blend_constant: [f32; 4],
    /// The channels that change.
    pub write_mask: ColorWrites,
    /// `None`: the whole target.
    pub viewport: Option<Viewport>,
    /// `None`: the whole target.
    pub scissor: Option<ScissorRect>,
    /// What the shader reads besides.
    pub bindings: Bindings,
    /// The stencil test.
    pub stencil: Option<StencilState>,
    /// What front and back are compared with.
    pub stencil_reference: [u8; 2],
    /// The stored depths over which something is drawn.
    pub depth_bounds: Option<[f32; 2]>,
    /// The samples that may change.
    pub sample_mask: u32,
    /// Whether alpha says how many samples are kept.
    pub alpha_to_coverage: bool,
    /// Whether shading is by sample in any case.
    pub sample_shading: bool,
    /// In place of blending.
    pub logic_operation: Option<LogicOperation>,
    /// Blending and write mask of the colour attachments after the first; by default as of the first.
    pub more_targets: Vec<(Option<BlendState>, ColorWrites)>,
    /// Whether the samples that pass are counted.
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

    /// A target of a random, usually small size and a random number of samples.
    #[must_use]
    pub fn random_target(random: &mut Random) -> Self {
        let sizes = [[64, 64], [33, 20], [19, 21], [63, 65], [1, 1], [70, 5]];
        let size = random.pick(&sizes);
        Self::new(size, random.pick(&[1, 4]))
    }

    /// The two passes' draws.
    #[must_use]
    pub fn passes(&self) -> [&[CaseDraw]; 2] {
        let (first, second) = self.draws.split_at(self.second_pass.min(self.draws.len()));
        [first, second]
    }

    /// The case in words, for whoever has to find out.
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
    /// Triangles of vertices with the standard layout.
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
