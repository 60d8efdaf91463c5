//! Physically based surfaces: metallic and rough, as glTF 2.0 describes them. Row F4.
//!
//! ```text
//! parameters, textures   what a material says
//!   -> surface           the shader: a point of the surface for each fragment
//!        ├─ reflection   the light that the point reflects, lobe by lobe
//!        │    ├─ brdf         densities, visibilities, Fresnel
//!        │    ├─ environment  light from all around
//!        │    └─ lights       light from points and directions
//!        └─ tone_map     from radiance to what is shown
//! ```

pub(crate) mod brdf;
pub(crate) mod environment;
pub(crate) mod lights;
pub(crate) mod parameters;
pub(crate) mod reflection;
pub(crate) mod surface;
pub(crate) mod textures;
pub(crate) mod tone_map;

#[cfg(test)]
mod tests;
