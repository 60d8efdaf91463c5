//! Built-in functions, in the order of operations of `estampe_types::maths`.

use super::types::is_wide;
use super::{Frame, LowerError, Lowered, Lowering, wide};
use estampe_ir::op::{Binary, Compare, MaskBinary, Math, Math2, Unary};
use estampe_ir::{Op, Value};
use naga::{Expression, Handle, MathFunction, ScalarKind, TypeInner};

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

    /// xʸ. A constant exponent of 1 to 64 without a fraction becomes multiplications, in the order
    /// of the `powi` of shaders in Rust: fewer operations, and a smaller error than of a logarithm.
    fn power(&mut self, x: Value, y: Value) -> Value {
        let b = &mut self.builder;
        let constant = b.constant_of(y).map(f32::from_bits);
        let whole = (1..=64_u8).find(|&n| constant == Some(f32::from(n)));
        let Some(mut left) = whole else {
            return b.op1(Op::Math2(Math2::Pow, [x, y]));
        };
        let (mut power, mut base) = (None, x);
        loop {
            if left & 1 == 1 {
                power = Some(power.map_or(base, |power| b.binary(Binary::FMul, power, base)));
            }
            left >>= 1;
            if left == 0 {
                return power.unwrap_or(x);
            }
            base = b.binary(Binary::FMul, base, base);
        }
    }

    fn of_floats(&mut self, function: MathFunction, values: &[Value]) -> Lowered<Value> {
        use Binary as B;
        use MathFunction as F;
        let x = values[0];
        let [y, z] = [1, 2].map(|at| values.get(at).copied().unwrap_or(x));
        let one = self.builder.float(1.0);
        let b = &mut self.builder;
        Ok(match function {
            F::Min => b.binary(B::FMin, x, y),
            F::Max => b.binary(B::FMax, x, y),
            F::Clamp => self.clamp(x, [y, z]),
            F::Saturate => {
                let zero = b.float(0.0);
                self.clamp(x, [zero, one])
            }
            F::Radians => self.times(x, std::f32::consts::PI / 180.0),
            F::Degrees => self.times(x, 180.0 / std::f32::consts::PI),
            F::Fract => {
                let whole = b.unary(Unary::FFloor, x);
                b.binary(B::FSub, x, whole)
            }
            F::Ldexp => self.ldexp(x, y),
            F::Pow => self.power(x, y),
            F::Atan2 => b.op1(Op::Math2(Math2::Atan2, [x, y])),
            F::Fma => {
                let product = b.binary(B::FMul, x, y);
                b.binary(B::FAdd, product, z)
            }
            F::Mix => {
                let difference = b.binary(B::FSub, y, x);
                let part = b.binary(B::FMul, difference, z);
                b.binary(B::FAdd, x, part)
            }
            F::Step => {
                let is_after = b.compare(Compare::FLe, x, y);
                self.word_of_mask(is_after, 1.0_f32.to_bits())
            }
            F::SmoothStep => self.smooth_step([x, y], z),
            F::InverseSqrt => {
                let root = b.unary(Unary::FSqrt, x);
                b.binary(B::FDiv, one, root)
            }
            F::Sign => {
                let (zero, minus) = (b.float(0.0), b.float(-1.0));
                let is_negative = b.compare(Compare::FLt, x, zero);
                let below = b.select(is_negative, minus, x);
                let is_positive = b.compare(Compare::FLt, zero, x);
                b.select(is_positive, one, below)
            }
            // log(x + √(x² + 1))
            F::Asinh => self.area(x, one, Binary::FAdd),
            // log(x + √(x² − 1))
            F::Acosh => self.area(x, one, Binary::FSub),
            // log((1 + x) ÷ (1 − x)) ÷ 2
            F::Atanh => {
                let (above, below) = (b.binary(B::FAdd, one, x), b.binary(B::FSub, one, x));
                let ratio = b.binary(B::FDiv, above, below);
                let logarithm = b.math(Math::Log, ratio);
                self.times(logarithm, 0.5)
            }
            _ => return Err(LowerError::Unsupported("functions of this kind")),
        })
    }

    fn times(&mut self, x: Value, factor: f32) -> Value {
        let factor = self.builder.float(factor);
        self.builder.binary(Binary::FMul, x, factor)
    }

    fn area(&mut self, x: Value, one: Value, kind: Binary) -> Value {
        let square = self.builder.binary(Binary::FMul, x, x);
        let sum = self.builder.binary(kind, square, one);
        let root = self.builder.unary(Unary::FSqrt, sum);
        let sum = self.builder.binary(Binary::FAdd, x, root);
        self.builder.math(Math::Log, sum)
    }

    fn clamp(&mut self, x: Value, [low, high]: [Value; 2]) -> Value {
        let raised = self.builder.binary(Binary::FMax, x, low);
        self.builder.binary(Binary::FMin, raised, high)
    }

    /// t·t·(3 − t·2), where t is the place of x between the edges, 0 to 1.
    fn smooth_step(&mut self, [low, high]: [Value; 2], x: Value) -> Value {
        let [zero, one, two, three] = [0.0, 1.0, 2.0, 3.0].map(|one| self.builder.float(one));
        let (from, width) = (
            self.builder.binary(Binary::FSub, x, low),
            self.builder.binary(Binary::FSub, high, low),
        );
        let place = self.builder.binary(Binary::FDiv, from, width);
        let t = self.clamp(place, [zero, one]);
        let double = self.builder.binary(Binary::FMul, t, two);
        let rest = self.builder.binary(Binary::FSub, three, double);
        let square = self.builder.binary(Binary::FMul, t, t);
        self.builder.binary(Binary::FMul, square, rest)
    }

    /// x · 2ʸ as two products, so that the powers are normal numbers.
    fn ldexp(&mut self, x: Value, y: Value) -> Value {
        let (low, high) = (self.signed(-252), self.signed(254));
        let y = self.builder.binary(Binary::SMax, y, low);
        let y = self.builder.binary(Binary::SMin, y, high);
        let one = self.builder.word(1);
        let half = self.builder.binary(Binary::SShr, y, one);
        let rest = self.builder.binary(Binary::Sub, y, half);
        let [half, rest] = [half, rest].map(|exponent| {
            let (bias, shift) = (self.builder.word(127), self.builder.word(23));
            let biased = self.builder.binary(Binary::Add, exponent, bias);
            self.builder.binary(Binary::Shl, biased, shift)
        });
        let scaled = self.builder.binary(Binary::FMul, x, half);
        self.builder.binary(Binary::FMul, scaled, rest)
    }

    fn signed(&mut self, number: i32) -> Value {
        self.builder.word(number.cast_unsigned())
    }

    fn of_integers(
        &mut self,
        function: MathFunction,
        is_signed: bool,
        values: &[Value],
    ) -> Lowered<Value> {
        use Binary as B;
        use MathFunction as F;
        let x = values[0];
        let [y, z, w] = [1, 2, 3].map(|at| values.get(at).copied().unwrap_or(x));
        let (min, max) = if is_signed {
            (B::SMin, B::SMax)
        } else {
            (B::UMin, B::UMax)
        };
        Ok(match function {
            F::Abs if is_signed => {
                let zero = self.builder.word(0);
                let negated = self.builder.binary(B::Sub, zero, x);
                self.builder.binary(B::SMax, x, negated)
            }
            F::Abs => x,
            F::Min => self.builder.binary(min, x, y),
            F::Max => self.builder.binary(max, x, y),
            F::Clamp => {
                let raised = self.builder.binary(max, x, y);
                self.builder.binary(min, raised, z)
            }
            F::Sign if !is_signed => {
                let one = self.builder.word(1);
                self.builder.binary(B::UMin, x, one)
            }
            F::Sign => {
                let (low, high) = (self.signed(-1), self.builder.word(1));
                let raised = self.builder.binary(B::SMax, x, low);
                self.builder.binary(B::SMin, raised, high)
            }
            F::FirstTrailingBit => {
                let zeros = self.builder.unary(Unary::TrailingZeros, x);
                self.or_none(x, zeros)
            }
            F::FirstLeadingBit => {
                let word = if is_signed {
                    let last = self.builder.word(31);
                    let sign = self.builder.binary(B::SShr, x, last);
                    self.builder.binary(B::Xor, x, sign)
                } else {
                    x
                };
                let zeros = self.builder.unary(Unary::LeadingZeros, word);
                let last = self.builder.word(31);
                let bit = self.builder.binary(B::Sub, last, zeros);
                self.or_none(word, bit)
            }
            F::ExtractBits => self.extract_bits(x, [y, z], is_signed),
            F::InsertBits => self.insert_bits([x, y], [z, w]),
            _ => return Err(LowerError::Unsupported("functions of this kind")),
        })
    }

    /// −1 where a word is 0.
    fn or_none(&mut self, word: Value, bit: Value) -> Value {
        let (zero, none) = (self.builder.word(0), self.signed(-1));
        let is_zero = self.builder.compare(Compare::Eq, word, zero);
        self.builder.select(is_zero, none, bit)
    }

    /// The offset and count of bits, held to those that a word has.
    fn bit_range(&mut self, [offset, count]: [Value; 2]) -> [Value; 2] {
        let bits = self.builder.word(32);
        let offset = self.builder.binary(Binary::UMin, offset, bits);
        let left = self.builder.binary(Binary::Sub, bits, offset);
        [offset, self.builder.binary(Binary::UMin, count, left)]
    }

    fn extract_bits(&mut self, x: Value, range: [Value; 2], is_signed: bool) -> Value {
        let [offset, count] = self.bit_range(range);
        let (bits, zero) = (self.builder.word(32), self.builder.word(0));
        let end = self.builder.binary(Binary::Add, offset, count);
        let left = self.builder.binary(Binary::Sub, bits, end);
        let right = self.builder.binary(Binary::Sub, bits, count);
        let high = self.builder.binary(Binary::Shl, x, left);
        let shift = if is_signed {
            Binary::SShr
        } else {
            Binary::UShr
        };
        let part = self.builder.binary(shift, high, right);
        // Shifts by 32 are shifts by 0.
        let is_empty = self.builder.compare(Compare::Eq, count, zero);
        self.builder.select(is_empty, zero, part)
    }

    fn insert_bits(&mut self, [x, new]: [Value; 2], range: [Value; 2]) -> Value {
        let [offset, count] = self.bit_range(range);
        let (bits, zero) = (self.builder.word(32), self.builder.word(0));
        let ones = self.builder.word(u32::MAX);
        let right = self.builder.binary(Binary::Sub, bits, count);
        let low = self.builder.binary(Binary::UShr, ones, right);
        let mask = self.builder.binary(Binary::Shl, low, offset);
        let moved = self.builder.binary(Binary::Shl, new, offset);
        let moved = self.builder.binary(Binary::And, moved, mask);
        let others = self.builder.unary(Unary::Not, mask);
        let kept = self.builder.binary(Binary::And, x, others);
        let inserted = self.builder.binary(Binary::Or, kept, moved);
        let is_empty = self.builder.compare(Compare::Eq, count, zero);
        self.builder.select(is_empty, x, inserted)
    }

    fn each(&mut self, kind: Binary, a: &[Value], b: &[Value]) -> Vec<Value> {
        let at = |list: &[Value], at: usize| list[at.min(list.len() - 1)];
        let count = a.len().max(b.len());
        (0..count)
            .map(|k| self.builder.binary(kind, at(a, k), at(b, k)))
            .collect()
    }

    fn integer_dot(&mut self, arguments: &[Vec<Value>]) -> Value {
        let products = self.each(Binary::Mul, &arguments[0], &arguments[1]);
        let zero = self.builder.word(0);
        products
            .into_iter()
            .fold(zero, |sum, one| self.builder.binary(Binary::Add, sum, one))
    }

    fn length(&mut self, v: &[Value]) -> Value {
        if let [x] = v {
            return self.builder.unary(Unary::FAbs, *x);
        }
        let square = self.dot(v, v);
        self.builder.unary(Unary::FSqrt, square)
    }

    fn normalize(&mut self, v: &[Value]) -> Vec<Value> {
        let (one, length) = (self.builder.float(1.0), self.length(v));
        let factor = self.builder.binary(Binary::FDiv, one, length);
        self.each(Binary::FMul, v, &[factor])
    }

    fn cross(&mut self, a: &[Value], b: &[Value]) -> Vec<Value> {
        let part = |k: usize| {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            let first = self.builder.binary(Binary::FMul, a[i], b[j]);
            let second = self.builder.binary(Binary::FMul, a[j], b[i]);
            self.builder.binary(Binary::FSub, first, second)
        };
        [0, 1, 2].map(part).to_vec()
    }

    /// v − n·(n·v·2).
    fn reflect(&mut self, v: &[Value], n: &[Value]) -> Vec<Value> {
        let along = self.dot(n, v);
        let double = self.times(along, 2.0);
        let back = self.each(Binary::FMul, n, &[double]);
        self.each(Binary::FSub, v, &back)
    }

    /// k = 1 − η²(1 − (n·v)²); η·v − (η·(n·v) + √k)·n, or zeros where k is negative.
    fn refract(&mut self, arguments: &[Vec<Value>]) -> Vec<Value> {
        let (v, n, eta) = (&arguments[0], &arguments[1], arguments[2][0]);
        let (one, zero) = (self.builder.float(1.0), self.builder.float(0.0));
        let along = self.dot(n, v);
        let square = self.builder.binary(Binary::FMul, along, along);
        let across = self.builder.binary(Binary::FSub, one, square);
        let ratio = self.builder.binary(Binary::FMul, eta, eta);
        let bent = self.builder.binary(Binary::FMul, ratio, across);
        let k = self.builder.binary(Binary::FSub, one, bent);
        let is_inside = self.builder.compare(Compare::FLt, k, zero);
        let root = self.builder.unary(Unary::FSqrt, k);
        let part = self.builder.binary(Binary::FMul, eta, along);
        let normal = self.builder.binary(Binary::FAdd, part, root);
        let forward = self.each(Binary::FMul, v, &[eta]);
        let back = self.each(Binary::FMul, n, &[normal]);
        let through = self.each(Binary::FSub, &forward, &back);
        through
            .into_iter()
            .map(|one| self.builder.select(is_inside, zero, one))
            .collect()
    }

    fn face_forward(&mut self, arguments: &[Vec<Value>]) -> Vec<Value> {
        let (n, incident, reference) = (&arguments[0], &arguments[1], &arguments[2]);
        let (along, zero) = (self.dot(reference, incident), self.builder.float(0.0));
        let faces = self.builder.compare(Compare::FLt, along, zero);
        let one = |&n: &Value| {
            let away = self.builder.unary(Unary::FNeg, n);
            self.builder.select(faces, n, away)
        };
        n.iter().map(one).collect()
    }

    fn outer(&mut self, column: &[Value], row: &[Value]) -> Vec<Value> {
        let columns = row
            .iter()
            .map(|&factor| self.each(Binary::FMul, column, &[factor]));
        columns.flatten().collect()
    }

    /// The fraction and the whole part, each with the sign of the number.
    fn modf(&mut self, x: &[Value]) -> Vec<Value> {
        let whole: Vec<_> = x
            .iter()
            .map(|&x| self.builder.unary(Unary::FTrunc, x))
            .collect();
        let mut parts = self.each(Binary::FSub, x, &whole);
        parts.extend(whole);
        parts
    }

    /// The fraction, from ½ to 1 with the sign of the number, and the exponent as an integer.
    /// Zeros, infinities and NaN are their own fraction, with the exponent 0.
    fn frexp(&mut self, x: &[Value]) -> Vec<Value> {
        let (mut fractions, mut exponents) = (Vec::new(), Vec::new());
        for &x in x {
            let b = &mut self.builder;
            let [zero, infinity] = [0.0, f32::INFINITY].map(|number| b.float(number));
            let [no_exponent, shift, exponent_bits, bias] =
                [0, 23, 0xFF, 126].map(|word| b.word(word));
            // Subnormal numbers become normal ones.
            let (factor, of_factor) = (b.float(16_777_216.0), b.word(24));
            let magnitude = b.unary(Unary::FAbs, x);
            let least = b.float(f32::MIN_POSITIVE);
            let is_small = b.compare(Compare::FLt, magnitude, least);
            let scaled = b.binary(Binary::FMul, x, factor);
            let normal = b.select(is_small, scaled, x);
            let scale = b.select(is_small, of_factor, no_exponent);
            let high = b.binary(Binary::UShr, normal, shift);
            let biased = b.binary(Binary::And, high, exponent_bits);
            let exponent = b.binary(Binary::Sub, biased, bias);
            let exponent = b.binary(Binary::Sub, exponent, scale);
            let (sign_and_significand, of_half) = (b.word(0x807F_FFFF), b.word(0x3F00_0000));
            let kept = b.binary(Binary::And, normal, sign_and_significand);
            let fraction = b.binary(Binary::Or, kept, of_half);
            // NaN is not below infinity.
            let is_finite = b.compare(Compare::FLt, magnitude, infinity);
            let is_zero = b.compare(Compare::FEq, x, zero);
            let has_parts = b.mask_binary(MaskBinary::AndNot, is_finite, is_zero);
            fractions.push(b.select(has_parts, fraction, x));
            exponents.push(b.select(has_parts, exponent, no_exponent));
        }
        fractions.extend(exponents);
        fractions
    }

    fn of_matrix(
        &mut self,
        function: MathFunction,
        inner: &TypeInner,
        matrix: &[Value],
    ) -> Lowered<Vec<Value>> {
        let &TypeInner::Matrix { columns, rows, .. } = inner else {
            return Err(LowerError::Unsupported("matrices of this type"));
        };
        let (columns, rows) = (columns as usize, rows as usize);
        match function {
            MathFunction::Transpose => {
                let row = |row: usize| matrix.iter().skip(row).step_by(rows).copied();
                Ok((0..rows).flat_map(row).collect())
            }
            MathFunction::Determinant => Ok(vec![self.determinant(matrix, columns)]),
            _ => Ok(self.inverse(matrix, columns)),
        }
    }

    /// By the first column, from its first row on.
    fn determinant(&mut self, matrix: &[Value], size: usize) -> Value {
        if size == 1 {
            return matrix[0];
        }
        let mut sum = None;
        for row in 0..size {
            let minor = self.minor(matrix, size, [0, row]);
            let term = self.builder.binary(Binary::FMul, matrix[row], minor);
            sum = Some(match sum {
                None => term,
                Some(sum) if row % 2 == 1 => self.builder.binary(Binary::FSub, sum, term),
                Some(sum) => self.builder.binary(Binary::FAdd, sum, term),
            });
        }
        sum.unwrap_or(matrix[0])
    }

    /// The determinant without a column and a row.
    fn minor(&mut self, matrix: &[Value], size: usize, [column, row]: [usize; 2]) -> Value {
        let kept = matrix.iter().enumerate();
        let kept = kept.filter(|(at, _)| at / size != column && at % size != row);
        let kept: Vec<_> = kept.map(|(_, &value)| value).collect();
        self.determinant(&kept, size - 1)
    }

    /// The cofactors, transposed, each divided by the determinant.
    fn inverse(&mut self, matrix: &[Value], size: usize) -> Vec<Value> {
        let determinant = self.determinant(matrix, size);
        let mut inverse = Vec::new();
        for at in 0..size * size {
            let (column, row) = (at / size, at % size);
            let minor = self.minor(matrix, size, [row, column]);
            let cofactor = if (column + row) % 2 == 1 {
                self.builder.unary(Unary::FNeg, minor)
            } else {
                minor
            };
            inverse.push(self.builder.binary(Binary::FDiv, cofactor, determinant));
        }
        inverse
    }

    /// Numbers of −1..=1 or 0..=1, or halves, side by side in a word, the first lowest.
    fn pack(&mut self, function: MathFunction, values: &[Value]) -> Value {
        use MathFunction as F;
        let bits = u32::try_from(32 / values.len()).unwrap_or(16);
        let (low, scale) = match function {
            F::Pack4x8snorm => (-1.0, 127.0),
            F::Pack2x16snorm => (-1.0, 32_767.0),
            F::Pack4x8unorm => (0.0, 255.0),
            _ => (0.0, 65_535.0),
        };
        let mut word = self.builder.word(0);
        for (at, &value) in (0..).zip(values) {
            let code = if function == F::Pack2x16float {
                self.builder.unary(Unary::F16FromF32, value)
            } else {
                let limits = [low, 1.0].map(|limit| self.builder.float(limit));
                let held = self.clamp(value, limits);
                let (half, scaled) = (self.builder.float(0.5), self.times(held, scale));
                let raised = self.builder.binary(Binary::FAdd, half, scaled);
                let whole = self.builder.unary(Unary::FFloor, raised);
                let code = self.builder.unary(Unary::S32FromF32, whole);
                let mask = self.builder.word(u32::MAX >> (32 - bits));
                self.builder.binary(Binary::And, code, mask)
            };
            let by = self.builder.word(at * bits);
            let moved = self.builder.binary(Binary::Shl, code, by);
            word = self.builder.binary(Binary::Or, word, moved);
        }
        word
    }

    fn unpack(&mut self, function: MathFunction, word: Value) -> Vec<Value> {
        use MathFunction as F;
        let (count, scale, is_signed) = match function {
            F::Unpack4x8snorm => (4, 127.0, true),
            F::Unpack4x8unorm => (4, 255.0, false),
            F::Unpack2x16snorm => (2, 32_767.0, true),
            _ => (2, 65_535.0, false),
        };
        let bits = 32 / count;
        let part = |at: u32| {
            let width = self.builder.word(bits);
            let offset = self.builder.word(at * bits);
            let code = self.extract_bits(word, [offset, width], is_signed);
            if function == F::Unpack2x16float {
                return self.builder.unary(Unary::F32FromF16, code);
            }
            let to_float = if is_signed {
                Unary::F32FromS32
            } else {
                Unary::F32FromU32
            };
            let number = self.builder.unary(to_float, code);
            let divisor = self.builder.float(scale);
            let quotient = self.builder.binary(Binary::FDiv, number, divisor);
            if is_signed {
                let low = self.builder.float(-1.0);
                self.builder.binary(Binary::FMax, quotient, low)
            } else {
                quotient
            }
        };
        (0..count).map(part).collect()
    }
}
