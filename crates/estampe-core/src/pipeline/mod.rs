//! The state of a draw: an untrusted descriptor, validated once into an immutable pipeline.

pub(crate) mod amplified;
mod binding_limits;
pub(crate) mod color_target;
mod declared_bindings;
mod error;
pub(crate) mod primitive_kind;
mod stage_key;

pub use amplified::TessellationState;
pub use binding_limits::{check_bind_group_layouts, check_immediates};
pub use error::PipelineError;
pub(crate) use stage_key::StageKey;

use amplified::Amplified;
use binding_limits::check_bindings;
use color_target::ColorTarget;
pub use declared_bindings::check_declared;
use estampe_types::shader::{GeometryProgram, MAX_DISTANCES, StoppedBatches, TextureReads};
use estampe_types::state::{
    BlendFactor, BlendState, ColorTargetState, DepthStencilState, LineState, LineStipple,
    LogicOperation, MultisampleState, PrimitiveState, VertexBufferLayout,
};
use estampe_types::{
    BindGroupLayout, Interface, Limits, Program, Shader, ShaderProgram, TextureFormat, VertexFormat,
};
use std::sync::Arc;

/// Describes a render pipeline.
#[derive(Debug, Clone)]
pub struct RenderPipelineDescriptor {
    /// The vertex and fragment shader.
    pub program: Arc<dyn Program>,
    /// The program whose vertex shader is used in place of `program`'s, in pipelines with
    /// tessellation or a geometry shader: its varyings are those that these stages read, while
    /// `program`'s are those that fragments read. Default none.
    pub vertex_program: Option<Arc<dyn Program>>,
    /// Tessellation of patches. Its topology is [`PatchList`]. Default none.
    ///
    /// [`PatchList`]: estampe_types::state::PrimitiveTopology::PatchList
    pub tessellation: Option<TessellationState>,
    /// A geometry shader, which reads the primitives of the topology, or of tessellation. Default
    /// none.
    pub geometry: Option<Arc<dyn GeometryProgram>>,
    /// The bind groups that the shaders read, by group number: each draw must bind groups of these
    /// layouts. Default those that the program declares: all that a shader as text uses, none of
    /// a shader in Rust.
    pub bind_group_layouts: Vec<BindGroupLayout>,
    /// The layout of each vertex buffer of a draw. Default none.
    pub vertex_buffers: Vec<VertexBufferLayout>,
    /// Topology, facing, culling. Default a triangle list, nothing culled.
    pub primitive: PrimitiveState,
    /// The depth and stencil tests, or none. Default depth less, written.
    pub depth_stencil: Option<DepthStencilState>,
    /// Samples per pixel, and which of them may change. Default one.
    pub multisample: MultisampleState,
    /// A logic operation in place of blending, for all targets. Default none.
    pub logic_operation: Option<LogicOperation>,
    /// The colour targets, by the number of the shader's colour; `None` is a hole, whose colour is
    /// dropped. Default one `Rgba8Unorm`, replaced.
    pub targets: Vec<Option<ColorTargetState>>,
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
            bind_group_layouts: program.bind_group_layouts().to_vec(),
            program,
            vertex_program: None,
            tessellation: None,
            geometry: None,
            vertex_buffers: Vec::new(),
            primitive: PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState::LESS_WRITE),
            multisample: MultisampleState::default(),
            logic_operation: None,
            targets: vec![Some(TextureFormat::Rgba8Unorm.into())],
        }
    }

    /// The bytes of immediates that its programs read: each draw must give at least as many.
    #[must_use]
    pub fn immediate_size(&self) -> u32 {
        let vertices = self.vertex_program.as_ref();
        let of_vertices = vertices.map_or(0, |program| program.immediate_size());
        self.program.immediate_size().max(of_vertices)
    }
}

/// The routine that decodes an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Decoding {
    Float32,
    Unorm8,
    Unorm16,
    /// Any other format, and attributes that several instances share. They are fetched apart from
    /// the common attributes.
    Rare,
}

