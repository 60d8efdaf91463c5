//! Primitive state: assembly of vertices into primitives, culling and rasterization modes.

/// Assembly of vertices into primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PrimitiveTopology {
    /// Each vertex is a point.
    PointList,
    /// Each two vertices are a line.
    LineList,
    /// Each vertex after the first ends a line that begins at the previous vertex.
    LineStrip,
    /// A strip that is closed by a line from the last vertex to the first.
    LineLoop,
    /// Each three vertices are a triangle.
    #[default]
    TriangleList,
    /// Each vertex after the second makes a triangle with the two before; every second triangle is
    /// turned so that all face the same way. A strip of the four vertices (x₀, y₀), (x₀, y₁), (x₁,
    /// y₀), (x₁, y₁) fills a rectangle exactly: every sample in it is covered once.
    TriangleStrip,
    /// Each vertex after the second makes a triangle with the first and the previous vertex.
    TriangleFan,
    /// Each four vertices are a line from the second to the third; the other two belong to
    /// neighbouring lines.
    LineListAdjacency,
    /// A line strip without its first and last vertex, which belong to neighbouring lines.
    LineStripAdjacency,
    /// Each six vertices are a triangle (0, 2, 4); the odd ones are the vertices opposite its
    /// edges.
    TriangleListAdjacency,
    /// A triangle strip of the even vertices; the odd ones are the vertices opposite its outer
    /// edges.
    TriangleStripAdjacency,
    /// Each so many vertices as the pipeline's tessellation state says are the control points of a
    /// patch. Only pipelines with tessellation have it.
    PatchList,
}

/// Winding of front faces in the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FrontFace {
    /// Counter-clockwise.
    #[default]
    Ccw,
    /// Clockwise.
    Cw,
}

/// Faces that are culled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CullMode {
    /// None.
    #[default]
    None,
    /// Front faces.
    Front,
    /// Back faces.
    Back,
}

/// Rasterization of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PolygonMode {
    /// Filled.
    #[default]
    Fill,
    /// Their edges as lines.
    Line,
    /// Their vertices as points.
    Point,
}

/// Vertex whose values flat varyings take. (Vulkan's `VK_EXT_provoking_vertex`, OpenGL's
/// `glProvokingVertex`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ProvokingVertex {
    /// The first, as in Vulkan and WebGPU.
    #[default]
    First,
    /// The last, as in OpenGL.
    Last,
}

/// Conservative rasterization. (Vulkan's `VK_EXT_conservative_rasterization`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ConservativeMode {
    /// Ordinary coverage: the samples that lie inside the primitive.
    #[default]
    Disabled,
    /// Every pixel that the primitive's area touches.
    Overestimate,
    /// Only pixels that lie completely inside the primitive.
    Underestimate,
}

/// Rasterization of lines. (Vulkan's `VK_EXT_line_rasterization`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LineRasterization {
    /// The diamond-exit rule. Wide lines are copies beside each other along the minor axis.
    #[default]
    Bresenham,
    /// The rectangle around the line.
    Rectangular,
    /// The rectangle around the line, with alpha multiplied by the covered part of each pixel, in
    /// sixteenths. With blending, the line is anti-aliased.
    RectangularSmooth,
}

/// A pattern that omits parts of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LineStipple {
    /// Number of fragments per bit of the pattern, 1..=256.
    pub factor: u16,
    /// The pattern, from the lowest bit on; fragments of zero bits are discarded.
    pub pattern: u16,
}

/// Line state. The default is one pixel wide, by the diamond-exit rule, not stippled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineState {
    /// Width in pixels, above 0 and at most 64. For Bresenham lines it is rounded to ⌊w + ½⌋, and
    /// is at least one pixel.
    pub width: f32,
    /// Rasterization mode.
    pub rasterization: LineRasterization,
    /// Stipple pattern, if any. It continues along the lines of a strip or loop, and along the
    /// edges of a triangle.
    pub stipple: Option<LineStipple>,
}

impl Default for LineState {
    fn default() -> Self {
        Self {
            width: 1.0,
            rasterization: LineRasterization::default(),
            stipple: None,
        }
    }
}

/// Assembly and rasterization of primitives. The default is a triangle list, counter-clockwise
/// front faces, no culling, filled.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PrimitiveState {
    /// Assembly of vertices into primitives.
    pub topology: PrimitiveTopology,
    /// If set, the greatest index of the index buffer's format ends a strip, loop, fan or list and
    /// begins another.
    pub primitive_restart: bool,
    /// Vertex whose values flat varyings take.
    pub provoking_vertex: ProvokingVertex,
    /// Winding of front faces.
    pub front_face: FrontFace,
    /// Faces that are culled.
    pub cull_mode: CullMode,
    /// Filled triangles, edges or vertices.
    pub polygon_mode: PolygonMode,
    /// If set, primitives are not clipped at the ends of the depth range. Depth is clamped to the
    /// viewport's range in any case. Vertices with w below 2⁻²⁰, among them all behind the eye, are
    /// clipped. (WebGPU's `unclippedDepth`, Vulkan's `depthClampEnable`.)
    pub unclipped_depth: bool,
    /// Conservative rasterization of triangles.
    pub conservative: ConservativeMode,
    /// Line state.
    pub line: LineState,
    /// If set, points are discs: a sample is covered within half the point size of the centre.
    /// Otherwise points are squares.
    pub round_points: bool,
}
