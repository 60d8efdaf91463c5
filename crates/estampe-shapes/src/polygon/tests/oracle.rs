//! The exact area of a polygon by its boundary, independent of the sweep, and fractions of integers
//! of any length to sum it.
//!
//! Every edge is cut where another meets it. For each piece the winding numbers on both sides are
//! counted along rays from its middle, in integers. A piece from P to Q with the inside on one side
//! only contributes ± P × Q to twice the area (Green's theorem).

use std::cmp::Ordering;

use crate::polygon::FillRule;
use crate::polygon::arrangement::Corner;

/// Twice the exact area of the inside.
pub(super) fn doubled_area(rings: &[Vec<Corner>], rule: FillRule) -> Fraction {
    let edges: Vec<[Corner; 2]> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]))
        .filter(|[from, to]| from != to)
        .collect();
    let mut sum = Fraction::zero();
    for (number, &[p, q]) in edges.iter().enumerate() {
        let [dx, dy] = [q[0] - p[0], q[1] - p[1]].map(i128::from);
        let mut cuts: Vec<[i128; 2]> = vec![[0, 1], [1, 1]];
        for &[a, b] in &edges {
            cuts.extend(meetings([p, q], [a, b]));
        }
        cuts.sort_by(|[a, b], [c, d]| (a * d).cmp(&(c * b)));
        cuts.dedup_by(|[a, b], [c, d]| *a * *d == *c * *b);
        for pair in cuts.windows(2) {
            let ([a, b], [c, d]) = (pair[0], pair[1]);
            // The middle of the piece is p + (q − p) (a/b + c/d) / 2.
            let (t, w) = (a * d + c * b, 2 * b * d);
            let middle = [
                i128::from(p[0]) * w + dx * t,
                i128::from(p[1]) * w + dy * t,
                w,
            ];
            if edges[..number]
                .iter()
                .any(|edge| lies_along(middle, *edge, [dx, dy]))
            {
                // Counted with the earlier edge that coincides here.
                continue;
            }
            let is_inside = |ray: [i128; 2]| {
                let winding: i32 = edges.iter().map(|edge| crossing(middle, ray, *edge)).sum();
                match rule {
                    FillRule::EvenOdd => winding % 2 != 0,
                    FillRule::NonZero => winding != 0,
                }
            };
            let sides = i128::from(is_inside([-dy, dx])) - i128::from(is_inside([dy, -dx]));
            let cross = i128::from(p[0]) * i128::from(q[1]) - i128::from(q[0]) * i128::from(p[1]);
            sum.add((c * b - a * d) * cross * sides, b * d);
        }
    }
    sum
}

/// The parameters along `p q`, between 0 and 1, at which another edge meets it.
fn meetings([p, q]: [Corner; 2], [a, b]: [Corner; 2]) -> Vec<[i128; 2]> {
    let d = [q[0] - p[0], q[1] - p[1]].map(i128::from);
    let e = [b[0] - a[0], b[1] - a[1]].map(i128::from);
    let f = [a[0] - p[0], a[1] - p[1]].map(i128::from);
    let cross = |u: [i128; 2], v: [i128; 2]| u[0] * v[1] - u[1] * v[0];
    let dot = |u: [i128; 2], v: [i128; 2]| u[0] * v[0] + u[1] * v[1];
    let denominator = cross(d, e);
    let candidates = if denominator != 0 {
        let (t, s) = (cross(f, e), cross(f, d));
        let sign = denominator.signum();
        let is_on_other = (0..=denominator.abs()).contains(&(s * sign));
        if is_on_other {
            vec![[t * sign, denominator.abs()]]
        } else {
            Vec::new()
        }
    } else if cross(f, d) == 0 {
        let to_b = [b[0] - p[0], b[1] - p[1]].map(i128::from);
        vec![[dot(f, d), dot(d, d)], [dot(to_b, d), dot(d, d)]]
    } else {
        Vec::new()
    };
    candidates
        .into_iter()
        .filter(|[t, w]| *t > 0 && t < w)
        .collect()
}

/// True if a point, which has a denominator, lies on an edge with this direction.
fn lies_along([x, y, w]: [i128; 3], [a, b]: [Corner; 2], d: [i128; 2]) -> bool {
    let e = [b[0] - a[0], b[1] - a[1]].map(i128::from);
    let [fx, fy] = [x - i128::from(a[0]) * w, y - i128::from(a[1]) * w];
    let along = fx * e[0] + fy * e[1];
    d[0] * e[1] == d[1] * e[0]
        && fx * e[1] == fy * e[0]
        && along >= 0
        && along <= (e[0] * e[0] + e[1] * e[1]) * w
}

