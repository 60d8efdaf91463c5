//! The named surfaces: sphere, torus, plane.

use glam::DVec3;

use super::circle::cos_sin_turns;
use super::grid::{SurfacePoint, surface};
use crate::mesh::ShapeMesh;

/// The direction at a longitude and latitude, both in turns: longitude 0 is +Z, a quarter +X.
fn direction(longitude: f64, latitude: f64) -> DVec3 {
    let (cos_longitude, sin_longitude) = cos_sin_turns(longitude);
    let (cos_latitude, sin_latitude) = cos_sin_turns(latitude);
    DVec3::new(
        cos_latitude * sin_longitude,
        sin_latitude,
        cos_latitude * cos_longitude,
    )
}

/// A sphere around the origin with its poles on the Y axis.
///
/// `segments` cells go around (at least 3) and `rings` from pole to pole (at least 2). The image is
/// wrapped around it as a map of the world is (equirectangular), its middle facing +Z.
///
/// S(s, t) = r (cos t sin s, sin t, cos t cos s), with the longitude s from −½ to ½ turn and the
/// latitude t from ¼ turn down to −¼.
#[must_use]
pub fn sphere(radius: f64, segments: u32, rings: u32) -> ShapeMesh {
    let cells = [segments.max(3), rings.max(2)];
    surface(
        "sphere",
        -0.5..0.5,
        0.25..-0.25,
        cells,
        |longitude, latitude| {
            let normal = direction(longitude, latitude);
            SurfacePoint {
                position: normal * radius,
                normal,
            }
        },
    )
}

/// A torus around the Y axis.
///
/// `ring_radius` is the distance from the axis to the tube's middle, `tube_radius` the tube's
/// radius. `segments` cells go around the axis and `sides` around the tube (at least 3 each). The
/// image's upper and lower edges meet on the inside; its middle faces +Z.
///
/// S(s, t) = ((R + r cos t) sin s, r sin t, (R + r cos t) cos s), with s from −½ to ½ turn and t
/// from ½ turn (inside) over ¼ (top), 0 (outside) and −¼ (bottom) to −½.
#[must_use]
pub fn torus(ring_radius: f64, tube_radius: f64, segments: u32, sides: u32) -> ShapeMesh {
    let cells = [segments.max(3), sides.max(3)];
    surface(
        "torus",
        -0.5..0.5,
        0.5..-0.5,
        cells,
        |around_axis, around_tube| {
            let normal = direction(around_axis, around_tube);
            let middle = direction(around_axis, 0.0) * ring_radius;
            SurfacePoint {
                position: middle + normal * tube_radius,
                normal,
            }
        },
    )
}

/// A rectangle around the origin in x and z that faces +Y; the image's top is at −Z.
#[must_use]
pub fn plane(width: f64, depth: f64, cells: [u32; 2]) -> ShapeMesh {
    surface("plane", -0.5..0.5, -0.5..0.5, cells, |s, t| SurfacePoint {
        position: DVec3::new(s * width, 0.0, t * depth),
        normal: DVec3::Y,
    })
}
