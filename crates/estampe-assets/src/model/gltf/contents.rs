//! The hierarchy and the extensions of a file, for reports.

use super::accessor::Accessors;
use super::document::Document;
use super::fault::shortened;
use super::hierarchy::Hierarchy;
use crate::model::contents::{ModelContents, ModelNode};

/// The contents of a scene, whose nodes come parents first.
pub(super) fn of(
    nodes: &[usize],
    hierarchy: &Hierarchy,
    document: &Document<'_>,
    accessors: &Accessors<'_>,
) -> ModelContents {
    let mut depths = vec![0_usize; document.nodes.len()];
    let node = |&index: &usize| {
        let node = &document.nodes[index];
        depths[index] = hierarchy
            .parent(index)
            .map_or(0, |parent| depths[parent] + 1);
        let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.0));
        let instancing = node.extensions.instancing.as_deref();
        let places = instancing.and_then(|found| found.attributes.values().next());
        let instances = places.and_then(|&places| accessors.count(places, String::new).ok());
        ModelNode {
            name: shortened(&node.name),
            depth: depths[index],
            mesh: mesh.map(|mesh| shortened(&mesh.name)),
            instances: instances.unwrap_or(usize::from(mesh.is_some())),
            has_skin: node.skin.is_some(),
            has_camera: node.camera.is_some(),
            has_light: node.extensions.light.is_some(),
        }
    };
    let used = document.extensions_used.iter();
    ModelContents {
        nodes: nodes.iter().map(node).collect(),
        extensions: used.map(|name| shortened(name)).collect(),
        has_made_normals: Vec::new(),
        image_sizes: Vec::new(),
    }
}
