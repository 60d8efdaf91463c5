use fastrand::Rng;
use glam::DVec3;

use super::*;
use crate::random_cases::random_cases;

/// Four points in −10..10.
fn points(random: &mut Rng) -> [DVec3; 4] {
    let mut axis = || random.f64() * 20.0 - 10.0;
    [0; 4].map(|_| DVec3::new(axis(), axis(), axis()))
}

/// A parameter away from both ends, in 0.1..0.9.
fn inner(random: &mut Rng) -> f64 {
    0.1 + random.f64() * 0.8
}

/// De Casteljau's scheme: the oracle.
fn de_casteljau(control: [DVec3; 4], t: f64) -> DVec3 {
    let mut points = control.to_vec();
    while points.len() > 1 {
        points = points
            .windows(2)
            .map(|pair| pair[0].lerp(pair[1], t))
            .collect();
    }
    points[0]
}

#[test]
fn the_bernstein_form_is_de_casteljaus() {
    random_cases(|random| {
        let (control, t) = (points(random), random.f64());
        let point = cubic_point(control, CurveParameter::new(t));
        assert!(point.distance(de_casteljau(control, t)) < 1e-13);
    });
}

#[test]
fn derivatives_are_the_limits_of_differences() {
    random_cases(|random| {
        let (control, t) = (points(random), inner(random));
        let at = |t: f64| cubic_point(control, CurveParameter::new(t));
        let difference = (at(t + 1e-5) - at(t - 1e-5)) / 2e-5;
        let derivative = cubic_derivative(control, CurveParameter::new(t));
        assert!(derivative.distance(difference) < 1e-6);
    });
}

/// Traversed backwards, a curve has the same bits.
#[test]
fn curves_are_symmetric() {
    random_cases(|random| {
        let (control, steps, step) = (points(random), random.u32(1..50), random.u32(..50));
        let step = step.min(steps);
        let [a, b, c, d] = control;
        let there = cubic_point(control, CurveParameter::fraction(step, steps));
        let back = cubic_point([d, c, b, a], CurveParameter::fraction(steps - step, steps));
        assert_eq!(there, back);
    });
}

/// An edge of a patch is the curve over its control points, whatever the other control points are.
#[test]
fn patches_end_in_their_edges() {
    random_cases(|random| {
        let control = [0; 4].map(|_| points(random));
        let (steps, step) = (random.u32(1..20), random.u32(..20));
        let patch = BicubicPatch { control };
        let t = CurveParameter::fraction(step.min(steps), steps);
        let (start, end) = (
            CurveParameter::fraction(0, 1),
            CurveParameter::fraction(1, 1),
        );
        assert_eq!(patch.point(start, t), cubic_point(control[0], t));
        assert_eq!(patch.point(end, t), cubic_point(control[3], t));
        assert_eq!(
            patch.point(t, start),
            cubic_point(control.map(|row| row[0]), t)
        );
        assert_eq!(
            patch.point(t, end),
            cubic_point(control.map(|row| row[3]), t)
        );
    });
}

#[test]
fn patch_derivatives() {
    random_cases(|random| {
        let control = [0; 4].map(|_| points(random));
        let (s, t) = (inner(random), inner(random));
        let patch = BicubicPatch { control };
        let at = |s: f64, t: f64| (CurveParameter::new(s), CurveParameter::new(t));
        let point = |s: f64, t: f64| patch.point(at(s, t).0, at(s, t).1);
        let d = 1e-5;
        let (here_s, here_t) = at(s, t);
        let along_s = (point(s + d, t) - point(s - d, t)) / (2.0 * d);
        let along_t = (point(s, t + d) - point(s, t - d)) / (2.0 * d);
        assert!(patch.derivative_s(here_s, here_t).distance(along_s) < 1e-6);
        assert!(patch.derivative_t(here_s, here_t).distance(along_t) < 1e-6);
        let d = 1e-3;
        let mixed =
            point(s + d, t + d) - point(s - d, t + d) - point(s + d, t - d) + point(s - d, t - d);
        let mixed = mixed / (4.0 * d * d);
        assert!(patch.derivative_st(here_s, here_t).distance(mixed) < 1e-2);
        let normal = patch.normal(here_s, here_t);
        assert!((normal.length() - 1.0).abs() < 1e-12);
        assert!(normal.dot(patch.derivative_s(here_s, here_t)).abs() < 1e-6);
    });
}

/// If all control points of a row are equal, the normal there is the limit of the normals beside
/// it.
#[test]
fn the_normal_of_a_pole_is_a_limit() {
    let tip = DVec3::Z * 2.0;
    let ring = |r: f64, z: f64| {
        [(r, 0.0), (r, -0.56 * r), (0.56 * r, -r), (0.0, -r)].map(|(x, y)| DVec3::new(x, y, z))
    };
    let cone = BicubicPatch {
        control: [[tip; 4], ring(0.5, 1.5), ring(1.0, 0.7), ring(2.0, 0.0)],
    };
    for step in 0..=8 {
        let t = CurveParameter::fraction(step, 8);
        let pole = cone.normal(CurveParameter::new(0.0), t);
        let beside = cone.normal(CurveParameter::new(1e-6), t);
        assert!(pole.distance(beside) < 1e-5, "{pole} {beside}");
        assert!(pole.z > 0.5);
    }
    let nothing = BicubicPatch {
        control: [[tip; 4]; 4],
    };
    assert_eq!(
        nothing.normal(CurveParameter::new(0.5), CurveParameter::new(0.5)),
        DVec3::ZERO
    );
}
