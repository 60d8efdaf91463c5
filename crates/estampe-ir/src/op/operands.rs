//! The operands and results of operations, for passes that do not care which operation it is.

use super::{LevelOfDetail, Op, TextureOp, Type, Value};

impl Op {
    /// The types of the results, in order.
    #[must_use]
    pub fn results(&self) -> &'static [Type] {
        use Type::{Mask, Word};
        match self {
            Self::MaskConstant(_)
            | Self::InputMask(_)
            | Self::Compare(..)
            | Self::MaskNot(_)
            | Self::MaskBinary(..)
            | Self::QuadAny(_)
            | Self::Any(_) => &[Mask],
            Self::StoreLocal { .. }
            | Self::StoreBuffer { .. }
            | Self::StoreWorkgroup { .. }
            | Self::Barrier => &[],
            Self::CompareExchange { .. } => &[Word, Mask],
            Self::Texture(op) => &[Word; 4][..op.query.results() as usize],
            _ => &[Word],
        }
    }

    /// Calls `visit` with each operand and the type that it must have.
    pub fn each_operand(&self, mut visit: impl FnMut(Value, Type)) {
        // One list for reading and for replacing: a copy is cheap beside what passes do.
        let mut copy = self.clone();
        copy.each_operand_mut(|value, kind| visit(*value, kind));
    }

    /// Calls `visit` with each operand, to replace it, and the type that it must have.
    pub fn each_operand_mut(&mut self, mut visit: impl FnMut(&mut Value, Type)) {
        let mask = Type::Mask;
        let mut word = |value: &mut Value| visit(value, Type::Word);
        match self {
            Self::Constant(_)
            | Self::MaskConstant(_)
            | Self::Input(_)
            | Self::InputMask(_)
            | Self::BufferBytes(_)
            | Self::Barrier => {}
            Self::Unary(_, a)
            | Self::Math(_, a)
            | Self::LoadLocal { index: a, .. }
            | Self::LoadBuffer { offset: a, .. }
            | Self::LoadWorkgroup(a) => word(a),
            Self::Binary(_, pair) | Self::Math2(_, pair) | Self::Compare(_, pair) => {
                pair.iter_mut().for_each(word);
            }
            Self::Fma(three) => three.iter_mut().for_each(word),
            Self::MaskNot(a) | Self::QuadAny(a) | Self::Any(a) => visit(a, mask),
            Self::MaskBinary(_, pair) => pair.iter_mut().for_each(|one| visit(one, mask)),
            Self::Select { mask: m, yes, no } => {
                word(yes);
                word(no);
                visit(m, mask);
            }
            Self::Derivative { value, mask: m, .. } | Self::QuadLane { value, mask: m, .. } => {
                word(value);
                visit(m, mask);
            }
            Self::StoreLocal {
                index: at,
                value,
                mask: m,
                ..
            }
            | Self::StoreBuffer {
                offset: at,
                value,
                mask: m,
                ..
            }
            | Self::StoreWorkgroup {
                index: at,
                value,
                mask: m,
            }
            | Self::Atomic {
                offset: at,
                value,
                mask: m,
                ..
            } => {
                word(at);
                word(value);
                visit(m, mask);
            }
            Self::CompareExchange {
                offset,
                expected,
                value,
                mask: m,
                ..
            } => {
                word(offset);
                word(expected);
                word(value);
                visit(m, mask);
            }
            Self::Texture(op) => op.each_operand_mut(visit),
        }
    }

    /// The operand that says in which lanes the operation acts, if it has one.
    pub fn mask_mut(&mut self) -> Option<&mut Value> {
        match self {
            Self::Derivative { mask, .. }
            | Self::QuadLane { mask, .. }
            | Self::StoreLocal { mask, .. }
            | Self::StoreBuffer { mask, .. }
            | Self::StoreWorkgroup { mask, .. }
            | Self::Atomic { mask, .. }
            | Self::CompareExchange { mask, .. } => Some(mask),
            Self::Texture(op) => Some(&mut op.mask),
            _ => None,
        }
    }

    /// True if the results depend on the operands alone, in the same lane, wherever and however
    /// often the operation runs. It may then be shared, moved to where its operands are known, and
    /// dropped. Loads from buffers that the kernel does not write are such operations, too: pass
    /// whether the buffer at a position is written.
    pub fn is_pure(&self, is_written: impl Fn(u32) -> bool) -> bool {
        match self {
            Self::Constant(_)
            | Self::MaskConstant(_)
            | Self::Input(_)
            | Self::InputMask(_)
            | Self::Unary(..)
            | Self::Binary(..)
            | Self::Fma(_)
            | Self::Compare(..)
            | Self::MaskNot(_)
            | Self::MaskBinary(..)
            | Self::Select { .. }
            | Self::Math(..)
            | Self::Math2(..)
            | Self::BufferBytes(_) => true,
            Self::LoadBuffer { buffer, .. } => !is_written(*buffer),
            Self::Texture(op) => op.query.is_of_shape(),
            _ => false,
        }
    }

    /// True if the operation does more than give results: it may not be dropped if those are not
    /// used.
    #[must_use]
    pub fn has_effect(&self) -> bool {
        match self {
            Self::StoreLocal { .. }
            | Self::StoreBuffer { .. }
            | Self::StoreWorkgroup { .. }
            | Self::Atomic { .. }
            | Self::CompareExchange { .. }
            | Self::Barrier => true,
            Self::Texture(op) => op.query == super::TextureQuery::Store,
            _ => false,
        }
    }
}

impl TextureOp {
    /// The number of operands that are words.
    #[must_use]
    pub fn words(&self) -> usize {
        let of_level = match &self.level {
            LevelOfDetail::Zero | LevelOfDetail::Implicit => 0,
            LevelOfDetail::Bias(_) | LevelOfDetail::Explicit(_) => 1,
            LevelOfDetail::Gradient { x, y } => x.len() + y.len(),
        };
        let single = [self.layer, self.reference, self.sample];
        self.coordinates.len() + of_level + single.into_iter().flatten().count() + self.stored.len()
    }

    fn each_operand_mut(&mut self, mut visit: impl FnMut(&mut Value, Type)) {
        let mut word = |value: &mut Value| visit(value, Type::Word);
        self.coordinates.iter_mut().for_each(&mut word);
        self.layer.iter_mut().for_each(&mut word);
        match &mut self.level {
            LevelOfDetail::Zero | LevelOfDetail::Implicit => {}
            LevelOfDetail::Bias(level) | LevelOfDetail::Explicit(level) => word(level),
            LevelOfDetail::Gradient { x, y } => x.iter_mut().chain(y).for_each(&mut word),
        }
        self.reference.iter_mut().for_each(&mut word);
        self.sample.iter_mut().for_each(&mut word);
        self.stored.iter_mut().for_each(word);
        visit(&mut self.mask, Type::Mask);
    }
}
