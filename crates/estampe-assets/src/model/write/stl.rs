//! ASCII STL: a solid for each mesh, a facet with its normal for each triangle.

use super::number::append_all;
use super::word;
use crate::AssetError;
use estampe_scene::Mesh;
use glam::DVec3;
use std::fmt::Write as _;

/// Writes all meshes.
pub(super) fn write(meshes: &[Mesh]) -> Result<String, AssetError> {
    let mut text = String::new();
    for mesh in meshes {
        if !(mesh.lines.is_empty() && mesh.points.is_empty()) {
            return Err(AssetError::unsupported(
                "STL holds triangles only, not lines or points",
                "write OBJ or PLY",
            ));
        }
        let name = word(&mesh.name);
        let _ = writeln!(text, "{}", format!("solid {name}").trim_end());
        for triangle in &mesh.triangles {
            let corners = triangle.map(|vertex| mesh.positions[vertex as usize]);
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            // Of a triangle without area, zero.
            let normal = (b - a).cross(c - a).normalize_or_zero() + DVec3::ZERO;
            text.push_str("facet normal");
            append_all(&mut text, normal.as_vec3().to_array());
            text.push_str("\n  outer loop\n");
            for corner in corners {
                text.push_str("    vertex");
                append_all(&mut text, corner.to_array());
                text.push('\n');
            }
            text.push_str("  endloop\nendfacet\n");
        }
        let _ = writeln!(text, "{}", format!("endsolid {name}").trim_end());
    }
    Ok(text)
}
