//! The functions, their values and their derivatives.

use super::number::{Number, PairSlopes};

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log2,
    Sqrt,
    Abs,
    Floor,
    Sign,
}

/// An operator or function of two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pair {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    Min,
    Max,
}

/// A name that is followed by arguments in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callable {
    One(Function),
    Two(Pair),
    /// Two or more arguments, combined from left to right.
    Many(Pair),
}

/// The names of functions, in the order in which messages list them.
pub(super) const CALLABLES: [(&str, Callable); 20] = [
    ("sin", Callable::One(Function::Sin)),
    ("cos", Callable::One(Function::Cos)),
    ("tan", Callable::One(Function::Tan)),
    ("asin", Callable::One(Function::Asin)),
    ("acos", Callable::One(Function::Acos)),
    ("atan", Callable::One(Function::Atan)),
    ("atan2", Callable::Two(Pair::Atan2)),
    ("sinh", Callable::One(Function::Sinh)),
    ("cosh", Callable::One(Function::Cosh)),
    ("tanh", Callable::One(Function::Tanh)),
    ("exp", Callable::One(Function::Exp)),
    ("ln", Callable::One(Function::Ln)),
    ("log2", Callable::One(Function::Log2)),
    ("sqrt", Callable::One(Function::Sqrt)),
    ("abs", Callable::One(Function::Abs)),
    ("min", Callable::Many(Pair::Min)),
    ("max", Callable::Many(Pair::Max)),
    ("floor", Callable::One(Function::Floor)),
    ("sign", Callable::One(Function::Sign)),
    ("pow", Callable::Two(Pair::Power)),
];

/// The constants.
pub(super) const CONSTANTS: [(&str, f64); 3] = [
    ("pi", std::f64::consts::PI),
    ("e", std::f64::consts::E),
    ("tau", std::f64::consts::TAU),
];

/// −1, 0 or 1; NaN of NaN.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        // Zero of either sign becomes 0.
        x + 0.0
    }
}

impl Function {
    fn value(self, x: f64) -> f64 {
        match self {
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tan => libm::tan(x),
            Self::Asin => libm::asin(x),
            Self::Acos => libm::acos(x),
            Self::Atan => libm::atan(x),
            Self::Sinh => libm::sinh(x),
            Self::Cosh => libm::cosh(x),
            Self::Tanh => libm::tanh(x),
            Self::Exp => libm::exp(x),
            Self::Ln => libm::log(x),
            Self::Log2 => libm::log2(x),
            Self::Sqrt => libm::sqrt(x),
            Self::Abs => x.abs(),
            Self::Floor => libm::floor(x),
            Self::Sign => sign(x),
        }
    }

    /// The first and second derivative at x, where the function has the given value.
    fn slopes(self, x: f64, value: f64) -> [f64; 2] {
        match self {
            Self::Sin => [libm::cos(x), -value],
            Self::Cos => [-libm::sin(x), -value],
            Self::Tan => {
                let slope = 1.0 + value * value;
                [slope, 2.0 * value * slope]
            }
            Self::Asin => asin_slopes(x),
            Self::Acos => asin_slopes(x).map(|slope| -slope),
            Self::Atan => {
                let slope = 1.0 / (1.0 + x * x);
                [slope, -2.0 * x * slope * slope]
            }
            Self::Sinh => [libm::cosh(x), value],
            Self::Cosh => [libm::sinh(x), value],
            Self::Tanh => {
                let cosh = libm::cosh(x);
                let slope = 1.0 / (cosh * cosh);
                [slope, -2.0 * value * slope]
            }
            Self::Exp => [value, value],
            Self::Ln => [1.0 / x, -1.0 / (x * x)],
            Self::Log2 => {
                let scale = std::f64::consts::LOG2_E;
                [scale / x, -scale / (x * x)]
            }
            Self::Sqrt => [0.5 / value, -0.25 / (x * value)],
            Self::Abs => [sign(x), 0.0],
            Self::Floor | Self::Sign => [0.0, 0.0],
        }
    }

    /// Applies the function.
    pub(super) fn apply<N: Number>(self, argument: N) -> N {
        let x = argument.value();
        let value = self.value(x);
        argument.composed(value, || self.slopes(x, value))
    }
}

