//! The state of a draw: an untrusted descriptor, validated once into an immutable pipeline.

use estampe_types::shader::{DepthOutput, MAX_DISTANCES, Sampling};
use estampe_types::state::{
    BlendFactor, BlendState, ColorTargetState, CompareFunction, ConservativeMode, DepthBiasState,
    DepthState, LineRasterization, LineState, LineStipple, LogicOperation, PrimitiveState,
    StencilState, VertexBufferLayout,
};
use estampe_types::{
    Interface, Interpolation, Limits, Program, Shader, ShaderProgram, TextureFormat, VertexFormat,
};
use std::sync::Arc;

/// What a pipeline is made of.
#[derive(Debug, Clone)]
pub struct RenderPipelineDescriptor {
    /// The vertex and fragment shader.
    pub program: Arc<dyn Program>,
    /// How each vertex buffer of a draw lies. Default none.
    pub vertex_buffers: Vec<VertexBufferLayout>,
    /// Topology, facing, culling. Default a triangle list, nothing culled.
    pub primitive: PrimitiveState,
    /// The depth test, or none. Default less, written.
    pub depth: Option<DepthState>,
    /// The stencil test, or none. Default none.
    pub stencil: Option<StencilState>,
    /// What is added to the depth of triangles. Default nothing.
    pub depth_bias: DepthBiasState,
    /// Samples per pixel: 1, 2, 4, 8 or 16. Default 1.
    pub samples: u32,
    /// The samples that may change, bit by bit. Default all.
    pub sample_mask: u32,
    /// Whether the alpha of target 0 says how many of a fragment's samples are kept. Default no.
    pub alpha_to_coverage: bool,
    /// Whether fragments are shaded once for each sample, whatever the shader says. Default no.
    pub sample_shading: bool,
    /// A logic operation in place of blending, for all targets. Default none.
    pub logic_operation: Option<LogicOperation>,
    /// The colour targets. Default one `Rgba8Unorm`, replaced.
    pub targets: Vec<ColorTargetState>,
}

impl RenderPipelineDescriptor {
    /// The defaults, for a Rust shader.
    pub fn new(shader: impl Shader) -> Self {
        Self::with_program(Arc::new(ShaderProgram::new(shader)))
    }

    /// The defaults, for any program.
    #[must_use]
    pub fn with_program(program: Arc<dyn Program>) -> Self {
        Self {
            program,
            vertex_buffers: Vec::new(),
            primitive: PrimitiveState::default(),
            depth: Some(DepthState::LESS_WRITE),
            stencil: None,
            depth_bias: DepthBiasState::default(),
            samples: 1,
            sample_mask: u32::MAX,
            alpha_to_coverage: false,
            sample_shading: false,
            logic_operation: None,
            targets: vec![TextureFormat::Rgba8Unorm.into()],
        }
    }
}

