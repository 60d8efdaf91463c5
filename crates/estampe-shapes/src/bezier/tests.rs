use fastrand::Rng;
use glam::DVec3;

use super::*;
use crate::parametric::Seams;
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

/// Rows: M4.
#[test]
fn the_bernstein_form_is_de_casteljaus() {
    random_cases(|random| {
        let (control, t) = (points(random), random.f64());
        let point = cubic_point(control, CurveParameter::new(t));
        let curve = BezierCurve {
            control: control.to_vec(),
        };
        assert!(point.distance(curve.point(t)) < 1e-13);
        let derivative = cubic_derivative(control, CurveParameter::new(t));
        assert!(derivative.distance(curve.derivative().point(t)) < 1e-12);
        let second = cubic_second_derivative(control, CurveParameter::new(t));
        assert!(second.distance(curve.derivative().derivative().point(t)) < 1e-11);
    });
}

/// Curves of any degree: ends, subdivision, and polylines within their tolerance.
/// Rows: M4.
#[test]
fn curves_are_divided_and_flattened() {
    random_cases(|random| {
        let degree = random.usize(..8);
        let control: Vec<DVec3> = (0..=degree).map(|_| points(random)[0]).collect();
        let curve = BezierCurve { control };
        assert_eq!(curve.point(0.0), curve.control[0]);
        assert_eq!(curve.point(1.0), curve.control[degree]);
        let (at, t) = (inner(random), random.f64());
        let [first, last] = curve.split(at);
        assert!(first.point(t).distance(curve.point(at * t)) < 1e-12);
        assert!(last.point(t).distance(curve.point(at + (1.0 - at) * t)) < 1e-12);

        let tolerance = 0.01;
        let flat = curve.flatten(tolerance);
        let Some(strand) = flat.strands.first() else {
            assert_eq!(degree, 0);
            return;
        };
        for step in 0..=50 {
            let point = curve.point(f64::from(step) / 50.0);
            let distance = |pair: &[DVec3]| {
                let chord = pair[1] - pair[0];
                let along = (point - pair[0]).dot(chord) / chord.length_squared();
                point.distance(pair[0] + chord * along.clamp(0.0, 1.0))
            };
            let nearest = strand
                .points
                .windows(2)
                .map(distance)
                .fold(f64::MAX, f64::min);
            assert!(nearest <= tolerance * 1.001, "{nearest}");
        }
    });
    let nothing = BezierCurve {
        control: Vec::new(),
    };
    assert!(nothing.point(0.5).is_nan() && nothing.flatten(0.1).strands.is_empty());
    let wild = BezierCurve {
        control: vec![DVec3::ZERO, DVec3::NAN, DVec3::splat(1e300)],
    };
    assert!(wild.flatten(0.0).strands.is_empty());
}

/// Rows: M4.
#[test]
fn patches_are_divided() {
    random_cases(|random| {
        let patch = BicubicPatch {
            control: [0; 4].map(|_| points(random)),
        };
        let (at, s, t) = (inner(random), random.f64(), random.f64());
        let part = |f: f64| CurveParameter::new(f);
        let whole = |s: f64, t: f64| patch.point(part(s), part(t));
        let [low, high] = patch.split_s(at);
        assert!(low.point(part(s), part(t)).distance(whole(at * s, t)) < 1e-12);
        assert!(
            high.point(part(s), part(t))
                .distance(whole(at + (1.0 - at) * s, t))
                < 1e-12
        );
        let [low, high] = patch.split_t(at);
        assert!(low.point(part(s), part(t)).distance(whole(s, at * t)) < 1e-12);
        assert!(
            high.point(part(s), part(t))
                .distance(whole(s, at + (1.0 - at) * t))
                < 1e-12
        );
    });
}

/// A patch of which any border is a point, in all four orientations: the normal there is the limit
/// of those beside it. So it is at a corner where three control points coincide, and with two
/// borders that are points.
/// Rows: M4.
#[test]
fn normals_of_every_degenerate_border_are_limits() {
    random_cases(|random| {
        // A flat grid with some height, so that it has a clear side, with its first row in one
        // point.
        let mut number = |scale: f64| (random.f64() - 0.5) * scale;
        let mut control = [0.0, 1.0, 2.0, 3.0].map(|i: f64| {
            [0.0, 1.0, 2.0, 3.0]
                .map(|j: f64| DVec3::new(j + number(0.3) - 1.5, i + number(0.3), number(0.5)))
        });
        control[0] = [DVec3::new(0.0, 0.0, 0.2); 4];
        let row = BicubicPatch { control };
        let turned = |patch: &BicubicPatch| BicubicPatch {
            control: [0, 1, 2, 3].map(|i| [3, 2, 1, 0].map(|j: usize| patch.control[j][i])),
        };
        let mut patch = row;
        for turn in 0..4 {
            for step in 0..=8 {
                let f = f64::from(step) / 8.0;
                let (s, t, into) = match turn {
                    0 => (0.0, f, (1.0, 0.0)),
                    1 => (f, 1.0, (0.0, -1.0)),
                    2 => (1.0, f, (-1.0, 0.0)),
                    _ => (f, 0.0, (0.0, 1.0)),
                };
                let at = |step: f64| {
                    let (s, t) = (s + step * into.0, t + step * into.1);
                    patch.normal(CurveParameter::new(s), CurveParameter::new(t))
                };
                let distance = at(0.0).distance(at(1e-6));
                assert!(distance < 1e-4, "{turn} {step}: {} {}", at(0.0), at(1e-6));
            }
            patch = turned(&patch);
        }
        // Three equal points at a corner: both first derivatives vanish.
        let mut pinched = control;
        pinched[0] = [0.0, 1.0, 2.0, 3.0].map(|j| DVec3::new(j - 1.5, 0.0, 0.0));
        (pinched[0][1], pinched[1][0]) = (pinched[0][0], pinched[0][0]);
        let corner = BicubicPatch { control: pinched };
        let zero = CurveParameter::new(0.0);
        assert!(corner.normal(zero, zero).length() > 0.99);
        let lens = BicubicPatch {
            control: [
                control[0],
                control[1],
                control[2],
                [DVec3::new(0.0, 3.0, 0.1); 4],
            ],
        };
        let mesh = lens.mesh([6, 5], Seams::Joined);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            for &i in triangle {
                assert!((b - a).cross(c - a).dot(mesh.normals[i as usize]) > 0.0);
            }
        }
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
