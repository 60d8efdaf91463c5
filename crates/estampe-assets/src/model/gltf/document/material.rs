//! Materials, textures, samplers, images.

use super::{Index, Text};
use serde::Deserialize;

/// A material.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Material {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) pbr_metallic_roughness: MetallicRoughness,
    pub(crate) normal_texture: Option<TextureInfo>,
    pub(crate) occlusion_texture: Option<TextureInfo>,
    pub(crate) emissive_texture: Option<TextureInfo>,
    pub(crate) emissive_factor: Option<[f32; 3]>,
    pub(crate) alpha_mode: Option<String>,
    pub(crate) alpha_cutoff: Option<f32>,
    #[serde(default)]
    pub(crate) double_sided: bool,
    pub(crate) extensions: Option<Box<MaterialExtensions>>,
}

/// The base of a material.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct MetallicRoughness {
    pub(crate) base_color_factor: Option<[f32; 4]>,
    pub(crate) base_color_texture: Option<TextureInfo>,
    pub(crate) metallic_factor: Option<f32>,
    pub(crate) roughness_factor: Option<f32>,
    pub(crate) metallic_roughness_texture: Option<TextureInfo>,
}

/// A texture as a material uses it.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextureInfo {
    pub(crate) index: Index,
    #[serde(default)]
    pub(crate) tex_coord: Index,
    /// Of normal textures.
    pub(crate) scale: Option<f32>,
    /// Of occlusion textures.
    pub(crate) strength: Option<f32>,
    #[serde(default)]
    pub(crate) extensions: TextureInfoExtensions,
}

/// Extensions of a use of a texture.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(crate) transform: Option<Box<TextureTransform>>,
}

/// KHR_texture_transform.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextureTransform {
    pub(crate) offset: Option<[f32; 2]>,
    pub(crate) rotation: Option<f32>,
    pub(crate) scale: Option<[f32; 2]>,
    pub(crate) tex_coord: Option<Index>,
}

/// An image with its sampler.
#[derive(Debug, Deserialize)]
pub(crate) struct Texture {
    pub(crate) sampler: Option<Index>,
    pub(crate) source: Option<Index>,
    #[serde(default)]
    pub(crate) extensions: TextureExtensions,
}

/// Extensions of a texture: the same image in other formats.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct TextureExtensions {
    #[serde(rename = "EXT_texture_webp")]
    pub(crate) webp: Option<TextureSource>,
    #[serde(rename = "MSFT_texture_dds")]
    pub(crate) dds: Option<TextureSource>,
    #[serde(rename = "KHR_texture_basisu")]
    pub(crate) basisu: Option<TextureSource>,
}

/// An image in another format.
#[derive(Debug, Deserialize)]
pub(crate) struct TextureSource {
    pub(crate) source: Option<Index>,
}

/// OpenGL's numbers of filters and address modes.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Sampler {
    pub(crate) mag_filter: Option<Index>,
    pub(crate) min_filter: Option<Index>,
    pub(crate) wrap_s: Option<Index>,
    pub(crate) wrap_t: Option<Index>,
}

/// The file of an image.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Image<'a> {
    #[serde(borrow)]
    pub(crate) uri: Option<Text<'a>>,
    pub(crate) buffer_view: Option<Index>,
}

/// Extensions of a material.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_unlit")]
    pub(crate) unlit: Option<Unlit>,
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(crate) emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_ior")]
    pub(crate) ior: Option<Ior>,
    #[serde(rename = "KHR_materials_dispersion")]
    pub(crate) dispersion: Option<Dispersion>,
    #[serde(rename = "KHR_materials_specular")]
    pub(crate) specular: Option<Specular>,
    #[serde(rename = "KHR_materials_transmission")]
    pub(crate) transmission: Option<Transmission>,
    #[serde(rename = "KHR_materials_volume")]
    pub(crate) volume: Option<Volume>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub(crate) clearcoat: Option<Clearcoat>,
    #[serde(rename = "KHR_materials_sheen")]
    pub(crate) sheen: Option<Sheen>,
    #[serde(rename = "KHR_materials_anisotropy")]
    pub(crate) anisotropy: Option<Anisotropy>,
    #[serde(rename = "KHR_materials_iridescence")]
    pub(crate) iridescence: Option<Iridescence>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(crate) specular_glossiness: Option<SpecularGlossiness>,
}

/// KHR_materials_unlit has no properties.
#[derive(Debug, Deserialize)]
pub(crate) struct Unlit {}

/// KHR_materials_emissive_strength.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct EmissiveStrength {
    pub(crate) emissive_strength: Option<f32>,
}

/// KHR_materials_ior.
#[derive(Debug, Deserialize)]
pub(crate) struct Ior {
    pub(crate) ior: Option<f32>,
}

/// KHR_materials_dispersion.
#[derive(Debug, Deserialize)]
pub(crate) struct Dispersion {
    pub(crate) dispersion: Option<f32>,
}

/// KHR_materials_specular.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Specular {
    pub(crate) specular_factor: Option<f32>,
    pub(crate) specular_texture: Option<TextureInfo>,
    pub(crate) specular_color_factor: Option<[f32; 3]>,
    pub(crate) specular_color_texture: Option<TextureInfo>,
}

/// KHR_materials_transmission.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Transmission {
    pub(crate) transmission_factor: Option<f32>,
    pub(crate) transmission_texture: Option<TextureInfo>,
}

/// KHR_materials_volume.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Volume {
    pub(crate) thickness_factor: Option<f32>,
    pub(crate) thickness_texture: Option<TextureInfo>,
    pub(crate) attenuation_distance: Option<f32>,
    pub(crate) attenuation_color: Option<[f32; 3]>,
}

/// KHR_materials_clearcoat.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Clearcoat {
    pub(crate) clearcoat_factor: Option<f32>,
    pub(crate) clearcoat_texture: Option<TextureInfo>,
    pub(crate) clearcoat_roughness_factor: Option<f32>,
    pub(crate) clearcoat_roughness_texture: Option<TextureInfo>,
    pub(crate) clearcoat_normal_texture: Option<TextureInfo>,
}

/// KHR_materials_sheen.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Sheen {
    pub(crate) sheen_color_factor: Option<[f32; 3]>,
    pub(crate) sheen_color_texture: Option<TextureInfo>,
    pub(crate) sheen_roughness_factor: Option<f32>,
    pub(crate) sheen_roughness_texture: Option<TextureInfo>,
}

/// KHR_materials_anisotropy.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Anisotropy {
    pub(crate) anisotropy_strength: Option<f32>,
    pub(crate) anisotropy_rotation: Option<f32>,
    pub(crate) anisotropy_texture: Option<TextureInfo>,
}

/// KHR_materials_iridescence.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Iridescence {
    pub(crate) iridescence_factor: Option<f32>,
    pub(crate) iridescence_texture: Option<TextureInfo>,
    pub(crate) iridescence_ior: Option<f32>,
    pub(crate) iridescence_thickness_minimum: Option<f32>,
    pub(crate) iridescence_thickness_maximum: Option<f32>,
    pub(crate) iridescence_thickness_texture: Option<TextureInfo>,
}

/// KHR_materials_pbrSpecularGlossiness.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SpecularGlossiness {
    pub(crate) diffuse_factor: Option<[f32; 4]>,
    pub(crate) diffuse_texture: Option<TextureInfo>,
    pub(crate) specular_factor: Option<[f32; 3]>,
    pub(crate) glossiness_factor: Option<f32>,
    pub(crate) specular_glossiness_texture: Option<TextureInfo>,
}
