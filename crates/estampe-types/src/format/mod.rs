//! Formats of texels, vertices and indices.

mod texture;
mod vertex;

pub use texture::{SampleType, TexelEncoding, TextureFormat};
pub use vertex::{IndexFormat, VertexEncoding, VertexFormat};
