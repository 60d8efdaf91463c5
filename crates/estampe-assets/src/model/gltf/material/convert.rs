//! Materials from JSON: factors within their ranges, defaults, extensions.

use super::super::document::{Document, Material, MaterialExtensions, TextureInfo};
use super::specular_glossiness;
use super::{Draft, texture};
use crate::AssetError;
use crate::model::load::Context;
use estampe_scene::{
    AlphaMode, Anisotropy, Clearcoat, Iridescence, NormalTexture, PbrMaterial, Sheen,
    SpecularLayer, TextureRef, Transmission, Volume,
};
use glam::{Vec3, Vec4};

/// The textures of one material.
pub(super) struct Textures<'a, 'c, 'd> {
    document: &'a Document<'a>,
    context: &'c mut Context<'d>,
    /// Place of the material.
    pointer: String,
}

impl Textures<'_, '_, '_> {
    /// The texture of a property, given with its place below the material.
    pub(super) fn get(
        &mut self,
        info: &Option<TextureInfo>,
        property: &str,
    ) -> Result<Option<TextureRef>, AssetError> {
        let pointer = format!("{}/{property}", self.pointer);
        texture::reference(info.as_ref(), &pointer, self.document, self.context)
    }

    fn normal(
        &mut self,
        info: &Option<TextureInfo>,
        property: &str,
    ) -> Result<Option<NormalTexture>, AssetError> {
        let scale = info.as_ref().and_then(|info| info.scale).unwrap_or(1.0);
        let texture = self.get(info, property)?;
        Ok(texture.map(|texture| NormalTexture {
            texture,
            scale: finite(scale),
        }))
    }
}

/// The material at index `at`.
pub(super) fn draft(
    material: &Material,
    at: usize,
    document: &Document<'_>,
    context: &mut Context<'_>,
) -> Result<Draft, AssetError> {
    let none = MaterialExtensions::default();
    let extensions = material.extensions.as_deref().unwrap_or(&none);
    let pointer = format!("/materials/{at}");
    let alpha_mode = match material.alpha_mode.as_deref() {
        Some("MASK") => AlphaMode::Mask,
        Some("BLEND") => AlphaMode::Blend,
        _ => AlphaMode::Opaque,
    };
    let mut textures = Textures {
        document,
        context,
        pointer,
    };
    let base = &material.pbr_metallic_roughness;
    let strength = material.occlusion_texture.as_ref();
    let strength = strength.and_then(|info| info.strength);
    let strength_of_light = extensions.emissive_strength.as_ref();
    let strength_of_light = strength_of_light.and_then(|source| source.emissive_strength);
    let ior = extensions.ior.as_ref().and_then(|source| source.ior);
    let dispersion = extensions.dispersion.as_ref();
    let dispersion = dispersion.and_then(|source| source.dispersion);
    let base_texture = "pbrMetallicRoughness/baseColorTexture";
    let metal_texture = "pbrMetallicRoughness/metallicRoughnessTexture";
    let mut pbr = PbrMaterial {
        base_color: unit4(base.base_color_factor),
        base_color_texture: textures.get(&base.base_color_texture, base_texture)?,
        metallic: unit(base.metallic_factor, 1.0),
        roughness: unit(base.roughness_factor, 1.0),
        metallic_roughness_texture: textures
            .get(&base.metallic_roughness_texture, metal_texture)?,
        normal_texture: textures.normal(&material.normal_texture, "normalTexture")?,
        occlusion_texture: textures.get(&material.occlusion_texture, "occlusionTexture")?,
        occlusion_strength: unit(strength, 1.0),
        emissive: positive3(material.emissive_factor, 0.0),
        emissive_texture: textures.get(&material.emissive_texture, "emissiveTexture")?,
        emissive_strength: positive(strength_of_light, 1.0),
        alpha_cutoff: positive(material.alpha_cutoff, 0.5),
        is_double_sided: material.double_sided,
        is_unlit: extensions.unlit.is_some(),
        ior: match positive(ior, 1.5) {
            // 0 is a value of its own; others are at least 1, that of air.
            0.0 => 0.0,
            ior => ior.max(1.0),
        },
        dispersion: positive(dispersion, 0.0),
        ..PbrMaterial::default()
    };
    add_layers(&mut pbr, extensions, &mut textures)?;
    add_body(&mut pbr, extensions, &mut textures)?;
    let specular_glossiness = extensions.specular_glossiness.as_ref();
    let glossiness = specular_glossiness
        .map(|source| specular_glossiness::convert(source, &mut pbr, &mut textures))
        .transpose()?;
    Ok(Draft {
        name: material.name.clone(),
        pbr,
        alpha_mode,
        glossiness,
    })
}

