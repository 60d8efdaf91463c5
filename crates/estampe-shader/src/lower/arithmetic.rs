//! Operators, conversions and choices.

use super::half::is_half;
use super::types::{is_wide, words};
use super::{Frame, LowerError, Lowered, Lowering, wide};
use estampe_ir::op::{Axis, Binary, Compare, MaskBinary, Precision, Unary};
use estampe_ir::{Op, Value};
use naga::{
    BinaryOperator, DerivativeAxis, DerivativeControl, Expression, Handle, RelationalFunction,
    Scalar, ScalarKind, TypeInner, UnaryOperator,
};

impl<'a> Lowering<'a> {
    /// The type of the scalars of an expression.
    pub(super) fn scalar(&self, frame: &Frame<'a>, handle: Handle<Expression>) -> Lowered<Scalar> {
        let scalar = self.inner(frame, handle).scalar();
        scalar.ok_or(LowerError::Unsupported("operations on structs"))
    }

    /// The kind of the scalars of an expression.
    pub(super) fn scalar_kind(
        &self,
        frame: &Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<ScalarKind> {
        Ok(self.scalar(frame, handle)?.kind)
    }

    pub(super) fn computed(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        let function = frame.function;
        match function.expressions[handle] {
            Expression::Unary { op, expr } => {
                let scalar = self.scalar(frame, expr)?;
                let kind = scalar.kind;
                let values = self.values(frame, expr)?;
                if is_wide(scalar) {
                    return Ok(wide::unary(&mut self.builder, op, &values));
                }
                let one = |value: Value| match (op, kind) {
                    (UnaryOperator::Negate, ScalarKind::Float) => {
                        self.builder.unary(Unary::FNeg, value)
                    }
                    (UnaryOperator::Negate, _) => {
                        let zero = self.builder.word(0);
                        self.builder.binary(Binary::Sub, zero, value)
                    }
                    (UnaryOperator::LogicalNot, _) => self.builder.mask_not(value),
                    (UnaryOperator::BitwiseNot, ScalarKind::Bool) => self.builder.mask_not(value),
                    (UnaryOperator::BitwiseNot, _) => self.builder.unary(Unary::Not, value),
                };
                Ok(values.into_iter().map(one).collect())
            }
            Expression::Binary { op, left, right } => self.binary(frame, op, [left, right]),
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let condition = self.values(frame, condition)?;
                let width = self.inner(frame, accept).scalar().map_or(1, words) as usize;
                let (accept, reject) = (self.values(frame, accept)?, self.values(frame, reject)?);
                let pairs = accept.into_iter().zip(reject).enumerate();
                let chosen = pairs.map(|(at, (yes, no))| {
                    let mask = condition[(at / width).min(condition.len() - 1)];
                    self.builder.select(mask, yes, no)
                });
                Ok(chosen.collect())
            }
            Expression::Derivative { axis, ctrl, expr } => {
                let values = self.values(frame, expr)?;
                Ok(values
                    .into_iter()
                    .map(|value| self.derivative(axis, ctrl, value))
                    .collect())
            }
            Expression::Relational { fun, argument } => {
                let values = self.values(frame, argument)?;
                self.relational(fun, &values)
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                arg3,
            } => {
                let arguments = [Some(arg), arg1, arg2, arg3];
                self.math(frame, fun, arguments)
            }
            Expression::As {
                expr,
                kind,
                convert,
            } => {
                let of_expression = self.scalar(frame, expr)?;
                let from = of_expression.kind;
                let values = self.values(frame, expr)?;
                let is_to_half = (kind, convert) == (ScalarKind::Float, Some(2));
                let Some(width) = convert else {
                    if is_half(of_expression) && kind != ScalarKind::Float {
                        return Err(LowerError::Unsupported("16-bit integers"));
                    }
                    let bits = values.into_iter();
                    return Ok(bits
                        .map(|value| self.bits(value, from == ScalarKind::Float))
                        .collect());
                };
                let to = Scalar { kind, width };
                if is_wide(of_expression) || is_wide(to) {
                    return wide::convert(&mut self.builder, &values, [of_expression, to]);
                }
                if kind != ScalarKind::Bool && width != 4 && !is_to_half {
                    return Err(LowerError::Unsupported("numbers of this width"));
                }
                values
                    .into_iter()
                    .map(|value| self.convert(value, from, kind))
                    .collect()
            }
            _ => Err(LowerError::Unsupported("expressions of this kind")),
        }
    }

