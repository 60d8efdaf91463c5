//! Materials.
//!
//! ```text
//! JSON -> convert (pbr)  -> images of the used materials are decoded
//!                        -> specular_glossiness: textures that are made of others
//!                        -> phong: the fields that the Phong model reads
//! ```

mod convert;
mod phong;
mod specular_glossiness;
mod texture;

use super::buffers::Views;
use super::document::Document;
use super::images::Images;
use crate::AssetError;
use crate::model::load::Context;
use estampe_scene::{AlphaMode, Image, Material, NormalTexture, PbrMaterial, TextureRef};
use specular_glossiness::Glossiness;

/// Materials with their images.
#[derive(Debug)]
pub(super) struct Materials {
    /// In the order of the file; after them the default material if it is used.
    pub(super) materials: Vec<Material>,
    pub(super) images: Vec<Image>,
}

/// A material whose textures still have the image's index in the file.
struct Draft {
    name: String,
    pbr: PbrMaterial,
    alpha_mode: AlphaMode,
    glossiness: Option<Glossiness>,
}

/// Makes the materials. Those that no mesh uses have no textures.
pub(super) fn read(
    document: &Document<'_>,
    is_used: &[bool],
    needs_default: bool,
    views: &Views<'_>,
    context: &mut Context<'_>,
) -> Result<Materials, AssetError> {
    let mut drafts = Vec::with_capacity(document.materials.len());
    let mut is_image_used = vec![false; document.images.len()];
    for (at, material) in document.materials.iter().enumerate() {
        let mut draft = convert::draft(material, at, document, context)?;
        for_each_texture(&mut draft.pbr, |texture| {
            is_image_used[texture.image] |= is_used[at];
            is_used[at]
        });
        drafts.push(draft);
    }
    let mut images = Images::read(document, &is_image_used, views, context);
    let mut materials = Vec::with_capacity(drafts.len() + 1);
    let mut derived = specular_glossiness::Derived::default();
    for mut draft in drafts {
        for_each_texture(&mut draft.pbr, |texture| {
            let found = images.of_file[texture.image];
            texture.image = found.unwrap_or_default();
            found.is_some()
        });
        if let Some(glossiness) = draft.glossiness {
            derived.add_roughness(&mut draft.pbr, glossiness, &mut images);
        }
        materials.push(phong::material(draft.name, draft.pbr, draft.alpha_mode));
    }
    if needs_default {
        let name = "default".to_owned();
        materials.push(phong::material(
            name,
            PbrMaterial::default(),
            AlphaMode::Opaque,
        ));
    }
    Ok(Materials {
        materials,
        images: images.images,
    })
}

/// Calls `keep` with each texture, and removes those for which it returns false.
fn for_each_texture(pbr: &mut PbrMaterial, mut keep: impl FnMut(&mut TextureRef) -> bool) {
    let mut of = |slot: &mut Option<TextureRef>| {
        if slot.as_mut().is_some_and(|texture| !keep(texture)) {
            *slot = None;
        }
    };
    of(&mut pbr.base_color_texture);
    of(&mut pbr.metallic_roughness_texture);
    of(&mut pbr.occlusion_texture);
    of(&mut pbr.emissive_texture);
    if let Some(specular) = &mut pbr.specular {
        of(&mut specular.texture);
        of(&mut specular.color_texture);
    }
    if let Some(transmission) = &mut pbr.transmission {
        of(&mut transmission.texture);
    }
    if let Some(volume) = &mut pbr.volume {
        of(&mut volume.thickness_texture);
    }
    if let Some(sheen) = &mut pbr.sheen {
        of(&mut sheen.color_texture);
        of(&mut sheen.roughness_texture);
    }
    if let Some(anisotropy) = &mut pbr.anisotropy {
        of(&mut anisotropy.texture);
    }
    if let Some(iridescence) = &mut pbr.iridescence {
        of(&mut iridescence.texture);
        of(&mut iridescence.thickness_texture);
    }
    let mut of_normals = |slot: &mut Option<NormalTexture>| {
        if slot
            .as_mut()
            .is_some_and(|normal| !keep(&mut normal.texture))
        {
            *slot = None;
        }
    };
    of_normals(&mut pbr.normal_texture);
    if let Some(clearcoat) = &mut pbr.clearcoat {
        of_normals(&mut clearcoat.normal_texture);
        for slot in [&mut clearcoat.texture, &mut clearcoat.roughness_texture] {
            if slot.as_mut().is_some_and(|texture| !keep(texture)) {
                *slot = None;
            }
        }
    }
}