/// Layers on the surface: specular reflection, clear coat, sheen, anisotropy, iridescence.
fn add_layers(
    pbr: &mut PbrMaterial,
    extensions: &MaterialExtensions,
    textures: &mut Textures<'_, '_, '_>,
) -> Result<(), AssetError> {
    if let Some(source) = &extensions.specular {
        let at = |property| format!("extensions/KHR_materials_specular/{property}");
        pbr.specular = Some(SpecularLayer {
            factor: unit(source.specular_factor, 1.0),
            texture: textures.get(&source.specular_texture, &at("specularTexture"))?,
            color: positive3(source.specular_color_factor, 1.0),
            color_texture: textures
                .get(&source.specular_color_texture, &at("specularColorTexture"))?,
        });
    }
    if let Some(source) = &extensions.clearcoat {
        let at = |property| format!("extensions/KHR_materials_clearcoat/{property}");
        let rough = &source.clearcoat_roughness_texture;
        let normal = &source.clearcoat_normal_texture;
        pbr.clearcoat = Some(Clearcoat {
            factor: unit(source.clearcoat_factor, 0.0),
            texture: textures.get(&source.clearcoat_texture, &at("clearcoatTexture"))?,
            roughness: unit(source.clearcoat_roughness_factor, 0.0),
            roughness_texture: textures.get(rough, &at("clearcoatRoughnessTexture"))?,
            normal_texture: textures.normal(normal, &at("clearcoatNormalTexture"))?,
        });
    }
    if let Some(source) = &extensions.sheen {
        let at = |property| format!("extensions/KHR_materials_sheen/{property}");
        let rough = &source.sheen_roughness_texture;
        pbr.sheen = Some(Sheen {
            color: positive3(source.sheen_color_factor, 0.0),
            color_texture: textures.get(&source.sheen_color_texture, &at("sheenColorTexture"))?,
            roughness: unit(source.sheen_roughness_factor, 0.0),
            roughness_texture: textures.get(rough, &at("sheenRoughnessTexture"))?,
        });
    }
    if let Some(source) = &extensions.anisotropy {
        let at = "extensions/KHR_materials_anisotropy/anisotropyTexture";
        pbr.anisotropy = Some(Anisotropy {
            strength: unit(source.anisotropy_strength, 0.0),
            rotation_rad: finite(source.anisotropy_rotation.unwrap_or(0.0)),
            texture: textures.get(&source.anisotropy_texture, at)?,
        });
    }
    if let Some(source) = &extensions.iridescence {
        let at = |property| format!("extensions/KHR_materials_iridescence/{property}");
        let thickness = &source.iridescence_thickness_texture;
        pbr.iridescence = Some(Iridescence {
            factor: unit(source.iridescence_factor, 0.0),
            texture: textures.get(&source.iridescence_texture, &at("iridescenceTexture"))?,
            ior: positive(source.iridescence_ior, 1.3).max(1.0),
            thickness_min_nm: positive(source.iridescence_thickness_minimum, 100.0),
            thickness_max_nm: positive(source.iridescence_thickness_maximum, 400.0),
            thickness_texture: textures.get(thickness, &at("iridescenceThicknessTexture"))?,
        });
    }
    Ok(())
}

/// What light does below the surface: transmission and volume.
fn add_body(
    pbr: &mut PbrMaterial,
    extensions: &MaterialExtensions,
    textures: &mut Textures<'_, '_, '_>,
) -> Result<(), AssetError> {
    if let Some(source) = &extensions.transmission {
        let at = "extensions/KHR_materials_transmission/transmissionTexture";
        pbr.transmission = Some(Transmission {
            factor: unit(source.transmission_factor, 0.0),
            texture: textures.get(&source.transmission_texture, at)?,
        });
    }
    if let Some(source) = &extensions.volume {
        let at = "extensions/KHR_materials_volume/thicknessTexture";
        let distance = source.attenuation_distance.unwrap_or(f32::INFINITY);
        pbr.volume = Some(Volume {
            thickness: positive(source.thickness_factor, 0.0),
            thickness_texture: textures.get(&source.thickness_texture, at)?,
            // 0 is not allowed; it would divide by zero.
            attenuation_distance: if distance > 0.0 {
                distance
            } else {
                f32::INFINITY
            },
            attenuation_color: Vec3::from_array(source.attenuation_color.unwrap_or([1.0; 3]))
                .clamp(Vec3::ZERO, Vec3::ONE),
        });
    }
    Ok(())
}

/// Larger numbers of JSON are ∞ in f32.
fn finite(value: f32) -> f32 {
    value.clamp(f32::MIN, f32::MAX)
}

pub(super) fn unit(value: Option<f32>, default: f32) -> f32 {
    value.unwrap_or(default).clamp(0.0, 1.0)
}

pub(super) fn unit4(value: Option<[f32; 4]>) -> Vec4 {
    Vec4::from_array(value.unwrap_or([1.0; 4])).clamp(Vec4::ZERO, Vec4::ONE)
}

fn positive(value: Option<f32>, default: f32) -> f32 {
    value.unwrap_or(default).clamp(0.0, f32::MAX)
}

pub(super) fn positive3(value: Option<[f32; 3]>, default: f32) -> Vec3 {
    let value = Vec3::from_array(value.unwrap_or([default; 3]));
    value.clamp(Vec3::ZERO, Vec3::splat(f32::MAX))
}
