//! The eye that has equal margins on two sides of the model.
//!
//! A point at p, a distance d before the eye, reaches (p − e)/d to one side of an eye at e: a line
//! over e, which falls. The greatest reach to that side is the upper envelope of such lines, and so
//! is that to the other side, (e − p)/d. Where the two cross, found by Newton's method, the margins
//! are equal.
//!
//! Newton's method looks at all points in each step. After the first step the eye moves little, and
//! hardly any point can still be the furthest: a line that lies below another one at both ends of
//! an interval lies below it everywhere between. So the second step looks for the *candidates* of
//! an interval around the eye, in order, and later steps look at them alone. Points are left out
//! only if they are below by more than rounding could change, so the result has the bits that all
//! points give.

use super::Cloud;
use glam::DVec3;

/// The furthest points on both sides of an eye.
#[derive(Debug, Clone, Copy)]
struct Furthest {
    /// Reach, place and distance of the furthest point in the direction of the coordinate, and of
    /// the furthest in the other one, whose reach is positive too.
    sides: [(f64, f64, f64); 2],
}

impl Furthest {
    const NONE: Self = Self {
        sides: [(f64::NEG_INFINITY, 0.0, 1.0); 2],
    };

    /// Of points, each with its place and distance, seen from an eye. Of equal ones the first.
    #[inline]
    fn of(points: impl Iterator<Item = (f64, f64)>, eye: f64) -> Self {
        let mut furthest = Self::NONE;
        for (at, distance) in points {
            let reach = (at - eye) / distance;
            let sides = &mut furthest.sides;
            if reach > sides[0].0 {
                sides[0] = (reach, at, distance);
            }
            if -reach > sides[1].0 {
                sides[1] = (-reach, at, distance);
            }
        }
        furthest
    }

    /// Of the points of both; of equal ones the first.
    fn or(self, later: Self) -> Self {
        let further = |side: usize| {
            let (own, other) = (self.sides[side], later.sides[side]);
            if other.0 > own.0 { other } else { own }
        };
        Self {
            sides: [further(0), further(1)],
        }
    }
}

/// The coordinate of the eye at which the points have equal projected extent on both sides: max (p
/// − e)/(z − p_z) = max (e − p)/(z − p_z), by Newton's method on its linear pieces.
pub(super) fn centred(
    points: &Cloud,
    eye_z: f64,
    start: f64,
    coordinate: impl Fn(&DVec3) -> f64 + Sync,
) -> f64 {
    const MOST_STEPS: usize = 16;
    let seen = |p: &DVec3| (coordinate(p), eye_z - p.z);
    let mut eye = start;
    let mut candidates: Option<Candidates> = None;
    for step in 0..MOST_STEPS {
        let known = candidates.as_ref().filter(|known| known.hold(eye));
        let furthest = match known {
            Some(known) => Furthest::of(known.points.iter().copied(), eye),
            None => {
                let of_piece = |piece: &[DVec3]| Furthest::of(piece.iter().map(seen), eye);
                let of_pieces = points.map_pieces(of_piece).into_iter();
                of_pieces.fold(Furthest::NONE, Furthest::or)
            }
        };
        let [(right, p, depth_p), (left, q, depth_q)] = furthest.sides;
        if (right - left).abs() <= 1e-12 * (1.0 + right.abs()) {
            break;
        }
        let next = (p * depth_q + q * depth_p) / (depth_p + depth_q);
        if step == 0 {
            candidates = Some(Candidates::around((eye, next), furthest, points, seen));
        }
        eye = next;
    }
    eye
}

/// The points that can be the furthest from any eye of an interval.
struct Candidates {
    middle: f64,
    radius: f64,
    /// Place and distance of each, in order.
    points: Vec<(f64, f64)>,
}

impl Candidates {
    /// Of the eyes around one, up to as far as twice its next step; `furthest` are the points that
    /// are furthest from it.
    fn around(
        (eye, next): (f64, f64),
        furthest: Furthest,
        points: &Cloud,
        seen: impl Fn(&DVec3) -> (f64, f64) + Sync,
    ) -> Self {
        /// Relative, far more than the rounding of a reach and far less than what matters.
        const SLACK: f64 = 1e-9;
        let radius = 2.0 * (next - eye).abs();
        let ends = [eye - radius, eye + radius];
        // The reach at both ends of what is furthest in the middle is a bound for all others.
        let bounds = furthest.sides.map(|(_, at, distance)| {
            ends.map(|end| {
                let reach = (at - end) / distance;
                (reach, SLACK * (1.0 + reach.abs()))
            })
        });
        let can_be_furthest = |&(at, distance): &(f64, f64)| {
            let [low, high] = ends.map(|end| (at - end) / distance);
            let [right, left] = bounds;
            // Comparisons with NaN, from points that are not finite, keep the point.
            let is_below = low < right[0].0 - right[0].1 && high < right[1].0 - right[1].1;
            let is_above = low > left[0].0 + left[0].1 && high > left[1].0 + left[1].1;
            !(is_below && is_above)
        };
        let of_piece = |piece: &[DVec3]| -> Vec<(f64, f64)> {
            piece.iter().map(&seen).filter(can_be_furthest).collect()
        };
        Self {
            middle: eye,
            radius,
            points: points.map_pieces(of_piece).concat(),
        }
    }

    /// True if the candidates are those of an eye.
    fn hold(&self, eye: f64) -> bool {
        (eye - self.middle).abs() <= self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fastrand::Rng;

    /// All points in each step.
    fn slowly(points: &[DVec3], eye_z: f64, start: f64) -> f64 {
        let mut eye = start;
        for _ in 0..16 {
            let seen = points.iter().map(|p| (p.x, eye_z - p.z));
            let [(right, p, depth_p), (left, q, depth_q)] = Furthest::of(seen, eye).sides;
            if (right - left).abs() <= 1e-12 * (1.0 + right.abs()) {
                break;
            }
            eye = (p * depth_q + q * depth_p) / (depth_p + depth_q);
        }
        eye
    }

    #[test]
    fn candidates_give_the_bits_of_all_points() {
        let mut random = Rng::with_seed(5);
        let mut number = |scale: f64| (random.f64() - 0.5) * scale;
        for case in 0..300 {
            let count = [1, 2, 7, 100, 3000][case % 5];
            // Clouds, thin ones, and ones with many equal points.
            let depth = [2.0, 1e-3, 0.0][case % 3];
            let grid = [0.0, 8.0][case % 2];
            let points: Vec<DVec3> = (0..count)
                .map(|_| {
                    let at = number(2.0);
                    let at = if grid > 0.0 {
                        (at * grid).round() / grid
                    } else {
                        at
                    };
                    DVec3::new(at, 0.0, number(depth))
                })
                .collect();
            for eye_z in [1.001, 1.5, 40.0] {
                let start = number(0.5);
                let expected = slowly(&points, eye_z, start);
                let found = centred(&Cloud::from(&points), eye_z, start, |p| p.x);
                assert_eq!(
                    found.to_bits(),
                    expected.to_bits(),
                    "{case}: {found} {expected}"
                );
            }
        }
    }
}
