//! The history of a pixel, as plain data.

use super::TestOutcome;

/// What happened to a pixel in a pass.
#[derive(Debug, Clone, PartialEq)]
pub struct PixelHistory {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The layer of the attachments; 0 if they have one.
    pub layer: u32,
    /// The stored values of each sample after the attachments were loaded or cleared.
    pub initial: Vec<SampleValues>,
    /// The primitives that cover the pixel, in the order in which they were drawn.
    pub primitives: Vec<PrimitiveRecord>,
    /// The stored values of each sample after the last draw.
    pub last: Vec<SampleValues>,
    /// The bytes of the pixel in each colour attachment, as the texture or, of several samples, the
    /// resolve target holds them; `None` of a hole.
    pub texels: Vec<Option<Vec<u8>>>,
}

/// The stored values of one sample.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleValues {
    /// R, G, B, A of each colour attachment, linear; integers of integer formats as numbers; `None`
    /// of a hole.
    pub colors: Vec<Option<[f64; 4]>>,
    /// The encoded R, G, B, A of each colour attachment; `None` of a hole.
    pub codes: Vec<Option<[u32; 4]>>,
    /// The depth, 0..=1; `None` without a depth attachment.
    pub depth: Option<f32>,
    /// The stencil value; `None` without a stencil attachment.
    pub stencil: Option<u8>,
}

/// What reaches the rasterizer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PrimitiveKind {
    /// A point.
    Point,
    /// A line.
    Line,
    /// A triangle.
    Triangle,
}

impl PrimitiveKind {
    /// The name in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Line => "line",
            Self::Triangle => "triangle",
        }
    }
}

/// A primitive, or a piece of one, that covers a sample of the pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct PrimitiveRecord {
    /// The number of the draw in the pass.
    pub draw: usize,
    /// The number of the primitive in the draw, over all instances; of primitives that
    /// tessellation or a geometry shader made, over all of those, in all layers.
    pub primitive: u64,
    /// The index of the instance.
    pub instance: u32,
    /// What tessellation or a geometry shader made the primitive of; `None` without them.
    pub origin: Option<PrimitiveOrigin>,
    /// The vertices as the vertex shader, or the last stage after it, left them; of a triangle the
    /// provoking one first.
    pub vertices: Vec<InspectedVertex>,
    /// The kind of the piece: lines and points of triangles that are drawn as such are those.
    pub kind: PrimitiveKind,
    /// The vertices of the piece in the window: those of the primitive, unless it was clipped.
    pub piece: Vec<PieceVertex>,
    /// True if the piece is not the primitive itself, but a part that clipping left.
    pub is_clipped: bool,
    /// True if the primitive is front facing; lines and points are.
    pub front_facing: bool,
    /// True if the facing of the piece is culled: nothing else happened.
    pub is_culled: bool,
    /// Of a triangle, its edge functions at the pixel's centre, in pixels²: twice the areas of the
    /// triangles that the centre makes with the edges opposite to each vertex of the piece,
    /// positive inside.
    pub edges: Option<[f64; 3]>,
    /// Of a triangle, the edge functions divided by their sum.
    pub barycentrics: Option<[f64; 3]>,
    /// The shader's runs on the pixel: one, or one for each covered sample.
    pub fragments: Vec<FragmentRecord>,
}

/// What tessellation or a geometry shader made a primitive of.
#[derive(Debug, Clone, PartialEq)]
pub struct PrimitiveOrigin {
    /// The number of the patch or primitive in its instance, as shaders read it.
    pub number: u32,
    /// The vertices of the patch or primitive as the vertex shader left them, those of neighbours
    /// included.
    pub vertices: Vec<InspectedVertex>,
    /// What tessellation made of the patch; `None` without it.
    pub tessellated: Option<TessellatedRecord>,
    /// What the geometry shader emitted; `None` without it.
    pub emitted: Option<EmittedRecord>,
}

/// A primitive of a patch.
#[derive(Debug, Clone, PartialEq)]
pub struct TessellatedRecord {
    /// The outer levels of the patch, as its shader left them.
    pub outer: [f32; 4],
    /// The inner levels of the patch, as its shader left them.
    pub inner: [f32; 2],
    /// The number of the primitive in the patch.
    pub primitive: u32,
    /// Its vertices.
    pub vertices: Vec<TessellatedVertex>,
}

/// A vertex that tessellation made.
#[derive(Debug, Clone, PartialEq)]
pub struct TessellatedVertex {
    /// The place in the domain: u, v, and in triangles w.
    pub coordinates: [f32; 3],
    /// x, y, z, w in clip space.
    pub clip: [f32; 4],
    /// The scalars of the varyings, in order.
    pub varyings: Vec<f32>,
}

/// How a geometry shader emitted a primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EmittedRecord {
    /// The number of the shader's invocation on its primitive.
    pub invocation: u32,
    /// The layer that the provoking vertex names. One that does not exist counts as 0.
    pub layer: u32,
    /// The viewport that the provoking vertex names. One that does not exist counts as 0.
    pub viewport_index: u32,
}

/// A vertex of a primitive.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedVertex {
    /// The index of the vertex; of a vertex that tessellation or a geometry shader made, its number
    /// in its primitive.
    pub index: u32,
    /// The attributes as they were fetched, by location; none of a vertex that was made.
    pub attributes: Vec<Vec<f32>>,
    /// x, y, z, w in clip space.
    pub clip: [f32; 4],
    /// The scalars of the varyings, in order.
    pub varyings: Vec<f32>,
}

impl InspectedVertex {
    /// The position in normalized device coordinates: x ÷ w, y ÷ w, z ÷ w; `None` behind the eye.
    #[must_use]
    pub fn ndc(&self) -> Option<[f32; 3]> {
        let [x, y, z, w] = self.clip;
        (w > 0.0).then(|| [x / w, y / w, z / w])
    }
}

/// A vertex of a piece in the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceVertex {
    /// x and y in pixels, from the top left: multiples of 1/256.
    pub position: [f32; 2],
    /// The depth, before it is clamped to the viewport's range.
    pub depth: f32,
    /// 1 ÷ w of clip space.
    pub inverse_w: f32,
}

/// A run of the fragment shader.
#[derive(Debug, Clone, PartialEq)]
pub struct FragmentRecord {
    /// The sample that was shaded; `None` if shading is per pixel.
    pub sample: Option<u32>,
    /// The covered samples for which it ran, bit by bit.
    pub covered: u16,
    /// Window x, y, interpolated depth, and 1/w, at the place of the run.
    pub position: [f32; 4],
    /// The interpolated scalars of the varyings.
    pub varyings: Vec<f32>,
    /// The shader's colours.
    pub colors: Vec<[f32; 4]>,
    /// The depth that the shader wrote, if it writes one.
    pub depth: Option<f32>,
    /// True if the shader discarded the fragment.
    pub is_discarded: bool,
    /// The samples that are left after discarding, the shader's sample mask and alpha to coverage.
    pub kept: u16,
    /// The tests of the samples that are left, in order.
    pub samples: Vec<SampleRecord>,
}

/// The tests of a sample, and what they stored.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleRecord {
    /// The number of the sample.
    pub sample: u32,
    /// The depth that was tested, as the attachment stores it.
    pub depth: f32,
    /// The first test that failed, or that all passed.
    pub outcome: TestOutcome,
    /// The stored values before.
    pub before: SampleValues,
    /// The stored values after.
    pub after: SampleValues,
}