/// The buffer, layout and format that an attribute of the shader is read from.
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
    color_targets: Vec<ColorTarget>,
    /// The stages between vertices and primitives, if there are any.
    amplified: Option<Amplified>,
    /// The vertices are records that other stages made.
    has_finished_vertices: bool,
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
        descriptor.program.validate()?;
        let interface = descriptor.program.interface();
        check_bindings(descriptor, limits)?;
        check_declared(
            descriptor.program.bind_group_layouts(),
            &descriptor.bind_group_layouts,
        )?;
        check_targets(descriptor, interface, limits)?;
        check_interface(interface, limits)?;
        check_lines(&descriptor.primitive.line)?;
        let amplified = Amplified::new(descriptor, limits)?;
        // The vertex shader of an amplified pipeline belongs to another one.
        let attributes = match &amplified {
            Some(_) => Vec::new(),
            None => attribute_sources(descriptor, interface, limits)?,
        };
        let mut inner = Inner::new(descriptor.clone(), attributes);
        inner.amplified = amplified;
        Ok(Self::of(inner))
    }

    /// The batches of its programs that were stopped.
    pub fn stopped_batches(&self) -> impl Iterator<Item = &StoppedBatches> {
        let descriptor = &self.inner.descriptor;
        let programs = [
            Some(&descriptor.program),
            descriptor.vertex_program.as_ref(),
        ];
        let programs = programs.into_iter().flatten();
        programs.filter_map(|program| program.stopped_batches())
    }

    fn of(inner: Inner) -> Self {
        Self {
            inner: Arc::new(inner),
        }
    }

    /// Returns the descriptor from which the pipeline was made.
    #[must_use]
    pub fn descriptor(&self) -> &RenderPipelineDescriptor {
        &self.inner.descriptor
    }

    /// Returns true if the shader stores to textures.
    #[must_use]
    pub fn stores(&self) -> bool {
        self.interface().stores
    }

    /// How shaders may read the texture at this place: see [`Program::texture_reads`].
    #[must_use]
    pub fn texture_reads(&self, group: u32, binding: u32) -> TextureReads {
        let descriptor = &self.inner.descriptor;
        let has_other_programs = descriptor.vertex_program.is_some()
            || descriptor.tessellation.is_some()
            || descriptor.geometry.is_some();
        match has_other_programs {
            true => TextureReads::ALL,
            false => descriptor.program.texture_reads(group, binding),
        }
    }

    pub(crate) fn program(&self) -> &dyn Program {
        &*self.inner.descriptor.program
    }

    pub(crate) fn interface(&self) -> &Interface {
        self.program().interface()
    }

    /// Returns true if there are stages between vertices and primitives: tessellation, a geometry
    /// shader.
    #[must_use]
    pub fn amplifies(&self) -> bool {
        self.inner.amplified.is_some()
    }

    /// The stages between vertices and primitives, if there are any.
    pub(crate) fn amplified(&self) -> Option<&Amplified> {
        self.inner.amplified.as_ref()
    }

    /// True if the vertices are records that other stages made.
    pub(crate) fn has_finished_vertices(&self) -> bool {
        self.inner.has_finished_vertices
    }

    pub(crate) fn attributes(&self) -> &[AttributeSource] {
        &self.inner.attributes
    }

    pub(crate) fn key(&self) -> &StageKey {
        &self.inner.key
    }

    /// The facts of the colour targets that are no holes.
    pub(crate) fn color_targets(&self) -> &[ColorTarget] {
        &self.inner.color_targets
    }

    /// Returns true if both are clones of one pipeline.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }
}

impl Inner {
    /// The parts of a plain pipeline of what was checked.
    fn new(descriptor: RenderPipelineDescriptor, attributes: Vec<AttributeSource>) -> Self {
        let interface = descriptor.program.interface();
        let targets = descriptor.targets.iter().enumerate();
        let color_targets: Vec<_> = targets
            .filter_map(|(output, target)| {
                let target = target.as_ref()?;
                Some(ColorTarget::new(target, output, descriptor.logic_operation))
            })
            .collect();
        let key = StageKey::new(&descriptor, interface, &color_targets);
        Self {
            descriptor,
            attributes,
            key,
            color_targets,
            amplified: None,
            has_finished_vertices: false,
        }
    }
}

fn check_targets(
    descriptor: &RenderPipelineDescriptor,
    interface: &Interface,
    limits: &Limits,
) -> Result<(), PipelineError> {
    if !matches!(descriptor.multisample.count, 1 | 2 | 4 | 8 | 16) {
        return Err(PipelineError::SampleCount(descriptor.multisample.count));
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
        let Some(target) = target else {
            continue;
        };
        let format = target.format;
        if !format.is_renderable() {
            return Err(PipelineError::NotRenderable { index, format });
        }
        if let Some(&Some(shader)) = interface.color_types.get(index)
            && shader != format.sample_type()
        {
            return Err(PipelineError::ColorType {
                index,
                shader,
                format,
            });
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
    let gradients = &interface.gradients;
    for (number, &scalar) in gradients.iter().enumerate() {
        if scalar >= count
            || gradients[..number]
                .last()
                .is_some_and(|&before| before >= scalar)
        {
            return Err(PipelineError::Gradient { scalar, count });
        }
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

/// Returns the decoding of a format, for attributes whose elements several instances do not share.
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
