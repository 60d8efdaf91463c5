//! Polylines from a function of one parameter, interrupted where the function is.

use std::cell::Cell;
use std::ops::Range;

use glam::DVec3;

use super::{Curve, Strand};
use crate::continuity::{Break, SEARCH_BUDGET, Sample, find_break, has_limit, last_that};
use crate::parametric::between;

/// The maximum number of steps of a curve; larger numbers are clamped.
pub(crate) const MAX_STEPS: u32 = 1 << 20;

/// A point of a curve with its parameter.
pub(crate) type Point = (f64, DVec3);

/// Samples a function at `steps` + 1 parameters, and divides the points where it is interrupted.
///
/// A run ends where the function jumps, has a pole or is not defined, at the last parameter before
/// it that bisection finds. At a pole this point, which is far away, is left out unless
/// `keeps_poles`.
pub(crate) fn runs(
    range: &Range<f64>,
    steps: u32,
    keeps_poles: bool,
    sample: impl Fn(f64) -> Sample,
) -> Vec<Vec<Point>> {
    let steps = steps.clamp(1, MAX_STEPS);
    let budget = Cell::new(SEARCH_BUDGET);
    let position = |t: f64| sample(t).position;
    // The end of the domain between a parameter inside and one outside, if it belongs to the curve.
    let end = |inside: f64, outside: f64| {
        let end = last_that(|t| sample(t).is_defined(), inside, outside);
        (keeps_poles || has_limit(position, inside, end)).then_some(end)
    };
    let mut runs = Vec::new();
    let mut run: Vec<Point> = Vec::new();
    let mut previous: Option<(f64, Sample)> = None;
    for step in 0..=steps {
        let t = between(range, step, steps);
        let here = sample(t);
        // The first parameter behind an interruption, if there is one.
        let after = match &previous {
            Some((from, last)) if last.is_defined() => {
                if here.is_defined() {
                    match find_break(&sample, (*from, *last), (t, here), &budget) {
                        None => None,
                        Some(Break {
                            before,
                            after,
                            is_step,
                        }) => {
                            let is_kept = is_step || keeps_poles;
                            runs.push(finished(&mut run, is_kept.then_some(before), position));
                            is_kept.then_some(after)
                        }
                    }
                } else {
                    runs.push(finished(&mut run, end(*from, t), position));
                    None
                }
            }
            Some((from, _)) if here.is_defined() => end(t, *from),
            _ => None,
        };
        if let Some(after) = after.filter(|after| *after != t) {
            run.push((after, position(after)));
        }
        if here.is_defined() {
            run.push((t, here.position));
        }
        previous = Some((t, here));
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}

/// Takes the run, after adding the point at its end.
fn finished(run: &mut Vec<Point>, end: Option<f64>, position: impl Fn(f64) -> DVec3) -> Vec<Point> {
    if let (Some(end), Some(&(last, _))) = (end, run.last())
        && end != last
    {
        run.push((end, position(end)));
    }
    std::mem::take(run)
}

/// The curve of a function, closed if it is one run that ends where it began.
pub(crate) fn sampled(range: &Range<f64>, steps: u32, sample: impl Fn(f64) -> Sample) -> Curve {
    let runs = runs(range, steps, false, sample);
    curve_of(
        runs.into_iter()
            .map(|run| run.into_iter().map(|(_, point)| point).collect()),
    )
}

/// The curve of these polylines. One that ends where it began, but for rounding, is closed.
pub(crate) fn curve_of(lines: impl Iterator<Item = Vec<DVec3>>) -> Curve {
    let strands = lines.filter_map(|mut points| {
        let low = points.iter().copied().reduce(DVec3::min)?;
        let high = points.iter().copied().reduce(DVec3::max)?;
        let tolerance = 1e-9 * (high - low).length();
        let ends = points.first()?.distance(*points.last()?);
        let is_closed = points.len() > 3 && ends <= tolerance;
        if is_closed {
            points.pop();
        }
        // Neither a function that stands still nor a point that was found twice has extent.
        points.dedup();
        (points.len() > 1).then_some(Strand { points, is_closed })
    });
    Curve {
        strands: strands.collect(),
    }
}