/// Why a pipeline was refused: the rule that its descriptor breaks.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The sample count is not offered.
    #[error("a pipeline has 1, 2, 4, 8 or 16 samples per pixel, not {0}")]
    SampleCount(u32),
    /// Lines of no width, or of more than 64 pixels.
    #[error("lines are {0} pixels wide; their width must be above 0 and at most 64")]
    LineWidth(String),
    /// A stipple factor that is 0 or more than 256.
    #[error("the stipple factor is {0}; it must be 1 to 256")]
    StippleFactor(u16),
    /// Too many colour targets.
    #[error("the pipeline has {count} colour targets; the limit max_color_attachments is {limit}")]
    TooManyTargets {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: u32,
    },
    /// The shader writes another number of targets than there are.
    #[error(
        "the shader writes {shader} colour targets, the pipeline has {pipeline}: they must agree"
    )]
    TargetCount {
        /// What the shader writes.
        shader: usize,
        /// What the pipeline has.
        pipeline: usize,
    },
    /// A colour target has a format that cannot be drawn into.
    #[error(
        "colour target {index} has the format {}, into which colours cannot be drawn: depth, stencil and compressed \
         formats and rgb9e5ufloat are not renderable",
        format.name()
    )]
    NotRenderable {
        /// Which target.
        index: usize,
        /// Its format.
        format: TextureFormat,
    },
    /// Blending of integers.
    #[error(
        "colour target {index} blends, but its format {} holds integers, which cannot be blended",
        format.name()
    )]
    NotBlendable {
        /// Which target.
        index: usize,
        /// Its format.
        format: TextureFormat,
    },
    /// A blend factor needs a second colour, which the shader does not give.
    #[error(
        "colour target {0} blends with the fragment's second colour, but the shader gives none (DUAL_SOURCE)"
    )]
    NoSecondColor(usize),
    /// Dual-source blending with another number of targets than one.
    #[error("a shader with a second colour has one colour target, this one has {0}")]
    DualSourceTargets(usize),
    /// Too many vertex buffers.
    #[error("the pipeline has {count} vertex buffers; the limit max_vertex_buffers is {limit}")]
    TooManyVertexBuffers {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: u32,
    },
    /// A stride is too large.
    #[error(
        "vertex buffer {buffer} has a stride of {stride} bytes; the limit \
         max_vertex_buffer_array_stride is {limit}"
    )]
    StrideTooLarge {
        /// Which buffer.
        buffer: usize,
        /// Its stride.
        stride: u32,
        /// How large it may be.
        limit: u32,
    },
    /// An attribute reaches beyond its element.
    #[error(
        "attribute at location {location} ends at byte {end} of an element of vertex buffer {buffer}, \
         beyond its stride of {stride}"
    )]
    AttributeBeyondStride {
        /// Which buffer.
        buffer: usize,
        /// The shader location that it feeds.
        location: u32,
        /// Where the attribute ends.
        end: u64,
        /// The element's length.
        stride: u32,
    },
    /// A shader location is fed twice.
    #[error("shader location {0} is fed by two attributes")]
    LocationTwice(u32),
    /// A shader location is fed by nothing.
    #[error("the shader reads location {0}, which no vertex buffer feeds")]
    LocationMissing(usize),
    /// A location that the shader does not read, or beyond the limit.
    #[error("location {location} is fed, but the shader reads only {count} locations")]
    LocationUnknown {
        /// The location.
        location: u32,
        /// How many the shader has.
        count: usize,
    },
    /// Too many attributes.
    #[error("the shader reads {count} attributes; the limit max_vertex_attributes is {limit}")]
    TooManyAttributes {
        /// How many it reads.
        count: usize,
        /// How many it may read.
        limit: u32,
    },
    /// Too many clip or cull distances.
    #[error("the shader has {count} clip or cull distances; there are at most {limit} of each")]
    TooManyDistances {
        /// How many it has.
        count: usize,
        /// How many it may have.
        limit: usize,
    },
    /// Too many varyings.
    #[error(
        "the shader has {count} scalars of varyings; the limit max_inter_stage_scalars is {limit}"
    )]
    TooManyVaryings {
        /// How many it has.
        count: usize,
        /// How many it may have.
        limit: u32,
    },
}

/// How an attribute is decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Decoding {
    Float32,
    Unorm8,
    Unorm16,
    /// Anything else, and what several instances share: fetched out of the way of common attributes.
    Rare,
}

/// Where one attribute of the shader comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AttributeSource {
    /// Index into the draw's vertex buffers.
    pub(crate) buffer: usize,
    pub(crate) attribute: estampe_types::state::VertexAttribute,
    pub(crate) stride: u32,
    pub(crate) per_instance: bool,
    /// Instances that share an element; 0: all of them.
    pub(crate) step_rate: u32,
    /// Components of the format.
    pub(crate) components: usize,
    pub(crate) decoding: Decoding,
}

/// What selects code, reduced: nothing in it changes from fragment to fragment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct StageKey {
    /// The fragments' colour depends on the primitive alone, so it is shaded once for each.
    pub(crate) uniform_over_primitive: bool,
    /// Depth is tested, and perhaps written, before the shader runs.
    pub(crate) early_depth: bool,
    /// The fragments' one colour is their first four scalars, so that the program need not be called.
    pub(crate) passes_color: bool,
    /// Depth is written, and by which comparison, if at all.
    pub(crate) depth: Option<DepthState>,
    /// The state asks for more than the common paths know: everything is drawn by the general one.
    pub(crate) is_general: bool,
}

/// A validated, immutable pipeline; cheap to clone.
#[derive(Debug, Clone)]
pub struct RenderPipeline {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    descriptor: RenderPipelineDescriptor,
    attributes: Vec<AttributeSource>,
    key: StageKey,
}

impl RenderPipeline {
    /// Validates a descriptor.
    ///
    /// # Errors
    /// [`PipelineError`] names the first rule that it breaks.
    pub fn new(
        descriptor: &RenderPipelineDescriptor,
        limits: &Limits,
    ) -> Result<Self, PipelineError> {
        let interface = descriptor.program.interface();
        check_targets(descriptor, interface, limits)?;
        check_interface(interface, limits)?;
        check_lines(&descriptor.primitive.line)?;
        let attributes = attribute_sources(descriptor, interface, limits)?;
        let key = stage_key(descriptor, interface);
        Ok(Self {
            inner: Arc::new(Inner {
                descriptor: descriptor.clone(),
                attributes,
                key,
            }),
        })
    }

