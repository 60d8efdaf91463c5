//! Physically based surfaces: metallic and rough, as glTF 2.0 describes them. Row F4.
//!
//! ```text
//! parameters, textures   what a material says
//!   -> surface           the shader: a point of the surface for each fragment
//!        ├─ layers       what the material's layers are there
//!        ├─ reflection   the light that the point reflects, lobe by lobe
//!        │    ├─ brdf         densities, visibilities, Fresnel
//!        │    ├─ anisotropy   those of surfaces with a direction
//!        │    ├─ iridescence  the Fresnel term of thin films
//!        │    ├─ environment  light from all around
//!        │    └─ lights       light from points and directions
//!        ├─ transmission what is seen through the point
//!        └─ tone_map     from radiance to what is shown
//! ```

pub mod anisotropy;
pub mod brdf;
pub mod environment;
pub mod iridescence;
pub mod layers;
pub mod lights;
pub mod parameters;
pub mod reflection;
pub mod surface;
pub mod textures;
pub mod tone_map;
pub mod transmission;

#[cfg(test)]
mod tests;
