//! Why a pipeline was refused.

use estampe_types::TextureFormat;

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
