//! Transformation of normals.

use glam::{DMat3, DMat4, DVec3};

/// The matrix that transforms normals when `world_from_object` transforms points: the inverse
/// transpose of its upper left 3×3 part, up to a positive factor. Renormalise its results.
///
/// It is the matrix of cofactors, cof(M) = det(M)·M⁻ᵀ, times the sign of the determinant. A
/// singular matrix (a flattened model) therefore still transforms normals that are defined.
#[must_use]
pub fn normal_matrix(world_from_object: &DMat4) -> DMat3 {
    let m = DMat3::from_mat4(*world_from_object);
    let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
    let cofactors = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
    if a.dot(b.cross(c)) < 0.0 {
        cofactors * -1.0
    } else {
        cofactors
    }
}

/// The unit normal after a transform; zero if it is not defined.
#[must_use]
pub fn transform_normal(world_from_object: &DMat4, normal: DVec3) -> DVec3 {
    (normal_matrix(world_from_object) * normal).normalize_or_zero()
}
