//! Shaders as text: WGSL, GLSL and SPIR-V.

mod error;
mod programs;
mod uniforms;

pub use error::{ShaderModuleError, UniformError};
pub use estampe_ir::interface::Stage as ShaderStage;
pub use estampe_shader::front::{
    ClipSpace, Dialect as GlslDialect, EntryPoint, Reflection, ShaderError as ShaderSourceError,
    ShaderErrors, UniformBlock, UniformMember,
};
pub use estampe_shader::front::{Scalar as ScalarType, ValueType};
pub use programs::{EntryPointDescriptor, ProgramDescriptor};
pub use uniforms::{UniformValue, Uniforms};

use estampe_shader::front::{self, Module, Options, Source};
use std::sync::Arc;

/// The text of a shader.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum ShaderSource<'a> {
    /// The WebGPU Shading Language: any number of entry points.
    Wgsl(&'a str),
    /// A vertex and a fragment shader in the OpenGL Shading Language: `#version` 110 to 460, and
    /// 100 to 320 `es`. What one writes and the other reads is found by name, and a uniform that
    /// both declare is one.
    Glsl {
        /// The text of the vertex shader.
        vertex: &'a str,
        /// The text of the fragment shader.
        fragment: &'a str,
    },
    /// One stage in the OpenGL Shading Language.
    GlslStage {
        /// The stage: the language does not say.
        stage: ShaderStage,
        /// The text.
        text: &'a str,
    },
    /// The words of SPIR-V.
    SpirV(&'a [u32]),
    /// The bytes of a file of SPIR-V, in either byte order.
    SpirVBytes(&'a [u8]),
}

/// Describes a shader module: WebGPU's `GPUShaderModuleDescriptor`.
#[derive(Debug, Clone)]
pub struct ShaderModuleDescriptor<'a> {
    /// The name of the file in messages. Default none: messages say `shader`.
    pub label: Option<&'a str>,
    /// The text.
    pub source: ShaderSource<'a>,
    /// Macros of GLSL that are defined before the first line, as name and replacement. Default
    /// none.
    pub defines: &'a [(&'a str, &'a str)],
    /// The clip space of GLSL. Default that of the dialect: OpenGL's z from −w to w, which becomes
    /// 0 to w at the end of the vertex shader, or Vulkan's.
    pub clip_space: Option<ClipSpace>,
    /// The dialect of GLSL. Default what the text looks like.
    pub dialect: Option<GlslDialect>,
    /// If set, each operation on floats is rounded. Otherwise a product that is added or subtracted
    /// is rounded together with the sum, once (*contraction*), unless both of its factors are the
    /// same in all invocations: mostly faster and more exact, and the same on all machines, but not
    /// the bits of the strict shader. Default true.
    pub strict_math: bool,
}

impl<'a> ShaderModuleDescriptor<'a> {
    /// The defaults, for a text.
    #[must_use]
    pub fn new(source: ShaderSource<'a>) -> Self {
        Self {
            label: None,
            source,
            defines: &[],
            clip_space: None,
            dialect: None,
            strict_math: true,
        }
    }
}

/// A checked shader. Cheap to clone.
///
/// ```
/// use estampe::{ColorAttachment, Device, DeviceDescriptor, Draw, RenderPass};
/// use estampe::{RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource};
/// use estampe::{TextureDescriptor, TextureFormat};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let module = device.create_shader_module(&ShaderModuleDescriptor::new(ShaderSource::Wgsl(
///     "@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
///          let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0;
///          return vec4f(corner, 0.0, 1.0);
///      }
///      @fragment fn fs() -> @location(0) vec4f { return vec4f(1.0, 0.5, 0.0, 1.0); }",
/// )))?;
/// let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
///     depth_stencil: None,
///     ..RenderPipelineDescriptor::with_program(device.create_program(&module.program())?)
/// })?;
/// let image = device.create_texture(&TextureDescriptor::new_2d(8, 8, TextureFormat::Rgba8Unorm))?;
/// device.render(&RenderPass {
///     color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
///     draws: &[Draw::new(&pipeline, 0..3)],
///     ..RenderPass::default()
/// })?;
/// assert_eq!(device.read_texture(&image)?[..4], [255, 128, 0, 255]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ShaderModule {
    /// One module, or those of the stages of a program.
    modules: Arc<[Module]>,
    strict_math: bool,
}

