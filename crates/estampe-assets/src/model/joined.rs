//! Joining of meshes beyond the limit to the last one within it.

use estampe_scene::{Mesh, MeshAttribute, Surface};
use glam::{Vec2, Vec3};

/// Joins the meshes after the first `max` to the last of these.
pub(super) fn join_beyond(meshes: &mut Vec<Mesh>, max: u64) {
    let max = usize::try_from(max).unwrap_or(usize::MAX).max(1);
    if meshes.len() <= max {
        return;
    }
    let rest = meshes.split_off(max);
    if let Some(last) = meshes.last_mut() {
        for mesh in rest {
            append(last, mesh);
        }
    }
}

/// Adds a mesh, or appends it to the last one if there are `max` already.
pub(super) fn push_within(meshes: &mut Vec<Mesh>, mesh: Mesh, max: u64) {
    let is_full = meshes.len() as u64 >= max;
    match meshes.last_mut() {
        Some(last) if is_full => append(last, mesh),
        _ => meshes.push(mesh),
    }
}

/// Appends a mesh. What only one of the two has is filled in the other: normals with zero, which
/// are computed later, colours with white, everything else with zero.
fn append(whole: &mut Mesh, mesh: Mesh) {
    let before = whole.positions.len();
    let after = before + mesh.positions.len();
    whole.positions.extend(mesh.positions);
    extend(
        &mut whole.normals,
        mesh.normals,
        [before, after],
        Vec3::ZERO,
    );
    extend(&mut whole.uvs, mesh.uvs, [before, after], Vec2::ZERO);
    extend(&mut whole.colors, mesh.colors, [before, after], [1.0; 4]);
    for attribute in mesh.attributes {
        let named = |own: &MeshAttribute| own.name == attribute.name;
        let at = whole.attributes.iter().position(named);
        let at = at.unwrap_or_else(|| {
            whole.attributes.push(MeshAttribute {
                values: Vec::new(),
                ..attribute.clone()
            });
            whole.attributes.len() - 1
        });
        let own = &mut whole.attributes[at];
        own.values.resize(before * own.components, 0.0);
        own.values.extend(attribute.values);
    }
    for own in &mut whole.attributes {
        own.values.resize(after * own.components, 0.0);
    }

    let first = u32::try_from(before).expect("limits keep vertices below 2^32");
    let first_triangle = whole.triangles.len();
    let moved = |vertex: u32| vertex + first;
    let triangles = mesh.triangles.into_iter();
    whole
        .triangles
        .extend(triangles.map(|corners| corners.map(moved)));
    let lines = mesh.lines.into_iter();
    whole.lines.extend(lines.map(|ends| ends.map(moved)));
    whole.points.extend(mesh.points.into_iter().map(moved));
    // Meshes of lines and points have no surfaces, and no triangles either.
    for Surface {
        material,
        triangles,
    } in mesh.surfaces
    {
        whole.surfaces.push(Surface {
            material,
            triangles: triangles.start + first_triangle..triangles.end + first_triangle,
        });
    }
}

/// Appends values of vertices `before..after`, filling what is missing.
fn extend<T: Copy>(whole: &mut Vec<T>, values: Vec<T>, [before, after]: [usize; 2], missing: T) {
    if whole.is_empty() && values.is_empty() {
        return;
    }
    whole.resize(before, missing);
    whole.extend(values);
    whole.resize(after, missing);
}
