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

pub(crate) mod anisotropy;
pub(crate) mod brdf;
pub(crate) mod environment;
pub(crate) mod iridescence;
pub(crate) mod layers;
pub(crate) mod lights;
pub(crate) mod parameters;
pub(crate) mod reflection;
pub(crate) mod surface;
pub(crate) mod textures;
pub(crate) mod tone_map;
pub(crate) mod transmission;

#[cfg(test)]
mod tests;
