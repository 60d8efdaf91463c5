//! Polylines from a function of one parameter, interrupted where the function is.

use std::cell::Cell;
use std::ops::Range;

use glam::DVec3;

use super::{Curve, Strand};
use crate::continuity::{Break, SEARCH_BUDGET, Sample, find_break, last_that};
use crate::parametric::between;

/// The maximum number of steps of a curve; larger numbers are clamped.
pub(crate) const MAX_STEPS: u32 = 1 << 20;

/// A point of a curve with its parameter.
pub(crate) type Point = (f64, DVec3);

/// Samples a function at `steps` + 1 parameters, and divides the points where it is interrupted.
///
/// A run ends where the function jumps, has a pole or is not defined, at the last parameter before
/// it that bisection finds. At a pole this point is left out unless `keeps_poles`, because it is
/// far away.
pub(crate) fn runs(
    range: &Range<f64>,
    steps: u32,
    keeps_poles: bool,
    sample: impl Fn(f64) -> Sample,
) -> Vec<Vec<Point>> {
    let steps = steps.clamp(1, MAX_STEPS);
    let budget = Cell::new(SEARCH_BUDGET);
    let is_defined = |t: f64| sample(t).is_defined();
    let mut runs = Vec::new();
    let mut run: Vec<Point> = Vec::new();
    let mut previous: Option<(f64, Sample)> = None;
    for step in 0..=steps {
        let t = between(range, step, steps);
        let here = sample(t);
        let (before, after) = match &previous {
            Some((from, last)) if last.is_defined() => {
                if here.is_defined() {
                    match find_break(&sample, (*from, *last), (t, here), &budget) {
                        None => (None, None),
                        Some(Break {
                            before,
                            after,
                            is_step,
                        }) => {
                            let is_kept = is_step || keeps_poles;
                            runs.push(finished(&mut run, is_kept.then_some(before), &sample));
                            (None, is_kept.then_some(after))
                        }
                    }
                } else {
                    let before = last_that(is_defined, *from, t);
                    (Some(before), None)
                }
            }
            Some((from, _)) if here.is_defined() => (None, Some(last_that(is_defined, t, *from))),
            _ => (None, None),
        };
        if let Some(before) = before {
            runs.push(finished(&mut run, Some(before), &sample));
        }
        if let Some(after) = after.filter(|after| *after != t) {
            run.push((after, sample(after).position));
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
fn finished(run: &mut Vec<Point>, end: Option<f64>, sample: impl Fn(f64) -> Sample) -> Vec<Point> {
    if let (Some(end), Some(&(last, _))) = (end, run.last())
        && end != last
    {
        run.push((end, sample(end).position));
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
