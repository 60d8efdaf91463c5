//! The parameters of a physically based surface, as its shader reads them.

use super::textures::MaterialTexture;
use super::transmission::TransmissionParameters;

/// The parameters of a surface: each factor is multiplied by its texture.
#[derive(Debug, Clone)]
pub struct PbrParameters {
    /// Linear RGBA.
    pub base: [f32; 4],
    pub base_texture: Option<MaterialTexture>,
    pub metallic: f32,
    /// Perceptual.
    pub roughness: f32,
    /// The metallic share is multiplied by the texture.
    pub is_metallic_textured: bool,
    /// The roughness is multiplied by the texture.
    pub is_roughness_textured: bool,
    /// Roughness in green, metallic in blue.
    pub metallic_roughness_texture: Option<MaterialTexture>,
    pub normal: Option<NormalMap>,
    pub occlusion: Option<Occlusion>,
    pub emissive: [f32; 3],
    pub emissive_texture: Option<MaterialTexture>,
    /// Reflectance of a dielectric at normal incidence.
    pub dielectric_f0: f32,
    pub specular: Option<SpecularParameters>,
    pub clearcoat: Option<ClearcoatParameters>,
    pub sheen: Option<SheenParameters>,
    pub anisotropy: Option<AnisotropyParameters>,
    pub iridescence: Option<IridescenceParameters>,
    pub transmission: Option<TransmissionParameters>,
    /// The colour is the base colour.
    pub is_unlit: bool,
    /// Fragments whose alpha is less are discarded, if the surface is cut out.
    pub alpha_cutoff: f32,
}

/// A texture of normals in tangent space.
#[derive(Debug, Clone)]
pub struct NormalMap {
    pub texture: MaterialTexture,
    /// Factor of x and y.
    pub scale: f32,
}

/// Occlusion of the light from all around, in red.
#[derive(Debug, Clone)]
pub struct Occlusion {
    pub texture: MaterialTexture,
    pub strength: f32,
}

/// Specular reflection of dielectrics (KHR_materials_specular).
#[derive(Debug, Clone)]
pub struct SpecularParameters {
    pub factor: f32,
    /// In alpha.
    pub texture: Option<MaterialTexture>,
    pub color: [f32; 3],
    pub color_texture: Option<MaterialTexture>,
}

/// A clear layer on top (KHR_materials_clearcoat).
#[derive(Debug, Clone)]
pub struct ClearcoatParameters {
    pub factor: f32,
    /// In red.
    pub texture: Option<MaterialTexture>,
    pub roughness: f32,
    /// In green.
    pub roughness_texture: Option<MaterialTexture>,
    pub normal: Option<NormalMap>,
}

/// Fibres on top (KHR_materials_sheen).
#[derive(Debug, Clone)]
pub struct SheenParameters {
    pub color: [f32; 3],
    pub color_texture: Option<MaterialTexture>,
    pub roughness: f32,
    /// In alpha.
    pub roughness_texture: Option<MaterialTexture>,
}

/// Roughness that depends on the direction (KHR_materials_anisotropy).
#[derive(Debug, Clone)]
pub struct AnisotropyParameters {
    pub strength: f32,
    /// Cosine and sine of the rotation, counter-clockwise from the tangent.
    pub rotation: [f32; 2],
    /// Direction in red and green, strength in blue.
    pub texture: Option<MaterialTexture>,
}

/// A thin film (KHR_materials_iridescence).
#[derive(Debug, Clone)]
pub struct IridescenceParameters {
    pub factor: f32,
    /// In red.
    pub texture: Option<MaterialTexture>,
    /// At least 1.
    pub ior: f32,
    /// Where the texture is 0, and where it is 1.
    pub thickness_nm: [f32; 2],
    /// In green.
    pub thickness_texture: Option<MaterialTexture>,
}
