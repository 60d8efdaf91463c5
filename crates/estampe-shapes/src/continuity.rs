//! Jumps, poles and the ends of a function's domain between two samples.
//!
//! A grid sees a function at its samples only, and a straight line between two of them may hide a
//! jump (`floor(x)`), a pole (`1/x`), or the end of the domain (`sqrt(x)`). Derivatives tell which
//! segments to look at: where a function is smooth, the difference of its values is nearly the mean
//! of its slopes times the step (the trapezoidal rule). Where it is not, bisection follows the
//! halves that do not fit. A steep but continuous function flattens out as the interval shrinks; at
//! a jump the difference remains.

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

/// Evaluations that the search in one segment may spend: a jump and its surroundings take 100.
const SEGMENT_BUDGET: u32 = 400;

/// A part of a segment that is not smooth.
#[derive(Clone, Copy, Debug)]
struct Part {
    ends: [(f64, Sample); 2],
    /// The deviation from the trapezoidal rule.
    misfit: f64,
    bisections: u32,
}

impl Part {
    /// The part between two samples; `None` if it is smooth.
    fn new(ends: [(f64, Sample); 2], bisections: u32) -> Option<Self> {
        let [(a, at_a), (b, at_b)] = ends;
        let difference = at_b.position - at_a.position;
        let predicted = (at_a.slope + at_b.slope) * (0.5 * (b - a));
        let misfit = (difference - predicted).length();
        // An infinite slope, as that of a square root at 0, fits nothing.
        let misfit = if misfit.is_nan() {
            f64::INFINITY
        } else {
            misfit
        };
        (misfit > SMOOTH * difference.length()).then_some(Self {
            ends,
            misfit,
            bisections,
        })
    }

    /// The part from the first end of both to the last. Beside a pole, the values of neighbours in
    /// f64 differ as they do at a jump; the pole is among them.
    fn united(&self, other: &Self) -> Self {
        let [first, last] = self.ends;
        let [other_first, other_last] = other.ends;
        // Parameters may run backwards.
        let way = last.0 - first.0;
        let is_before = (other_first.0 - first.0) * way < 0.0;
        let is_after = (other_last.0 - last.0) * way > 0.0;
        Self {
            ends: [
                if is_before { other_first } else { first },
                if is_after { other_last } else { last },
            ],
            ..*self
        }
    }

    /// The distance of the points at both ends.
    fn distance(&self) -> f64 {
        let [(_, at_a), (_, at_b)] = self.ends;
        at_b.position.distance(at_a.position)
    }
}

/// The break between two parameters with defined samples, if there is one.
pub(crate) fn find_break(
    sample: impl Fn(f64) -> Sample,
    first: (f64, Sample),
    last: (f64, Sample),
    budget: &Cell<u64>,
) -> Option<Break> {
    let segment = Part::new([first, last], 0)?;
    let (length, whole) = ((last.0 - first.0).abs(), segment.distance());
    // Next to a pole both halves fit badly, so both are searched, the worse one first.
    let mut parts = vec![segment];
    let mut found: Option<Part> = None;
    for _ in 0..SEGMENT_BUDGET {
        let Some(part) = parts.pop() else {
            break;
        };
        let [(a, at_a), (b, at_b)] = part.ends;
        let middle = 0.5 * (a + b);
        if part.bisections >= BISECTIONS || middle == a || middle == b {
            if part.distance() > REMAINING * whole {
                found = Some(found.map_or(part, |other| other.united(&part)));
            }
            continue;
        }
        budget.set(budget.get().checked_sub(1)?);
        let at_middle = sample(middle);
        if !at_middle.is_defined() {
            // At the end of a square root, rounding may leave its domain between two samples in it.
            if (b - a).abs() <= ROUNDING * length && part.distance() <= REMAINING * whole {
                continue;
            }
            let is_defined = |t: f64| sample(t).is_defined();
            return Some(Break {
                before: last_that(is_defined, a, middle),
                after: last_that(is_defined, b, middle),
                is_step: false,
            });
        }
        let half = |ends| Part::new(ends, part.bisections + 1);
        let low = half([(a, at_a), (middle, at_middle)]);
        let high = half([(middle, at_middle), (b, at_b)]);
        match (low, high) {
            (Some(low), Some(high)) if low.misfit > high.misfit => parts.extend([high, low]),
            (low, high) => parts.extend([low, high].into_iter().flatten()),
        }
    }
    found.map(|part| Break {
        before: part.ends[0].0,
        after: part.ends[1].0,
        is_step: part.distance() <= 2.0 * whole,
    })
}

/// True if a function tends to a point at the end of its domain, and not away from all points as at
/// a pole. `inside` is a sample, and `end` the last parameter at which the function is defined.
///
/// At a limit, the way of the function on the last 2⁻¹⁶ of the interval is shorter than that
/// from 2⁻⁸ to 2⁻¹⁶: that of x^a by r / (1 − r) with r = 2^(−8a), a sixteenth for the square root
/// and less than 0.8 for a ≥ 0.15. At a logarithm's end it is longer, as `end` is 2⁻⁴⁸ of the
/// interval from it, and at that of x^−a by far.
pub(crate) fn has_limit(position: impl Fn(f64) -> DVec3, inside: f64, end: f64) -> bool {
    const SHARE: f64 = 1.0 / 256.0;
    const LONGEST: f64 = 0.8;
    /// The share of the whole way that counts as rounding.
    const ROUNDING: f64 = 1e-6;
    let at = |share: f64| position(end + (inside - end) * share);
    let [start, middle, near, last] = [at(1.0), at(SHARE), at(SHARE * SHARE), position(end)];
    let limit = LONGEST * near.distance(middle) + ROUNDING * near.distance(start);
    // A comparison with NaN is false.
    last.distance(near) <= limit
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
