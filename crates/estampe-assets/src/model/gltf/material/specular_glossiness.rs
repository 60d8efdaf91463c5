//! KHR_materials_pbrSpecularGlossiness as a metallic-roughness material.
//!
//! | of the extension         | becomes                                                     |
//! |--------------------------|-------------------------------------------------------------|
//! | diffuse colour, texture  | base colour, texture; metallic 0                            |
//! | specular colour          | KHR_materials_specular's colour, index of refraction 0      |
//! | RGB of its texture       | the colour's texture                                        |
//! | glossiness g             | roughness 1 − g                                             |
//! | glossiness · texture's A | a texture whose green is 1 − g · A; roughness 1             |
//!
//! The index 0 makes ((ior − 1) ÷ (ior + 1))² = 1, so reflection at normal incidence is the
//! specular colour itself, and nothing is lost. The usual conversion to a metallic factor by the
//! brightness of the specular colour was not chosen: it changes colours, and needs two textures of
//! the same size.

use super::super::document::SpecularGlossiness;
use super::convert::{Textures, positive3, unit, unit4};
use crate::AssetError;
use crate::model::load::Context;
use estampe_scene::{PbrMaterial, SpecularLayer};
use std::collections::HashMap;

/// The factor of a glossiness texture, which is the one of the specular colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Glossiness(f32);

/// Converts a material, except for the texture of its roughness, which needs the image.
pub(super) fn convert(
    source: &SpecularGlossiness,
    pbr: &mut PbrMaterial,
    textures: &mut Textures<'_, '_, '_>,
) -> Result<Glossiness, AssetError> {
    let at = |property| format!("extensions/KHR_materials_pbrSpecularGlossiness/{property}");
    let texture = &source.specular_glossiness_texture;
    let glossiness = unit(source.glossiness_factor, 1.0);
    pbr.base_color = unit4(source.diffuse_factor);
    pbr.base_color_texture = textures.get(&source.diffuse_texture, &at("diffuseTexture"))?;
    pbr.metallic = 0.0;
    pbr.metallic_roughness_texture = None;
    pbr.roughness = 1.0 - glossiness;
    pbr.ior = 0.0;
    pbr.specular = Some(SpecularLayer {
        factor: 1.0,
        texture: None,
        color: positive3(source.specular_factor, 1.0),
        color_texture: textures.get(texture, &at("specularGlossinessTexture"))?,
    });
    Ok(Glossiness(glossiness))
}

/// Textures of roughness by image and glossiness.
#[derive(Debug, Default)]
pub(super) struct Derived {
    known: HashMap<(usize, u32), Option<usize>>,
}

impl Derived {
    /// Makes the texture of the roughness. Beyond the limits the factor alone remains.
    pub(super) fn add_roughness(
        &mut self,
        pbr: &mut PbrMaterial,
        Glossiness(glossiness): Glossiness,
        context: &mut Context<'_>,
    ) {
        let Some(source) = pbr.specular.and_then(|specular| specular.color_texture) else {
            return;
        };
        let key = (source.image, glossiness.to_bits());
        let limits = context.limits;
        let images = &mut context.images;
        let make = || images.add_roughness(source.image, glossiness, limits);
        if let Some(image) = *self.known.entry(key).or_insert_with(make) {
            pbr.roughness = 1.0;
            pbr.metallic_roughness_texture = Some(estampe_scene::TextureRef { image, ..source });
        }
    }
}
