//! Bytes of the decoded model, and the sources of its normals and tangents.

use crate::input::Model;
use estampe_assets::ModelFormat;
use estampe_scene::{Mesh, Scene};

/// Bytes of vertices with all attributes and of indices.
pub(super) fn geometry_bytes(scene: &Scene) -> u64 {
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
    scene.meshes.iter().map(of_mesh).sum::<usize>() as u64
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

/// The source of a mesh's tangents. They are made if a normal texture or an anisotropic material
/// needs them and the mesh has the texture coordinates; `None` if nothing needs them.
pub(super) fn tangents(model: &Model, at: usize) -> Option<&'static str> {
    let mesh = &model.scene.meshes[at];
    if mesh.attribute(Mesh::TANGENT).is_some() {
        return Some(FILE);
    }
    let mut used = mesh.surfaces.iter().filter_map(|surface| surface.material);
    let uv_set = used.find_map(|material| {
        let pbr = model.scene.materials[material].pbr.as_ref()?;
        pbr.tangent_uv_set()
    })?;
    let has_uvs = match uv_set {
        1 => mesh.attribute(Mesh::UV1).is_some(),
        _ => !mesh.uvs.is_empty(),
    };
    (has_uvs && !mesh.normals.is_empty()).then_some(MADE)
}

/// The attributes of a mesh besides positions, each with its source.
pub(super) fn attributes(model: &Model, at: usize) -> Vec<(&'static str, &'static str)> {
    let mesh = &model.scene.meshes[at];
    let file = |is_there: bool| is_there.then_some(FILE);
    let sources = [
        ("normals", normals(model, at)),
        ("tangents", tangents(model, at)),
        ("uvs", file(!mesh.uvs.is_empty())),
        ("uvs1", file(mesh.attribute(Mesh::UV1).is_some())),
        ("colors", file(!mesh.colors.is_empty())),
    ];
    let found = sources.into_iter();
    found
        .filter_map(|(name, source)| Some((name, source?)))
        .collect()
}

/// The names of the attributes in memory: tangents that are made are those of a picture.
pub(super) fn stored(model: &Model, at: usize) -> Vec<&'static str> {
    let is_stored = |found: &(&str, &str)| *found != ("tangents", MADE);
    let all = attributes(model, at).into_iter();
    all.filter(is_stored).map(|(name, _)| name).collect()
}

/// The unit of the model's lengths, where the format states one.
pub(super) fn unit(model: &Model) -> Option<&'static str> {
    match model.format {
        Some(ModelFormat::Gltf) => Some("m"),
        Some(ModelFormat::ThreeMf) => Some("mm"),
        _ => None,
    }
}
