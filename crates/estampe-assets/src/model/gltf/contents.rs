//! The hierarchy and the extensions of a file, for reports.

use super::accessor::Accessors;
use super::document::Document;
use super::fault::shortened;
use super::hierarchy::Hierarchy;
use crate::model::contents::{ModelContents, ModelNode};
use std::collections::HashMap;

/// The contents of a scene, whose nodes come parents first.
pub(super) fn of(
    nodes: &[usize],
    hierarchy: &Hierarchy,
    document: &Document<'_>,
    accessors: &Accessors<'_>,
) -> ModelContents {
    let mut depths = HashMap::new();
    let node = |&index: &usize| {
        let node = &document.nodes[index];
        let above = hierarchy
            .parent(index)
            .and_then(|parent| depths.get(&parent));
        let depth = above.map_or(0, |depth: &usize| depth + 1);
        depths.insert(index, depth);
        let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.0));
        let instancing = node.extensions.instancing.as_deref();
        let places = instancing.and_then(|found| found.attributes.values().next());
        let instances = places.and_then(|&places| accessors.count(places, String::new).ok());
        ModelNode {
            name: shortened(&node.name),
            depth,
            mesh: mesh.map(|mesh| shortened(&mesh.name)),
            instances: instances.unwrap_or(usize::from(mesh.is_some())),
            has_skin: node.skin.is_some(),
            has_camera: node.camera.is_some(),
            has_light: node.extensions.light.is_some(),
        }
    };
    let used = document.extensions_used.iter();
    ModelContents {
        nodes: nodes
            .iter()
            .take(ModelContents::MAX_NODES)
            .map(node)
            .collect(),
        node_count: nodes.len(),
        extensions: { used.take(ModelContents::MAX_EXTENSIONS) }
            .map(|name| shortened(name))
            .collect(),
        has_made_normals: Vec::new(),
        image_sizes: Vec::new(),
    }
}
