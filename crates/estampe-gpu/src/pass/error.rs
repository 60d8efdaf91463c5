//! Errors of render passes.

use crate::{BufferConflict, BufferError, ImmediatesError, TextureConflict, TextureError};
use estampe_core::RenderPassError as DrawError;
use estampe_types::TextureFormat;

/// The reason why a pass was refused. Nothing has been drawn or cleared, unless it was
/// [cancelled](crate::DrawError::Cancelled) or a [shader was stopped](PassErrorKind::Stopped).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}: {kind}", name(pass.as_deref()))]
pub struct RenderPassError {
    /// The label of the pass.
    pub pass: Option<String>,
    /// The rule that it breaks.
    pub kind: PassErrorKind,
}

fn name(label: Option<&str>) -> String {
    label.map_or("the pass".to_owned(), |label| format!("the pass `{label}`"))
}

fn format_list(formats: &[Option<TextureFormat>]) -> String {
    let names = formats
        .iter()
        .map(|format| format.map_or("none", |format| format.name()));
    names.collect::<Vec<_>>().join(", ")
}

/// The rule that a pass breaks. Draws, attachments, groups and buffers are numbered from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PassErrorKind {
    /// No attachment gives the pass a size.
    #[error("it has no attachment: give it one, or set `extent`")]
    NoExtent,
    /// A size or a number of samples that a pass cannot have.
    #[error(
        "it has {width}x{height} pixels of {samples} samples: 1 to {limit}, and 1, 2, 4, 8 or 16 samples"
    )]
    Extent {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Samples per pixel.
        samples: u32,
        /// The longest side.
        limit: u32,
    },
    /// Too many colour attachments.
    #[error("{count} colour attachments; the limit max_color_attachments is {limit}")]
    TooManyColors {
        /// The number of colour attachments.
        count: usize,
        /// The limit.
        limit: u32,
    },
    /// A view that is not one image.
    #[error(
        "{attachment} is a view of {levels} mip levels and {layers} layers: render to a view of one level \
         (`Texture::image`), of a 3D texture with `depth_slice`"
    )]
    NotAnImage {
        /// The attachment.
        attachment: String,
        /// The mip levels of the view.
        levels: u32,
        /// The layers of the view.
        layers: u32,
    },
    /// Attachments of different numbers of layers.
    #[error(
        "its attachments are views of {} and of {} layers: all of them, and their resolve targets, \
         have the same number",
        counts[0], counts[1]
    )]
    Layers {
        /// The smallest and the largest number of layers.
        counts: [u32; 2],
    },
    /// Attachments of different sizes or samples.
    #[error(
        "{attachment} has {}x{} pixels of {} samples, and the pass {}x{} of {}: all attachments agree",
        actual[0], actual[1], actual[2], expected[0], expected[1], expected[2]
    )]
    Size {
        /// The attachment.
        attachment: String,
        /// Its width, height and samples.
        actual: [u32; 3],
        /// Those of the attachments before it.
        expected: [u32; 3],
    },
    /// A format that an attachment cannot have.
    #[error("{attachment} has the format {}: {rule}", format.name())]
    Format {
        /// The attachment.
        attachment: String,
        /// Its format.
        format: TextureFormat,
        /// The rule that it breaks.
        rule: &'static str,
    },
    /// One image is used twice, at least once to be written.
    #[error(
        "{first} and {second} are the same image: a pass cannot use an image that it writes twice"
    )]
    UsedTwice {
        /// One use.
        first: String,
        /// The other use.
        second: String,
    },
    /// A buffer is written by shaders and used otherwise.
    #[error(transparent)]
    BufferUsedTwice(#[from] BufferConflict),
    /// A texture is stored to and sampled.
    #[error(transparent)]
    TextureUsedTwice(#[from] TextureConflict),
    /// A resolve target that does not fit.
    #[error("the resolve target of {attachment} {rule}")]
    Resolve {
        /// The attachment.
        attachment: String,
        /// The rule that it breaks.
        rule: &'static str,
    },
    /// A texture that cannot be used as it is.
    #[error("{attachment}: {error}")]
    Texture {
        /// The use.
        attachment: String,
        /// The reason.
        error: TextureError,
    },
    /// A buffer that shaders write could not be made ready for that.
    #[error(transparent)]
    StorageBuffer(BufferError),
    /// More vertices than a pass may have.
    #[error(
        "draw {draw} brings the vertices of the pass to {vertices}, counted over all instances; the limit \
         max_pass_vertices is {limit}: raise it, or divide the pass"
    )]
    TooManyVertices {
        /// The draw.
        draw: usize,
        /// The vertices or indices of the draws up to it, times their instances.
        vertices: u64,
        /// The limit.
        limit: u64,
    },
    /// A range of a query that is not one of the pass's draws.
    #[error(
        "range query {query} is of draws {}..{}, and the pass has {draws}",
        range.start, range.end
    )]
    QueryRange {
        /// The query.
        query: usize,
        /// Its range of draws.
        range: std::ops::Range<usize>,
        /// The number of draws.
        draws: usize,
    },
    /// A pipeline was created for other colour attachments.
    #[error(
        "draw {draw}: its pipeline writes the colour formats [{}] and the pass has [{}]; give the pipeline one \
         target for each attachment, of the same format",
        format_list(pipeline),
        format_list(attachments)
    )]
    ColorFormats {
        /// The draw.
        draw: usize,
        /// The formats of the pipeline's targets; `None` is a hole.
        pipeline: Vec<Option<TextureFormat>>,
        /// The formats of the pass's attachments.
        attachments: Vec<Option<TextureFormat>>,
    },
    /// A shader was stopped, and the rest of the pass with it: what it drew is undefined.
    #[error(
        "draw {draw}: a shader of its pipeline executed more jumps than the limit max_shader_jumps, {limit}: \
         does a loop never end? Draw less at once, or raise the limit"
    )]
    Stopped {
        /// The first draw with the pipeline.
        draw: usize,
        /// The limit.
        limit: u64,
    },
    /// A draw that does not fit the attachments.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A draw that writes an aspect which the pass declares read-only.
    #[error(
        "draw {draw}: its pipeline writes {aspect}, which is read-only in this pass: create the pipeline \
         without, or attach with `AspectOperations::Write`"
    )]
    ReadOnly {
        /// The draw.
        draw: usize,
        /// Depth or stencil.
        aspect: &'static str,
    },
    /// Another number of vertex buffers than the pipeline's.
    #[error("draw {draw}: {given} vertex buffers, and its pipeline reads {expected}")]
    VertexBuffers {
        /// The draw.
        draw: usize,
        /// The number that the draw gives.
        given: usize,
        /// The number that the pipeline has layouts for.
        expected: usize,
    },
    /// A buffer that cannot be used as it is.
    #[error("draw {draw}: {buffer}: {error}")]
    Buffer {
        /// The draw.
        draw: usize,
        /// The use.
        buffer: String,
        /// The reason.
        error: BufferError,
    },
    /// An offset that is not a multiple of what it must be.
    #[error(
        "draw {draw}: {buffer} begins at byte {offset}, which is not a multiple of {alignment}"
    )]
    Offset {
        /// The draw.
        draw: usize,
        /// The use.
        buffer: String,
        /// The offset in bytes.
        offset: u64,
        /// The multiple that it must be of, in bytes.
        alignment: u32,
    },
    /// Too few or too many immediates.
    #[error("draw {draw}: {error}")]
    Immediates {
        /// The draw.
        draw: usize,
        /// The reason.
        error: ImmediatesError,
    },
    /// A bind group that is missing, of another layout, or beyond the pipeline's.
    #[error("draw {draw}: bind group {group}: {rule}")]
    BindGroup {
        /// The draw.
        draw: usize,
        /// The group's number.
        group: usize,
        /// The rule that it breaks.
        rule: String,
    },
}
