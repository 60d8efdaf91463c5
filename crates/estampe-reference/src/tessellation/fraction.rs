//! Exact rational numbers.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Sub};

/// A rational number in lowest terms; the denominator is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fraction {
    numerator: i128,
    denominator: i128,
}

impl Fraction {
    /// `numerator / denominator`; the denominator is not 0.
    #[must_use]
    pub fn new(numerator: i128, denominator: i128) -> Self {
        let (mut a, mut b) = (numerator.abs(), denominator.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let divisor = a.max(1) * denominator.signum();
        Self {
            numerator: numerator / divisor,
            denominator: denominator / divisor,
        }
    }

    /// An integer.
    #[must_use]
    pub fn whole(number: i128) -> Self {
        Self::new(number, 1)
    }

    /// A float of 1 to 64, exactly: a multiple of 2⁻²³.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "at most 64 · 2²³")]
    pub fn of_level(level: f32) -> Self {
        Self::new((f64::from(level) * 8_388_608.0) as i128, 8_388_608)
    }

    /// The least integer that is not below it.
    #[must_use]
    pub fn ceil(self) -> i128 {
        -(-self.numerator).div_euclid(self.denominator)
    }

    /// The nearest multiple of 2⁻²⁴, halves up, as a number of them.
    #[must_use]
    pub fn rounded(self) -> u32 {
        let doubled = (self.numerator << 25) + self.denominator;
        u32::try_from(doubled.div_euclid(2 * self.denominator)).unwrap_or(u32::MAX)
    }
}

macro_rules! operator {
    ($trait:ident $method:ident, $a:ident $b:ident => $numerator:expr, $denominator:expr) => {
        impl $trait for Fraction {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                Self::new($numerator, $denominator)
            }
        }
    };
}
operator!(Add add, a b => a.numerator * b.denominator + b.numerator * a.denominator, a.denominator * b.denominator);
operator!(Sub sub, a b => a.numerator * b.denominator - b.numerator * a.denominator, a.denominator * b.denominator);
operator!(Mul mul, a b => a.numerator * b.numerator, a.denominator * b.denominator);
operator!(Div div, a b => a.numerator * b.denominator, a.denominator * b.numerator);

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.numerator * other.denominator).cmp(&(other.numerator * self.denominator))
    }
}
