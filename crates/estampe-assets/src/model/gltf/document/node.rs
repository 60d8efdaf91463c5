//! Nodes and what they place: meshes, skins, cameras, lights.

use super::Index;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A node of the hierarchy.
#[derive(Debug, Deserialize)]
pub(crate) struct Node {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) children: Vec<Index>,
    pub(crate) matrix: Option<Box<[f64; 16]>>,
    pub(crate) translation: Option<[f64; 3]>,
    pub(crate) rotation: Option<[f64; 4]>,
    pub(crate) scale: Option<[f64; 3]>,
    pub(crate) mesh: Option<Index>,
    pub(crate) skin: Option<Index>,
    pub(crate) camera: Option<Index>,
    #[serde(default)]
    pub(crate) weights: Vec<f32>,
    #[serde(default)]
    pub(crate) extensions: NodeExtensions,
}

/// Extensions of a node.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(crate) light: Option<LightUse>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(crate) instancing: Option<Box<Instancing>>,
}

/// The light of a node.
#[derive(Debug, Deserialize)]
pub(crate) struct LightUse {
    pub(crate) light: Index,
}

/// Places of a node's mesh.
#[derive(Debug, Deserialize)]
pub(crate) struct Instancing {
    pub(crate) attributes: BTreeMap<String, Index>,
}

/// A mesh: primitives with one material each.
#[derive(Debug, Deserialize)]
pub(crate) struct Mesh {
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) primitives: Vec<Primitive>,
    #[serde(default)]
    pub(crate) weights: Vec<f32>,
}

/// Vertices and how they are connected.
#[derive(Debug, Deserialize)]
pub(crate) struct Primitive {
    pub(crate) attributes: BTreeMap<String, Index>,
    pub(crate) indices: Option<Index>,
    pub(crate) material: Option<Index>,
    pub(crate) mode: Option<Index>,
    #[serde(default)]
    pub(crate) targets: Vec<BTreeMap<String, Index>>,
    #[serde(default)]
    pub(crate) extensions: PrimitiveExtensions,
}

/// Extensions of a primitive.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct PrimitiveExtensions {
    #[serde(rename = "KHR_materials_variants")]
    pub(crate) variants: Option<Box<VariantMappings>>,
}

/// The materials of variants.
#[derive(Debug, Deserialize)]
pub(crate) struct VariantMappings {
    #[serde(default)]
    pub(crate) mappings: Vec<VariantMapping>,
}

/// One material, for these variants.
#[derive(Debug, Deserialize)]
pub(crate) struct VariantMapping {
    pub(crate) material: Index,
    #[serde(default)]
    pub(crate) variants: Vec<Index>,
}

/// Joints that move vertices.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Skin {
    pub(crate) inverse_bind_matrices: Option<Index>,
    pub(crate) joints: Vec<Index>,
}

/// A camera; it looks along −z of its node.
#[derive(Debug, Deserialize)]
pub(crate) struct Camera {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(rename = "type")]
    pub(crate) kind: Option<String>,
    pub(crate) perspective: Option<Perspective>,
    pub(crate) orthographic: Option<Orthographic>,
}

/// Perspective projection.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Perspective {
    pub(crate) aspect_ratio: Option<f32>,
    pub(crate) yfov: f32,
    pub(crate) zfar: Option<f32>,
    pub(crate) znear: f32,
}

/// Orthographic projection.
#[derive(Debug, Deserialize)]
pub(crate) struct Orthographic {
    pub(crate) xmag: f32,
    pub(crate) ymag: f32,
    pub(crate) zfar: f32,
    pub(crate) znear: f32,
}

/// A light of KHR_lights_punctual; it shines along −z of its node.
#[derive(Debug, Deserialize)]
pub(crate) struct Light {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(rename = "type")]
    pub(crate) kind: String,
    pub(crate) color: Option<[f32; 3]>,
    pub(crate) intensity: Option<f32>,
    pub(crate) range: Option<f32>,
    pub(crate) spot: Option<Spot>,
}

/// The cone of a spot light.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Spot {
    pub(crate) inner_cone_angle: Option<f32>,
    pub(crate) outer_cone_angle: Option<f32>,
}
