//! Transforms between the spaces of the pipeline, computed in f64.
//!
//! ```text
//! object --affine--> world --view--> view (eye) --projection--> clip --÷w--> NDC
//! NDC --viewport--> window
//! ```
//!
//! Matrices act on column vectors and are named `to_from`, so that adjacent names in a product
//! agree: `clip_from_view * view_from_world * p_world`. All spaces are right-handed; the camera
//! looks down −z. Sines and cosines are `libm`'s, so that results are the same on every machine.
//! The product of all matrices is rounded to f32 once, for the shader.
//!
//! * [`affine`]: scale, shear, rotation, translation and their composition;
//! * [`normals`]: transformation of normals;
//! * [`view`]: the camera's frame and the view that inverts it;
//! * [`projection`]: frustum, perspective, orthographic and central projections;
//! * [`viewport`]: from NDC to the window.

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

/// `m * (v, 0)`: translations have no effect on directions.
#[must_use]
pub fn transform_vector(m: &DMat4, v: DVec3) -> DVec3 {
    (*m * v.extend(0.0)).truncate()
}

/// `value` rounded to the nearest f32, ties to even; infinite beyond f32's range.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
#[must_use]
pub fn round_to_f32(value: f64) -> f32 {
    value as f32
}

/// The matrix in f32, for a shader.
#[must_use]
pub fn to_f32(m: &DMat4) -> glam::Mat4 {
    m.as_mat4()
}
