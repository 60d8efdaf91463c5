#![forbid(unsafe_code)]
//! The plain data of a scene: meshes, materials, images, lights and cameras.
//!
//! Readers (`estampe-assets`) and built-in shapes create these values, and the renderer draws them;
//! this crate depends on neither. Field names state the space: `object` is the file's own space,
//! `world` the scene's (right-handed, Y up). [`Workers`] are threads for work on such data.

mod bounds;
mod camera;
mod hdr_image;
mod image;
mod in_order;
mod light;
mod material;
mod mesh;
mod pbr;
mod texture_ref;
mod workers;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use bounds::Bounds;
pub use camera::{Camera, NamedCamera, Projection};
pub use hdr_image::HdrImage;
pub use image::Image;
pub use light::{Light, LightSource, PunctualLight, PunctualLightKind};
pub use material::{AlphaMode, Material};
pub use mesh::{LineSegment, Mesh, MeshAttribute, Surface, Triangle, UpAxis};
pub use pbr::{
    Anisotropy, Clearcoat, Iridescence, NormalTexture, PbrMaterial, Sheen, SpecularLayer,
    Transmission, Volume,
};
pub use texture_ref::{AddressMode, TextureFilter, TextureRef, TextureSampler, UvTransform};
pub use workers::{Workers, pieces};

/// The contents of one file.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// The meshes, in file order. All are in the same space.
    pub meshes: Vec<Mesh>,
    /// The materials that surfaces refer to by index.
    pub materials: Vec<Material>,
    /// The images that materials refer to by index; straight alpha, row 0 at the top (v = 0).
    pub images: Vec<Image>,
    /// The axis that points up in the file's space.
    pub up: UpAxis,
    /// The cameras of the file, in world space.
    pub cameras: Vec<NamedCamera>,
    /// The lights of the file, in world space.
    pub lights: Vec<PunctualLight>,
}
