//! Readers of models: glTF, OBJ with MTL, STL, PLY, OFF and 3MF; and writers of OBJ, STL and PLY.
//!
//! ```text
//! bytes -> gltf | obj | stl | ply | off | threemf  (one folder each: elements -> meshes)
//!       -> finish                  (faces with non-finite corners dropped, limits)
//!       -> normals                 (missing ones)
//!       -> Scene -> write -> bytes
//! ```
//!
//! The readers work on bytes, so no encoding is assumed; names are decoded as UTF-8 or, if that
//! fails, as Latin-1. Side files (material libraries, textures) come from [`Resources`], which
//! decides which files a model may open.

mod contents;
mod corner_split;
mod deferred;
mod detect;
mod encoding;
mod finish;
mod folder;
mod gltf;
mod input;
mod joined;
mod load;
mod mtl;
pub mod normals;
mod number;
mod obj;
mod off;
mod options;
mod ply;
mod polygons;
mod resources;
mod srgb;
mod statements;
mod stl;
mod textures;
mod threemf;
mod vertex_copies;
mod weld;
mod write;

#[cfg(test)]
mod tests;

pub use contents::{ModelContents, ModelNode};
pub use deferred::{FullDetail, LeastDetail, TextureDetail};
pub use detect::ModelFormat;
pub use folder::Folder;
pub use input::{ModelInput, ModelSource, SourceBytes};
pub use load::{
    Loaded, load_model, load_model_with, parse_model, parse_model_for, parse_model_with,
    read_model_for,
};
pub use normals::NormalMode;
pub use options::{AnimationClip, AnimationName, ModelChoices, ModelOptions, TextureAlpha};
pub use resources::{NoResources, ResourceError, Resources};
pub use write::encode_model;