    fn derivative(
        &mut self,
        axis: DerivativeAxis,
        control: DerivativeControl,
        value: Value,
    ) -> Value {
        let mask = self.builder.mask(true);
        let precision = match control {
            DerivativeControl::Fine | DerivativeControl::None => Precision::Fine,
            DerivativeControl::Coarse => Precision::Coarse,
        };
        let mut along = |axis| {
            self.builder.op1(Op::Derivative {
                axis,
                precision,
                value,
                mask,
            })
        };
        match axis {
            DerivativeAxis::X => along(Axis::X),
            DerivativeAxis::Y => along(Axis::Y),
            DerivativeAxis::Width => {
                let sides = [along(Axis::X), along(Axis::Y)];
                let [x, y] = sides.map(|side| self.builder.unary(Unary::FAbs, side));
                self.builder.binary(Binary::FAdd, x, y)
            }
        }
    }

    fn relational(
        &mut self,
        function: RelationalFunction,
        values: &[Value],
    ) -> Lowered<Vec<Value>> {
        Ok(match function {
            RelationalFunction::All => vec![self.combined(MaskBinary::And, values)],
            RelationalFunction::Any => vec![self.combined(MaskBinary::Or, values)],
            RelationalFunction::IsNan => {
                let is_nan = |&x: &Value| self.builder.compare(Compare::FNe, x, x);
                values.iter().map(is_nan).collect()
            }
            RelationalFunction::IsInf => {
                let is_infinite = |&x: &Value| {
                    let magnitude = self.builder.unary(Unary::FAbs, x);
                    let infinity = self.builder.float(f32::INFINITY);
                    self.builder.compare(Compare::FEq, magnitude, infinity)
                };
                values.iter().map(is_infinite).collect()
            }
        })
    }

    fn convert(&mut self, value: Value, from: ScalarKind, to: ScalarKind) -> Lowered<Value> {
        use ScalarKind as K;
        Ok(match (from, to) {
            (K::Bool, K::Bool) => value,
            (K::Bool, K::Float) => self.word_of_mask(value, 1.0_f32.to_bits()),
            (K::Bool, K::Sint | K::Uint) => self.word_of_mask(value, 1),
            (K::Float, K::Bool) => {
                let zero = self.builder.word(0);
                self.builder.compare(Compare::FNe, value, zero)
            }
            (K::Sint | K::Uint, K::Bool) => {
                let zero = self.builder.word(0);
                self.builder.compare(Compare::Ne, value, zero)
            }
            // What is too large becomes the greatest float that is an integer of the type.
            (K::Float, K::Sint) => {
                let most = self.builder.float(2_147_483_520.0);
                let value = self.builder.binary(Binary::FMin, most, value);
                self.builder.unary(Unary::S32FromF32, value)
            }
            (K::Float, K::Uint) => {
                let most = self.builder.float(4_294_967_040.0);
                let value = self.builder.binary(Binary::FMin, most, value);
                self.builder.unary(Unary::U32FromF32, value)
            }
            (K::Sint, K::Float) => self.builder.unary(Unary::F32FromS32, value),
            (K::Uint, K::Float) => self.builder.unary(Unary::F32FromU32, value),
            (K::Float, K::Float) | (K::Sint | K::Uint, K::Sint | K::Uint) => value,
            _ => return Err(LowerError::Unsupported("conversions of this kind")),
        })
    }

    fn binary(
        &mut self,
        frame: &mut Frame<'a>,
        operator: BinaryOperator,
        [left, right]: [Handle<Expression>; 2],
    ) -> Lowered<Vec<Value>> {
        let (of_left, of_right) = (self.inner(frame, left), self.inner(frame, right));
        let scalar = self.scalar(frame, left)?;
        let kind = scalar.kind;
        let a = self.values(frame, left)?;
        // The amount of a shift has a type of its own.
        let is_shift = matches!(
            operator,
            BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight
        );
        let b = if is_shift {
            self.shift_amounts(frame, right)?
        } else {
            self.values(frame, right)?
        };
        if is_wide(scalar) {
            return wide::binary(&mut self.builder, operator, kind, [&a, &b]);
        }
        if operator == BinaryOperator::Multiply {
            match (of_left, of_right) {
                (&TypeInner::Matrix { rows, .. }, TypeInner::Vector { .. }) => {
                    return Ok(self.matrix_vector(&a, rows as usize, &b));
                }
                (TypeInner::Vector { .. }, &TypeInner::Matrix { rows, .. }) => {
                    let columns = b.chunks(rows as usize);
                    return Ok(columns.map(|column| self.dot(&a, column)).collect());
                }
                (&TypeInner::Matrix { rows, columns, .. }, TypeInner::Matrix { .. }) => {
                    let of_right = b.chunks(columns as usize);
                    let product =
                        of_right.map(|column| self.matrix_vector(&a, rows as usize, column));
                    return Ok(product.flatten().collect());
                }
                _ => {}
            }
        }
        let count = a.len().max(b.len());
        let at = |list: &[Value], at: usize| list[at.min(list.len() - 1)];
        (0..count)
            .map(|k| self.operator(operator, kind, [at(&a, k), at(&b, k)]))
            .collect()
    }

