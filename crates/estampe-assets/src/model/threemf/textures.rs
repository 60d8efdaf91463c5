//! The textures of the package: each used one becomes a material with an image.

use super::document::{Document, Group, Texture};
use super::package::Package;
use crate::model::deferred::{AlphaRule, Origin};
use crate::model::load::Context;
use crate::model::options::TextureAlpha;
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Material};
use glam::Vec3;
use std::borrow::Cow;
use std::collections::HashMap;

/// The materials of the textures.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// Index of the material of each texture; `None` if it is not used, or could not be read.
    pub(super) material_of: Vec<Option<usize>>,
}

impl Textures {
    /// Finds the images of the textures that have coordinates, and adds their materials to the
    /// document. Failures are warnings.
    pub(super) fn read(
        document: &mut Document,
        package: &mut Package<'_>,
        context: &mut Context<'_>,
    ) -> Result<Self, AssetError> {
        let mut textures = Self {
            material_of: vec![None; document.textures.len()],
        };
        let mut is_used = vec![false; document.textures.len()];
        for group in &document.groups {
            if let Group::Coordinates {
                texture: Some(texture),
                ..
            } = *group
            {
                is_used[texture] = true;
            }
        }
        let mut material_of_part: HashMap<&str, Option<usize>> = HashMap::new();
        let used = document.textures.iter().enumerate();
        for (at, texture) in used.filter(|&(at, _)| is_used[at]) {
            if let Some(&known) = material_of_part.get(texture.part.as_str()) {
                textures.material_of[at] = known;
                continue;
            }
            let material = match image(texture, package, context) {
                Ok(image) => {
                    context.images.add_alpha_rule(AlphaRule {
                        material: document.materials.len(),
                        chosen: TextureAlpha::Auto,
                        color_without: Some(Material::default().base_color),
                    });
                    document.materials.push(Material {
                        name: texture.part.clone(),
                        base_color: Vec3::ONE,
                        base_color_texture: Some(image),
                        alpha_mode: AlphaMode::Blend,
                        ..Material::default()
                    });
                    let count = document.materials.len();
                    Limits::check("materials", count as u64, context.limits.max_materials)?;
                    Some(count - 1)
                }
                Err(error) => {
                    origin(texture).warn(&error, &mut context.warnings);
                    None
                }
            };
            material_of_part.insert(&texture.part, material);
            textures.material_of[at] = material;
        }
        Ok(textures)
    }
}

/// The image of a part, to be decoded later.
fn image(
    texture: &Texture,
    package: &mut Package<'_>,
    context: &mut Context<'_>,
) -> Result<usize, AssetError> {
    let bytes = package.bytes(&texture.part)?.ok_or_else(|| {
        AssetError::malformed("the package has no such part", "export the file again")
    })?;
    let bytes = Cow::Owned(bytes);
    let encoded = context
        .images
        .encoded(bytes, origin(texture), context.limits)?;
    let image = context.images.add_texture(Some(encoded), None);
    image.ok_or_else(|| AssetError::malformed("there is no image", ""))
}

fn origin(texture: &Texture) -> Origin {
    Origin::Named {
        file: texture.place.clone(),
        location: texture.location.into(),
        name: texture.part.clone(),
    }
}
