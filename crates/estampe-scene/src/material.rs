//! Materials of surfaces.

use crate::PbrMaterial;
use glam::Vec3;

/// A surface material, as OBJ's MTL describes it, and its physically based description if the file
/// has one.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the file; may be empty.
    pub name: String,
    /// Base colour, linear; multiplied by the base-colour texture and the vertex colour.
    pub base_color: Vec3,
    /// Opacity: 1 opaque, 0 invisible.
    pub opacity: f32,
    /// Specular colour, linear.
    pub specular: Vec3,
    /// Specular exponent of the Phong model.
    pub shininess: f32,
    /// Emitted light, linear.
    pub emissive: Vec3,
    /// Index into `Scene::images` of the sRGB base-colour texture.
    pub base_color_texture: Option<usize>,
    /// Index into `Scene::images` of the bump map: a texture of heights, which are the mean of red,
    /// green and blue, linear.
    pub bump_texture: Option<usize>,
    /// Factor of the heights; negative ones make dents.
    pub bump_scale: f32,
    /// Use of the base-colour texture's alpha.
    pub alpha_mode: AlphaMode,
    /// The physically based description, if the file has one. The other fields are then an
    /// approximation of it for the Phong model.
    pub pbr: Option<Box<PbrMaterial>>,
}

/// Use of a material's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Fragments with alpha below ½ are discarded.
    Mask,
    /// Source-over blending.
    Blend,
}

impl Default for Material {
    /// Light grey, opaque, a soft highlight.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec3::splat(0.6),
            opacity: 1.0,
            specular: Vec3::splat(0.15),
            shininess: 32.0,
            emissive: Vec3::ZERO,
            base_color_texture: None,
            bump_texture: None,
            bump_scale: 1.0,
            alpha_mode: AlphaMode::Opaque,
            pbr: None,
        }
    }
}
