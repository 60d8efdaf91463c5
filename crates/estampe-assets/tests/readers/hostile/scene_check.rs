//! Properties that every scene has, however damaged its file was.

use estampe_scene::{Mesh, Scene};

/// Checks the properties that every scene has.
pub(super) fn check(scene: &Scene) {
    for mesh in &scene.meshes {
        check_mesh(mesh, scene.materials.len());
    }
    for material in &scene.materials {
        assert!(material.base_color.is_finite() && material.specular.is_finite());
        assert!((0.0..=1.0).contains(&material.opacity));
        assert!(
            material
                .base_color_texture
                .is_none_or(|image| image < scene.images.len())
        );
    }
    for image in &scene.images {
        assert_eq!(
            image.rgba.len(),
            image.width as usize * image.height as usize * 4
        );
    }
}

fn check_mesh(mesh: &Mesh, material_count: usize) {
    let count = mesh.positions.len();
    let is_empty_or_full = |len: usize| len == 0 || len == count;
    assert!(is_empty_or_full(mesh.normals.len()), "normals");
    assert!(is_empty_or_full(mesh.uvs.len()), "uvs");
    assert!(is_empty_or_full(mesh.colors.len()), "colors");
    assert!(mesh.triangles.is_empty() || !mesh.normals.is_empty());
    let used = mesh.triangles.iter().flatten();
    let used = used.chain(mesh.lines.iter().flatten()).chain(&mesh.points);
    for &vertex in used {
        assert!(
            mesh.positions[vertex as usize].is_finite(),
            "elements have finite corners"
        );
    }
    for normal in &mesh.normals {
        let length = normal.length();
        assert!(length == 0.0 || (length - 1.0).abs() < 1e-5, "{normal}");
    }
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
    assert!(
        mesh.colors
            .iter()
            .flatten()
            .all(|value| (0.0..=1.0).contains(value))
    );
    let mut next = 0;
    for surface in &mesh.surfaces {
        assert_eq!(surface.triangles.start, next, "surfaces have no gaps");
        next = surface.triangles.end;
        assert!(
            surface
                .material
                .is_none_or(|material| material < material_count)
        );
    }
    assert!(mesh.surfaces.is_empty() || next == mesh.triangles.len());
}