fn asin_slopes(x: f64) -> [f64; 2] {
    // More precise near ±1 than 1 − x².
    let rest = (1.0 - x) * (1.0 + x);
    let slope = 1.0 / libm::sqrt(rest);
    [slope, x * slope / rest]
}

impl Pair {
    /// Applies the operator or function.
    pub(super) fn apply<N: Number>(self, a: N, b: N) -> N {
        match self {
            Self::Add => a.plus(b),
            Self::Subtract => a.minus(b),
            Self::Multiply => a.times(b),
            Self::Divide => {
                let (x, y) = (a.value(), b.value());
                let value = x / y;
                a.composed_pair(b, value, || PairSlopes {
                    a: 1.0 / y,
                    b: -value / y,
                    aa: 0.0,
                    ab: -1.0 / (y * y),
                    bb: 2.0 * value / (y * y),
                })
            }
            Self::Power => {
                let (x, y) = (a.value(), b.value());
                let value = power(x, y);
                a.composed_pair(b, value, || power_slopes(x, y, value))
            }
            Self::Atan2 => {
                let (y, x) = (a.value(), b.value());
                a.composed_pair(b, libm::atan2(y, x), || atan2_slopes(y, x))
            }
            Self::Min if is_chosen(b, a, b.value() < a.value()) => b,
            Self::Max if is_chosen(b, a, b.value() > a.value()) => b,
            Self::Min | Self::Max => a,
        }
    }
}

/// True if the second argument of a minimum or maximum is the result: if it is beyond the first, or
/// NaN when the first is not.
fn is_chosen<N: Number>(second: N, first: N, is_beyond: bool) -> bool {
    is_beyond || second.value().is_nan() && !first.value().is_nan()
}

/// x^y. NaN of NaN, also where IEEE 754 says 1: at NaN^0 and 1^NaN.
fn power(x: f64, y: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        f64::NAN
    } else {
        libm::pow(x, y)
    }
}

/// The partial derivatives of x^y.
fn power_slopes(x: f64, y: f64, value: f64) -> PairSlopes {
    // 0^y stays 0 while y > 0 changes; the logarithm alone would be infinite.
    let times_ln = |factor: f64| {
        if factor == 0.0 {
            0.0
        } else {
            factor * libm::log(x)
        }
    };
    let below = libm::pow(x, y - 1.0);
    PairSlopes {
        a: y * below,
        b: times_ln(value),
        aa: y * (y - 1.0) * libm::pow(x, y - 2.0),
        ab: below + times_ln(y * below),
        bb: times_ln(times_ln(value)),
    }
}

/// The partial derivatives of atan2(y, x), by y and x.
fn atan2_slopes(y: f64, x: f64) -> PairSlopes {
    let square = x * x + y * y;
    let (u, v) = (x / square, y / square);
    PairSlopes {
        a: u,
        b: -v,
        aa: -2.0 * u * v,
        ab: v * v - u * u,
        bb: 2.0 * u * v,
    }
}

/// x^n, by repeated squaring; for negative n the inverse of x^−n.
fn integer_power(x: f64, n: i32) -> f64 {
    if x.is_nan() {
        return x;
    }
    let (mut result, mut square, mut rest) = (1.0, x, n.unsigned_abs());
    while rest > 0 {
        if rest % 2 == 1 {
            result *= square;
        }
        rest /= 2;
        // The last square is not used, and could overflow.
        if rest > 0 {
            square *= square;
        }
    }
    if n < 0 { 1.0 / result } else { result }
}

/// Raises a number to a constant integer power.
pub(super) fn apply_integer_power<N: Number>(argument: N, n: i32) -> N {
    let x = argument.value();
    let (first, second) = (f64::from(n), f64::from(n) * f64::from(n - 1));
    argument.composed(integer_power(x, n), || {
        // At 0 the lower powers are infinite only if the factor is not 0.
        let slope = |factor: f64, n: i32| {
            if factor == 0.0 {
                0.0
            } else {
                factor * integer_power(x, n)
            }
        };
        [slope(first, n - 1), slope(second, n - 2)]
    })
}
