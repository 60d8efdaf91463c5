//! Irradiance as spherical harmonics of degree 2 (R. Ramamoorthi, P. Hanrahan, "An Efficient
//! Representation for Irradiance Environment Maps", 2001), whose mean error is about 1 %.

use super::cube::CubeImage;
use glam::Vec3;
use std::f32::consts::PI;

/// The side from which on a finer image would change nothing.
const SIDE: usize = 32;

/// Coefficients of irradiance ÷ π, so that a white diffuse surface has the sum as radiance; for
/// [`basis`].
pub(super) fn coefficients(levels: &[CubeImage]) -> [[f32; 3]; 9] {
    /// The cosine's coefficients ÷ π of degrees 0, 1 and 2: 1, 2/3, 1/4.
    const COSINE: [f32; 9] = [
        1.0,
        2.0 / 3.0,
        2.0 / 3.0,
        2.0 / 3.0,
        0.25,
        0.25,
        0.25,
        0.25,
        0.25,
    ];
    /// Squares of the norms of the basis below: 1 ÷ ∫b² over the sphere.
    const NORMS: [f32; 9] = [
        1.0 / (4.0 * PI),
        3.0 / (4.0 * PI),
        3.0 / (4.0 * PI),
        3.0 / (4.0 * PI),
        15.0 / (4.0 * PI),
        15.0 / (4.0 * PI),
        15.0 / (4.0 * PI),
        5.0 / (16.0 * PI),
        15.0 / (16.0 * PI),
    ];
    let image = levels.iter().find(|level| level.side() <= SIDE);
    let Some(image) = image.or(levels.last()) else {
        return [[0.0; 3]; 9];
    };
    let mut sums = [Vec3::ZERO; 9];
    let mut whole = 0.0;
    for (direction, radiance, solid_angle) in image.texels_with_solid_angles() {
        let values = basis(direction);
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += radiance * (value * solid_angle);
        }
        whole += solid_angle;
    }
    // The texels' angles are those of their middles; their sum becomes exactly 4π.
    let correction = 4.0 * PI / whole;
    let mut coefficients = [[0.0; 3]; 9];
    for (index, coefficient) in coefficients.iter_mut().enumerate() {
        let scale = COSINE[index] * NORMS[index] * correction;
        *coefficient = (sums[index] * scale).to_array();
    }
    coefficients
}

/// The basis, without its norms: 1; x, y, z; xy, yz, zx; 3z² − 1; x² − y².
pub(super) fn basis(d: Vec3) -> [f32; 9] {
    [
        1.0,
        d.x,
        d.y,
        d.z,
        d.x * d.y,
        d.y * d.z,
        d.z * d.x,
        3.0 * d.z * d.z - 1.0,
        d.x * d.x - d.y * d.y,
    ]
}
