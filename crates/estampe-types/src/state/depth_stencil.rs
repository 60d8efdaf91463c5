//! State of the depth and stencil tests.

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
    /// True if `new` passes against `stored`. With a NaN only `Always` and `NotEqual` pass.
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

    /// True if the stencil value `new` passes against `stored`.
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

/// The depth test. There is no default: a pipeline without a depth test has no `DepthState`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthState {
    /// If set, fragments that pass store their depth.
    pub write_enabled: bool,
    /// Comparison of a fragment's depth with the stored one.
    pub compare: CompareFunction,
}

impl DepthState {
    /// Nearer fragments pass and store their depth: the common case.
    pub const LESS_WRITE: Self = Self {
        write_enabled: true,
        compare: CompareFunction::Less,
    };
    /// Nearer fragments pass and store no depth: for transparent surfaces.
    pub const LESS_READ: Self = Self {
        write_enabled: false,
        compare: CompareFunction::Less,
    };
}

/// Depth bias: the value that is added to the depth of every fragment of a triangle, `slope_scale ·
/// max(|∂z/∂x|, |∂z/∂y|) + constant · r`, limited by `clamp`. The unit r is the least difference
/// that the depth format resolves: 2⁻ⁿ for n bits, and for floats 2^(e − 23) where e is the
/// exponent of the triangle's greatest depth. (Vulkan 1.3, "Depth Bias Computation".) The default
/// adds nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DepthBiasState {
    /// Constant bias, in units of r.
    pub constant: f32,
    /// Factor of the greatest slope.
    pub slope_scale: f32,
    /// Greatest bias if positive, least bias if negative; 0 for no limit.
    pub clamp: f32,
}

impl DepthBiasState {
    /// True if the bias adds nothing.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.constant == 0.0 && self.slope_scale == 0.0
    }
}

/// Operation on a stored stencil value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum StencilOperation {
    /// Keeps the stored value.
    #[default]
    Keep,
    /// Stores 0.
    Zero,
    /// Stores the reference.
    Replace,
    /// Inverts the bits.
    Invert,
    /// Adds 1, up to 255.
    IncrementClamp,
    /// Subtracts 1, down to 0.
    DecrementClamp,
    /// Adds 1; 255 becomes 0.
    IncrementWrap,
    /// Subtracts 1; 0 becomes 255.
    DecrementWrap,
}

impl StencilOperation {
    /// The result of the operation, before the write mask.
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

/// The stencil test of one face. The default always passes and keeps the stored value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StencilFaceState {
    /// `(reference & read_mask) OP (stored & read_mask)`.
    pub compare: CompareFunction,
    /// Operation if the stencil test fails.
    pub fail_op: StencilOperation,
    /// Operation if the stencil test passes and the depth test fails.
    pub depth_fail_op: StencilOperation,
    /// Operation if both tests pass.
    pub pass_op: StencilOperation,
    /// Mask of the compared bits.
    pub read_mask: u8,
    /// Mask of the written bits.
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

/// The stencil test. Triangles use the test of the face towards the viewer; lines and points use
/// `front`. The reference is part of the draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct StencilState {
    /// The test of front faces, lines and points.
    pub front: StencilFaceState,
    /// The test of back faces.
    pub back: StencilFaceState,
}

impl StencilState {
    /// True if the test may change stencil values.
    #[must_use]
    pub fn writes(&self) -> bool {
        [self.front, self.back].iter().any(|face| {
            let operations = [face.fail_op, face.depth_fail_op, face.pass_op];
            face.write_mask != 0 && operations != [StencilOperation::Keep; 3]
        })
    }
}

impl From<StencilFaceState> for StencilState {
    /// Creates a state with the same test for both faces.
    fn from(face: StencilFaceState) -> Self {
        Self {
            front: face,
            back: face,
        }
    }
}

/// Depth and stencil of a pipeline: WebGPU's `GPUDepthStencilState`, without the format, which is
/// the attachment's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthStencilState {
    /// If set, fragments that pass store their depth. Default not.
    pub depth_write_enabled: bool,
    /// Comparison of a fragment's depth with the stored one. Default always.
    pub depth_compare: CompareFunction,
    /// The stencil test. Default none.
    pub stencil: Option<StencilState>,
    /// The bias added to the depth of triangles. Default nothing.
    pub bias: DepthBiasState,
}

impl DepthStencilState {
    /// Nearer fragments pass and store their depth: the common case.
    pub const LESS_WRITE: Self = Self::of(DepthState::LESS_WRITE);
    /// Nearer fragments pass and store no depth: for transparent surfaces.
    pub const LESS_READ: Self = Self::of(DepthState::LESS_READ);

    const fn of(depth: DepthState) -> Self {
        Self {
            depth_write_enabled: depth.write_enabled,
            depth_compare: depth.compare,
            stencil: None,
            bias: DepthBiasState {
                constant: 0.0,
                slope_scale: 0.0,
                clamp: 0.0,
            },
        }
    }

    /// The depth test.
    #[must_use]
    pub const fn depth(&self) -> DepthState {
        DepthState {
            write_enabled: self.depth_write_enabled,
            compare: self.depth_compare,
        }
    }
}

impl Default for DepthStencilState {
    fn default() -> Self {
        Self::of(DepthState {
            write_enabled: false,
            compare: CompareFunction::Always,
        })
    }
}

impl From<DepthState> for DepthStencilState {
    /// A depth test alone.
    fn from(depth: DepthState) -> Self {
        Self::of(depth)
    }
}

impl From<StencilState> for DepthStencilState {
    /// A stencil test alone.
    fn from(stencil: StencilState) -> Self {
        Self {
            stencil: Some(stencil),
            ..Self::default()
        }
    }
}
