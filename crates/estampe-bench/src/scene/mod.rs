//! The scenes of `peerbench`, drawn natively: data from [`generate`](crate::generate), and shaders
//! in Rust that compute the same as the scenes' WGSL.
//!
//! | scene | work | triangles |
//! |---|---|---:|
//! | clear | colour and depth cleared | 0 |
//! | fill | 32 full-screen opaque quads, back to front | 64 |
//! | fill_front | fill, front to back: one visible, 31 rejected | 64 |
//! | blend | 32 full-screen alpha-blended Gouraud quads | 64 |
//! | small_tris | bumpy sphere, Gouraud, back faces culled | 998,000 |
//! | mid_tris | torus, Blinn-Phong, diffuse and normal map, trilinear | 69,696 |
//! | textured | 16 tilted quads over each other, trilinear | 32 |
//! | heavy_fs | full-screen sphere tracing, divergent exit, value noise | 2 |
//! | shadow | depth map of the torus, then torus and ground, 3×3 comparisons | 139,394 |
//! | msaa4 | mid_tris with 4 samples, resolved | 69,696 |
//! | instances | 2,000 draws, a dynamic uniform offset each | 1,000,000 |
//! | fill_draws | fill as 32 draws, the same picture | 64 |
//! | textured_draws | textured as 16 draws, the same picture | 32 |
//! | many_draws | instances as 10,000 draws, the same picture | 1,000,000 |
//! | quad_draws | 10,000 draws of a quad, a dynamic uniform offset each; not in `peerbench` | 20,000 |
//!
//! Targets are RGBA8 and 32-bit depth, cleared to [`CLEAR_COLOR`] and 1.
//!
//! Scenes of real programs, whose frames are [`passes`] in WGSL alone, with targets of their own:
//!
//! | scene | work | triangles |
//! |---|---|---:|
//! | ui | 30 windows of panels and text, 150 draws with scissors, premultiplied blending | 46,800 |
//! | gbuffer | deferred shading, two targets, depth read back, 16 point lights, tone mapping | 69,700 |
//! | stencil | shadow volumes by depth fail, without colour, and a darkening draw | 69,357 |
//! | postfx | bloom and blur: 15 passes over images of RGBA16F | 1,514 |
//! | particles | 100,000 instanced soft quads, added into RGBA16F | 209,025 |
//! | foliage | 60,000 cards, 4 samples, discarding and alpha to coverage | 120,002 |
//! | wire | a terrain with a depth bias, and 150,700 hidden lines | 150,152 |
//! | mandelbrot_compute | a dispatch with a divergent loop writes a storage texture | 0 |
//! | blur_compute | a blur of 31 texels along rows, then columns, by memory of work-groups | 0 |
//! | nbody_compute | 8,192 bodies attract each other, by tiles; painted, and drawn as points | 0 |
//! | histogram_compute | 4 million integers counted by atomics, running sums, painted | 0 |
//! | skybox | 200 reflecting spheres and a sky from a cube map, an anisotropic ground | 100,003 |

mod blend;
mod blur_compute;
mod clear;
mod entry;
mod fill;
mod foliage;
mod gbuffer;
mod heavy_fs;
mod histogram_compute;
mod instances;
mod language;
mod mandelbrot_compute;
mod mid_tris;
mod nbody_compute;
mod particles;
pub mod passes;
mod postfx;
mod quad_draws;
pub(crate) mod shadow;
mod skybox;
mod small_tris;
mod stencil;
mod textured;
mod ui;
mod uniforms;
mod upload;
pub(crate) mod wgsl;
mod wire;

use crate::generate::{Fingerprint, MipChain};
pub use entry::{ALL, SceneEntry, SceneGroup};
use estampe::state::{VertexAttribute, VertexBufferLayout};
use estampe::{RenderPipelineDescriptor, VertexFormat};
pub use language::ShaderLanguage;
use std::ops::Range;

/// The clear colour of every frame, in multiples of 1/255, so that no renderer has to round a tie.
pub const CLEAR_COLOR: [f32; 4] = [26.0 / 255.0, 51.0 / 255.0, 77.0 / 255.0, 1.0];

/// The aspect ratio (width ÷ height) of the scenes' cameras, for frames of any size.
const ASPECT: f64 = 16.0 / 9.0;

/// The amount of geometry and texture of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// As `peerbench` defines it: only this can be compared with other renderers.
    Full,
    /// A hundredth of the triangles and texels, for tests with small frames.
    Reduced,
}

impl Detail {
    /// Selects one of two values.
    fn of<T>(self, full: T, reduced: T) -> T {
        match self {
            Self::Full => full,
            Self::Reduced => reduced,
        }
    }
}

/// A frame's worth of data, pipelines and draws.
#[derive(Debug)]
pub struct Scene {
    /// The name on the command line.
    pub name: &'static str,
    /// Vertex, index and uniform data, in the order of generation.
    pub buffers: Vec<Vec<u8>>,
    /// Textures, in the order of generation.
    pub textures: Vec<MipChain>,
    /// Samples per pixel.
    pub samples: u32,
    /// The pipelines of the draws.
    pub pipelines: Vec<RenderPipelineDescriptor>,
    /// Index of the buffer that draws bind as binding 0 of group 0, at their dynamic offset.
    pub uniforms: Option<usize>,
    /// A depth map that is drawn first and bound beside the uniforms.
    pub depth_map: Option<DepthMap>,
    /// The draws of a frame, in order.
    pub draws: Vec<SceneDraw>,
    /// The module that is used in place of the pipelines' shaders in Rust.
    pub(crate) wgsl: Option<&'static wgsl::WgslShaders>,
    /// Whether each operation of shaders in WGSL is rounded.
    pub strict_math: bool,
    /// A frame of several steps in WGSL, in place of the pipelines and draws above.
    pub frame: Option<passes::Frame>,
}

