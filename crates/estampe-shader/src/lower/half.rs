//! 16-bit floats (binary16) as values.
//!
//! A value is a word with the same number as binary32, which is always one that binary16 has. Each
//! operation is done on binary32, and its result is rounded to binary16: to nearest, ties to even,
//! with denormals, to infinity from 65520 on.
//!
//! * `+ − × ÷ √` are correctly rounded: binary32 has 24 bits, and 2 · 11 + 2 are enough that
//!   rounding twice gives what rounding once does. It holds for denormal results too: the quotient
//!   of two numbers of 11 bits, if it has more than 12, is further from those of 12 bits or fewer
//!   than binary32 rounds; sums and products are exact, or have normal results.
//! * A product of two values is exact in binary32, so `fma` rounds to binary32, then to binary16:
//!   its error is below 0.5001 units in the last place. WGSL allows that of a product and a sum.
//! * A built-in function, a product of matrices and an inner product are computed in binary32 as a
//!   whole, and rounded once: their error is 0.5 units and that of binary32.
//! * Functions whose results are their arguments, or whole numbers, or fractions of arguments need
//!   no rounding.

use super::{Frame, Lowering};
use estampe_ir::Value;
use estampe_ir::op::Unary;
use naga::{Expression, Handle, MathFunction, Scalar, TypeInner};

/// True for 16-bit floats.
pub(super) fn is_half(scalar: Scalar) -> bool {
    scalar == Scalar::F16
}

impl<'a> Lowering<'a> {
    /// The results of an operation, rounded if they are 16-bit floats and may be others.
    pub(super) fn rounded(
        &mut self,
        frame: &Frame<'a>,
        handle: Handle<Expression>,
        values: Vec<Value>,
    ) -> Vec<Value> {
        let is_exact = match frame.function.expressions[handle] {
            Expression::Math { fun, .. } => is_exact(fun),
            Expression::As { expr, .. } => is_of_halves(self.inner(frame, expr)),
            Expression::Binary { .. } | Expression::Derivative { .. } => false,
            _ => true,
        };
        if is_exact || !is_of_halves(self.inner(frame, handle)) {
            return values;
        }
        self.rounded_to_half(values)
    }

    /// The nearest 16-bit floats.
    pub(super) fn rounded_to_half(&mut self, values: Vec<Value>) -> Vec<Value> {
        let values = values.into_iter();
        values
            .map(|value| self.builder.unary(Unary::RoundF16, value))
            .collect()
    }
}

fn is_of_halves(inner: &TypeInner) -> bool {
    inner.scalar().is_some_and(is_half)
}

/// True for functions of 16-bit floats whose results are such, without rounding.
fn is_exact(function: MathFunction) -> bool {
    use MathFunction as F;
    matches!(
        function,
        F::Abs
            | F::Min
            | F::Max
            | F::Clamp
            | F::Saturate
            | F::Ceil
            | F::Floor
            | F::Round
            | F::Trunc
            | F::Step
            | F::Sign
            | F::FaceForward
            | F::Transpose
            | F::Modf
    )
}
