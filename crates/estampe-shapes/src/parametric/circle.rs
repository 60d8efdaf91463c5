//! Cosine and sine of fractions of a full turn.

use std::f64::consts::FRAC_PI_2;

/// (cos, sin) of an angle in turns, exact at every multiple of a quarter turn.
///
/// The angle is first reduced, exactly, to the nearest quarter turn and a remainder of at most an
/// eighth. A full circle therefore ends with the bits with which it began, which multiples of a
/// rounded π do not. Angles beyond 2⁵⁰ turns have no fraction left and count as zero.
#[must_use]
pub fn cos_sin_turns(turns: f64) -> (f64, f64) {
    let turns = turns - libm::floor(turns);
    if !turns.is_finite() {
        return (1.0, 0.0);
    }
    let quarters = libm::rint(4.0 * turns);
    let rest = (4.0 * turns - quarters) * FRAC_PI_2;
    let (cos, sin) = (libm::cos(rest), libm::sin(rest));
    // Adding zero turns −0 into 0.
    let (cos, sin) = if quarters == 1.0 {
        (-sin, cos)
    } else if quarters == 2.0 {
        (-cos, -sin)
    } else if quarters == 3.0 {
        (sin, -cos)
    } else {
        (cos, sin)
    };
    (cos + 0.0, sin + 0.0)
}
