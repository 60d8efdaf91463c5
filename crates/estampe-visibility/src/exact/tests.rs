//! Sides against integers of 128 bits.

use super::Plane;
use super::plane::side_of_points;
use fastrand::Rng;
use std::cmp::Ordering;

/// ((b − a) × (c − a))·(p − a) of integers.
fn expected([a, b, c, p]: [[i64; 3]; 4]) -> Ordering {
    let minus = |q: [i64; 3]| [0, 1, 2].map(|k: usize| i128::from(q[k] - a[k]));
    let (u, v, w) = (minus(b), minus(c), minus(p));
    let minor = |y: usize, z: usize| u[y] * v[z] - u[z] * v[y];
    (w[0] * minor(1, 2) + w[1] * minor(2, 0) + w[2] * minor(0, 1)).cmp(&0)
}

/// Rows: D4.
#[test]
fn sides_are_exact() {
    let mut random = Rng::with_seed(3);
    let mut on = 0;
    for case in 0..60_000 {
        let shift = random.i32(-90..90);
        let mut point = || -> [i64; 3] {
            let mut one = || match case % 3 {
                0 => random.i64(-3..4),
                1 => (1 << 23) + random.i64(-3..4),
                _ => random.i64(-(1 << 24)..1 << 24),
            };
            [one(), one(), one()]
        };
        let mut points = [point(), point(), point(), point()];
        if case % 5 == 0 {
            // On the plane, or one unit beside it.
            let [a, b, c] = [points[0], points[1], points[2]];
            points[3] =
                [0, 1, 2].map(|k: usize| b[k] + c[k] - a[k] + i64::from(case % 2 == 0 && k == 1));
        }
        let scaled = points.map(|p| p.map(|x| libm::scalbn(x as f64, shift)));
        let expected = expected(points);
        let plane = Plane::new([scaled[0], scaled[1], scaled[2]]);
        assert_eq!(plane.side(scaled[3]), expected, "{points:?}");
        assert_eq!(
            side_of_points(scaled[0], scaled[1], scaled[2], scaled[3]),
            expected
        );
        // The direction from a point to another has the side of its end from a plane through its
        // start.
        let direction = [0, 1, 2].map(|k: usize| points[3][k] - points[0][k]);
        let direction = direction.map(|x| libm::scalbn(x as f64, shift));
        assert_eq!(plane.side_of_direction(direction), expected, "{points:?}");
        on += usize::from(expected.is_eq());
    }
    assert!(on > 5000, "{on}");
}
