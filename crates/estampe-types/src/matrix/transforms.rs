//! Rigid transforms and scales of the host: the matrices of models and cameras.
//!
//! Angles are in radians and counter-clockwise when the axis points at the viewer. Their sines and
//! cosines are those of [`maths`], so the matrices have the same bits on every machine.

use super::Mat4;
use crate::{Vec3, maths};

impl Mat4 {
    /// Moves points by `offset`.
    #[must_use]
    pub fn translation(offset: impl Into<[f32; 3]>) -> Self {
        let [x, y, z] = offset.into();
        let mut matrix = Self::IDENTITY;
        matrix.0[3] = [x, y, z, 1.0];
        matrix
    }

    /// Scales along the axes.
    #[must_use]
    pub fn scale(factors: impl Into<[f32; 3]>) -> Self {
        let [x, y, z] = factors.into();
        let mut matrix = Self::IDENTITY;
        (matrix.0[0][0], matrix.0[1][1], matrix.0[2][2]) = (x, y, z);
        matrix
    }

    /// Rotates about the x axis, from y towards z.
    #[must_use]
    pub fn rotation_x(angle_rad: f32) -> Self {
        let (s, c) = (maths::sin(angle_rad), maths::cos(angle_rad));
        Self([
            [1.0, 0.0, 0.0, 0.0],
            [0.0, c, s, 0.0],
            [0.0, -s, c, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Rotates about the y axis, from z towards x.
    #[must_use]
    pub fn rotation_y(angle_rad: f32) -> Self {
        let (s, c) = (maths::sin(angle_rad), maths::cos(angle_rad));
        Self([
            [c, 0.0, -s, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [s, 0.0, c, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Rotates about the z axis, from x towards y.
    #[must_use]
    pub fn rotation_z(angle_rad: f32) -> Self {
        let (s, c) = (maths::sin(angle_rad), maths::cos(angle_rad));
        Self([
            [c, s, 0.0, 0.0],
            [-s, c, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Rotates about an axis through the origin, which need not have length 1 (Rodrigues' formula).
    /// The zero vector gives NaN.
    #[must_use]
    pub fn rotation(axis: impl Into<[f32; 3]>, angle_rad: f32) -> Self {
        let Vec3 { x, y, z } = Vec3::from(axis.into()).normalize();
        let (s, c) = (maths::sin(angle_rad), maths::cos(angle_rad));
        let t = 1.0 - c;
        Self([
            [t * x * x + c, t * x * y + s * z, t * x * z - s * y, 0.0],
            [t * x * y - s * z, t * y * y + c, t * y * z + s * x, 0.0],
            [t * x * z + s * y, t * y * z - s * x, t * z * z + c, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// The view of a camera at `eye` that looks at `target`: world space to view space,
    /// right-handed. `up` must not be parallel to the line of sight; if it is, or if `eye` is
    /// `target`, the matrix has NaN.
    #[must_use]
    pub fn look_at(
        eye: impl Into<[f32; 3]>,
        target: impl Into<[f32; 3]>,
        up: impl Into<[f32; 3]>,
    ) -> Self {
        let eye = Vec3::from(eye.into());
        Self::look_along(eye, Vec3::from(target.into()) - eye, up)
    }

    /// As [`look_at`](Self::look_at), with the direction of sight instead of the target.
    #[must_use]
    pub fn look_along(
        eye: impl Into<[f32; 3]>,
        direction: impl Into<[f32; 3]>,
        up: impl Into<[f32; 3]>,
    ) -> Self {
        let eye: Vec3<f32> = Vec3::from(eye.into());
        let forward: Vec3<f32> = Vec3::from(direction.into()).normalize();
        let right = forward.cross(Vec3::from(up.into())).normalize();
        let up = right.cross(forward);
        Self::from_rows(
            right.extend(-right.dot(eye)),
            up.extend(-up.dot(eye)),
            (-forward).extend(forward.dot(eye)),
            Vec3::repeat(0.0).point(),
        )
    }
}
