//! What is loaded: the source, its options and the limits on it.

use estampe_ir::interface::Stage;

/// A shader as its author wrote it.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// The WebGPU Shading Language.
    Wgsl(&'a str),
    /// The OpenGL Shading Language: `#version` 110 to 460, 100, and 300 to 320 `es`.
    Glsl {
        /// The text.
        text: &'a str,
        /// The stage that the text is for: GLSL does not say.
        stage: Stage,
    },
    /// SPIR-V as words.
    SpirV(&'a [u32]),
    /// SPIR-V as the bytes of a file, of either byte order.
    SpirVBytes(&'a [u8]),
}

/// The range of z in the clip space that a vertex shader writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ClipSpace {
    /// z from 0 to w, as in WebGPU, Vulkan and Direct3D. The position is left alone.
    Webgpu,
    /// z from −w to w, as in OpenGL. At the end of the vertex shader, z becomes (z + w) / 2.
    OpenGl,
}

/// The kind of GLSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// OpenGL and WebGL: bindings are given by the pass, `binding` numbers are units of OpenGL.
    OpenGl,
    /// Vulkan: `set` and `binding` are the bind group and binding.
    Vulkan,
}

/// How a source is loaded. The default is stated at each field.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The name of the file in messages. None by default: messages say `shader`.
    pub file: Option<String>,
    /// Values of pipeline-overridable constants (specialization constants), by name or by the
    /// digits of their id. `None` (the default) leaves the constants open, to be given by
    /// [`Module::specialize`](super::Module::specialize); a list settles all of them, so that each
    /// one that is not in the list must have a default.
    pub constants: Option<Vec<(String, f64)>>,
    /// Macros of GLSL that are defined before the first line, as name and replacement. None by
    /// default.
    pub defines: Vec<(String, String)>,
    /// The clip space of a GLSL vertex shader. `None` (the default) takes that of the dialect:
    /// [`ClipSpace::OpenGl`] for OpenGL, [`ClipSpace::Webgpu`] for Vulkan.
    pub clip_space: Option<ClipSpace>,
    /// The dialect of GLSL. `None` (the default) finds it out: Vulkan if the text has `set =`,
    /// `push_constant`, `constant_id`, `gl_VertexIndex`, `gl_InstanceIndex`, or declares textures
    /// apart from samplers; otherwise OpenGL.
    pub dialect: Option<Dialect>,
    /// The bind group that holds what a GLSL shader of OpenGL names: loose uniforms, blocks,
    /// textures and samplers. 0 by default.
    pub group: u32,
    /// The limits on the source.
    pub limits: Limits,
}

/// Limits on sources, so that hostile ones end in an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The most bytes of a source. 4 MiB by default.
    pub source_bytes: usize,
    /// The most tokens of GLSL after macros are replaced. 500 000 by default.
    pub tokens: usize,
    /// How deeply brackets may nest in GLSL. Eight times as many operators, and twice as many
    /// branches, may follow each other, also in WGSL. 128 by default.
    pub nesting: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            source_bytes: 4 << 20,
            tokens: 500_000,
            nesting: 128,
        }
    }
}
