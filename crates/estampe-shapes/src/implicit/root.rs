//! The root of a function between two parameters of different sign.

/// A change of sign on the way from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SignChange {
    /// The parameter.
    pub(super) at: f64,
    /// True if the function jumps over zero instead of reaching it.
    pub(super) is_jump: bool,
}

/// The width of the bracket at which the search ends, if the function is small there.
const NARROW: f64 = 1e-11;

/// The width at which it ends in any case: near the spacing of f64.
const NARROWEST: f64 = 1.0 / (1_u64 << 46) as f64;

/// The share of the values at both ends that remains at a jump.
const REMAINING: f64 = 1e-3;

/// Finds the root of `function` between 0 and 1, where it has the values `first` and `last`, one of
/// them negative and the other not. Zero is not negative, so where the function is zero over a
/// range, the end next to negative values is found.
///
/// The Illinois variant of regula falsi (Dowell and Jarratt 1971), with a bisection in every third
/// step, so that the bracket halves at least that often.
pub(super) fn sign_change(first: f64, last: f64, function: impl Fn(f64) -> f64) -> SignChange {
    let (mut a, mut at_a, mut b, mut at_b) = (0.0, first, 1.0, last);
    let finite = [first, last]
        .into_iter()
        .map(f64::abs)
        .filter(|v| v.is_finite());
    let scale = finite.fold(0.0, f64::max);
    let remains = |at_a: f64, at_b: f64| {
        let difference = (at_b - at_a).abs();
        difference > REMAINING * scale || difference.is_nan()
    };
    // The values that regula falsi sees: halved at an end that stays too long.
    let (mut weight_a, mut weight_b) = (at_a, at_b);
    for step in 1_u32.. {
        let width = b - a;
        if width <= NARROWEST || width <= NARROW && !remains(at_a, at_b) {
            break;
        }
        let secant = a - weight_a * width / (weight_b - weight_a);
        let is_inside = secant > a && secant < b;
        let middle = if step % 3 == 0 || !is_inside {
            0.5 * (a + b)
        } else {
            secant
        };
        let value = function(middle);
        if value.is_nan() {
            let is_jump = true;
            return SignChange {
                at: middle,
                is_jump,
            };
        }
        if (value < 0.0) == (first < 0.0) {
            (a, at_a, weight_a) = (middle, value, value);
            weight_b *= 0.5;
        } else {
            (b, at_b, weight_b) = (middle, value, value);
            weight_a *= 0.5;
        }
    }
    SignChange {
        at: 0.5 * (a + b),
        is_jump: remains(at_a, at_b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_jumps() {
        let at =
            |function: &dyn Fn(f64) -> f64| sign_change(function(0.0), function(1.0), function);
        for root in [1e-9, 0.1, 0.3, 0.5, 0.999] {
            let steep = |slope: f64| move |x: f64| libm::tanh(slope * (x - root));
            for slope in [1.0, 30.0, 1e6, -1e6] {
                let found = at(&steep(slope));
                assert!(
                    (found.at - root).abs() < 1e-10 && !found.is_jump,
                    "{found:?}"
                );
            }
            let cube = at(&|x| libm::cbrt(x - root));
            assert!((cube.at - root).abs() < 1e-10 && !cube.is_jump, "{cube:?}");
            let flat = at(&|x| (x - root) * (x - root) * (x - root));
            assert!((flat.at - root).abs() < 1e-5 && !flat.is_jump, "{flat:?}");
            let pole = at(&|x| 1.0 / (x - root));
            assert!((pole.at - root).abs() < 1e-10 && pole.is_jump, "{pole:?}");
            let step = at(&|x| if x < root { -3.0 } else { 5.0 });
            assert!((step.at - root).abs() < 1e-10 && step.is_jump, "{step:?}");
        }
        assert!(
            at(&|x| if x == 0.0 {
                -1.0
            } else if x < 0.5 {
                f64::NAN
            } else {
                1.0
            })
            .is_jump
        );
        let infinite = at(&|x| libm::log(x) + 2.0);
        assert!((infinite.at - libm::exp(-2.0)).abs() < 1e-10 && !infinite.is_jump);
        let plateau = at(&|x| (x - 0.25).min(0.0));
        assert!(
            (plateau.at - 0.25).abs() < 1e-3 && !plateau.is_jump,
            "{plateau:?}"
        );
    }
}
