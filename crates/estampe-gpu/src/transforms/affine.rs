//! Scale, shear, rotation and translation, in space and in the plane.
//!
//! Products do not commute: `translation(t) * rotation(…) * scale(s)` scales first.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// Multiplies each coordinate by its factor.
#[must_use]
pub fn scale(factors: DVec3) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(factors.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, factors.y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, factors.z, 0.0),
        DVec4::W,
    )
}

/// Moves points by `offset`; leaves vectors (w = 0) alone.
#[must_use]
pub fn translation(offset: DVec3) -> DMat4 {
    DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::Z, offset.extend(1.0))
}

/// Moves each point along `along` in proportion to its coordinate along `normal`: p +
/// along·(normal·p).
///
/// Preserves volumes if the two are perpendicular.
#[must_use]
pub fn shear(along: DVec3, normal: DVec3) -> DMat4 {
    let column = |axis: DVec3| (axis + along * normal.dot(axis)).extend(0.0);
    DMat4::from_cols(
        column(DVec3::X),
        column(DVec3::Y),
        column(DVec3::Z),
        DVec4::W,
    )
}

/// Rotates by `angle_rad` about the axis `direction` through the origin, counter-clockwise when
/// seen against the axis direction.
///
/// Rodrigues: R = (1 − c)·d·dᵀ + c·I + s·`[d]`×, ‖d‖ = 1. A zero direction gives the identity.
#[must_use]
pub fn rotation(direction: DVec3, angle_rad: f64) -> DMat4 {
    let d = direction.normalize_or_zero();
    if d == DVec3::ZERO {
        return DMat4::IDENTITY;
    }
    let (s, c) = libm::sincos(angle_rad);
    let column =
        |axis: DVec3| (d * ((1.0 - c) * d.dot(axis)) + axis * c + d.cross(axis) * s).extend(0.0);
    DMat4::from_cols(
        column(DVec3::X),
        column(DVec3::Y),
        column(DVec3::Z),
        DVec4::W,
    )
}

/// Rotates about an axis through `point`: T(point) · R · T(−point).
#[must_use]
pub fn rotation_about(point: DVec3, direction: DVec3, angle_rad: f64) -> DMat4 {
    translation(point) * rotation(direction, angle_rad) * translation(-point)
}

/// The smallest rotation that takes the direction `from` to `to`; half a turn about X, or else Z,
/// when they are opposite. Zero directions give the identity.
#[must_use]
pub fn rotation_between(from: DVec3, to: DVec3) -> DMat4 {
    let (a, b) = (from.normalize_or_zero(), to.normalize_or_zero());
    if a == DVec3::ZERO || b == DVec3::ZERO {
        return DMat4::IDENTITY;
    }
    let (axis, cosine) = (a.cross(b), a.dot(b));
    // Near half a turn 1 + c cancels: half a turn takes a to −a exactly, the rest is a small
    // rotation.
    if 1.0 + cosine < 1e-6 {
        let axis = if a.x.abs() < 0.9 { DVec3::X } else { DVec3::Z };
        let perpendicular = (axis - a * a.dot(axis)).normalize();
        // Half a turn: R = 2·d·dᵀ − I.
        let column = |e: DVec3| (perpendicular * (2.0 * perpendicular.dot(e)) - e).extend(0.0);
        let half_turn = DMat4::from_cols(
            column(DVec3::X),
            column(DVec3::Y),
            column(DVec3::Z),
            DVec4::W,
        );
        return rotation_between(-a, b) * half_turn;
    }
    // Rodrigues with s·d = a × b and c = a · b; 1/(1 + c) = (1 − c)/s².
    let column =
        |e: DVec3| (axis * (axis.dot(e) / (1.0 + cosine)) + e * cosine + axis.cross(e)).extend(0.0);
    DMat4::from_cols(
        column(DVec3::X),
        column(DVec3::Y),
        column(DVec3::Z),
        DVec4::W,
    )
}

/// T · R · S: scale, then rotate, then move.
#[must_use]
pub fn compose(offset: DVec3, rotation: DMat4, factors: DVec3) -> DMat4 {
    translation(offset) * rotation * scale(factors)
}

/// 2D scale, as a homogeneous matrix.
#[must_use]
pub fn scale_2d(factors: DVec2) -> DMat3 {
    DMat3::from_cols(DVec3::X * factors.x, DVec3::Y * factors.y, DVec3::Z)
}

/// 2D translation of points (w = 1).
#[must_use]
pub fn translation_2d(offset: DVec2) -> DMat3 {
    DMat3::from_cols(DVec3::X, DVec3::Y, offset.extend(1.0))
}

/// 2D shear: x' = x + by.x·y, y' = y + by.y·x.
#[must_use]
pub fn shear_2d(by: DVec2) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(1.0, by.y, 0.0),
        DVec3::new(by.x, 1.0, 0.0),
        DVec3::Z,
    )
}

/// 2D rotation about `point`, counter-clockwise (x right, y up).
#[must_use]
pub fn rotation_2d(point: DVec2, angle_rad: f64) -> DMat3 {
    let (s, c) = libm::sincos(angle_rad);
    let about_origin = DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z);
    translation_2d(point) * about_origin * translation_2d(-point)
}
