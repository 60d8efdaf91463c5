//! Projections: view space to clip space.

use super::Mat4;
use crate::maths;

/// # Projections
///
/// The camera looks down −z; `z_near` and `z_far` are positive distances. Visible points have −w ≤
/// x, y ≤ w, with y up in clip space. Depth is z ÷ w:
///
/// | functions | near | far |
/// |---|---|---|
/// | plain | 0 | 1 |
/// | `_reversed` | 1 | 0 |
/// | `_infinite` | 0 | 1, at infinite distance |
/// | `_infinite_reversed` | 1 | 0, at infinite distance |
/// | `_gl` | −1 | 1 |
///
/// The pipeline clips at 0 ≤ z ≤ w. The `_gl` matrices are for code that was written for OpenGL:
/// `Mat4::ZERO_TO_ONE_FROM_GL * m` makes them fit. Reversed depth with a float depth format spreads
/// its precision evenly over distance; the depth test is then `Greater`, and the clear value 0.
impl Mat4 {
    /// OpenGL's clip space (−w ≤ z ≤ w) to ours: z' = (z + w)·½.
    pub const ZERO_TO_ONE_FROM_GL: Self = Self([
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.5, 0.0],
        [0.0, 0.0, 0.5, 1.0],
    ]);

    /// Perspective with a vertical field of view, and `aspect` = width ÷ height.
    #[must_use]
    pub fn perspective(fov_y_rad: f32, aspect: f32, z_near: f32, z_far: f32) -> Self {
        symmetric(fov_y_rad, aspect, zero_to_one(z_near, z_far))
    }

    /// [`perspective`](Self::perspective) with depth 1 at `z_near` and 0 at `z_far`.
    #[must_use]
    pub fn perspective_reversed(fov_y_rad: f32, aspect: f32, z_near: f32, z_far: f32) -> Self {
        symmetric(fov_y_rad, aspect, zero_to_one(z_far, z_near))
    }

    /// [`perspective`](Self::perspective) without a far plane.
    #[must_use]
    pub fn perspective_infinite(fov_y_rad: f32, aspect: f32, z_near: f32) -> Self {
        symmetric(fov_y_rad, aspect, [-1.0, -z_near])
    }

    /// [`perspective_reversed`](Self::perspective_reversed) without a far plane.
    #[must_use]
    pub fn perspective_infinite_reversed(fov_y_rad: f32, aspect: f32, z_near: f32) -> Self {
        symmetric(fov_y_rad, aspect, [0.0, z_near])
    }

    /// [`perspective`](Self::perspective) with OpenGL's depth, −1 to 1 (`gluPerspective`).
    #[must_use]
    pub fn perspective_gl(fov_y_rad: f32, aspect: f32, z_near: f32, z_far: f32) -> Self {
        symmetric(fov_y_rad, aspect, minus_one_to_one(z_near, z_far))
    }

    /// Perspective through the rectangle `left..right`, `bottom..top` on the near plane.
    #[must_use]
    pub fn frustum(left: f32, right: f32, bottom: f32, top: f32, z_near: f32, z_far: f32) -> Self {
        let depth = zero_to_one(z_near, z_far);
        off_centre([left, right], [bottom, top], z_near, depth)
    }

    /// [`frustum`](Self::frustum) with OpenGL's depth, −1 to 1 (`glFrustum`).
    #[must_use]
    pub fn frustum_gl(
        left: f32,
        right: f32,
        bottom: f32,
        top: f32,
        z_near: f32,
        z_far: f32,
    ) -> Self {
        let depth = minus_one_to_one(z_near, z_far);
        off_centre([left, right], [bottom, top], z_near, depth)
    }

    /// Parallel projection of the box `left..right`, `bottom..top`, −`z_near`..−`z_far`.
    #[must_use]
    pub fn orthographic(
        left: f32,
        right: f32,
        bottom: f32,
        top: f32,
        z_near: f32,
        z_far: f32,
    ) -> Self {
        let range = 1.0 / (z_near - z_far);
        parallel([left, right], [bottom, top], [range, z_near * range])
    }

    /// [`orthographic`](Self::orthographic) with depth 1 at `z_near` and 0 at `z_far`.
    #[must_use]
    pub fn orthographic_reversed(
        left: f32,
        right: f32,
        bottom: f32,
        top: f32,
        z_near: f32,
        z_far: f32,
    ) -> Self {
        Self::orthographic(left, right, bottom, top, z_far, z_near)
    }

    /// [`orthographic`](Self::orthographic) with OpenGL's depth, −1 to 1 (`glOrtho`).
    #[must_use]
    pub fn orthographic_gl(
        left: f32,
        right: f32,
        bottom: f32,
        top: f32,
        z_near: f32,
        z_far: f32,
    ) -> Self {
        let range = 1.0 / (z_near - z_far);
        let depth = [2.0 * range, (z_near + z_far) * range];
        parallel([left, right], [bottom, top], depth)
    }
}

/// Clip z = a·z + b with w = −z, as [a, b]: depth 0 at `zero` and 1 at `one`.
fn zero_to_one(zero: f32, one: f32) -> [f32; 2] {
    let a = one / (zero - one);
    [a, a * zero]
}

/// Clip z = a·z + b with w = −z, as [a, b]: depth −1 at `z_near` and 1 at `z_far`.
fn minus_one_to_one(z_near: f32, z_far: f32) -> [f32; 2] {
    let range = 1.0 / (z_near - z_far);
    [(z_near + z_far) * range, 2.0 * z_near * z_far * range]
}

/// A perspective about the axis: x and y scaled by 1 ÷ tan(fov ÷ 2).
fn symmetric(fov_y_rad: f32, aspect: f32, [a, b]: [f32; 2]) -> Mat4 {
    let y = 1.0 / maths::tan(fov_y_rad * 0.5);
    Mat4([
        [y / aspect, 0.0, 0.0, 0.0],
        [0.0, y, 0.0, 0.0],
        [0.0, 0.0, a, -1.0],
        [0.0, 0.0, b, 0.0],
    ])
}

/// A perspective through a rectangle on the near plane.
fn off_centre(x: [f32; 2], y: [f32; 2], z_near: f32, [a, b]: [f32; 2]) -> Mat4 {
    let (width, height) = (x[1] - x[0], y[1] - y[0]);
    Mat4([
        [2.0 * z_near / width, 0.0, 0.0, 0.0],
        [0.0, 2.0 * z_near / height, 0.0, 0.0],
        [(x[0] + x[1]) / width, (y[0] + y[1]) / height, a, -1.0],
        [0.0, 0.0, b, 0.0],
    ])
}

/// A parallel projection: clip z = a·z + b.
fn parallel(x: [f32; 2], y: [f32; 2], [a, b]: [f32; 2]) -> Mat4 {
    let (width, height) = (x[1] - x[0], y[1] - y[0]);
    Mat4([
        [2.0 / width, 0.0, 0.0, 0.0],
        [0.0, 2.0 / height, 0.0, 0.0],
        [0.0, 0.0, a, 0.0],
        [-(x[0] + x[1]) / width, -(y[0] + y[1]) / height, b, 1.0],
    ])
}
