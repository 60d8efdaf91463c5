//! The hierarchy of nodes: its checks, and the world transforms.
//!
//! Nodes are visited with a list of pending ones instead of recursion, so that any depth is read.

use super::document::{Document, Index, Node};
use super::fault::{element, malformed};
use super::pose::Pose;
use crate::AssetError;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// The nodes in an order in which parents come before their children.
pub(super) struct Hierarchy {
    parents: Vec<Option<usize>>,
    order: Vec<usize>,
}

impl Hierarchy {
    /// Checks that every node has at most one parent, and that none is its own ancestor.
    pub(super) fn new(document: &Document<'_>) -> Result<Self, AssetError> {
        let nodes = &document.nodes;
        let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
        for (parent, node) in nodes.iter().enumerate() {
            for (at, &child) in node.children.iter().enumerate() {
                let pointer = || format!("/nodes/{parent}/children/{at}");
                element(nodes, child, "node", pointer)?;
                if let Some(other) = parents[child.0].replace(parent) {
                    let what =
                        format!("node {child} is a child of node {other} too; it has one parent");
                    return Err(malformed(pointer(), what));
                }
            }
        }
        let roots = (0..nodes.len()).filter(|&node| parents[node].is_none());
        let order = depth_first(nodes, roots.collect());
        if order.len() < nodes.len() {
            // Only nodes of cycles are not below a root.
            let mut is_visited = vec![false; nodes.len()];
            for &node in &order {
                is_visited[node] = true;
            }
            let node = is_visited.iter().position(|visited| !visited);
            return Err(malformed(
                format!("/nodes/{}", node.unwrap_or_default()),
                "the node is its own ancestor",
            ));
        }
        Ok(Self { parents, order })
    }

    /// The nodes of a scene, or all of them.
    pub(super) fn nodes_of_scene(
        &self,
        scene: Option<Index>,
        document: &Document<'_>,
    ) -> Result<Vec<usize>, AssetError> {
        let Some(index) = scene else {
            return Ok(self.order.clone());
        };
        let scene = element(&document.scenes, index, "scene", || "/scene".to_owned())?;
        let mut is_root = vec![false; document.nodes.len()];
        let mut roots = Vec::with_capacity(scene.nodes.len());
        for (at, &node) in scene.nodes.iter().enumerate() {
            let pointer = || format!("/scenes/{index}/nodes/{at}");
            element(&document.nodes, node, "node", pointer)?;
            if let Some(parent) = self.parents[node.0] {
                let what = format!("node {node} is a child of node {parent}, not a root");
                return Err(malformed(pointer(), what));
            }
            if std::mem::replace(&mut is_root[node.0], true) {
                let what = format!("node {node} is in the scene twice");
                return Err(malformed(pointer(), what));
            }
            roots.push(node.0);
        }
        Ok(depth_first(&document.nodes, roots))
    }

    /// The parent of a node.
    pub(super) fn parent(&self, node: usize) -> Option<usize> {
        self.parents[node]
    }

    /// The transform of each node from its own space to the world's.
    pub(super) fn world_transforms(&self, document: &Document<'_>, pose: &Pose) -> Vec<DAffine3> {
        let mut world_from_node = vec![DAffine3::IDENTITY; document.nodes.len()];
        for &node in &self.order {
            let parent_from_node = local_transform(node, &document.nodes[node], pose);
            world_from_node[node] = match self.parents[node] {
                Some(parent) => world_from_node[parent] * parent_from_node,
                None => parent_from_node,
            };
        }
        world_from_node
    }
}

/// The nodes below the roots, parents before children, in file order.
fn depth_first(nodes: &[Node], mut roots: Vec<usize>) -> Vec<usize> {
    roots.reverse();
    let mut pending = roots;
    let mut order = Vec::with_capacity(nodes.len());
    while let Some(node) = pending.pop() {
        order.push(node);
        pending.extend(nodes[node].children.iter().rev().map(|child| child.0));
    }
    order
}

fn local_transform(index: usize, node: &Node, pose: &Pose) -> DAffine3 {
    let animated = pose.of_node(index);
    let is_animated = animated.is_some_and(|pose| pose.moves());
    if let Some(matrix) = &node.matrix
        && !is_animated
    {
        let column = |at: usize| DVec3::new(matrix[at], matrix[at + 1], matrix[at + 2]);
        return DAffine3 {
            matrix3: DMat3::from_cols(column(0), column(4), column(8)),
            translation: column(12),
        };
    }
    let translation = animated
        .and_then(|pose| pose.translation)
        .or(node.translation);
    let rotation = animated.and_then(|pose| pose.rotation).or(node.rotation);
    let scale = animated.and_then(|pose| pose.scale).or(node.scale);
    transform(
        translation.unwrap_or([0.0; 3]),
        rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
        scale.unwrap_or([1.0; 3]),
    )
}

/// Scale, then rotation by a quaternion (x, y, z, w) of any length, then translation.
pub(super) fn transform(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> DAffine3 {
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    let rotation = if length > 0.0 && length.is_finite() {
        rotation / length
    } else {
        DQuat::IDENTITY
    };
    DAffine3::from_scale_rotation_translation(
        DVec3::from_array(scale),
        rotation,
        DVec3::from_array(translation),
    )
}
