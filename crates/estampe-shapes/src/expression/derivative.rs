//! Numbers with derivatives: [`Dual`], the first ones by any number of variables, and [`Jet`], the
//! first and second ones by two variables.
//!
//! For f(u), with the partial derivatives uᵢ and uᵢⱼ of u:
//!
//! ```text
//!   fᵢ  = f′ uᵢ
//!   fᵢⱼ = f″ uᵢ uⱼ + f′ uᵢⱼ
//! ```
//!
//! and for f(a, b):
//!
//! ```text
//!   fᵢ  = f_a aᵢ + f_b bᵢ
//!   fᵢⱼ = f_aa aᵢ aⱼ + f_ab (aᵢ bⱼ + aⱼ bᵢ) + f_bb bᵢ bⱼ + f_a aᵢⱼ + f_b bᵢⱼ
//! ```

use super::number::{Number, PairSlopes};

/// A value and its partial derivatives by N variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// The partial derivative by each variable.
    pub partials: [f64; N],
}

/// A value and its first and second partial derivatives by two variables s and t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// The partial derivatives by s and t.
    pub partials: [f64; 2],
    /// The second partial derivatives: by s twice, by s and t, by t twice.
    pub seconds: [f64; 3],
}

/// The product of a slope and a partial derivative. If nothing changes in a direction, an infinite
/// or undefined slope has no effect there: x^2 under a square root has the slope 0 at 0.
fn scaled(slope: f64, partial: f64) -> f64 {
    if partial == 0.0 { 0.0 } else { slope * partial }
}

impl<const N: usize> Dual<N> {
    /// The variables themselves, at these values.
    pub(super) fn variables(values: [f64; N]) -> [Self; N] {
        std::array::from_fn(|variable| Self {
            value: values[variable],
            partials: std::array::from_fn(|by| if by == variable { 1.0 } else { 0.0 }),
        })
    }

    fn each(value: f64, partial: impl Fn(usize) -> f64) -> Self {
        Self {
            value,
            partials: std::array::from_fn(partial),
        }
    }
}

impl<const N: usize> Number for Dual<N> {
    fn constant(value: f64) -> Self {
        Self {
            value,
            partials: [0.0; N],
        }
    }

    fn value(self) -> f64 {
        self.value
    }

    fn negated(self) -> Self {
        Self::each(-self.value, |i| -self.partials[i])
    }

    fn plus(self, other: Self) -> Self {
        Self::each(self.value + other.value, |i| {
            self.partials[i] + other.partials[i]
        })
    }

    fn minus(self, other: Self) -> Self {
        Self::each(self.value - other.value, |i| {
            self.partials[i] - other.partials[i]
        })
    }

    fn times(self, other: Self) -> Self {
        Self::each(self.value * other.value, |i| {
            scaled(self.value, other.partials[i]) + scaled(other.value, self.partials[i])
        })
    }

    fn composed(self, value: f64, slopes: impl FnOnce() -> [f64; 2]) -> Self {
        let [slope, _] = slopes();
        Self::each(value, |i| scaled(slope, self.partials[i]))
    }

    fn composed_pair(self, other: Self, value: f64, slopes: impl FnOnce() -> PairSlopes) -> Self {
        let slopes = slopes();
        Self::each(value, |i| {
            scaled(slopes.a, self.partials[i]) + scaled(slopes.b, other.partials[i])
        })
    }
}

/// The variables of each second derivative of a [`Jet`].
const SECONDS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

impl Jet {
    /// The variables themselves, at these values.
    pub(super) fn variables([s, t]: [f64; 2]) -> [Self; 2] {
        let variable = |value, partials| Self {
            value,
            partials,
            seconds: [0.0; 3],
        };
        [variable(s, [1.0, 0.0]), variable(t, [0.0, 1.0])]
    }

    fn each(
        value: f64,
        partial: impl Fn(usize) -> f64,
        second: impl Fn(usize, usize, usize) -> f64,
    ) -> Self {
        Self {
            value,
            partials: std::array::from_fn(partial),
            seconds: std::array::from_fn(|k| second(k, SECONDS[k].0, SECONDS[k].1)),
        }
    }
}

impl Number for Jet {
    fn constant(value: f64) -> Self {
        Self {
            value,
            partials: [0.0; 2],
            seconds: [0.0; 3],
        }
    }

    fn value(self) -> f64 {
        self.value
    }

    fn negated(self) -> Self {
        Self::each(
            -self.value,
            |i| -self.partials[i],
            |k, _, _| -self.seconds[k],
        )
    }

    fn plus(self, other: Self) -> Self {
        Self::each(
            self.value + other.value,
            |i| self.partials[i] + other.partials[i],
            |k, _, _| self.seconds[k] + other.seconds[k],
        )
    }

    fn minus(self, other: Self) -> Self {
        Self::each(
            self.value - other.value,
            |i| self.partials[i] - other.partials[i],
            |k, _, _| self.seconds[k] - other.seconds[k],
        )
    }

    fn times(self, other: Self) -> Self {
        let (a, b) = (self.partials, other.partials);
        Self::each(
            self.value * other.value,
            |i| scaled(self.value, b[i]) + scaled(other.value, a[i]),
            |k, i, j| {
                scaled(self.value, other.seconds[k])
                    + (scaled(a[i], b[j]) + scaled(a[j], b[i]))
                    + scaled(other.value, self.seconds[k])
            },
        )
    }

    fn composed(self, value: f64, slopes: impl FnOnce() -> [f64; 2]) -> Self {
        let [first, second] = slopes();
        let u = self.partials;
        Self::each(
            value,
            |i| scaled(first, u[i]),
            |k, i, j| scaled(second, u[i] * u[j]) + scaled(first, self.seconds[k]),
        )
    }

    fn composed_pair(self, other: Self, value: f64, slopes: impl FnOnce() -> PairSlopes) -> Self {
        let f = slopes();
        let (a, b) = (self.partials, other.partials);
        Self::each(
            value,
            |i| scaled(f.a, a[i]) + scaled(f.b, b[i]),
            |k, i, j| {
                scaled(f.aa, a[i] * a[j])
                    + scaled(f.ab, a[i] * b[j] + a[j] * b[i])
                    + scaled(f.bb, b[i] * b[j])
                    + scaled(f.a, self.seconds[k])
                    + scaled(f.b, other.seconds[k])
            },
        )
    }
}
