//! The bytecode.

use crate::op::{
    Atomic, Axis, Binary, Compare, MaskBinary, Math, Math2, Memory, Precision, TextureOp, Unary,
};

/// A register of words: a packet for each packet of the chunk.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Slot(pub(super) u32);

/// A register of a mask: 16 bits for each packet of the chunk.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct MaskSlot(pub(super) u32);

/// A word that is the same in all lanes. A mask has the words 0 and [`TRUE`].
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Scalar(pub(super) u32);

/// The scalar of a mask that is set.
pub(super) const TRUE: u32 = u32::MAX;

/// Where a word is.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Word {
    Slot(Slot),
    Scalar(Scalar),
}

/// Where a mask is.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Mask {
    Slot(MaskSlot),
    Scalar(Scalar),
}

impl From<Slot> for Word {
    fn from(slot: Slot) -> Self {
        Self::Slot(slot)
    }
}

impl From<MaskSlot> for Mask {
    fn from(slot: MaskSlot) -> Self {
        Self::Slot(slot)
    }
}

/// A product and a sum, each rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Product {
    /// a · b + c.
    Plus,
    /// a · b − c.
    Minus,
    /// c − a · b.
    From,
}

/// An operation on scalars.
#[derive(Debug, Clone, Copy)]
pub(super) enum ScalarOp {
    Unary(Unary, Scalar),
    Binary(Binary, [Scalar; 2]),
    Fma([Scalar; 3]),
    Compare(Compare, [Scalar; 2]),
    MaskNot(Scalar),
    MaskBinary(MaskBinary, [Scalar; 2]),
    /// The mask, then the word where it is set, then the other.
    Select([Scalar; 3]),
    Math(Math, Scalar),
    Math2(Math2, [Scalar; 2]),
    Input(u32),
    /// An input that is a mask.
    InputMask(u32),
    BufferBytes(u32),
    LoadBuffer(u32, Scalar),
    LoadWorkgroup(Scalar),
    /// A table of constants.
    LoadTable(u32, Scalar),
    /// Whether a lane of the mask is set.
    Any(MaskSlot),
    /// The word of the first lane in the mask; 0 if there is none.
    First(Slot, Mask),
    Copy(Scalar),
}

/// An instruction: registers and kinds. Where a word may be a scalar, not all words of the
/// instruction are.
#[derive(Debug, Clone)]
pub(super) enum Instruction {
    Scalar(Scalar, ScalarOp),
    Unary(Unary, Slot, Slot),
    Binary(Binary, Slot, [Word; 2]),
    Product(Product, Slot, [Word; 3]),
    Fma(Slot, [Slot; 3]),
    Compare(Compare, MaskSlot, [Word; 2]),
    MaskNot(MaskSlot, MaskSlot),
    MaskBinary(MaskBinary, MaskSlot, [Mask; 2]),
    Select(Slot, Mask, [Word; 2]),
    Math(Math, Slot, Slot),
    Math2(Math2, Slot, [Slot; 2]),
    Derivative(Axis, Precision, Slot, Slot, Mask),
    /// The lane of the quad, its words and the lanes that run.
    QuadLane(u8, Slot, Slot, Mask),
    QuadAny(MaskSlot, MaskSlot),
    Copy(Slot, Word),
    CopyMask(MaskSlot, Mask),
    Input(Slot, u32),
    InputMask(MaskSlot, u32),
    Output(u32, Word),
    OutputMask(u32, Mask),
    LoadTable(u32, Slot, Slot),
    /// The array's first word among all local words, its length, and the index.
    LoadLocal(Slot, Array, Word),
    StoreLocal(Array, [Word; 2], Mask),
    LoadBuffer(Slot, u32, Slot),
    StoreBuffer(u32, [Word; 2], Mask),
    LoadWorkgroup(Slot, Slot),
    StoreWorkgroup([Word; 2], Mask),
    Atomic(Box<AtomicCode>),
    CompareExchange(Box<CompareExchangeCode>),
    Texture(Box<TextureCode>),
    /// Waits for the other packets of the work-group.
    Barrier,
    Jump(u32),
    Branch(Mask, [u32; 2]),
    Return,
}

/// An array of the invocation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Array {
    /// The number of words of the arrays before it.
    pub(super) first: u32,
    pub(super) words: u32,
}

#[derive(Debug, Clone)]
pub(super) struct AtomicCode {
    pub(super) kind: Atomic,
    pub(super) memory: Memory,
    pub(super) result: Slot,
    pub(super) offset: Word,
    pub(super) value: Word,
    pub(super) mask: Mask,
}

#[derive(Debug, Clone)]
pub(super) struct CompareExchangeCode {
    pub(super) memory: Memory,
    pub(super) result: Slot,
    pub(super) is_stored: MaskSlot,
    pub(super) offset: Word,
    pub(super) expected: Word,
    pub(super) value: Word,
    pub(super) mask: Mask,
}

#[derive(Debug, Clone)]
pub(super) struct TextureCode {
    pub(super) op: TextureOp,
    pub(super) operands: Vec<Word>,
    pub(super) mask: Mask,
    pub(super) results: Vec<Slot>,
}
