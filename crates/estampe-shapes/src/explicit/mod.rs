//! Explicit functions: curves y = f(x) and surfaces z = f(x, y).
//!
//! Functions return their value with its partial derivatives ([`Dual`](crate::expression::Dual)),
//! from which normals follow, and by which jumps and poles are found: where `floor(x)`, `1/x` or
//! `tan(x)` is interrupted, so is the curve or surface. Where a function ends, as `sqrt(x)` does at
//! 0, bisection finds the end. A range of values, if there is one, cuts the curve or surface at its
//! limits.

mod curve;
mod surface;

use std::ops::Range;

pub use curve::curve;
pub use surface::surface;

/// The lower and the upper limit of a range that may run backwards.
fn limits(values: &Range<f64>) -> (f64, f64) {
    (values.start.min(values.end), values.start.max(values.end))
}

#[cfg(test)]
mod tests;