    /// What it was made of.
    #[must_use]
    pub fn descriptor(&self) -> &RenderPipelineDescriptor {
        &self.inner.descriptor
    }

    pub(crate) fn program(&self) -> &dyn Program {
        &*self.inner.descriptor.program
    }

    pub(crate) fn interface(&self) -> &Interface {
        self.program().interface()
    }

    pub(crate) fn attributes(&self) -> &[AttributeSource] {
        &self.inner.attributes
    }

    pub(crate) fn key(&self) -> StageKey {
        self.inner.key
    }
}

fn check_targets(
    descriptor: &RenderPipelineDescriptor,
    interface: &Interface,
    limits: &Limits,
) -> Result<(), PipelineError> {
    if !matches!(descriptor.samples, 1 | 2 | 4 | 8 | 16) {
        return Err(PipelineError::SampleCount(descriptor.samples));
    }
    let count = descriptor.targets.len();
    if count > limits.max_color_attachments as usize {
        return Err(PipelineError::TooManyTargets {
            count,
            limit: limits.max_color_attachments,
        });
    }
    if interface.color_targets != count {
        return Err(PipelineError::TargetCount {
            shader: interface.color_targets,
            pipeline: count,
        });
    }
    for (index, target) in descriptor.targets.iter().enumerate() {
        let format = target.format;
        if !format.is_renderable() {
            return Err(PipelineError::NotRenderable { index, format });
        }
        let Some(blend) = &target.blend else {
            continue;
        };
        if !format.is_blendable() {
            return Err(PipelineError::NotBlendable { index, format });
        }
        if uses_second_color(blend) && !interface.dual_source {
            return Err(PipelineError::NoSecondColor(index));
        }
    }
    if interface.dual_source && count != 1 {
        return Err(PipelineError::DualSourceTargets(count));
    }
    Ok(())
}

fn check_lines(state: &LineState) -> Result<(), PipelineError> {
    if !(state.width > 0.0 && state.width <= 64.0) {
        return Err(PipelineError::LineWidth(state.width.to_string()));
    }
    match state.stipple {
        Some(LineStipple { factor, .. }) if !(1..=256).contains(&factor) => {
            Err(PipelineError::StippleFactor(factor))
        }
        _ => Ok(()),
    }
}

fn check_interface(interface: &Interface, limits: &Limits) -> Result<(), PipelineError> {
    let count = interface.attributes.len();
    if count > limits.max_vertex_attributes as usize {
        return Err(PipelineError::TooManyAttributes {
            count,
            limit: limits.max_vertex_attributes,
        });
    }
    let count = interface.clip_distances.max(interface.cull_distances);
    if count > MAX_DISTANCES {
        let limit = MAX_DISTANCES;
        return Err(PipelineError::TooManyDistances { count, limit });
    }
    let count = interface.varyings.len();
    if count > limits.max_inter_stage_scalars as usize {
        return Err(PipelineError::TooManyVaryings {
            count,
            limit: limits.max_inter_stage_scalars,
        });
    }
    Ok(())
}

fn attribute_sources(
    descriptor: &RenderPipelineDescriptor,
    interface: &Interface,
    limits: &Limits,
) -> Result<Vec<AttributeSource>, PipelineError> {
    let count = descriptor.vertex_buffers.len();
    if count > limits.max_vertex_buffers as usize {
        return Err(PipelineError::TooManyVertexBuffers {
            count,
            limit: limits.max_vertex_buffers,
        });
    }
    let mut sources = vec![None; interface.attributes.len()];
    for (buffer, layout) in descriptor.vertex_buffers.iter().enumerate() {
        let stride = layout.array_stride;
        let limit = limits.max_vertex_buffer_array_stride;
        if stride > limit {
            return Err(PipelineError::StrideTooLarge {
                buffer,
                stride,
                limit,
            });
        }
        for attribute in &layout.attributes {
            let location = attribute.shader_location;
            let end = u64::from(attribute.offset) + attribute.format.size_bytes() as u64;
            let element = if stride == 0 { limit } else { stride };
            if end > u64::from(element) {
                let stride = element;
                return Err(PipelineError::AttributeBeyondStride {
                    buffer,
                    location,
                    end,
                    stride,
                });
            }
            let count = sources.len();
            let source = sources
                .get_mut(location as usize)
                .ok_or(PipelineError::LocationUnknown { location, count })?;
            if source.is_some() {
                return Err(PipelineError::LocationTwice(location));
            }
            let per_instance = layout.step_mode == estampe_types::state::VertexStepMode::Instance;
            *source = Some(AttributeSource {
                buffer,
                attribute: *attribute,
                stride,
                per_instance,
                step_rate: layout.instance_step_rate,
                components: attribute.format.components(),
                decoding: if per_instance && layout.instance_step_rate != 1 {
                    Decoding::Rare
                } else {
                    decoding(attribute.format)
                },
            });
        }
    }
    let found = |(location, source): (usize, Option<AttributeSource>)| {
        source.ok_or(PipelineError::LocationMissing(location))
    };
    sources.into_iter().enumerate().map(found).collect()
}

