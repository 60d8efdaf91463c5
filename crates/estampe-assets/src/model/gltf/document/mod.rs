//! The JSON part of a file as plain data: glTF 2.0's properties that are read, and no others.
//!
//! Types say what serde can check: kinds of values and required properties. Everything else
//! (indices, names of enumerations, ranges) is checked where it is used, where the message can say
//! more.
//! The crate `gltf-json` was not used: it refuses extensions that it does not know in typed places,
//! and has no types for half of those that are read here.

mod animation;

mod material;
mod node;
mod storage;
mod value;

pub(super) use animation::{Animation, AnimationChannel, AnimationSampler};
pub(super) use material::{
    Image, Material, MaterialExtensions, Sampler, SpecularGlossiness, Texture, TextureInfo,
    TextureSource,
};
pub(super) use node::{Camera, Instancing, Light, Mesh, Node, Primitive, Skin};
pub(super) use storage::{Accessor, Buffer, BufferView, MeshoptView, Sparse};
pub(super) use value::{Index, Text};

use serde::Deserialize;

/// The root of the JSON.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    pub(super) asset: Asset,
    pub(super) scene: Option<Index>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(super) skins: Vec<Skin>,
    #[serde(default)]
    pub(super) cameras: Vec<Camera>,
    #[serde(default)]
    pub(super) animations: Vec<Animation>,
    #[serde(default)]
    pub(super) materials: Vec<Material>,
    #[serde(default)]
    pub(super) textures: Vec<Texture>,
    #[serde(default)]
    pub(super) samplers: Vec<Sampler>,
    #[serde(borrow, default)]
    pub(super) images: Vec<Image<'a>>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(borrow, default)]
    pub(super) buffers: Vec<Buffer<'a>>,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    #[serde(default)]
    pub(super) extensions: Extensions,
}

/// Versions.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Asset {
    pub(super) version: String,
    pub(super) min_version: Option<String>,
}

/// A scene: its root nodes.
#[derive(Debug, Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) name: String,
    #[serde(default)]
    pub(super) nodes: Vec<Index>,
}

/// Extensions of the root.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Extensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) lights: Option<Lights>,
    #[serde(rename = "KHR_materials_variants")]
    pub(super) variants: Option<Variants>,
}

impl Extensions {
    /// The lights that nodes refer to.
    pub(super) fn lights(&self) -> &[Light] {
        self.lights.as_ref().map_or(&[], |found| &found.lights)
    }

    /// The alternative sets of materials.
    pub(super) fn variants(&self) -> &[Variant] {
        self.variants.as_ref().map_or(&[], |found| &found.variants)
    }
}

/// The lights that nodes refer to.
#[derive(Debug, Deserialize)]
pub(super) struct Lights {
    #[serde(default)]
    pub(super) lights: Vec<Light>,
}

/// The names of alternative sets of materials.
#[derive(Debug, Deserialize)]
pub(super) struct Variants {
    #[serde(default)]
    pub(super) variants: Vec<Variant>,
}

/// An alternative set of materials.
#[derive(Debug, Deserialize)]
pub(super) struct Variant {
    pub(super) name: String,
}