    /// The amounts of a shift, of which only the low word counts.
    fn shift_amounts(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        let width = words(self.scalar(frame, handle)?) as usize;
        let values = self.values(frame, handle)?;
        Ok(values.into_iter().step_by(width).collect())
    }

    /// The sum of the columns, each times a component, from the first on.
    fn matrix_vector(&mut self, matrix: &[Value], rows: usize, vector: &[Value]) -> Vec<Value> {
        let row = |row: usize| {
            let of_row: Vec<_> = matrix.iter().skip(row).step_by(rows).copied().collect();
            self.dot(&of_row, vector)
        };
        (0..rows).map(row).collect()
    }

    /// The inner product, summed from the first component on.
    pub(super) fn dot(&mut self, a: &[Value], b: &[Value]) -> Value {
        let pairs = a.iter().zip(b);
        let products: Vec<_> = pairs
            .map(|(&a, &b)| self.builder.binary(Binary::FMul, a, b))
            .collect();
        let mut products = products.into_iter();
        let first = products.next().expect("a vector has a component");
        products.fold(first, |sum, product| {
            self.builder.binary(Binary::FAdd, sum, product)
        })
    }

    fn operator(
        &mut self,
        operator: BinaryOperator,
        kind: ScalarKind,
        [a, b]: [Value; 2],
    ) -> Lowered<Value> {
        use BinaryOperator as O;
        use ScalarKind as K;
        let binary = match (operator, kind) {
            (O::Add, K::Float) => Binary::FAdd,
            (O::Subtract, K::Float) => Binary::FSub,
            (O::Multiply, K::Float) => Binary::FMul,
            (O::Divide, K::Float) => Binary::FDiv,
            (O::Modulo, K::Float) => return Ok(self.remainder(a, b)),
            (O::Add, _) => Binary::Add,
            (O::Subtract, _) => Binary::Sub,
            (O::Multiply, _) => Binary::Mul,
            (O::Divide, K::Sint) => Binary::SDiv,
            (O::Divide, _) => Binary::UDiv,
            (O::Modulo, K::Sint) => Binary::SRem,
            (O::Modulo, _) => Binary::URem,
            (O::ShiftLeft, _) => Binary::Shl,
            (O::ShiftRight, K::Sint) => Binary::SShr,
            (O::ShiftRight, _) => Binary::UShr,
            _ => return self.comparison(operator, kind, [a, b]),
        };
        Ok(self.builder.binary(binary, a, b))
    }

    /// x − y·trunc(x ÷ y).
    fn remainder(&mut self, x: Value, y: Value) -> Value {
        let quotient = self.builder.binary(Binary::FDiv, x, y);
        let whole = self.builder.unary(Unary::FTrunc, quotient);
        let product = self.builder.binary(Binary::FMul, y, whole);
        self.builder.binary(Binary::FSub, x, product)
    }

    fn comparison(
        &mut self,
        operator: BinaryOperator,
        kind: ScalarKind,
        [a, b]: [Value; 2],
    ) -> Lowered<Value> {
        use BinaryOperator as O;
        use ScalarKind as K;
        let is_bool = kind == K::Bool;
        let masks = match operator {
            O::LogicalAnd => Some(MaskBinary::And),
            O::LogicalOr => Some(MaskBinary::Or),
            O::And if is_bool => Some(MaskBinary::And),
            O::InclusiveOr if is_bool => Some(MaskBinary::Or),
            O::ExclusiveOr | O::NotEqual if is_bool => Some(MaskBinary::Xor),
            O::Equal if is_bool => {
                let differs = self.builder.mask_binary(MaskBinary::Xor, a, b);
                return Ok(self.builder.mask_not(differs));
            }
            _ => None,
        };
        if let Some(kind) = masks {
            return Ok(self.builder.mask_binary(kind, a, b));
        }
        let words = match operator {
            O::And => Some(Binary::And),
            O::InclusiveOr => Some(Binary::Or),
            O::ExclusiveOr => Some(Binary::Xor),
            _ => None,
        };
        if let Some(kind) = words {
            return Ok(self.builder.binary(kind, a, b));
        }
        let [less, less_equal] = match kind {
            K::Float => [Compare::FLt, Compare::FLe],
            K::Sint => [Compare::SLt, Compare::SLe],
            _ => [Compare::ULt, Compare::ULe],
        };
        let is_float = kind == K::Float;
        let (kind, a, b) = match operator {
            O::Equal => (if is_float { Compare::FEq } else { Compare::Eq }, a, b),
            O::NotEqual => (if is_float { Compare::FNe } else { Compare::Ne }, a, b),
            O::Less => (less, a, b),
            O::LessEqual => (less_equal, a, b),
            O::Greater => (less, b, a),
            O::GreaterEqual => (less_equal, b, a),
            _ => return Err(LowerError::Unsupported("operators of this kind")),
        };
        Ok(self.builder.compare(kind, a, b))
    }
}