/// How an attribute of a format is decoded, if it does not step.
fn decoding(format: VertexFormat) -> Decoding {
    match format {
        VertexFormat::Float32
        | VertexFormat::Float32x2
        | VertexFormat::Float32x3
        | VertexFormat::Float32x4 => Decoding::Float32,
        VertexFormat::Unorm8x2 | VertexFormat::Unorm8x4 => Decoding::Unorm8,
        VertexFormat::Unorm16x2 | VertexFormat::Unorm16x4 => Decoding::Unorm16,
        _ => Decoding::Rare,
    }
}

fn stage_key(descriptor: &RenderPipelineDescriptor, interface: &Interface) -> StageKey {
    let flat = interface
        .varyings
        .iter()
        .all(|mode| *mode == Interpolation::Flat);
    // A test that always passes and writes nothing is no test.
    let depth = descriptor
        .depth
        .filter(|depth| depth.write_enabled || depth.compare != CompareFunction::Always);
    let early_depth = !interface.discards && interface.depth_output == DepthOutput::None;
    StageKey {
        uniform_over_primitive: flat && !interface.reads_position && early_depth,
        early_depth,
        // A program of a caller's own may claim more than it has.
        // Smooth lines change the colour on its way.
        passes_color: interface.passes_color
            && descriptor.primitive.line.rasterization != LineRasterization::RectangularSmooth
            && early_depth
            && interface.color_targets == 1
            && interface.varyings.len() >= 4,
        depth,
        is_general: is_general(descriptor, interface),
    }
}

/// Whether the state asks for more than RGBA8 targets, a depth test and blending by one colour, with one or four
/// samples that are treated alike.
fn is_general(descriptor: &RenderPipelineDescriptor, interface: &Interface) -> bool {
    let is_common = |target: &ColorTargetState| {
        let is_rgba8 = matches!(
            target.format,
            TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
        );
        is_rgba8 && !target.blend.as_ref().is_some_and(has_rare_factor)
    };
    let samples = descriptor.samples;
    let all_samples = u32::MAX >> (32 - samples.clamp(1, 32));
    !descriptor.targets.iter().all(is_common)
        || descriptor.targets.len() > 1 && samples > 1
        || !matches!(samples, 1 | 4)
        || descriptor.sample_mask & all_samples != all_samples
        || descriptor.stencil.is_some()
        || descriptor.logic_operation.is_some()
        || descriptor.alpha_to_coverage
        || samples > 1 && (descriptor.sample_shading || interface.per_sample)
        || samples > 1 && interface.sampling.iter().any(|s| *s != Sampling::Center)
        || descriptor.primitive.conservative != ConservativeMode::Disabled
        || interface.per_sample
        || interface.reads_coverage
        || interface.writes_sample_mask
        || interface.dual_source
        || interface.stores
        || matches!(
            interface.depth_output,
            DepthOutput::Greater | DepthOutput::Less
        )
}

fn has_rare_factor(blend: &BlendState) -> bool {
    factors(blend).iter().any(|factor| {
        factor.is_dual_source()
            || matches!(
                factor,
                BlendFactor::ConstantAlpha | BlendFactor::OneMinusConstantAlpha
            )
    })
}

fn uses_second_color(blend: &BlendState) -> bool {
    factors(blend).iter().any(|factor| factor.is_dual_source())
}

fn factors(blend: &BlendState) -> [BlendFactor; 4] {
    let BlendState { color, alpha } = blend;
    [
        color.src_factor,
        color.dst_factor,
        alpha.src_factor,
        alpha.dst_factor,
    ]
}
