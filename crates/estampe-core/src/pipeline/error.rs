//! Why a pipeline was refused.

use estampe_types::shader::GeometryPrimitive;
use estampe_types::state::PrimitiveTopology;
use estampe_types::{BindingType, SampleType, ShaderError, TextureFormat};

/// Why a pipeline was refused: the rule that its descriptor breaks.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// Too many bind group layouts.
    #[error("{count} bind group layouts; the limit max_bind_groups is {limit}")]
    TooManyBindGroups {
        /// The number of layouts.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// A binding of the shader that the layouts lack, or have as another kind.
    #[error(
        "the shader uses {shader} at group {group}, binding {binding}, where the bind group \
         layouts of the pipeline have {}",
        layout.map_or("nothing".to_owned(), |layout| layout.to_string())
    )]
    Binding {
        /// The group.
        group: usize,
        /// The binding.
        binding: u32,
        /// What the shader uses.
        shader: BindingType,
        /// What the layouts have.
        layout: Option<BindingType>,
    },
    /// Too many bindings of a kind, or too many bytes of colour.
    #[error("the pipeline has {count} {what}; the limit {limit_name} is {limit}")]
    TooMany {
        /// The kind.
        what: &'static str,
        /// The number of them.
        count: usize,
        /// The limit's name.
        limit_name: &'static str,
        /// The largest number allowed.
        limit: u32,
    },
    /// The shader contradicts what it declares, or a limit.
    #[error(transparent)]
    Shader(#[from] ShaderError),
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
        /// The number of colour targets.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// The shader writes another number of targets than there are.
    #[error(
        "the shader writes {shader} colour targets, the pipeline has {pipeline}: they must agree"
    )]
    TargetCount {
        /// The number of colour targets that the shader writes.
        shader: usize,
        /// The number of colour targets in the pipeline.
        pipeline: usize,
    },
    /// A colour target has a format that cannot be drawn into.
    #[error(
        "colour target {index} has the format {}, into which colours cannot be drawn: depth, stencil and compressed \
         formats and rgb9e5ufloat are not renderable",
        format.name()
    )]
    NotRenderable {
        /// The index of the colour target.
        index: usize,
        /// Its format.
        format: TextureFormat,
    },
    /// The shader writes other numbers than a colour target holds.
    #[error(
        "the shader writes {} at location {index}, and colour target {index} has the format {}, \
         which holds {}: give the output or the target the other's type",
        numbers(*shader), format.name(), numbers(format.sample_type())
    )]
    ColorType {
        /// The index of the colour target, which is the location of the shader's output.
        index: usize,
        /// The type of the numbers that the shader writes.
        shader: SampleType,
        /// The format of the target.
        format: TextureFormat,
    },
    /// Blending of integers.
    #[error(
        "colour target {index} blends, but its format {} holds integers, which cannot be blended",
        format.name()
    )]
    NotBlendable {
        /// The index of the colour target.
        index: usize,
        /// Its format.
        format: TextureFormat,
    },
    /// A blend factor needs a second colour, which the shader does not give.
    #[error(
        "colour target {0} blends with the fragment's second colour, but the shader gives none (with_second_color)"
    )]
    NoSecondColor(usize),
    /// Dual-source blending with another number of targets than one.
    #[error("a shader with a second colour has one colour target, this one has {0}")]
    DualSourceTargets(usize),
    /// Too many vertex buffers.
    #[error("the pipeline has {count} vertex buffers; the limit max_vertex_buffers is {limit}")]
    TooManyVertexBuffers {
        /// The number of vertex buffers.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// A stride is too large.
    #[error(
        "vertex buffer {buffer} has a stride of {stride} bytes; the limit \
         max_vertex_buffer_array_stride is {limit}"
    )]
    StrideTooLarge {
        /// The index of the vertex buffer.
        buffer: usize,
        /// Its stride in bytes.
        stride: u32,
        /// The largest stride allowed, in bytes.
        limit: u32,
    },
    /// An attribute reaches beyond its element.
    #[error(
        "attribute at location {location} ends at byte {end} of an element of vertex buffer {buffer}, \
         beyond its stride of {stride}"
    )]
    AttributeBeyondStride {
        /// The index of the vertex buffer.
        buffer: usize,
        /// The shader location that it feeds.
        location: u32,
        /// The end of the attribute in bytes from the element's beginning.
        end: u64,
        /// The length of an element in bytes.
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
        /// The number of locations that the shader reads.
        count: usize,
    },
    /// Too many attributes.
    #[error("the shader reads {count} attributes; the limit max_vertex_attributes is {limit}")]
    TooManyAttributes {
        /// The number of attributes that the shader reads.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// Too many clip or cull distances.
    #[error("the shader has {count} clip or cull distances; there are at most {limit} of each")]
    TooManyDistances {
        /// The number of clip or cull distances.
        count: usize,
        /// The largest number of each allowed.
        limit: usize,
    },
    /// The program reads the derivative of a varying that it does not have, or does not list them
    /// in ascending order.
    #[error(
        "the program reads the derivative of scalar {scalar} of its {count} scalars of varyings: \
         list scalars that exist, in ascending order"
    )]
    Gradient {
        /// The scalar.
        scalar: usize,
        /// The number of scalars of varyings.
        count: usize,
    },
    /// Too many varyings.
    #[error(
        "the shader has {count} scalars of varyings; the limit max_inter_stage_scalars is {limit}"
    )]
    TooManyVaryings {
        /// The number of scalars of varyings.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// Patches without tessellation, or tessellation of something else.
    #[error(
        "the topology is {topology:?}: a pipeline has tessellation if, and only if, its topology is \
         PatchList"
    )]
    PatchTopology {
        /// The topology.
        topology: PrimitiveTopology,
    },
    /// A patch without vertices, or with too many.
    #[error("a patch has {0} vertices (patch_points); it must have 1 to 32")]
    PatchPoints(u32),
    /// Too many scalars of control points or patches.
    #[error("{what} of the tessellation shader has {count} scalars; there are at most {limit}")]
    PatchScalars {
        /// A control point, or the values of a patch.
        what: &'static str,
        /// The number of scalars.
        count: usize,
        /// The largest number allowed.
        limit: usize,
    },
    /// A stage reads other varyings than the stage before gives.
    #[error(
        "the {from} gives {gives} scalars of varyings and the {to} reads {reads}: they must agree \
         (vertex_program names a vertex shader whose varyings differ from the fragments')"
    )]
    StageScalars {
        /// The stage that gives them.
        from: &'static str,
        /// The scalars that it gives.
        gives: usize,
        /// The stage that reads them.
        to: &'static str,
        /// The scalars that it reads.
        reads: usize,
    },
    /// The geometry shader reads other primitives than it is given.
    #[error("the {from} gives {made:?} and the geometry shader reads {reads:?}: they must agree")]
    GeometryInput {
        /// The state that gives the primitives.
        from: &'static str,
        /// The primitives that it gives.
        made: GeometryPrimitive,
        /// The primitives that the shader reads.
        reads: GeometryPrimitive,
    },
    /// A vertex program without a stage that needs it.
    #[error(
        "the pipeline has a vertex_program and neither tessellation nor a geometry shader; give the \
         vertex shader in `program`"
    )]
    VertexProgramUnused,
}

/// The name of a type of numbers in a sentence.
fn numbers(of: SampleType) -> &'static str {
    match of {
        SampleType::Float => "floats (f32)",
        SampleType::Uint => "unsigned integers (u32)",
        SampleType::Sint => "signed integers (i32)",
        SampleType::Depth => "depths",
    }
}