impl ShaderModule {
    pub(crate) fn new(descriptor: &ShaderModuleDescriptor<'_>) -> Result<Self, ShaderErrors> {
        let define = |(name, value): &(&str, &str)| ((*name).to_owned(), (*value).to_owned());
        let options = Options {
            file: descriptor.label.map(str::to_owned),
            defines: descriptor.defines.iter().map(define).collect(),
            clip_space: descriptor.clip_space,
            dialect: descriptor.dialect,
            ..Options::default()
        };
        let one = |source| front::load(source, &options).map(|module| vec![module]);
        let modules = match descriptor.source {
            ShaderSource::Wgsl(text) => one(Source::Wgsl(text)),
            ShaderSource::GlslStage { stage, text } => one(Source::Glsl { text, stage }),
            ShaderSource::SpirV(words) => one(Source::SpirV(words)),
            ShaderSource::SpirVBytes(bytes) => one(Source::SpirVBytes(bytes)),
            ShaderSource::Glsl { vertex, fragment } => {
                let source = |text, stage| Source::Glsl { text, stage };
                let in_stage = |stage: &str| Options {
                    file: Some(match descriptor.label {
                        Some(label) => format!("{label} ({stage})"),
                        None => format!("{stage} shader"),
                    }),
                    ..options.clone()
                };
                let (vertex, fragment) = front::load_pair(
                    (source(vertex, ShaderStage::Vertex), &in_stage("vertex")),
                    (
                        source(fragment, ShaderStage::Fragment),
                        &in_stage("fragment"),
                    ),
                )?;
                Ok(vec![vertex, fragment])
            }
        };
        Ok(Self {
            modules: modules?.into(),
            strict_math: descriptor.strict_math,
        })
    }

    /// The entry points.
    pub fn entry_points(&self) -> impl Iterator<Item = &EntryPoint> {
        self.modules.iter().flat_map(|module| &module.entry_points)
    }

    /// What the module exchanges with the program that runs it: of a program in GLSL, for each
    /// stage.
    pub fn reflections(&self) -> impl Iterator<Item = &Reflection> {
        self.modules.iter().map(|module| &module.reflection)
    }

    /// The loose uniforms of GLSL, or the block of a name, to be set by name.
    ///
    /// # Errors
    /// [`UniformError::NoBlock`] if there is no such block.
    pub fn uniforms(&self, block: &str) -> Result<Uniforms, UniformError> {
        // The later stage's block begins with the other one's.
        let blocks = || {
            let all = self.reflections().flat_map(|reflection| &reflection.blocks);
            all.filter(|one| one.name == block)
        };
        let found = blocks().max_by_key(|one| one.size);
        let found = found.ok_or_else(|| UniformError::NoBlock {
            block: block.to_owned(),
        })?;
        Ok(Uniforms::new(found.clone(), blocks()))
    }

    /// Lowers every entry point: what is left between a valid text and one that runs. `constants`
    /// are values of pipeline-overridable constants; those without a default or a value are 1, and
    /// names that there are not are ignored. Returns the errors of all entry points, none if each
    /// can be compiled.
    #[must_use]
    pub fn check_entry_points(&self, constants: &[(&str, f64)]) -> Vec<ShaderModuleError> {
        let mut errors = Vec::new();
        for module in &*self.modules {
            let constants = programs::constants_of(module, constants);
            let constants: Vec<(&str, f64)> = constants
                .iter()
                .map(|(key, value)| (&**key, *value))
                .collect();
            errors.extend(module.entry_points.iter().filter_map(|entry| {
                let descriptor = EntryPointDescriptor {
                    module: self,
                    name: Some(&entry.name),
                    constants: &constants,
                };
                descriptor.check(entry.stage).err()
            }));
        }
        errors
    }

    /// The vertex shader and the fragment shader of the module, if it has one of each.
    #[must_use]
    pub fn program(&self) -> ProgramDescriptor<'_> {
        ProgramDescriptor::new(self)
    }
}
