//! The depth and stencil tests.

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

    /// The same of stencil values.
    #[must_use]
    pub const fn passes_stencil(self, new: u8, stored: u8) -> bool {
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

/// What is added to the depth of every fragment of a triangle:
/// `slope_scale · max(|∂z/∂x|, |∂z/∂y|) + constant · r`, confined by `clamp`. The unit r is the least difference
/// that the depth format can tell: 2⁻ⁿ for n bits, and for floats 2^(e − 23) where e is the exponent of the
/// triangle's greatest depth. (Vulkan 1.3, "Depth Bias Computation".) The default adds nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DepthBiasState {
    /// How many units.
    pub constant: f32,
    /// How many times the greatest slope.
    pub slope_scale: f32,
    /// The greatest sum if positive, the least if negative; 0 confines nothing.
    pub clamp: f32,
}

impl DepthBiasState {
    /// Whether it adds nothing.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.constant == 0.0 && self.slope_scale == 0.0
    }
}

/// What becomes of a stencil value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum StencilOperation {
    /// It stays.
    #[default]
    Keep,
    /// It becomes 0.
    Zero,
    /// It becomes the reference.
    Replace,
    /// Its bits are inverted.
    Invert,
    /// One more, at most 255.
    IncrementClamp,
    /// One less, at least 0.
    DecrementClamp,
    /// One more, 0 after 255.
    IncrementWrap,
    /// One less, 255 after 0.
    DecrementWrap,
}

impl StencilOperation {
    /// The new value before the write mask.
    #[must_use]
    pub const fn apply(self, stored: u8, reference: u8) -> u8 {
        match self {
            Self::Keep => stored,
            Self::Zero => 0,
            Self::Replace => reference,
            Self::Invert => !stored,
            Self::IncrementClamp => stored.saturating_add(1),
            Self::DecrementClamp => stored.saturating_sub(1),
            Self::IncrementWrap => stored.wrapping_add(1),
            Self::DecrementWrap => stored.wrapping_sub(1),
        }
    }
}

/// The stencil test of one face. The default always passes and keeps what is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StencilFaceState {
    /// `(reference & read_mask) OP (stored & read_mask)`.
    pub compare: CompareFunction,
    /// Where the stencil test fails.
    pub fail_op: StencilOperation,
    /// Where it passes and the depth test fails.
    pub depth_fail_op: StencilOperation,
    /// Where both pass.
    pub pass_op: StencilOperation,
    /// The bits that are compared.
    pub read_mask: u8,
    /// The bits that are written.
    pub write_mask: u8,
}

impl Default for StencilFaceState {
    fn default() -> Self {
        Self {
            compare: CompareFunction::Always,
            fail_op: StencilOperation::Keep,
            depth_fail_op: StencilOperation::Keep,
            pass_op: StencilOperation::Keep,
            read_mask: 0xFF,
            write_mask: 0xFF,
        }
    }
}

/// The stencil test: of triangles by the side that is seen, of lines and points as of front faces. The reference
/// comes with the draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct StencilState {
    /// Where the front is seen.
    pub front: StencilFaceState,
    /// Where the back is seen.
    pub back: StencilFaceState,
}

impl From<StencilFaceState> for StencilState {
    /// The same test on both sides.
    fn from(face: StencilFaceState) -> Self {
        Self {
            front: face,
            back: face,
        }
    }
}
