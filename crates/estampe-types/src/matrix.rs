//! A 4×4 matrix that is the same for every lane.

use crate::{Real, Vec3, Vec4};
use std::ops::Mul;

/// A 4×4 matrix of uniform values, by columns: `clip = m * position`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mat4(pub [[f32; 4]; 4]);

impl Mat4 {
    /// The matrix that changes nothing.
    pub const IDENTITY: Self = Self([
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);

    /// `m * (v, 1)`: the fourth column is added last, without a product.
    #[inline(always)]
    pub fn transform_point<R: Real>(&self, v: Vec3<R>) -> Vec4<R> {
        let m = &self.0;
        let row = |r: usize| v.x * m[0][r] + v.y * m[1][r] + v.z * m[2][r] + m[3][r];
        Vec4::new(row(0), row(1), row(2), row(3))
    }

    /// The upper left 3×3 part times `v`: directions, whose w is 0.
    #[inline(always)]
    pub fn transform_vector<R: Real>(&self, v: Vec3<R>) -> Vec3<R> {
        let m = &self.0;
        let row = |r: usize| v.x * m[0][r] + v.y * m[1][r] + v.z * m[2][r];
        Vec3::new(row(0), row(1), row(2))
    }
}

impl<R: Real> Mul<Vec4<R>> for Mat4 {
    type Output = Vec4<R>;
    /// Each row's products are summed from the first column on.
    #[inline(always)]
    fn mul(self, v: Vec4<R>) -> Vec4<R> {
        let m = &self.0;
        let row = |r: usize| v.x * m[0][r] + v.y * m[1][r] + v.z * m[2][r] + v.w * m[3][r];
        Vec4::new(row(0), row(1), row(2), row(3))
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
