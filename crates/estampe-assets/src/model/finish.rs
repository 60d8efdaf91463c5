//! Final steps of all readers: removal of non-finite corners, computation of missing normals.

use super::load::{Context, Parsed};
use super::normals::{self, NormalMode, Positions};
use estampe_scene::{Material, Mesh, Scene, Surface};
use glam::{Vec2, Vec3};

/// Prepares the scene for drawing.
pub(super) fn finish(mut parsed: Parsed, context: &mut Context<'_>) -> Parsed {
    for (index, mesh) in parsed.scene.meshes.iter_mut().enumerate() {
        let groups = parsed.smoothing_groups.get_mut(index);
        let dropped = drop_non_finite(mesh, groups);
        if dropped > 0 {
            context.warnings.add(context.name, None, || {
                let (elements, are) = match dropped {
                    1 => ("element", "is"),
                    _ => ("elements", "are"),
                };
                format!("{dropped} {elements} with a coordinate that is not finite {are} omitted")
            });
        }
        drop_useless_normals(mesh);
        for uv in mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()) {
            *uv = Vec2::ZERO;
        }
    }
    whiten_colored(&mut parsed.scene);
    let is_grouped = parsed
        .smoothing_groups
        .iter()
        .flatten()
        .any(|&group| group != 0);
    let mode = if is_grouped {
        NormalMode::SmoothingGroups(&parsed.smoothing_groups)
    } else if parsed.has_flat_normals {
        NormalMode::Flat
    } else {
        NormalMode::default()
    };
    let lacks_normals = |mesh: &Mesh| mesh.normals.is_empty() && !mesh.triangles.is_empty();
    parsed.contents.has_made_normals = parsed.scene.meshes.iter().map(lacks_normals).collect();
    let positions = if parsed.has_distinct_positions {
        Positions::Distinct
    } else {
        Positions::Any
    };
    normals::fill_missing_by(&mut parsed.scene.meshes, mode, positions, context.workers);
    let is_empty =
        |mesh: &Mesh| mesh.triangles.is_empty() && mesh.lines.is_empty() && mesh.points.is_empty();
    if parsed.scene.meshes.iter().all(is_empty) {
        context
            .warnings
            .add(context.name, None, || "it has nothing to draw".to_owned());
    }
    parsed
}

/// Removes the elements that use a vertex that is not finite; returns their number.
fn drop_non_finite(mesh: &mut Mesh, groups: Option<&mut Vec<u32>>) -> usize {
    if mesh.positions.iter().all(|position| position.is_finite()) {
        return 0;
    }
    let count = |mesh: &Mesh| mesh.triangles.len() + mesh.lines.len() + mesh.points.len();
    let before = count(mesh);
    let positions = &mesh.positions;
    let is_kept = |vertices: &[u32]| {
        vertices
            .iter()
            .all(|&vertex| positions[vertex as usize].is_finite())
    };
    mesh.lines.retain(|segment| is_kept(segment));
    mesh.points.retain(|&point| is_kept(&[point]));
    if let Some(groups) = groups {
        let mut triangles = mesh.triangles.iter();
        groups.retain(|_| triangles.next().is_none_or(|triangle| is_kept(triangle)));
    }
    // Surfaces shrink by the triangles that are removed from them.
    let mut kept = Vec::with_capacity(mesh.triangles.len());
    let mut surfaces = std::mem::take(&mut mesh.surfaces);
    if surfaces.is_empty() {
        kept.extend(
            mesh.triangles
                .iter()
                .filter(|triangle| is_kept(&triangle[..])),
        );
    }
    for Surface {
        triangles: range, ..
    } in &mut surfaces
    {
        let first = kept.len();
        let triangles = &mesh.triangles[range.clone()];
        kept.extend(triangles.iter().filter(|triangle| is_kept(&triangle[..])));
        *range = first..kept.len();
    }
    surfaces.retain(|surface| !surface.triangles.is_empty());
    mesh.surfaces = surfaces;
    mesh.triangles = kept;
    before - count(mesh)
}

/// Removes normals that are all zero, which have no information.
fn drop_useless_normals(mesh: &mut Mesh) {
    if mesh.normals.iter().all(|normal| *normal == Vec3::ZERO) {
        mesh.normals = Vec::new();
    }
}

/// Gives meshes that have vertex colours and no material a white material, so that the vertex
/// colours are not multiplied by the default grey.
fn whiten_colored(scene: &mut Scene) {
    let white = scene.materials.len();
    let mut is_used = false;
    for mesh in scene
        .meshes
        .iter_mut()
        .filter(|mesh| !mesh.colors.is_empty())
    {
        if mesh.surfaces.is_empty() && !mesh.triangles.is_empty() {
            mesh.surfaces = vec![Surface {
                material: None,
                triangles: 0..mesh.triangles.len(),
            }];
        }
        for surface in mesh
            .surfaces
            .iter_mut()
            .filter(|surface| surface.material.is_none())
        {
            surface.material = Some(white);
            is_used = true;
        }
    }
    if is_used {
        let name = "vertex colours".to_owned();
        scene.materials.push(Material {
            name,
            base_color: Vec3::ONE,
            ..Material::default()
        });
    }
}
