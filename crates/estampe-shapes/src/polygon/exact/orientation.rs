//! The orientation of three points in f32, exactly.

use std::cmp::Ordering;

use glam::Vec2;

/// Compares twice the signed area of the triangle `a b c` with zero: `Greater` if it is
/// counter-clockwise with y up. Coordinates that are not finite give `Equal` or an arbitrary order.
///
/// The six products of the expanded determinant are exact in f64. A plain sum decides unless it is
/// near zero; then the products are added without error, as an expansion (Shewchuk, "Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
pub(in crate::polygon) fn orientation(a: Vec2, b: Vec2, c: Vec2) -> Ordering {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec2());
    let products = [
        b.x * c.y,
        -(b.x * a.y),
        -(a.x * c.y),
        -(c.x * b.y),
        c.x * a.y,
        a.x * b.y,
    ];
    let sum: f64 = products.iter().sum();
    let size: f64 = products.iter().map(|product| product.abs()).sum();
    // Five additions round to 2⁻⁵³ of at most `size` each.
    if sum.abs() > size * (8.0 * f64::EPSILON) {
        return sum.total_cmp(&0.0);
    }
    let mut expansion: Vec<f64> = Vec::with_capacity(products.len());
    for product in products {
        add(&mut expansion, product);
    }
    // The components do not overlap and grow, so the last that is not zero has the sum's sign.
    let last = expansion.iter().rev().find(|component| **component != 0.0);
    last.map_or(Ordering::Equal, |component| component.total_cmp(&0.0))
}

/// Adds a number to an expansion without error: Shewchuk's Grow-Expansion.
fn add(expansion: &mut Vec<f64>, number: f64) {
    let mut carried = number;
    for component in expansion.iter_mut() {
        let sum = carried + *component;
        // Knuth's two-sum: the rounding error of the sum, exactly.
        let virtual_part = sum - carried;
        *component = (carried - (sum - virtual_part)) + (*component - virtual_part);
        carried = sum;
    }
    expansion.push(carried);
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    /// Integers of 24 bits times powers of two, against i128.
    #[test]
    fn orientations_are_exact() {
        let mut random = Rng::with_seed(1);
        let mut equal = 0;
        for case in 0..200_000 {
            let shift = random.u32(..20);
            let near = |random: &mut Rng| match case % 3 {
                0 => random.i32(-8..8),
                1 => (1 << 23) + random.i32(-3..3),
                _ => random.i32(-(1 << 24)..1 << 24),
            };
            let mut point = || [near(&mut random), near(&mut random)];
            let (a, b, c) = (point(), point(), point());
            let scaled =
                |[x, y]: [i32; 2]| Vec2::new(x as f32, y as f32) * libm::exp2f(shift as f32 - 10.0);
            let difference =
                |p: [i32; 2], q: [i32; 2], i: usize| i128::from(p[i]) - i128::from(q[i]);
            let expected = difference(b, a, 0) * difference(c, a, 1)
                - difference(c, a, 0) * difference(b, a, 1);
            let found = orientation(scaled(a), scaled(b), scaled(c));
            assert_eq!(found, expected.cmp(&0), "{a:?} {b:?} {c:?}");
            equal += usize::from(expected == 0);
        }
        assert!(equal > 1000, "{equal}");
        // Exponents far apart: beyond the digits of f64.
        let tiny = Vec2::new(1.0, f32::from_bits(1));
        assert_eq!(
            orientation(Vec2::ZERO, Vec2::X * 1e30, tiny),
            Ordering::Greater
        );
        assert_eq!(
            orientation(Vec2::ZERO, Vec2::X * 1e30, -tiny),
            Ordering::Less
        );
        assert_eq!(
            orientation(Vec2::ZERO, Vec2::X * 1e30, Vec2::X),
            Ordering::Equal
        );
    }
}
