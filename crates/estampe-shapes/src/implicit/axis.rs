//! The sides of a box, and how near its vertices may be to each other.

use std::ops::Range;

use super::ImplicitError;

/// The least distance of a vertex from a node, as a fraction of their edge.
const LEAST_FRACTION: f64 = 1e-3;

/// The limits and the cells of a box along one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) cells: u32,
}

impl Axis {
    /// Checks a range, which may run backwards.
    pub(super) fn new(
        number: usize,
        range: &Range<f64>,
        cells: u32,
    ) -> Result<Self, ImplicitError> {
        let (low, high) = (range.start.min(range.end), range.start.max(range.end));
        let is_small = |x: f64| x.abs() <= 1e30;
        if !(is_small(range.start) && is_small(range.end) && low < high) {
            return Err(ImplicitError::Bounds { axis: number });
        }
        Ok(Self { low, high, cells })
    }

    /// The coordinate of a node; at halves of cells there are centres. Exact at both ends.
    pub(super) fn coordinate(&self, halves: u32) -> f64 {
        let (step, steps) = (f64::from(halves), 2.0 * f64::from(self.cells));
        (self.low * (steps - step) + self.high * step) / steps
    }

    pub(super) fn cell(&self) -> f64 {
        (self.high - self.low) / f64::from(self.cells)
    }
}

/// The least distance of vertices from nodes, as a fraction of an edge, at which they differ in
/// f32.
pub(super) fn least_fraction(axes: &[Axis]) -> Result<f64, ImplicitError> {
    /// Steps of f32 by which vertices differ at least.
    const STEPS: f64 = 16.0;
    let mut least = LEAST_FRACTION;
    // Rounding on one axis moves a vertex relative to all others, so the finest axis counts.
    let finest = axes.iter().map(Axis::cell).fold(f64::INFINITY, f64::min);
    for (number, axis) in axes.iter().enumerate() {
        let coordinate = if axis.high.abs() > axis.low.abs() {
            axis.high
        } else {
            axis.low
        };
        let step = coordinate.abs() * f64::from(f32::EPSILON);
        let fraction = STEPS * step / finest;
        if fraction > 0.1 {
            return Err(ImplicitError::TooFine {
                axis: number,
                cell: finest,
                coordinate,
            });
        }
        least = least.max(fraction);
    }
    Ok(least)
}
