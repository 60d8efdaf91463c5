//! Procedural data of the scenes: meshes, textures and matrices, equal to the bit for all compared
//! renderers.
//!
//! The numbers follow `peerbench`'s definition, in separate code; [`Fingerprint`] proves that they
//! agree:
//!
//! * real arithmetic is binary64 with `+ − × ÷ √` alone, in a fixed order, and is rounded to
//!   binary32 once, when a number is stored ([`LittleEndian::reals`]);
//! * sine and cosine are a series of our own ([`sin_cos_turns`]), because libraries differ;
//! * texels are integers, except normals, which follow the first rule; each mip level is the
//!   rounded mean of 2×2 texels of the previous one.
//!
//! So the order of operations in these files is part of the definition and must not be changed.

mod bytes;
mod fingerprint;
mod hash;
mod leaves;
mod mesh;
mod noise;
mod sky;
mod texture;
mod transform;
mod turns;

pub use bytes::LittleEndian;
pub use fingerprint::Fingerprint;
pub use hash::{hash32, unit_hash};
pub use leaves::leaf_textures;
pub use mesh::{IndexedMesh, QUAD_CORNERS, quad_indices, torus, uv_sphere};
pub use sky::sky_cube;
pub use texture::{MipChain, diffuse_texture, normal_texture};
pub use transform::{
    Matrix, Vector, cross, dot, look_at, normalize, orthographic, perspective, view_rays,
};
pub use turns::sin_cos_turns;

#[cfg(test)]
mod tests;
