//! Transforms between the spaces of the pipeline (rows X1 to X5), computed in f64.
//!
//! ```text
//! object --affine--> world --view--> view (eye) --projection--> clip --÷w--> NDC --viewport--> window
//! ```
//!
//! Matrices act on column vectors and are named `to_from`, so that a chain checks itself by eye:
//! `clip_from_view * view_from_world * p_world`. Everything right-handed; the camera looks down −z.
//! Sines and cosines are `libm`'s, so the same numbers come out on every machine. What the GPU gets
//! is the product of all matrices, rounded to f32 once.
//!
//! * [`affine`]: scale, shear, rotation, translation and their composition (X1);
//! * [`normals`]: how normals follow a transform (X2);
//! * [`view`]: the camera's frame and the view that inverts it (X3);
//! * [`projection`]: frustum, perspective, orthographic and central projections (X4);
//! * [`viewport`]: from NDC to the window (X5).

pub mod affine;
pub mod normals;
pub mod projection;
pub mod view;
pub mod viewport;

#[cfg(test)]
mod tests;

use glam::{DMat4, DVec3};

/// `m * (p, 1)`, divided by w.
#[must_use]
pub fn transform_point(m: &DMat4, p: DVec3) -> DVec3 {
    let h = *m * p.extend(1.0);
    h.truncate() / h.w
}

/// `m * (v, 0)`: directions do not feel translations.
#[must_use]
pub fn transform_vector(m: &DMat4, v: DVec3) -> DVec3 {
    (*m * v.extend(0.0)).truncate()
}

/// The matrix in f32, for a shader.
#[must_use]
pub fn to_f32(m: &DMat4) -> glam::Mat4 {
    m.as_mat4()
}
