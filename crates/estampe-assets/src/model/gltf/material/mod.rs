//! Materials.
//!
//! ```text
//! JSON -> convert (pbr)  -> images of the used materials are found
//!                        -> specular_glossiness: textures that are made of others
//!                        -> phong: the fields that the Phong model reads
//! ```

mod convert;
mod phong;
mod specular_glossiness;
mod texture;

use super::buffers::Views;
use super::document::Document;
use super::images;
use crate::AssetError;
use crate::model::deferred::retain_pbr_textures;
use crate::model::load::Context;
use estampe_scene::{AlphaMode, Material, PbrMaterial};
use specular_glossiness::Glossiness;

/// A material whose textures still have the image's index in the file.
struct Draft {
    name: String,
    pbr: PbrMaterial,
    alpha_mode: AlphaMode,
    glossiness: Option<Glossiness>,
}

/// Makes the materials, in the order of the file; after them the default material if it is used.
/// Those that no mesh uses have no textures.
pub(super) fn read<'a>(
    document: &Document<'_>,
    is_used: &[bool],
    needs_default: bool,
    (views, bin): (&Views<'_>, Option<&'a [u8]>),
    context: &mut Context<'a>,
) -> Result<Vec<Material>, AssetError> {
    let mut drafts = Vec::with_capacity(document.materials.len());
    let mut is_image_used = vec![false; document.images.len()];
    for (at, material) in document.materials.iter().enumerate() {
        let mut draft = convert::draft(material, at, document, context)?;
        retain_pbr_textures(&mut draft.pbr, |texture, _| {
            is_image_used[texture.image] |= is_used[at];
            is_used[at]
        });
        drafts.push(draft);
    }
    let image_of_file = images::find(document, &is_image_used, (views, bin), context)?;
    let mut materials = Vec::with_capacity(drafts.len() + 1);
    let mut derived = specular_glossiness::Derived::default();
    for mut draft in drafts {
        retain_pbr_textures(&mut draft.pbr, |texture, _| {
            let found = image_of_file[texture.image];
            texture.image = found.unwrap_or_default();
            found.is_some()
        });
        if let Some(glossiness) = draft.glossiness {
            derived.add_roughness(&mut draft.pbr, glossiness, context);
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
    Ok(materials)
}
