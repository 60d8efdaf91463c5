//! How vertices become primitives, and what of those is drawn.

/// How vertices are joined into primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PrimitiveTopology {
    /// Each vertex is a point.
    PointList,
    /// Each two vertices are a line.
    LineList,
    /// Each vertex after the first ends a line that begins at the one before.
    LineStrip,
    /// A strip that is closed by a line from the last vertex to the first.
    LineLoop,
    /// Each three vertices are a triangle.
    #[default]
    TriangleList,
    /// Each vertex after the second makes a triangle with the two before; every other one is turned
    /// so that all face the same way. One of four vertices, (x₀, y₀), (x₀, y₁), (x₁, y₀), (x₁, y₁), fills a
    /// rectangle exactly: every sample in it once.
    TriangleStrip,
    /// Each vertex after the second makes a triangle with the one before and the first.
    TriangleFan,
    /// Each four vertices are a line, the second to the third, with its neighbours' other ends around it.
    LineListAdjacency,
    /// A line strip whose first and last vertices are neighbours only.
    LineStripAdjacency,
    /// Each six vertices are a triangle (0, 2, 4); the odd ones are the vertices opposite its edges.
    TriangleListAdjacency,
    /// A triangle strip of the even vertices; the odd ones are the vertices opposite its outer edges.
    TriangleStripAdjacency,
}

/// Which winding, as seen in the window, is the front.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FrontFace {
    /// Counter-clockwise.
    #[default]
    Ccw,
    /// Clockwise.
    Cw,
}

/// Which triangles are dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CullMode {
    /// None.
    #[default]
    None,
    /// Those that face the viewer.
    Front,
    /// Those that face away.
    Back,
}

/// How triangles are drawn.
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

/// Which vertex of a primitive gives the values that are not interpolated. (Vulkan's
/// `VK_EXT_provoking_vertex`, OpenGL's `glProvokingVertex`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ProvokingVertex {
    /// The first, as in Vulkan and WebGPU.
    #[default]
    First,
    /// The last, as in OpenGL.
    Last,
}

/// What of a pixel a primitive must touch to cover it. (Vulkan's `VK_EXT_conservative_rasterization`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ConservativeMode {
    /// Its samples, as ever.
    #[default]
    Disabled,
    /// Any part of its area: no pixel that is touched is left out.
    Overestimate,
    /// All of its area: no pixel is drawn that is not inside.
    Underestimate,
}

/// How a line becomes pixels. (Vulkan's `VK_EXT_line_rasterization`.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LineRasterization {
    /// By the diamond-exit rule; wide ones are copies beside each other along the minor axis.
    #[default]
    Bresenham,
    /// The rectangle around the line.
    Rectangular,
    /// The same, alpha multiplied by how much of each pixel is covered, in sixteenths: anti-aliased, if blended.
    RectangularSmooth,
}

/// A pattern that leaves out parts of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LineStipple {
    /// How many fragments each bit of the pattern stands for, 1..=256.
    pub factor: u16,
    /// The lowest bit is the first; where a bit is 0 nothing is drawn.
    pub pattern: u16,
}

/// How lines are drawn. The default is one pixel wide, by the diamond-exit rule, not stippled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineState {
    /// Width in pixels, above 0 and at most 64. Bresenham lines are as many pixels wide as this is when rounded,
    /// half to even, but at least one.
    pub width: f32,
    /// How they become pixels.
    pub rasterization: LineRasterization,
    /// What is left out, if anything. The pattern goes on along the lines of a strip or loop, and along the edges of a
    /// triangle.
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

/// How primitives are put together and drawn. The default is a triangle list, counter-clockwise front, nothing
/// culled, filled.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PrimitiveState {
    /// How vertices are joined.
    pub topology: PrimitiveTopology,
    /// Whether the greatest index of the index buffer's format ends a strip, loop, fan or list and begins another.
    pub primitive_restart: bool,
    /// Which vertex gives the values that are not interpolated.
    pub provoking_vertex: ProvokingVertex,
    /// Which winding is the front.
    pub front_face: FrontFace,
    /// Which faces are dropped.
    pub cull_mode: CullMode,
    /// Filled, edges or vertices.
    pub polygon_mode: PolygonMode,
    /// Whether nothing is clipped at the depth range's ends; depth is clamped to the viewport's in any case. What
    /// has w below 2⁻²⁰, such as all that lies behind the eye, is clipped. (WebGPU's `unclippedDepth`, Vulkan's
    /// `depthClampEnable`.)
    pub unclipped_depth: bool,
    /// What of a pixel a triangle must touch to cover it.
    pub conservative: ConservativeMode,
    /// How lines are drawn.
    pub line: LineState,
    /// Whether points are round: only samples within half their size of the centre are covered. Squares otherwise.
    pub round_points: bool,
}
