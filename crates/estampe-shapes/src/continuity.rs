//! Jumps, poles and the ends of a function's domain between two samples.
//!
//! A grid sees a function at its samples only, and a straight line between two of them may hide a
//! jump (`floor(x)`), a pole (`1/x`), or the end of the domain (`sqrt(x)`). Derivatives tell which
//! segments to look at: where a function is smooth, the difference of its values is nearly the mean
//! of its slopes times the step (the trapezoidal rule). Where it is not, bisection follows the half
//! that fits worse. A steep but continuous function flattens out as the interval shrinks; at a jump
//! the difference remains.

use std::cell::Cell;

use glam::DVec3;

/// A point of a curve and its derivative by the curve's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) position: DVec3,
    pub(crate) slope: DVec3,
}

impl Sample {
    /// True if the function is defined here.
    pub(crate) fn is_defined(&self) -> bool {
        is_defined(self.position)
    }
}

/// Coordinates beyond this count as undefined, so that squares of distances fit f64, and positions
/// with room to spare f32.
const MAX_COORDINATE: f64 = 1e30;

/// True if a function that has this value is defined there.
pub(crate) fn is_defined(position: DVec3) -> bool {
    // A comparison with NaN is false.
    position.abs().cmple(DVec3::splat(MAX_COORDINATE)).all()
}

/// A place at which a curve is interrupted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Break {
    /// The last parameter before it at which the curve is defined.
    pub(crate) before: f64,
    /// The first parameter after it.
    pub(crate) after: f64,
    /// True if both sides end at finite points that are about as far apart as the samples are; not
    /// at a pole.
    pub(crate) is_step: bool,
}

/// Deviation from the trapezoidal rule, relative to the difference of the values, up to which a
/// segment counts as smooth.
const SMOOTH: f64 = 0.25;

/// Steps of a bisection: what remains of an interval is near the spacing of f64.
const BISECTIONS: u32 = 48;

/// The share of a difference that remains at a jump when bisection has ended. A cube root, the
/// steepest function that is continuous and usual, keeps 2^(−48/3) = 1.5e-5.
const REMAINING: f64 = 1e-3;

/// The share of an interval below which a gap in a function's domain may be due to rounding.
const ROUNDING: f64 = 1e-9;

/// Evaluations that all searches of one mesh may spend; beyond it segments count as continuous. A
/// function that oscillates between all samples would spend 48 at each.
pub(crate) const SEARCH_BUDGET: u64 = 1 << 24;

/// The break between two parameters with defined samples, if there is one.
pub(crate) fn find_break(
    sample: impl Fn(f64) -> Sample,
    (from, first): (f64, Sample),
    (to, last): (f64, Sample),
    budget: &Cell<u64>,
) -> Option<Break> {
    let misfit = |a: f64, at_a: &Sample, b: f64, at_b: &Sample| {
        let difference = at_b.position - at_a.position;
        let predicted = (at_a.slope + at_b.slope) * (0.5 * (b - a));
        let misfit = (difference - predicted).length();
        // An infinite slope, as that of a square root at 0, fits nothing.
        let misfit = if misfit.is_nan() {
            f64::INFINITY
        } else {
            misfit
        };
        (misfit, misfit <= SMOOTH * difference.length())
    };
    if misfit(from, &first, to, &last).1 {
        return None;
    }
    let whole = last.position.distance(first.position);
    let remains =
        |at_a: &Sample, at_b: &Sample| at_b.position.distance(at_a.position) > REMAINING * whole;
    let (mut a, mut at_a, mut b, mut at_b) = (from, first, to, last);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (a + b);
        if middle == a || middle == b {
            break;
        }
        budget.set(budget.get().checked_sub(1)?);
        let at_middle = sample(middle);
        if !at_middle.is_defined() {
            // At the end of a square root, rounding may leave its domain between two samples in it.
            if b - a <= ROUNDING * (to - from) && !remains(&at_a, &at_b) {
                return None;
            }
            let is_defined = |t: f64| sample(t).is_defined();
            return Some(Break {
                before: last_that(is_defined, a, middle),
                after: last_that(is_defined, b, middle),
                is_step: false,
            });
        }
        let (below, above) = (
            misfit(a, &at_a, middle, &at_middle),
            misfit(middle, &at_middle, b, &at_b),
        );
        if below.1 && above.1 {
            return None;
        }
        if below.0 > above.0 || above.1 {
            (b, at_b) = (middle, at_middle);
        } else {
            (a, at_a) = (middle, at_middle);
        }
    }
    remains(&at_a, &at_b).then_some(Break {
        before: a,
        after: b,
        is_step: at_b.position.distance(at_a.position) <= 2.0 * whole,
    })
}

/// The last parameter on the way from `inside` to `outside` that satisfies a condition, which holds
/// at `inside` and not at `outside`, by bisection.
pub(crate) fn last_that(condition: impl Fn(f64) -> bool, inside: f64, outside: f64) -> f64 {
    let (mut inside, mut outside) = (inside, outside);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            break;
        }
        if condition(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}
