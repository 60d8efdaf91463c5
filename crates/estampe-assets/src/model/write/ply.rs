//! ASCII PLY: vertices with normals and texture coordinates, faces, edges.

use super::number::append_all;
use estampe_scene::Mesh;
use std::fmt::Write as _;

/// Writes all meshes, one after the other.
pub(super) fn write(meshes: &[Mesh]) -> String {
    let count = |of: fn(&Mesh) -> usize| -> usize { meshes.iter().map(of).sum() };
    let vertices = count(|mesh| mesh.positions.len());
    let (faces, edges) = (
        count(|mesh| mesh.triangles.len()),
        count(|mesh| mesh.lines.len()),
    );
    let has_normals = vertices > 0 && meshes.iter().all(|m| m.normals.len() == m.positions.len());
    let has_uvs = vertices > 0 && meshes.iter().all(|m| m.uvs.len() == m.positions.len());

    let mut text = "ply\nformat ascii 1.0\ncomment estampe\n".to_owned();
    let _ = writeln!(text, "element vertex {vertices}");
    let named = [(true, "x y z"), (has_normals, "nx ny nz"), (has_uvs, "s t")];
    for name in named
        .iter()
        .filter(|(has, _)| *has)
        .flat_map(|(_, names)| names.split(' '))
    {
        let _ = writeln!(text, "property float {name}");
    }
    if faces > 0 {
        let _ = writeln!(
            text,
            "element face {faces}\nproperty list uchar uint vertex_indices"
        );
    }
    if edges > 0 {
        let _ = writeln!(
            text,
            "element edge {edges}\nproperty uint vertex1\nproperty uint vertex2"
        );
    }
    text.push_str("end_header\n");

    for mesh in meshes {
        for (vertex, position) in mesh.positions.iter().enumerate() {
            let start = text.len();
            append_all(&mut text, position.to_array());
            if has_normals {
                append_all(&mut text, mesh.normals[vertex].to_array());
            }
            if has_uvs {
                // v = 0 is the top row here, and the bottom row in PLY.
                let uv = mesh.uvs[vertex];
                append_all(&mut text, [uv.x, 1.0 - uv.y]);
            }
            // Each number begins with a space.
            text.remove(start);
            text.push('\n');
        }
    }
    let mut first = 0;
    for mesh in meshes {
        for [a, b, c] in mesh
            .triangles
            .iter()
            .map(|t| t.map(|vertex| first + vertex as usize))
        {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        first += mesh.positions.len();
    }
    let mut first = 0;
    for mesh in meshes {
        for [a, b] in mesh
            .lines
            .iter()
            .map(|line| line.map(|vertex| first + vertex as usize))
        {
            let _ = writeln!(text, "{a} {b}");
        }
        first += mesh.positions.len();
    }
    text
}
