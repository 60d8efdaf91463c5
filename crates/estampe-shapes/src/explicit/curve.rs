//! Curves y = f(x).

use std::ops::Range;

use glam::DVec3;

use super::limits;
use crate::continuity::{Sample, last_that};
use crate::curve::{Curve, curve_of, runs};
use crate::expression::Dual;

/// The curve y = f(x) in the plane z = 0, at `steps` + 1 values of x.
///
/// `steps` are clamped to 1..=2²⁰. Only the parts with y in `values` are kept, if there is such a
/// range; both limits belong to it.
#[must_use]
pub fn curve(
    x: &Range<f64>,
    values: Option<&Range<f64>>,
    steps: u32,
    function: impl Fn(f64) -> Dual<1>,
) -> Curve {
    let point = |x: f64| DVec3::new(x, function(x).value, 0.0);
    let mut lines = runs(x, steps, values.is_some(), |x| {
        let Dual { value, partials } = function(x);
        Sample {
            position: DVec3::new(x, value, 0.0),
            slope: DVec3::new(1.0, partials[0], 0.0),
        }
    });
    if let Some(values) = values {
        let (low, high) = limits(values);
        lines = clipped(lines, &point, |y| y <= high, high);
        lines = clipped(lines, &point, |y| y >= low, low);
    }
    curve_of(
        lines
            .into_iter()
            .map(|line| line.into_iter().map(|(_, point)| point).collect()),
    )
}

/// Cuts runs of points where the function leaves the kept values; the new ends have the limit's.
fn clipped(
    lines: Vec<Vec<(f64, DVec3)>>,
    point: &impl Fn(f64) -> DVec3,
    is_kept: impl Fn(f64) -> bool,
    limit: f64,
) -> Vec<Vec<(f64, DVec3)>> {
    let mut kept = Vec::new();
    for line in lines {
        let mut run: Vec<(f64, DVec3)> = Vec::new();
        let mut previous: Option<(f64, bool)> = None;
        for (x, position) in line {
            let is_inside = is_kept(position.y);
            if let Some((before, was_inside)) = previous
                && was_inside != is_inside
            {
                let (inside, outside) = if is_inside { (x, before) } else { (before, x) };
                let cut = last_that(|x| is_kept(point(x).y), inside, outside);
                run.push((cut, point(cut).with_y(limit)));
                if was_inside {
                    kept.push(std::mem::take(&mut run));
                }
            }
            if is_inside {
                run.push((x, position));
            }
            previous = Some((x, is_inside));
        }
        kept.push(run);
    }
    kept.retain(|run| run.len() > 1);
    kept
}
