//! The textures of the package: each used one becomes a material with an image.

use super::document::{Document, Group};
use super::package::Package;
use crate::model::load::Context;
use crate::model::textures::classify_alpha;
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Image, Material};
use glam::Vec3;
use std::collections::HashMap;

/// The materials of the textures, and their images.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub(super) images: Vec<Image>,
    /// Index of the material of each texture; `None` if it is not used, or could not be read.
    pub(super) material_of: Vec<Option<usize>>,
}

impl Textures {
    /// Reads the images of the textures that have coordinates, and adds their materials to the
    /// document. Failures are warnings.
    pub(super) fn read(
        document: &mut Document,
        package: &mut Package<'_>,
        context: &mut Context<'_>,
    ) -> Result<Self, AssetError> {
        let mut textures = Self {
            images: Vec::new(),
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
        let mut pixels_left = context.limits.max_total_image_pixels;
        let used = document.textures.iter().enumerate();
        for (at, texture) in used.filter(|&(at, _)| is_used[at]) {
            if let Some(&known) = material_of_part.get(texture.part.as_str()) {
                textures.material_of[at] = known;
                continue;
            }
            let material = match image(&texture.part, pixels_left, package, context.limits) {
                Ok((image, alpha_mode)) => {
                    pixels_left -= u64::from(image.width) * u64::from(image.height);
                    textures.images.push(image);
                    document.materials.push(Material {
                        name: texture.part.clone(),
                        base_color: Vec3::ONE,
                        base_color_texture: Some(textures.images.len() - 1),
                        alpha_mode,
                        ..Material::default()
                    });
                    let count = document.materials.len();
                    Limits::check("materials", count as u64, context.limits.max_materials)?;
                    Some(count - 1)
                }
                Err(error) => {
                    context.warnings.add(&texture.place, texture.location, || {
                        format!("the texture `{}` is omitted: {error}", texture.part)
                    });
                    None
                }
            };
            material_of_part.insert(&texture.part, material);
            textures.material_of[at] = material;
        }
        Ok(textures)
    }
}

/// The image of a part, and the use of its alpha.
fn image(
    part: &str,
    pixels_left: u64,
    package: &mut Package<'_>,
    limits: &Limits,
) -> Result<(Image, AlphaMode), AssetError> {
    let bytes = package.bytes(part)?.ok_or_else(|| {
        AssetError::malformed("the package has no such part", "export the file again")
    })?;
    let limits = Limits {
        max_image_pixels: limits.max_image_pixels.min(pixels_left),
        ..limits.clone()
    };
    let mut image = crate::image::decode(&bytes, &limits)?;
    let alpha_mode = classify_alpha(&mut image);
    Ok((image, alpha_mode))
}
