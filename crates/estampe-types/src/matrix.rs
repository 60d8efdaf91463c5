//! A 4×4 matrix that is the same for every lane.

use crate::{Real, Vec3, Vec4};
use std::ops::Mul;

/// A 4×4 matrix of uniform values, by columns: `clip = m * position`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mat4(pub [[f32; 4]; 4]);

impl Mat4 {
    /// The identity matrix.
    pub const IDENTITY: Self = Self([
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);

    /// `m * (v, 1)`: the fourth column is added last, without a product.
    #[inline(always)]
    pub fn transform_point<R: Real>(&self, v: Vec3<R>) -> Vec4<R> {
        let [x, y, z, w] = self.rows();
        Vec4::new(affine(x, v), affine(y, v), affine(z, v), affine(w, v))
    }

    /// The upper left 3×3 part times `v`: directions, whose w is 0.
    #[inline(always)]
    pub fn transform_vector<R: Real>(&self, v: Vec3<R>) -> Vec3<R> {
        let [x, y, z, _] = self.rows();
        Vec3::new(linear(x, v), linear(y, v), linear(z, v))
    }

    /// The matrix by rows.
    #[inline(always)]
    fn rows(&self) -> [[f32; 4]; 4] {
        let [a, b, c, d] = &self.0;
        [
            [a[0], b[0], c[0], d[0]],
            [a[1], b[1], c[1], d[1]],
            [a[2], b[2], c[2], d[2]],
            [a[3], b[3], c[3], d[3]],
        ]
    }
}

// Functions and not closures: the compiler decides whether it inlines a closure, and one that was
// not inlined lost the shader its SIMD level.

/// A row times (v, 0).
#[inline(always)]
fn linear<R: Real>(row: [f32; 4], v: Vec3<R>) -> R {
    v.x * row[0] + v.y * row[1] + v.z * row[2]
}

/// A row times (v, 1).
#[inline(always)]
fn affine<R: Real>(row: [f32; 4], v: Vec3<R>) -> R {
    linear(row, v) + row[3]
}

/// A row times v.
#[inline(always)]
fn product<R: Real>(row: [f32; 4], v: Vec4<R>) -> R {
    v.x * row[0] + v.y * row[1] + v.z * row[2] + v.w * row[3]
}

impl<R: Real> Mul<Vec4<R>> for Mat4 {
    type Output = Vec4<R>;
    /// Sums each row's products from the first column on.
    #[inline(always)]
    fn mul(self, v: Vec4<R>) -> Vec4<R> {
        let [x, y, z, w] = self.rows();
        Vec4::new(product(x, v), product(y, v), product(z, v), product(w, v))
    }
}

impl From<[[f32; 4]; 4]> for Mat4 {
    fn from(columns: [[f32; 4]; 4]) -> Self {
        Self(columns)
    }
}

impl From<glam::Mat4> for Mat4 {
    fn from(matrix: glam::Mat4) -> Self {
        Self(matrix.to_cols_array_2d())
    }
}
