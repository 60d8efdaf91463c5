//! Physically based materials: metallic and rough, with the layers of glTF's extensions.
//!
//! Each factor is multiplied by its texture. Colours are linear; the RGB channels of colour
//! textures are sRGB-encoded, and all other channels hold numbers as they are.

use crate::{AlphaMode, TextureRef};
use glam::{Vec3, Vec4};

/// A physically based material: glTF 2.0's metallic-roughness model and its extensions.
#[derive(Debug, Clone, PartialEq)]
pub struct PbrMaterial {
    /// Colour and alpha: diffuse reflection of dielectrics, specular reflection of metals.
    pub base_color: Vec4,
    /// Factor of the base colour and alpha: RGB sRGB-encoded.
    pub base_color_texture: Option<TextureRef>,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, the square root of the α of GGX: 0 smooth, 1 rough.
    pub roughness: f32,
    /// Factors: roughness in green, metallic in blue.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Normals in tangent space.
    pub normal_texture: Option<NormalTexture>,
    /// Occlusion of ambient light, in red.
    pub occlusion_texture: Option<TextureRef>,
    /// Influence of the occlusion: the factor of ambient light is 1 + strength · (texel − 1).
    pub occlusion_strength: f32,
    /// Emitted light.
    pub emissive: Vec3,
    /// Factor of the emitted light: RGB sRGB-encoded.
    pub emissive_texture: Option<TextureRef>,
    /// Factor of the emitted light, which may exceed 1. With it the unit is cd/m².
    pub emissive_strength: f32,
    /// With [`AlphaMode::Mask`](crate::AlphaMode::Mask), fragments whose alpha is less are
    /// discarded.
    pub alpha_cutoff: f32,
    /// Use of alpha, if it is not that of [`Material::alpha_mode`](crate::Material): shadings
    /// without [`Self::transmission`] blend materials whose alpha the file ignores. The opacity is
    /// then that of [`Self::base_color`].
    pub alpha_mode: Option<AlphaMode>,
    /// The back of faces is visible too, with the normal turned.
    pub is_double_sided: bool,
    /// The colour is the base colour; light has no influence (KHR_materials_unlit).
    pub is_unlit: bool,
    /// Index of refraction of a dielectric (KHR_materials_ior). 0 means total reflection: the
    /// specular colour alone decides.
    pub ior: f32,
    /// KHR_materials_dispersion: 20 divided by the Abbe number; 0 is none.
    pub dispersion: f32,
    /// Specular reflection of dielectrics (KHR_materials_specular).
    pub specular: Option<SpecularLayer>,
    /// Light passes through the surface (KHR_materials_transmission).
    pub transmission: Option<Transmission>,
    /// The body below the surface (KHR_materials_volume).
    pub volume: Option<Volume>,
    /// A clear layer on top (KHR_materials_clearcoat).
    pub clearcoat: Option<Clearcoat>,
    /// Fibres on top, as of velvet (KHR_materials_sheen).
    pub sheen: Option<Sheen>,
    /// Roughness that depends on the direction (KHR_materials_anisotropy).
    pub anisotropy: Option<Anisotropy>,
    /// A thin film (KHR_materials_iridescence).
    pub iridescence: Option<Iridescence>,
}

impl PbrMaterial {
    /// The set of texture coordinates along which the tangents of surfaces go: that of the normal
    /// texture, else of the clearcoat's, else of the anisotropy's; `None` if nothing needs
    /// tangents.
    #[must_use]
    pub fn tangent_uv_set(&self) -> Option<u8> {
        let coat = self.clearcoat.and_then(|coat| coat.normal_texture);
        let map = self.normal_texture.or(coat);
        let direction = self.anisotropy.map(|layer| {
            let texture = layer.texture.map(|texture| texture.uv_set);
            texture.unwrap_or_default()
        });
        map.map(|map| map.texture.uv_set).or(direction)
    }
}

impl Default for PbrMaterial {
    /// glTF's defaults: white, metallic, rough.
    fn default() -> Self {
        Self {
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            emissive_strength: 1.0,
            alpha_cutoff: 0.5,
            alpha_mode: None,
            is_double_sided: false,
            is_unlit: false,
            ior: 1.5,
            dispersion: 0.0,
            specular: None,
            transmission: None,
            volume: None,
            clearcoat: None,
            sheen: None,
            anisotropy: None,
            iridescence: None,
        }
    }
}

/// A texture of normals: x right (along the tangent), y up (along the bitangent), z outwards, each
/// −1..1 stored as 0..255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalTexture {
    /// The texture.
    pub texture: TextureRef,
    /// Factor of x and y.
    pub scale: f32,
}

/// Specular reflection of dielectrics: at normal incidence
/// min(((ior − 1) ÷ (ior + 1))² · color, 1) · factor, at grazing angles `factor`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecularLayer {
    /// Strength of the reflection.
    pub factor: f32,
    /// Factor of the strength, in alpha.
    pub texture: Option<TextureRef>,
    /// Colour at normal incidence; may exceed 1.
    pub color: Vec3,
    /// Factor of the colour: RGB sRGB-encoded.
    pub color_texture: Option<TextureRef>,
}

/// Light that passes through the surface instead of being diffused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transmission {
    /// The part that passes, 0..1.
    pub factor: f32,
    /// Factor, in red.
    pub texture: Option<TextureRef>,
}

/// The body below the surface. Without it the surface is infinitely thin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Thickness in the space of the file's mesh, which [`Mesh::scale`](crate::Mesh::scale) leads
    /// to world units; 0 is a thin surface.
    pub thickness: f32,
    /// Factor of the thickness, in green.
    pub thickness_texture: Option<TextureRef>,
    /// Mean distance, in world units, after which light is absorbed; ∞ is clear.
    pub attenuation_distance: f32,
    /// Colour of white light after that distance.
    pub attenuation_color: Vec3,
}

/// A clear layer on top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearcoat {
    /// Strength, 0..1.
    pub factor: f32,
    /// Factor of the strength, in red.
    pub texture: Option<TextureRef>,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Factor of the roughness, in green.
    pub roughness_texture: Option<TextureRef>,
    /// Normals of the layer; `None` is the normal of the mesh.
    pub normal_texture: Option<NormalTexture>,
}

/// Fibres on top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheen {
    /// Colour; black is none.
    pub color: Vec3,
    /// Factor of the colour: RGB sRGB-encoded.
    pub color_texture: Option<TextureRef>,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Factor of the roughness, in alpha.
    pub roughness_texture: Option<TextureRef>,
}

/// Roughness that depends on the direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropy {
    /// Strength, 0..1.
    pub strength: f32,
    /// Direction of the stretched highlight: counter-clockwise from the tangent.
    pub rotation_rad: f32,
    /// Direction in red and green (−1..1 as 0..255), factor of the strength in blue.
    pub texture: Option<TextureRef>,
}

/// A thin film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iridescence {
    /// Strength, 0..1.
    pub factor: f32,
    /// Factor of the strength, in red.
    pub texture: Option<TextureRef>,
    /// Index of refraction of the film.
    pub ior: f32,
    /// Thickness where the texture is 0.
    pub thickness_min_nm: f32,
    /// Thickness where the texture is 1, and without a texture.
    pub thickness_max_nm: f32,
    /// Thickness between the two, in green.
    pub thickness_texture: Option<TextureRef>,
}
