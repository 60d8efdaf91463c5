//! Caps: the inside of the rings in which a plane meets a mesh.

use super::HalfSpace;
use super::outline::Outline;
use crate::transforms::round_to_f32;
use estampe_scene::{Mesh, Surface};
use estampe_shapes::polygon::{FillRule, triangulate_rings};
use glam::{DVec2, DVec3, Vec2};

/// The part of the plane that is inside of the mesh, its front on the side that is cut away. Empty
/// for open meshes, and for outlines of too many points.
pub(super) fn cap(mesh: &Mesh, plane: &HalfSpace) -> Mesh {
    let Outline { rings, is_oriented } = Outline::new(mesh, plane);
    let Some(&origin) = rings.first().and_then(|ring| ring.first()) else {
        return Mesh::default();
    };
    let origin = origin.as_dvec3();
    let [u, v] = axes(plane.normal);
    let flat = |ring: &Vec<glam::Vec3>| {
        let flat = ring.iter().map(|point| {
            let way = point.as_dvec3() - origin;
            Vec2::new(round_to_f32(way.dot(u)), round_to_f32(way.dot(v)))
        });
        flat.collect()
    };
    let flat: Vec<Vec<Vec2>> = rings.iter().map(flat).collect();
    let refs: Vec<&[Vec2]> = flat.iter().map(Vec::as_slice).collect();
    let rule = if is_oriented {
        FillRule::NonZero
    } else {
        FillRule::EvenOdd
    };
    let Ok(filled) = triangulate_rings(&refs, rule) else {
        return Mesh::default();
    };
    // The first vertices are the points of the rings, exactly those of the cut mesh.
    let mut positions = rings.concat();
    let crossings = filled.vertices.iter().skip(positions.len());
    let position = |at: &Vec2| {
        let DVec2 { x, y } = at.as_dvec2();
        (origin + u * x + v * y).as_vec3()
    };
    positions.extend(crossings.map(position));
    Mesh {
        positions,
        triangles: filled.triangles,
        ..Mesh::default()
    }
}

/// Adds a cap to those of the same mesh.
pub(super) fn append(caps: &mut Mesh, cap: &Mesh, material: usize) {
    let Ok(first) = u32::try_from(caps.positions.len()) else {
        return;
    };
    caps.positions.extend(&cap.positions);
    let moved = cap.triangles.iter();
    caps.triangles
        .extend(moved.map(|triangle| triangle.map(|corner| corner.saturating_add(first))));
    caps.surfaces = vec![Surface {
        material: Some(material),
        triangles: 0..caps.triangles.len(),
    }];
}

/// Two unit directions on the plane; their cross product is its normal.
fn axes(normal: DVec3) -> [DVec3; 2] {
    let least = normal.abs();
    let along = if least.x <= least.y && least.x <= least.z {
        DVec3::X
    } else if least.y <= least.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let u = along.cross(normal).normalize();
    [u, normal.cross(u)]
}
