//! How a fragment's colour and the stored one are combined.

use crate::format::TextureFormat;

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
    /// The blend constant's alpha.
    ConstantAlpha,
    /// 1 − the blend constant's alpha.
    OneMinusConstantAlpha,
    /// The fragment's second colour.
    Src1,
    /// 1 − the fragment's second colour.
    OneMinusSrc1,
    /// The alpha of the fragment's second colour.
    Src1Alpha,
    /// 1 − the alpha of the fragment's second colour.
    OneMinusSrc1Alpha,
}

impl BlendFactor {
    /// Whether it needs a second colour from the shader.
    #[must_use]
    pub const fn is_dual_source(self) -> bool {
        matches!(
            self,
            Self::Src1 | Self::OneMinusSrc1 | Self::Src1Alpha | Self::OneMinusSrc1Alpha
        )
    }
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

/// A bitwise operation of the fragment's value s and the stored one d, in place of blending: on unorm, snorm and
/// integer formats the channels' bits are combined; on float and sRGB formats it does nothing and the fragment's
/// value replaces. (Vulkan 1.3, "Logical Operations".)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LogicOperation {
    /// 0
    Clear,
    /// s ∧ d
    And,
    /// s ∧ ¬d
    AndReverse,
    /// s
    Copy,
    /// ¬s ∧ d
    AndInverted,
    /// d
    NoOp,
    /// s ⊕ d
    Xor,
    /// s ∨ d
    Or,
    /// ¬(s ∨ d)
    Nor,
    /// ¬(s ⊕ d)
    Equivalent,
    /// ¬d
    Invert,
    /// s ∨ ¬d
    OrReverse,
    /// ¬s
    CopyInverted,
    /// ¬s ∨ d
    OrInverted,
    /// ¬(s ∧ d)
    Nand,
    /// 1
    Set,
}

impl LogicOperation {
    /// All sixteen, in Vulkan's order.
    pub const ALL: [Self; 16] = [
        Self::Clear,
        Self::And,
        Self::AndReverse,
        Self::Copy,
        Self::AndInverted,
        Self::NoOp,
        Self::Xor,
        Self::Or,
        Self::Nor,
        Self::Equivalent,
        Self::Invert,
        Self::OrReverse,
        Self::CopyInverted,
        Self::OrInverted,
        Self::Nand,
        Self::Set,
    ];
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
