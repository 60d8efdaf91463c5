//! Blending and logic operations: the combination of a fragment's colour with the stored colour.

use crate::format::TextureFormat;

/// Factor by which a colour is multiplied in blending.
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
    /// True if the factor requires a second colour from the shader.
    #[must_use]
    pub const fn is_dual_source(self) -> bool {
        matches!(
            self,
            Self::Src1 | Self::OneMinusSrc1 | Self::Src1Alpha | Self::OneMinusSrc1Alpha
        )
    }
}

/// Operation that combines the two products of blending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BlendOperation {
    /// Source + destination.
    #[default]
    Add,
    /// Source − destination.
    Subtract,
    /// Destination − source.
    ReverseSubtract,
    /// The smaller one; the factors are ignored.
    Min,
    /// The greater one; the factors are ignored.
    Max,
}

/// Blending of colour or of alpha. The default replaces: source·1 + destination·0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BlendComponent {
    /// Operation that combines the two products.
    pub operation: BlendOperation,
    /// Factor of the fragment's value.
    pub src_factor: BlendFactor,
    /// Factor of the stored value.
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

/// Blending of a colour target. The default replaces the stored colour.
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
    /// The sum, for both colour and alpha.
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

/// Bitwise operation on the fragment's value s and the stored value d, in place of blending. On
/// unorm, snorm and integer formats it combines the bits of the channels. On float and sRGB formats
/// it has no effect: the fragment's value replaces the stored one. (Vulkan 1.3, "Logical
/// Operations".)
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

/// Mask of the channels that a draw writes: bit 0 R, 1 G, 2 B, 3 A. The default is all.
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
    /// Blending; `None` replaces, which is cheaper.
    pub blend: Option<BlendState>,
    /// Mask of the channels that are written.
    pub write_mask: ColorWrites,
}

/// A target that is no hole, so that a list of targets can be written as a list of formats.
impl From<TextureFormat> for Option<ColorTargetState> {
    fn from(format: TextureFormat) -> Self {
        Some(format.into())
    }
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
