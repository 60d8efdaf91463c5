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
//!
//! [`Mat4`](crate::Mat4) has the usual transforms in f32, for a few objects near the origin. In f64 a
//! camera may stand far from the origin, and matrices may be multiplied and inverted at will: the
//! product of all is rounded to f32 once, for the shader. The types are those of the crate glam.
//!
//! ```
//! use estampe::transforms::projection::{DepthConvention, perspective};
//! use estampe::transforms::{DVec3, affine, to_f32, view::CameraFrame};
//!
//! let world_from_object = affine::rotation_about(DVec3::X, DVec3::Y, 0.5);
//! let camera = CameraFrame::look_at(DVec3::new(1.0, 1.0, 2.0), DVec3::ZERO, DVec3::Y);
//! let clip_from_view = perspective(0.8, 4.0 / 3.0, 0.1, f64::INFINITY, DepthConvention::Reversed);
//! let clip_from_object = clip_from_view * camera.view_from_world() * world_from_object;
//! let uniform = estampe::Mat4::from(to_f32(&clip_from_object));
//! # assert_eq!(uniform.0[3][3], clip_from_object.w_axis.w as f32);
//! ```
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

pub use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

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

/// The matrix in f32, for a shader: `Mat4::from(to_f32(&m))` is [`Mat4`](crate::Mat4).
#[must_use]
pub fn to_f32(m: &DMat4) -> glam::Mat4 {
    m.as_mat4()
}
