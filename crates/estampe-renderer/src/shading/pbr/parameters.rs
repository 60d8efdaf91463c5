//! The parameters of a physically based surface, as its shader reads them.

use super::textures::MaterialTexture;
use super::transmission::TransmissionParameters;

/// The parameters of a surface: each factor is multiplied by its texture.
#[derive(Debug, Clone)]
pub(crate) struct PbrParameters {
    /// Linear RGBA.
    pub(crate) base: [f32; 4],
    pub(crate) base_texture: Option<MaterialTexture>,
    pub(crate) metallic: f32,
    /// Perceptual.
    pub(crate) roughness: f32,
    /// The metallic share is multiplied by the texture.
    pub(crate) is_metallic_textured: bool,
    /// The roughness is multiplied by the texture.
    pub(crate) is_roughness_textured: bool,
    /// Roughness in green, metallic in blue.
    pub(crate) metallic_roughness_texture: Option<MaterialTexture>,
    pub(crate) normal: Option<NormalMap>,
    pub(crate) occlusion: Option<Occlusion>,
    pub(crate) emissive: [f32; 3],
    pub(crate) emissive_texture: Option<MaterialTexture>,
    /// Reflectance of a dielectric at normal incidence.
    pub(crate) dielectric_f0: f32,
    pub(crate) specular: Option<SpecularParameters>,
    pub(crate) clearcoat: Option<ClearcoatParameters>,
    pub(crate) sheen: Option<SheenParameters>,
    pub(crate) anisotropy: Option<AnisotropyParameters>,
    pub(crate) iridescence: Option<IridescenceParameters>,
    pub(crate) transmission: Option<TransmissionParameters>,
    /// The colour is the base colour.
    pub(crate) is_unlit: bool,
    /// Fragments whose alpha is less are discarded, if the surface is cut out.
    pub(crate) alpha_cutoff: f32,
}

/// A texture of normals in tangent space.
#[derive(Debug, Clone)]
pub(crate) struct NormalMap {
    pub(crate) texture: MaterialTexture,
    /// Factor of x and y.
    pub(crate) scale: f32,
}

/// Occlusion of the light from all around, in red.
#[derive(Debug, Clone)]
pub(crate) struct Occlusion {
    pub(crate) texture: MaterialTexture,
    pub(crate) strength: f32,
}

/// Specular reflection of dielectrics (KHR_materials_specular).
#[derive(Debug, Clone)]
pub(crate) struct SpecularParameters {
    pub(crate) factor: f32,
    /// In alpha.
    pub(crate) texture: Option<MaterialTexture>,
    pub(crate) color: [f32; 3],
    pub(crate) color_texture: Option<MaterialTexture>,
}

/// A clear layer on top (KHR_materials_clearcoat).
#[derive(Debug, Clone)]
pub(crate) struct ClearcoatParameters {
    pub(crate) factor: f32,
    /// In red.
    pub(crate) texture: Option<MaterialTexture>,
    pub(crate) roughness: f32,
    /// In green.
    pub(crate) roughness_texture: Option<MaterialTexture>,
    pub(crate) normal: Option<NormalMap>,
}

/// Fibres on top (KHR_materials_sheen).
#[derive(Debug, Clone)]
pub(crate) struct SheenParameters {
    pub(crate) color: [f32; 3],
    pub(crate) color_texture: Option<MaterialTexture>,
    pub(crate) roughness: f32,
    /// In alpha.
    pub(crate) roughness_texture: Option<MaterialTexture>,
}

/// Roughness that depends on the direction (KHR_materials_anisotropy).
#[derive(Debug, Clone)]
pub(crate) struct AnisotropyParameters {
    pub(crate) strength: f32,
    /// Cosine and sine of the rotation, counter-clockwise from the tangent.
    pub(crate) rotation: [f32; 2],
    /// Direction in red and green, strength in blue.
    pub(crate) texture: Option<MaterialTexture>,
}

/// A thin film (KHR_materials_iridescence).
#[derive(Debug, Clone)]
pub(crate) struct IridescenceParameters {
    pub(crate) factor: f32,
    /// In red.
    pub(crate) texture: Option<MaterialTexture>,
    /// At least 1.
    pub(crate) ior: f32,
    /// Where the texture is 0, and where it is 1.
    pub(crate) thickness_nm: [f32; 2],
    /// In green.
    pub(crate) thickness_texture: Option<MaterialTexture>,
}
