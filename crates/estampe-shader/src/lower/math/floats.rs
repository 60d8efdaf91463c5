//! Functions of floating-point numbers, component by component.

use crate::lower::{LowerError, Lowered, Lowering};
use estampe_ir::op::{Binary, Compare, Math, Math2, Unary};
use estampe_ir::{Op, Value};
use naga::MathFunction;

impl Lowering<'_> {
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

    pub(super) fn of_floats(&mut self, function: MathFunction, values: &[Value]) -> Lowered<Value> {
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

    pub(super) fn times(&mut self, x: Value, factor: f32) -> Value {
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

    pub(super) fn clamp(&mut self, x: Value, [low, high]: [Value; 2]) -> Value {
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
}
