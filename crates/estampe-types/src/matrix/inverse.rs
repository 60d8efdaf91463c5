//! Determinants and inverses.
//!
//! Determinants of any kind of number are in f32. Inverses are the host's: they are computed in
//! f64, whose `+ − × ÷` give the same bits on every machine, and rounded once. In f32, the inverse
//! of a camera's matrix loses up to half of its digits to cancellation.

use super::{Mat2, Mat3, Mat4};
use crate::{Real, Vec3};

impl<R: Real> Mat2<R> {
    /// The determinant.
    #[inline(always)]
    pub fn determinant(&self) -> R {
        let [[a, b], [c, d]] = self.0;
        a * d - c * b
    }
}

impl<R: Real> Mat3<R> {
    /// The determinant: x·(y × z) of the columns.
    #[inline(always)]
    pub fn determinant(&self) -> R {
        let [x, y, z] = self.columns();
        x.dot(y.cross(z))
    }
}

impl<R: Real> Mat4<R> {
    /// The determinant, by the 2×2 minors of the first two and of the last two columns.
    #[inline(always)]
    pub fn determinant(&self) -> R {
        let [a, b, c, d] = self.columns();
        // (a.xyz × b.xyz) are minors without w; a·b.w − b·a.w are those with w.
        let (ab, cd) = (a.xyz().cross(b.xyz()), c.xyz().cross(d.xyz()));
        let ab_w: Vec3<R> = a.xyz() * b.w - b.xyz() * a.w;
        let cd_w: Vec3<R> = c.xyz() * d.w - d.xyz() * c.w;
        ab.dot(cd_w) + cd.dot(ab_w)
    }
}

/// The inverse of a matrix whose determinant is not 0 and that has no infinities or NaN, by Gauss
/// and Jordan's elimination with the largest pivot of each column.
fn inverse<const N: usize>(columns: [[f32; N]; N]) -> Option<[[f32; N]; N]> {
    let mut left = columns.map(|column| column.map(f64::from));
    let mut right = [[0.0; N]; N];
    for (index, column) in right.iter_mut().enumerate() {
        column[index] = 1.0;
    }
    // The transpose of the inverse is the inverse of the transpose: columns serve as rows.
    for at in 0..N {
        let mut pivot = at;
        for row in at + 1..N {
            if left[row][at].abs() > left[pivot][at].abs() {
                pivot = row;
            }
        }
        left.swap(at, pivot);
        right.swap(at, pivot);
        let divisor = left[at][at];
        if divisor == 0.0 || !divisor.is_finite() {
            return None;
        }
        for index in 0..N {
            left[at][index] /= divisor;
            right[at][index] /= divisor;
        }
        let (pivot_left, pivot_right) = (left[at], right[at]);
        for row in (0..N).filter(|&row| row != at) {
            let factor = left[row][at];
            for index in 0..N {
                left[row][index] -= factor * pivot_left[index];
                right[row][index] -= factor * pivot_right[index];
            }
        }
    }
    let rounded = right.map(|column| column.map(round_to_f32));
    rounded
        .iter()
        .flatten()
        .all(|element| element.is_finite())
        .then_some(rounded)
}

#[expect(clippy::cast_possible_truncation, reason = "this is the one rounding")]
fn round_to_f32(value: f64) -> f32 {
    value as f32
}

macro_rules! inverses {
    ($($name:ident)+) => {$(
        impl $name {
            /// The inverse, computed in f64 and rounded once. `None` if the matrix has none, or if
            /// it or its inverse is not finite.
            #[must_use]
            pub fn inverse(&self) -> Option<Self> {
                inverse(self.0).map(Self)
            }
        }
    )+};
}
inverses! { Mat2 Mat3 Mat4 }
