//! Values, types and operations, which both forms of a shader share.
//!
//! All arithmetic is on 32-bit words, one for each lane; floats are binary32. What a front end
//! calls a vector is several words. Where the result of a float operation is NaN, its sign and
//! payload are unspecified; [`Unary::Canonical`] makes them one before bits are seen.

mod evaluate;
mod kinds;
mod operands;
mod texture;

pub use evaluate::{NAN, fma};
pub use kinds::{Atomic, Axis, Binary, Compare, MaskBinary, Math, Math2, Precision, Unary};
pub use texture::{LevelOfDetail, TextureOp, TextureQuery};

/// A value: the result of one operation, or a parameter. Its number is its position among the
/// values of its tree or kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub u32);

impl Value {
    /// The position among the values.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// This value and those after it, so many in all: the results of one operation.
    #[must_use]
    pub fn and_next(self, count: usize) -> Vec<Self> {
        (self.0..).take(count).map(Self).collect()
    }
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Type {
    /// 32 bits in each lane: a float, or an integer of either sign.
    Word,
    /// A boolean in each lane.
    Mask,
}

/// Memory on which atomic operations act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Memory {
    /// A buffer, by its position in the interface. Offsets are in bytes, and rounded down to
    /// multiples of 4.
    Buffer(u32),
    /// The memory of the work-group. Offsets are in words.
    Workgroup,
}

/// An operation.
///
/// Operations with an operand `mask` have their effect only in lanes in which it is set. In a
/// [tree](crate::tree) it says when the invocation has effects at all (fragments that are
/// discarded, and helper invocations, have none). In a [kernel](crate::lanes) it also says which
/// lanes run.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Op {
    /// A word.
    Constant(u32),
    /// A mask that is the same in all lanes.
    MaskConstant(bool),
    /// An input that is a word, by its position in the interface.
    Input(u32),
    /// An input that is a mask, by its position in the interface.
    InputMask(u32),
    /// A word of a word.
    Unary(Unary, Value),
    /// A word of two words.
    Binary(Binary, [Value; 2]),
    /// a · b + c, rounded once.
    Fma([Value; 3]),
    /// A mask of two words.
    Compare(Compare, [Value; 2]),
    /// A mask of a mask: each lane's opposite.
    MaskNot(Value),
    /// A mask of two masks.
    MaskBinary(MaskBinary, [Value; 2]),
    /// `yes` in lanes where the mask is set, else `no`. Words.
    Select {
        /// The mask.
        mask: Value,
        /// The word where it is set.
        yes: Value,
        /// The word where it is not.
        no: Value,
    },
    /// A function of `estampe_types::maths`.
    Math(Math, Value),
    /// A function of two numbers of `estampe_types::maths`.
    Math2(Math2, [Value; 2]),
    /// The difference of a float to its neighbour in the quad; 0 in quads of which a lane is not in
    /// the mask.
    Derivative {
        /// The direction.
        axis: Axis,
        /// Fine or coarse.
        precision: Precision,
        /// The float.
        value: Value,
        /// The lanes that run.
        mask: Value,
    },
    /// The word of one lane of the quad, in all four; 0 where that lane is not in the mask. What
    /// subgroups, which are quads, exchange.
    QuadLane {
        /// The lane, 0 to 3. The lower two bits count.
        lane: u8,
        /// The word.
        value: Value,
        /// The lanes that run.
        mask: Value,
    },
    /// A mask: each quad in which a lane of the operand is set, as a whole.
    QuadAny(Value),
    /// A mask that is the same in all lanes: true if a lane of the operand is set. Kernels only.
    Any(Value),
    /// A word of an array of this invocation. Indices beyond the end read the last word.
    LoadLocal {
        /// The position of the array in the interface.
        array: u32,
        /// The word's number, unsigned.
        index: Value,
    },
    /// Stores a word to an array of this invocation. Indices beyond the end store nothing.
    StoreLocal {
        /// The position of the array in the interface.
        array: u32,
        /// The word's number, unsigned.
        index: Value,
        /// The word.
        value: Value,
        /// The lanes that store.
        mask: Value,
    },
    /// A word of a buffer. Words that are not wholly inside the bound range are 0.
    LoadBuffer {
        /// The position of the buffer in the interface.
        buffer: u32,
        /// Bytes from the start of the bound range, unsigned, rounded down to a multiple of 4.
        offset: Value,
    },
    /// Stores a word to a buffer, in the order of the lanes. Words that are not wholly inside the
    /// bound range are not stored.
    StoreBuffer {
        /// The position of the buffer in the interface.
        buffer: u32,
        /// Bytes from the start of the bound range, unsigned, rounded down to a multiple of 4.
        offset: Value,
        /// The word.
        value: Value,
        /// The lanes that store.
        mask: Value,
    },
    /// The number of bytes of the bound range of a buffer. Uniform.
    BufferBytes(u32),
    /// A word of the memory of the work-group. Beyond the end it is 0.
    LoadWorkgroup(Value),
    /// Stores a word to the memory of the work-group, in the order of the lanes. Beyond the end
    /// nothing is stored.
    StoreWorkgroup {
        /// The word's number, unsigned.
        index: Value,
        /// The word.
        value: Value,
        /// The lanes that store.
        mask: Value,
    },
    /// Reads a word and stores another one, lane after lane. The result is the word that was read;
    /// 0 outside of the memory and in lanes that are not in the mask.
    Atomic {
        /// What is stored.
        kind: Atomic,
        /// Where.
        memory: Memory,
        /// The place in the memory.
        offset: Value,
        /// The operand.
        value: Value,
        /// The lanes that act.
        mask: Value,
    },
    /// Stores `value` where the stored word equals `expected`. Two results: the word that was read,
    /// and a mask: it was stored.
    CompareExchange {
        /// Where.
        memory: Memory,
        /// The place in the memory.
        offset: Value,
        /// The word that is looked for.
        expected: Value,
        /// The word that replaces it.
        value: Value,
        /// The lanes that act.
        mask: Value,
    },
    /// Waits for all invocations of the work-group. Memory that was stored before is seen after.
    Barrier,
    /// An access to a texture.
    Texture(Box<TextureOp>),
}
