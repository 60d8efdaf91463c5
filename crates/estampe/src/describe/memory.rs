//! Bytes of the decoded model, and the sources of its normals and tangents.

use crate::input::Model;
use estampe_assets::ModelFormat;
use estampe_scene::{Mesh, Scene};

/// Bytes of vertices with all attributes and of indices.
pub(super) fn geometry_bytes(scene: &Scene) -> usize {
    let of_mesh = |mesh: &Mesh| {
        let attributes = mesh
            .attributes
            .iter()
            .map(|attribute| attribute.values.len());
        size_of_val(&*mesh.positions)
            + size_of_val(&*mesh.normals)
            + size_of_val(&*mesh.uvs)
            + size_of_val(&*mesh.colors)
            + attributes.sum::<usize>() * size_of::<f32>()
            + size_of_val(&*mesh.triangles)
            + size_of_val(&*mesh.lines)
            + size_of_val(&*mesh.points)
    };
    scene.meshes.iter().map(of_mesh).sum()
}

/// Bytes of whole decoded images, without mip levels.
pub(super) fn texture_bytes(model: &Model) -> u64 {
    let sizes = model.contents.image_sizes.iter();
    sizes.map(|&size| image_bytes(size)).sum()
}

/// Bytes of an image of this width and height.
pub(super) fn image_bytes((width, height): (u32, u32)) -> u64 {
    u64::from(width) * u64::from(height) * 4
}

/// Source of an attribute.
pub(super) const FILE: &str = "file";
/// Source of an attribute that is computed.
pub(super) const MADE: &str = "made";

/// The source of a mesh's normals; `None` if it has none.
pub(super) fn normals(model: &Model, at: usize) -> Option<&'static str> {
    let is_made = model.contents.has_made_normals.get(at).copied();
    let has_normals = !model.scene.meshes[at].normals.is_empty();
    has_normals.then_some(if is_made == Some(true) { MADE } else { FILE })
}

/// The source of a mesh's tangents; they are made if a normal texture needs them.
pub(super) fn tangents(model: &Model, at: usize) -> Option<&'static str> {
    let mesh = &model.scene.meshes[at];
    if mesh.attribute(Mesh::TANGENT).is_some() {
        return Some(FILE);
    }
    let mut used = mesh.surfaces.iter().filter_map(|surface| surface.material);
    let needs = |material: usize| {
        let pbr = model.scene.materials[material].pbr.as_deref();
        pbr.is_some_and(|pbr| pbr.normal_texture.is_some())
    };
    used.any(needs).then_some(MADE)
}

/// The unit of the model's lengths, where the format states one.
pub(super) fn unit(model: &Model) -> Option<&'static str> {
    match model.format {
        Some(ModelFormat::Gltf) => Some("m"),
        Some(ModelFormat::ThreeMf) => Some("mm"),
        _ => None,
    }
}
