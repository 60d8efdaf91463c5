//! The states of a pipeline, in WebGPU's words. Every value is plain data; every default is stated.

use crate::format::{TextureFormat, VertexFormat};

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
    /// so that all face the same way.
    TriangleStrip,
    /// Each vertex after the second makes a triangle with the one before and the first.
    TriangleFan,
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

/// How primitives are put together. The default is a triangle list, counter-clockwise front, nothing
/// culled, filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct PrimitiveState {
    /// How vertices are joined.
    pub topology: PrimitiveTopology,
    /// Which winding is the front.
    pub front_face: FrontFace,
    /// Which faces are dropped.
    pub cull_mode: CullMode,
    /// Filled, edges or vertices.
    pub polygon_mode: PolygonMode,
}

/// A comparison of a new value with the stored one: `new OP stored`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CompareFunction {
    /// Never passes.
    Never,
    /// `new < stored`.
    Less,
    /// `new == stored`.
    Equal,
    /// `new <= stored`.
    LessEqual,
    /// `new > stored`.
    Greater,
    /// `new != stored`.
    NotEqual,
    /// `new >= stored`.
    GreaterEqual,
    /// Always passes.
    #[default]
    Always,
}

impl CompareFunction {
    /// Whether `new` passes against `stored`. With a NaN only `Always` and `NotEqual` pass.
    #[must_use]
    pub fn passes(self, new: f32, stored: f32) -> bool {
        match self {
            Self::Never => false,
            Self::Less => new < stored,
            Self::Equal => new == stored,
            Self::LessEqual => new <= stored,
            Self::Greater => new > stored,
            Self::NotEqual => new != stored,
            Self::GreaterEqual => new >= stored,
            Self::Always => true,
        }
    }
}

/// The depth test. There is no default: a pipeline either has one or has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthState {
    /// Whether fragments that pass store their depth.
    pub write_enabled: bool,
    /// How a fragment's depth is compared with the stored one.
    pub compare: CompareFunction,
}

impl DepthState {
    /// Nearer fragments win and are stored: the common case.
    pub const LESS_WRITE: Self = Self {
        write_enabled: true,
        compare: CompareFunction::Less,
    };
    /// Nearer fragments pass, nothing is stored: transparent things.
    pub const LESS_READ: Self = Self {
        write_enabled: false,
        compare: CompareFunction::Less,
    };
}

/// What a colour is multiplied by in blending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlendFactor {
    /// 0.
    Zero,
    /// 1.
    One,
    /// The fragment's colour.
    Src,
    /// 1 − the fragment's colour.
    OneMinusSrc,
    /// The fragment's alpha.
    SrcAlpha,
    /// 1 − the fragment's alpha.
    OneMinusSrcAlpha,
    /// The stored colour.
    Dst,
    /// 1 − the stored colour.
    OneMinusDst,
    /// The stored alpha.
    DstAlpha,
    /// 1 − the stored alpha.
    OneMinusDstAlpha,
    /// min(source alpha, 1 − destination alpha) for colour, 1 for alpha.
    SrcAlphaSaturated,
    /// The blend constant.
    Constant,
    /// 1 − the blend constant.
    OneMinusConstant,
}

/// How the two products of blending are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BlendOperation {
    /// Source + destination.
    #[default]
    Add,
    /// Source − destination.
    Subtract,
    /// Destination − source.
    ReverseSubtract,
    /// The smaller, factors ignored.
    Min,
    /// The greater, factors ignored.
    Max,
}

/// Blending of colour or of alpha. The default replaces: source·1 + destination·0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BlendComponent {
    /// How the products are combined.
    pub operation: BlendOperation,
    /// What the fragment's value is multiplied by.
    pub src_factor: BlendFactor,
    /// What the stored value is multiplied by.
    pub dst_factor: BlendFactor,
}

impl BlendComponent {
    /// Source·1 + destination·0.
    pub const REPLACE: Self = Self {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::Zero,
    };
    /// Source·1 + destination·(1 − source alpha).
    pub const OVER: Self = Self {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
    };
}

