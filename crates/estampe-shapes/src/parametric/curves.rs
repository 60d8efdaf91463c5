//! Parametric curves C(t), and the helix.

use std::ops::Range;

use glam::DVec3;

use super::circle::cos_sin_turns;
use crate::continuity::Sample;
use crate::curve::{Curve, sampled};

/// The polyline of C(t) at `steps` + 1 parameters, which are clamped to 1..=2²⁰ steps.
///
/// `point` returns C(t) and its derivative dC/dt, from which jumps are found: there the curve is
/// interrupted, as where it is not defined (NaN, infinite or beyond 1e30). A curve that ends where
/// it began, to 1e-9 of its extent, is closed. Points that follow each other differ.
#[must_use]
pub fn curve(range: &Range<f64>, steps: u32, point: impl Fn(f64) -> (DVec3, DVec3)) -> Curve {
    sampled(range, steps, |t| {
        let (position, slope) = point(t);
        Sample { position, slope }
    })
}

/// A right-handed helix around the Z axis: C(t) = (r cos 2πt, r sin 2πt, p t), with t from 0 to
/// `turns`.
///
/// `pitch` is the height of one turn; `steps` is the number of segments.
#[must_use]
pub fn helix(radius: f64, pitch: f64, turns: f64, steps: u32) -> Curve {
    curve(&(0.0..turns), steps, |t| {
        let (cos, sin) = cos_sin_turns(t);
        let position = DVec3::new(radius * cos, radius * sin, pitch * t);
        let around = radius * std::f64::consts::TAU;
        (position, DVec3::new(-around * sin, around * cos, pitch))
    })
}