/// 1 or −1 if an edge crosses the ray from a point, counter-clockwise or clockwise; else 0.
fn crossing([x, y, w]: [i128; 3], ray: [i128; 2], edge: [Corner; 2]) -> i32 {
    let [(side_a, ahead_a), (side_b, ahead_b)] = edge.map(|corner| {
        let f = [i128::from(corner[0]) * w - x, i128::from(corner[1]) * w - y];
        (ray[0] * f[1] - ray[1] * f[0], ray[0] * f[0] + ray[1] * f[1])
    });
    if (side_a > 0) == (side_b > 0) {
        return 0;
    }
    // Where the edge meets the ray's line.
    let ahead = (ahead_a * side_b - ahead_b * side_a) * (side_b - side_a).signum();
    match ahead.cmp(&0) {
        Ordering::Greater if side_b > 0 => 1,
        Ordering::Greater => -1,
        _ => 0,
    }
}

/// A fraction of integers of any length.
#[derive(Clone, Debug)]
pub(super) struct Fraction {
    /// The sums of the positive and of the negative parts.
    numerators: [Vec<u32>; 2],
    denominator: Vec<u32>,
}

impl Fraction {
    pub(super) fn zero() -> Self {
        Self {
            numerators: [Vec::new(), Vec::new()],
            denominator: vec![1],
        }
    }

    /// Adds a fraction with a positive denominator.
    pub(super) fn add(&mut self, numerator: i128, denominator: i128) {
        let common = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()).max(1);
        let (top, bottom) = (
            numerator.unsigned_abs() / common,
            denominator.unsigned_abs() / common,
        );
        let (top, bottom) = (digits(top), digits(bottom));
        let own = usize::from(numerator < 0);
        let added = product(&top, &self.denominator);
        if bottom != [1] {
            self.numerators = self
                .numerators
                .each_ref()
                .map(|part| product(part, &bottom));
            self.denominator = product(&self.denominator, &bottom);
        }
        self.numerators[own] = sum(&self.numerators[own], &added);
    }

    /// True if both fractions are the same number.
    pub(super) fn is_equal(&self, other: &Self) -> bool {
        // (a − b) / d = (e − f) / h where a h + f d = e d + b h.
        let [[a, b], [e, f]] = [&self.numerators, &other.numerators];
        let (d, h) = (&self.denominator, &other.denominator);
        sum(&product(a, h), &product(f, d)) == sum(&product(e, d), &product(b, h))
    }

    /// The number, rounded.
    pub(super) fn rounded(&self) -> f64 {
        let float = |digits: &[u32]| {
            digits
                .iter()
                .rev()
                .fold(0.0, |sum, digit| sum * 4_294_967_296.0 + f64::from(*digit))
        };
        let [plus, minus] = self.numerators.each_ref().map(|part| float(part));
        (plus - minus) / float(&self.denominator)
    }
}

fn gcd(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The digits to the base 2³², the lowest first, without leading zeros.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a digit is the lowest 32 bits"
)]
fn digits(mut number: u128) -> Vec<u32> {
    let mut digits = Vec::new();
    while number > 0 {
        digits.push(number as u32);
        number >>= 32;
    }
    digits
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a digit is the lowest 32 bits"
)]
fn sum(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut carry = 0_u64;
    let mut digits = Vec::new();
    for i in 0..a.len().max(b.len()) {
        let digit = |of: &[u32]| u64::from(of.get(i).copied().unwrap_or(0));
        carry += digit(a) + digit(b);
        digits.push(carry as u32);
        carry >>= 32;
    }
    if carry > 0 {
        digits.push(carry as u32);
    }
    digits
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a digit is the lowest 32 bits"
)]
fn product(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut digits = vec![0_u32; a.len() + b.len()];
    for (i, &x) in a.iter().enumerate() {
        let mut carry = 0_u64;
        for (j, &y) in b.iter().enumerate() {
            carry += u64::from(digits[i + j]) + u64::from(x) * u64::from(y);
            digits[i + j] = carry as u32;
            carry >>= 32;
        }
        digits[i + b.len()] = carry as u32;
    }
    while digits.last() == Some(&0) {
        digits.pop();
    }
    digits
}