impl Default for BlendComponent {
    fn default() -> Self {
        Self::REPLACE
    }
}

/// How a fragment's colour is combined with the stored one. The default replaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct BlendState {
    /// For R, G and B.
    pub color: BlendComponent,
    /// For alpha.
    pub alpha: BlendComponent,
}

impl BlendState {
    /// Source-over for straight alpha.
    pub const ALPHA_BLENDING: Self = Self {
        color: BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::SrcAlpha,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
        },
        alpha: BlendComponent::OVER,
    };
    /// Source-over for premultiplied alpha.
    pub const PREMULTIPLIED_ALPHA_BLENDING: Self = Self {
        color: BlendComponent::OVER,
        alpha: BlendComponent::OVER,
    };
    /// The sum, colour and alpha alike.
    pub const ADDITIVE: Self = {
        let sum = BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
        };
        Self {
            color: sum,
            alpha: sum,
        }
    };
}

/// Which channels a draw may change: bit 0 R, 1 G, 2 B, 3 A. The default is all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ColorWrites(pub u8);

impl ColorWrites {
    /// Every channel.
    pub const ALL: Self = Self(0xF);
    /// No channel.
    pub const NONE: Self = Self(0);
    /// Red, green and blue.
    pub const COLOR: Self = Self(0x7);
}

impl Default for ColorWrites {
    fn default() -> Self {
        Self::ALL
    }
}

/// One colour target of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ColorTargetState {
    /// The attachment's format.
    pub format: TextureFormat,
    /// How colours are combined; `None` replaces, which is cheaper.
    pub blend: Option<BlendState>,
    /// Which channels change.
    pub write_mask: ColorWrites,
}

impl From<TextureFormat> for ColorTargetState {
    fn from(format: TextureFormat) -> Self {
        Self {
            format,
            blend: None,
            write_mask: ColorWrites::ALL,
        }
    }
}

/// Whether a vertex buffer advances by vertex or by instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VertexStepMode {
    /// By vertex index.
    #[default]
    Vertex,
    /// By instance index.
    Instance,
}

/// One attribute of a vertex buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct VertexAttribute {
    /// How it is stored.
    pub format: VertexFormat,
    /// Bytes from the start of an element.
    pub offset: u32,
    /// Which of the shader's attributes it feeds.
    pub shader_location: u32,
}

/// How the elements of a vertex buffer lie.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct VertexBufferLayout {
    /// Bytes from one element to the next; 0 gives every vertex the same element.
    pub array_stride: u32,
    /// By vertex or by instance.
    pub step_mode: VertexStepMode,
    /// What an element holds.
    pub attributes: Vec<VertexAttribute>,
}

impl VertexBufferLayout {
    /// Attributes one after the other without gaps, feeding locations 0, 1, … by vertex.
    #[must_use]
    pub fn packed(formats: &[VertexFormat]) -> Self {
        let mut layout = Self::default();
        for (shader_location, &format) in (0u32..).zip(formats) {
            let offset = layout.array_stride;
            layout.attributes.push(VertexAttribute {
                format,
                offset,
                shader_location,
            });
            // A format has at most 16 bytes.
            layout.array_stride =
                offset.saturating_add(u32::try_from(format.size_bytes()).unwrap_or(16));
        }
        layout
    }
}

/// Where NDC lands in the target: a rectangle in window space and a range of depths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewport {
    /// Left edge, in pixels.
    pub x: f32,
    /// Top edge, in pixels.
    pub y: f32,
    /// Width in pixels, > 0.
    pub width: f32,
    /// Height in pixels, > 0.
    pub height: f32,
    /// Depth of NDC z = 0, in 0..=1.
    pub min_depth: f32,
    /// Depth of NDC z = 1, in 0..=1.
    pub max_depth: f32,
}

/// A rectangle of pixels outside which nothing is drawn; half-open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScissorRect {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}
