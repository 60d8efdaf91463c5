//! The numbers that a program computes with: plain ones, and those that carry derivatives.

/// A number, possibly with its derivatives by the variables.
pub(super) trait Number: Copy {
    /// A number that does not depend on the variables.
    fn constant(value: f64) -> Self;
    /// The number without derivatives.
    fn value(self) -> f64;
    fn negated(self) -> Self;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    /// f(self), whose value is given, as are on demand the first and second derivative of f.
    fn composed(self, value: f64, slopes: impl FnOnce() -> [f64; 2]) -> Self;
    /// f(self, other), whose value is given, as are on demand the partial derivatives of f.
    fn composed_pair(self, other: Self, value: f64, slopes: impl FnOnce() -> PairSlopes) -> Self;
}

/// The partial derivatives of a function f(a, b).
#[derive(Clone, Copy, Debug)]
pub(super) struct PairSlopes {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) aa: f64,
    pub(super) ab: f64,
    pub(super) bb: f64,
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn negated(self) -> Self {
        -self
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn minus(self, other: Self) -> Self {
        self - other
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn composed(self, value: f64, _: impl FnOnce() -> [Self; 2]) -> Self {
        value
    }

    fn composed_pair(self, _: Self, value: f64, _: impl FnOnce() -> PairSlopes) -> Self {
        value
    }
}