/// A pass before the frame's, into a square target with depth only.
#[derive(Debug, Clone)]
pub struct DepthMap {
    /// The side in pixels.
    pub size: u32,
    /// The draws, in order.
    pub draws: Vec<SceneDraw>,
}

/// An indexed draw, as indices into the scene's lists.
#[derive(Debug, Clone, Copy)]
pub struct SceneDraw {
    /// Index of the pipeline.
    pub pipeline: usize,
    /// Index of the vertex buffer.
    pub vertices: usize,
    /// Index of the index buffer, 32 bits per index.
    pub indices: usize,
    /// Half-open range of the indices; `None` is all.
    pub elements: Option<[u32; 2]>,
    /// The number of instances.
    pub instances: u32,
    /// Offset of its uniforms, in bytes.
    pub dynamic_offset: u32,
}

impl SceneDraw {
    /// One instance, all indices, uniforms from the start of their buffer.
    pub(crate) const fn new(pipeline: usize, vertices: usize, indices: usize) -> Self {
        Self {
            pipeline,
            vertices,
            indices,
            elements: None,
            instances: 1,
            dynamic_offset: 0,
        }
    }
}

impl Scene {
    /// A scene of one draw: the buffers are vertices, indices and, in some, uniforms.
    pub(crate) fn of_one_draw(
        name: &'static str,
        buffers: Vec<Vec<u8>>,
        textures: Vec<MipChain>,
        pipeline: RenderPipelineDescriptor,
    ) -> Self {
        Self {
            name,
            buffers,
            textures,
            samples: pipeline.multisample.count,
            pipelines: vec![pipeline],
            uniforms: None,
            depth_map: None,
            draws: vec![SceneDraw::new(0, 0, 1)],
            wgsl: None,
            strict_math: true,
            frame: None,
        }
    }

    /// A scene whose frame has several steps, in WGSL alone.
    pub(crate) fn of_frame(
        name: &'static str,
        buffers: Vec<Vec<u8>>,
        textures: Vec<MipChain>,
        frame: passes::Frame,
    ) -> Self {
        Self {
            name,
            buffers,
            textures,
            samples: 1,
            pipelines: Vec::new(),
            uniforms: None,
            depth_map: None,
            draws: Vec::new(),
            wgsl: None,
            strict_math: true,
            frame: Some(frame),
        }
    }

    /// The scene with its shaders in a language.
    #[must_use]
    pub fn in_language(self, language: ShaderLanguage) -> Self {
        let wgsl = match language {
            ShaderLanguage::Rust => None,
            ShaderLanguage::Wgsl | ShaderLanguage::WgslContracted => wgsl::of(self.name),
        };
        Self {
            wgsl,
            strict_math: language.is_strict(),
            ..self
        }
    }

    /// The number of triangles that a frame submits.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        if let Some(frame) = &self.frame {
            return frame.triangles();
        }
        let triangles = |draw: &SceneDraw| {
            let indices = self.elements(draw).len() as u64;
            indices / 3 * u64::from(draw.instances)
        };
        let depth_map = self.depth_map.iter().flat_map(|map| &map.draws);
        self.draws.iter().chain(depth_map).map(triangles).sum()
    }

    /// The range of a draw's indices.
    #[must_use]
    pub fn elements(&self, draw: &SceneDraw) -> Range<u32> {
        let words = self.buffers[draw.indices].len() / 4;
        let all = u32::try_from(words).expect("the generators count indices in 32 bits");
        let [first, end] = draw.elements.unwrap_or([0, all]);
        first..end
    }

    /// The scene with its single draw cut into this many, with equally many indices each.
    fn cut_into(mut self, draws: u32) -> Self {
        let whole = self.draws[0];
        let each = self.elements(&whole).end / draws;
        let parts = (0..draws).map(|part| SceneDraw {
            elements: Some([part * each, (part + 1) * each]),
            ..whole
        });
        self.draws = parts.collect();
        self
    }

    /// FNV-1a of the bytes of all buffers, then of all textures' levels. It equals `peerbench`'s if
    /// the data are equal.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let mut fingerprint = Fingerprint::default();
        for buffer in &self.buffers {
            fingerprint.update(buffer);
        }
        for level in self.textures.iter().flat_map(|texture| &texture.levels) {
            fingerprint.update(level);
        }
        fingerprint.value()
    }
}

/// A vertex buffer's layout: (format, byte offset) of locations 0, 1, ….
pub(crate) fn vertex_layout(
    stride_bytes: u32,
    attributes: &[(VertexFormat, u32)],
) -> VertexBufferLayout {
    let attributes = (0..).zip(attributes);
    let attributes = attributes.map(|(shader_location, &(format, offset))| VertexAttribute {
        format,
        offset,
        shader_location,
    });
    VertexBufferLayout {
        array_stride: stride_bytes,
        attributes: attributes.collect(),
        ..VertexBufferLayout::default()
    }
}
