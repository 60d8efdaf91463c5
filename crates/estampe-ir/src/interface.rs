//! What a kernel exchanges with the outside: inputs, outputs, and the memory that it names.

use crate::Type;
use crate::op::Axis;

/// The stage of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// An invocation is a vertex.
    Vertex,
    /// An invocation is a fragment; four consecutive lanes are a quad: upper left, upper right,
    /// lower left, lower right.
    Fragment,
    /// An invocation is one of a work-group.
    Compute,
}

/// An input of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Input {
    /// A component (0 to 3) of the vertex attribute at a location.
    Attribute {
        /// The location.
        location: u32,
        /// The component.
        component: u32,
    },
    /// A scalar of the varyings, by its position among all of the stage's scalars.
    Varying(u32),
    /// The derivative of a scalar of the varyings at the fragment itself: its change from a pixel
    /// to the next, were its rate that of this fragment. Unlike [`Op::Derivative`](crate::Op), it
    /// needs no other lane of the quad.
    Derivative {
        /// The scalar, by its position among all of the stage's scalars.
        scalar: u32,
        /// The direction in the window.
        axis: Axis,
    },
    /// A component (0 to 3) of what a non-dependent texture read gives, by its number: a sample
    /// whose operands are inputs, or inputs and uniform shifts, or a load at the pixel itself; both
    /// are made before the kernel runs.
    TextureRead {
        /// The read.
        read: u32,
        /// The component.
        component: u32,
    },
    /// The index of the vertex.
    VertexIndex,
    /// The index of the instance.
    InstanceIndex,
    /// x, y, z or 1/w of the fragment in the window: `0` to `3`.
    Position(u32),
    /// A mask: the primitive faces the front.
    FrontFacing,
    /// The index of the sample that is shaded. Uniform.
    SampleIndex,
    /// The covered samples of the fragment.
    SampleMask,
    /// A mask: the lane's effects count. False in helper invocations, and in lanes beyond the last
    /// vertex or invocation.
    Cover,
    /// x, y or z of the invocation in its work-group.
    LocalInvocationId(u32),
    /// The number of the invocation in its work-group.
    LocalInvocationIndex,
    /// x, y or z of the work-group. Uniform.
    WorkgroupId(u32),
    /// The number of work-groups along x, y or z. Uniform.
    NumWorkgroups(u32),
    /// A word of the immediates (push constants), by its number. Uniform.
    PushConstant(u32),
    /// The width (axis 0) or height (1) of the finest level of a texture. Uniform.
    TextureSide {
        /// The position of the texture in the interface.
        texture: u32,
        /// The axis.
        axis: u32,
    },
}

impl Input {
    /// The type of the input.
    #[must_use]
    pub fn kind(self) -> Type {
        match self {
            Self::FrontFacing | Self::Cover => Type::Mask,
            _ => Type::Word,
        }
    }

    /// True if the input is the same in all lanes that run together.
    #[must_use]
    pub fn is_uniform(self) -> bool {
        matches!(
            self,
            Self::SampleIndex
                | Self::WorkgroupId(_)
                | Self::NumWorkgroups(_)
                | Self::PushConstant(_)
                | Self::TextureSide { .. }
        )
    }
}

/// An output of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// x, y, z or w of a vertex in clip space.
    Position(u32),
    /// A scalar of the varyings, by its position among all of the stage's scalars.
    Varying(u32),
    /// The width of a point, in pixels.
    PointSize,
    /// A clip distance.
    ClipDistance(u32),
    /// A component of the colour of a target. For integer targets, the bits of the integer.
    Color {
        /// The index of the target.
        target: u32,
        /// The component, 0 to 3.
        component: u32,
    },
    /// A component of the second colour of dual-source blending.
    SecondColor(u32),
    /// The depth of the fragment.
    Depth,
    /// The samples of the fragment that are kept.
    SampleMask,
    /// A mask: the fragment is not discarded. Helper invocations are never kept.
    Cover,
}

impl Output {
    /// The type of the output.
    #[must_use]
    pub fn kind(self) -> Type {
        match self {
            Self::Cover => Type::Mask,
            _ => Type::Word,
        }
    }
}

/// A buffer that a kernel reads or writes: a group and binding number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferSlot {
    /// The bind group.
    pub group: u32,
    /// The binding in the group.
    pub binding: u32,
    /// True if the kernel stores to it.
    pub is_written: bool,
}

impl BufferSlot {
    /// The immediates as a buffer that is only read, for words whose place is computed; all others
    /// are [`Input::PushConstant`]. No resource is bound here: there are never so many bind groups.
    pub const IMMEDIATES: Self = Self {
        group: u32::MAX,
        binding: u32::MAX,
        is_written: false,
    };
}

/// Memory of its own that each invocation has.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct LocalArray {
    /// The number of words, at least 1.
    pub words: u32,
    /// The words at the start; those beyond the end of the list are 0. An array that is never
    /// stored to is a table of constants.
    pub init: Vec<u32>,
}

/// A texture that a kernel samples, reads or stores to: a group and binding number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureSlot {
    /// The bind group.
    pub group: u32,
    /// The binding in the group.
    pub binding: u32,
}

/// The interface of a tree or kernel. Operations name its entries by their position.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Interface {
    /// The inputs.
    pub inputs: Vec<Input>,
    /// The outputs, each at most once.
    pub outputs: Vec<Output>,
    /// The buffers.
    pub buffers: Vec<BufferSlot>,
    /// The textures.
    pub textures: Vec<TextureSlot>,
    /// The samplers.
    pub samplers: Vec<TextureSlot>,
    /// The arrays that each invocation has.
    pub locals: Vec<LocalArray>,
    /// The words of memory that the invocations of a work-group share.
    pub workgroup_words: u32,
    /// The invocations of a work-group along x, y and z; zeros in other stages.
    pub workgroup_size: [u32; 3],
}
