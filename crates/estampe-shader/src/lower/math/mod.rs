//! Built-in functions, in the order of operations of `estampe_types::maths`: those of whole vectors
//! and matrices first, all others component by component.

mod floats;
mod integers;
mod matrices;
mod packing;
mod parts;
mod vectors;

use super::types::is_wide;
use super::{Frame, LowerError, Lowered, Lowering, wide};
use estampe_ir::Value;
use estampe_ir::op::{Binary, Math, Unary};
use naga::{Expression, Handle, MathFunction, ScalarKind};

impl<'a> Lowering<'a> {
    pub(super) fn math(
        &mut self,
        frame: &mut Frame<'a>,
        function: MathFunction,
        handles: [Option<Handle<Expression>>; 4],
    ) -> Lowered<Vec<Value>> {
        use MathFunction as F;
        let first = handles[0].ok_or(LowerError::Unsupported("missing arguments"))?;
        let scalar = self.scalar(frame, first)?;
        let kind = scalar.kind;
        let inner = self.inner(frame, first);
        let mut arguments = Vec::new();
        for handle in handles.into_iter().flatten() {
            arguments.push(self.values(frame, handle)?);
        }
        if is_wide(scalar) {
            return wide::math(&mut self.builder, function, kind, &arguments);
        }
        let of_vectors = match function {
            F::Dot if kind != ScalarKind::Float => Some(vec![self.integer_dot(&arguments)]),
            F::Dot => Some(vec![self.dot(&arguments[0], &arguments[1])]),
            F::Length => Some(vec![self.length(&arguments[0])]),
            F::Distance => {
                let difference = self.each(Binary::FSub, &arguments[0], &arguments[1]);
                Some(vec![self.length(&difference)])
            }
            F::Normalize => Some(self.normalize(&arguments[0])),
            F::Cross => Some(self.cross(&arguments[0], &arguments[1])),
            F::Reflect => Some(self.reflect(&arguments[0], &arguments[1])),
            F::Refract => Some(self.refract(&arguments)),
            F::FaceForward => Some(self.face_forward(&arguments)),
            F::Outer => Some(self.outer(&arguments[0], &arguments[1])),
            F::Transpose | F::Determinant | F::Inverse => {
                Some(self.of_matrix(function, inner, &arguments[0])?)
            }
            F::Pack4x8snorm
            | F::Pack4x8unorm
            | F::Pack2x16snorm
            | F::Pack2x16unorm
            | F::Pack2x16float => Some(vec![self.pack(function, &arguments[0])]),
            F::Unpack4x8snorm
            | F::Unpack4x8unorm
            | F::Unpack2x16snorm
            | F::Unpack2x16unorm
            | F::Unpack2x16float => Some(self.unpack(function, arguments[0][0])),
            F::Pack4xI8 | F::Pack4xU8 | F::Pack4xI8Clamp | F::Pack4xU8Clamp => {
                Some(vec![self.pack_bytes(function, &arguments[0])])
            }
            F::Unpack4xI8 | F::Unpack4xU8 => {
                Some(self.unpack_bytes(arguments[0][0], function == F::Unpack4xI8))
            }
            F::Dot4I8Packed | F::Dot4U8Packed => {
                let words = [arguments[0][0], arguments[1][0]];
                Some(vec![self.dot_of_bytes(words, function == F::Dot4I8Packed)])
            }
            F::Modf => Some(self.modf(&arguments[0])),
            F::Frexp => Some(self.frexp(&arguments[0])),
            _ => None,
        };
        if let Some(values) = of_vectors {
            return Ok(values);
        }
        let count = arguments.iter().map(Vec::len).max().unwrap_or(0);
        let of_component = |at: usize| -> Vec<Value> {
            arguments
                .iter()
                .map(|list| list[at.min(list.len() - 1)])
                .collect()
        };
        let components: Vec<_> = (0..count).map(of_component).collect();
        let one = |values: Vec<Value>| self.component(function, kind, &values);
        components.into_iter().map(one).collect()
    }

    fn component(
        &mut self,
        function: MathFunction,
        kind: ScalarKind,
        values: &[Value],
    ) -> Lowered<Value> {
        use MathFunction as F;
        let x = values[0];
        let math = match function {
            F::Cos => Some(Math::Cos),
            F::Cosh => Some(Math::Cosh),
            F::Sin => Some(Math::Sin),
            F::Sinh => Some(Math::Sinh),
            F::Tan => Some(Math::Tan),
            F::Tanh => Some(Math::Tanh),
            F::Acos => Some(Math::Acos),
            F::Asin => Some(Math::Asin),
            F::Atan => Some(Math::Atan),
            F::Exp => Some(Math::Exp),
            F::Exp2 => Some(Math::Exp2),
            F::Log => Some(Math::Log),
            F::Log2 => Some(Math::Log2),
            _ => None,
        };
        if let Some(math) = math {
            return Ok(self.builder.math(math, x));
        }
        let unary = match function {
            F::Abs if kind == ScalarKind::Float => Some(Unary::FAbs),
            F::Ceil => Some(Unary::FCeil),
            F::Floor => Some(Unary::FFloor),
            F::Round => Some(Unary::FRound),
            F::Trunc => Some(Unary::FTrunc),
            F::Sqrt => Some(Unary::FSqrt),
            F::QuantizeToF16 => Some(Unary::RoundF16),
            F::CountTrailingZeros => Some(Unary::TrailingZeros),
            F::CountLeadingZeros => Some(Unary::LeadingZeros),
            F::CountOneBits => Some(Unary::CountOnes),
            F::ReverseBits => Some(Unary::ReverseBits),
            _ => None,
        };
        if let Some(unary) = unary {
            return Ok(self.builder.unary(unary, x));
        }
        match kind {
            ScalarKind::Float => self.of_floats(function, values),
            _ => self.of_integers(function, kind == ScalarKind::Sint, values),
        }
    }
}
