//! Decoding of the images, and the materials that depend on it.

use super::{Deferred, DeferredImages, Encoded, Origin, Source, TextureDetail, retain_textures};
use crate::image::{Reduced, Reduction, TexelContent, decode, decode_with_alpha};
use crate::model::load::Context;
use crate::model::textures::{classify_alpha, with_opacity};
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Image, Scene};

/// The image, if it could be decoded, and what could not.
type Decoded = (Option<Reduced>, Vec<(Origin, AssetError)>);

/// Decodes the images of a scene by several threads, each to the first level that is needed.
/// Failures are warnings, and remove the textures.
pub(in crate::model) fn decode_all(
    scene: &mut Scene,
    detail: &dyn TextureDetail,
    context: &mut Context<'_>,
) {
    let DeferredImages {
        images,
        alpha_rules,
        ..
    } = std::mem::replace(&mut context.images, DeferredImages::new(context.limits));
    if images.is_empty() {
        return;
    }
    let reductions = reductions(scene, &images, detail, context.limits);
    let glossiness: Vec<Option<f32>> = { images.iter() }
        .map(|image| match image.source {
            Source::Roughness { glossiness, .. } => Some(glossiness),
            _ => None,
        })
        .collect();
    let mut decoded = decoded(images, &reductions, context);
    for pbr in { scene.materials.iter_mut() }.filter_map(|material| material.pbr.as_mut()) {
        // Without its texture, the roughness is that of the factor alone.
        if let Some(texture) = pbr.metallic_roughness_texture
            && let (Some(None), Some(Some(glossiness))) =
                (decoded.get(texture.image), glossiness.get(texture.image))
        {
            pbr.roughness = 1.0 - glossiness;
        }
    }

    for rule in alpha_rules {
        let Some(material) = scene.materials.get_mut(rule.material) else {
            continue;
        };
        let texture = material.base_color_texture.and_then(|at| decoded.get(at));
        match texture.and_then(Option::as_ref) {
            Some(texture) => material.alpha_mode = rule.chosen.or(texture.alpha),
            None => {
                material.alpha_mode = AlphaMode::Opaque;
                material.base_color = rule.color_without.unwrap_or(material.base_color);
            }
        }
    }
    // Images that failed leave no gap.
    let mut count = 0;
    let new_index: Vec<Option<usize>> = { decoded.iter() }
        .map(|image| {
            image.as_ref()?;
            count += 1;
            Some(count - 1)
        })
        .collect();
    for material in &mut scene.materials {
        retain_textures(material, |image, _| {
            let found = new_index.get(*image).copied().flatten();
            *image = found.unwrap_or_default();
            found.is_some()
        });
    }
    scene.images = { decoded.drain(..).flatten() }
        .map(|reduced| reduced.image)
        .collect();
}

/// The level of each image, and the meaning of its texels. Images that are used as colours and as
/// numbers stay whole, as their two uses have different levels.
fn reductions(
    scene: &mut Scene,
    images: &[Deferred<'_>],
    detail: &dyn TextureDetail,
    limits: &Limits,
) -> Vec<Reduction> {
    scene.images = { images.iter() }
        .map(|image| Image {
            width: image.size.0,
            height: image.size.1,
            rgba: Vec::new(),
        })
        .collect();
    let mut levels = detail.first_levels(scene);
    levels.resize(images.len(), 0);
    let mut contents: Vec<Option<TexelContent>> = vec![None; images.len()];
    for material in &mut scene.materials {
        retain_textures(material, |&mut image, content| {
            if let Some(known) = contents.get_mut(image)
                && known.replace(content).is_some_and(|other| other != content)
            {
                levels[image] = 0;
            }
            true
        });
    }
    // An image that is made of another one has its level.
    for (at, image) in images.iter().enumerate() {
        if let Source::Roughness { of, .. } = image.source {
            levels[of] = levels[of].min(levels[at]);
        }
    }
    let chosen = images.iter().zip(levels).zip(contents);
    chosen
        .map(|((image, level), content)| Reduction {
            level: level.max(limits.least_level(image.size)),
            content: content.unwrap_or(TexelContent::Color),
        })
        .collect()
}

/// The decoded images in their order.
fn decoded(
    images: Vec<Deferred<'_>>,
    reductions: &[Reduction],
    context: &mut Context<'_>,
) -> Vec<Option<Reduced>> {
    let limits = context.limits;
    let mut made = Vec::new();
    let mut jobs = Vec::new();
    for (at, image) in images.into_iter().enumerate() {
        match image.source {
            Source::Roughness { of, glossiness } => made.push((at, of, glossiness)),
            source => jobs.push((at, source)),
        }
    }
    // The longest first, so that no thread begins it when the others have finished.
    jobs.sort_by_key(|(_, source)| std::cmp::Reverse(source.len_bytes()));
    let count = reductions.len();
    let mut results = context.workers.map(jobs, |(at, source)| {
        (at, source.decode(reductions[at], limits))
    });
    results.sort_by_key(|&(at, _)| at);
    let mut decoded: Vec<Option<Reduced>> = { 0..count }.map(|_| None).collect();
    for (at, (image, failures)) in results {
        decoded[at] = image;
        for (origin, error) in failures {
            origin.warn(&error, &mut context.warnings);
        }
    }
    for (at, of, glossiness) in made {
        decoded[at] = decoded[of].as_ref().map(|source| Reduced {
            image: roughness(&source.image, glossiness),
            alpha: AlphaMode::Opaque,
        });
    }
    decoded
}

impl Source<'_> {
    /// The bytes of its files.
    fn len_bytes(&self) -> usize {
        match self {
            Self::File(file) | Self::Texture(file) => file.bytes.len(),
            Self::WithOpacity(color, opacity) => {
                let color = color.as_ref().map_or(0, |color| color.bytes.len());
                color + opacity.bytes.len()
            }
            Self::Roughness { .. } => 0,
        }
    }

    fn decode(self, reduction: Reduction, limits: &Limits) -> Decoded {
        let mut failures = Vec::new();
        let mut tried =
            |file: Encoded<'_>, reduction: Reduction| match file.decode(reduction, limits) {
                Ok(image) => Some(image),
                Err(error) => {
                    failures.push((file.origin, error));
                    None
                }
            };
        let image = match self {
            Self::File(file) => tried(file, reduction),
            Self::Texture(file) => {
                let is_classified = reduction.level > 0;
                tried(file, reduction).map(|texture| with_used_alpha(texture, is_classified))
            }
            Self::WithOpacity(color, opacity) => {
                // The two may have different sizes, so they are combined whole.
                let color = color.and_then(|color| tried(color, Reduction::NONE));
                let opacity = tried(opacity, Reduction::NONE);
                let image = match (color, opacity) {
                    (color, None) => color.map(|color| color.image),
                    (Some(color), Some(mask)) => Some(with_opacity(color.image, &mask.image)),
                    (None, Some(Reduced { image: mask, .. })) => {
                        let white = Image::filled(mask.width, mask.height, [255; 4]);
                        Some(with_opacity(white, &mask))
                    }
                };
                image.and_then(|mut image| {
                    let alpha = classify_alpha(&mut image);
                    if reduction.level > 0 {
                        image = crate::image::reduced(&image, reduction).ok()?;
                    }
                    Some(Reduced { image, alpha })
                })
            }
            Self::Roughness { .. } => None,
        };
        (image, failures)
    }
}

impl Encoded<'_> {
    fn decode(&self, reduction: Reduction, limits: &Limits) -> Result<Reduced, AssetError> {
        if reduction.level > 0 {
            return decode_with_alpha(&self.bytes, reduction, limits);
        }
        let image = decode(&self.bytes, limits)?;
        // Files whose alpha matters are classified afterwards.
        Ok(Reduced {
            image,
            alpha: AlphaMode::Blend,
        })
    }
}

/// A texture whose alpha is 255 if it is 0 everywhere, and its use. Of a reduced image the use is
/// known, and that of the whole one.
fn with_used_alpha(mut texture: Reduced, is_classified: bool) -> Reduced {
    if !is_classified {
        texture.alpha = classify_alpha(&mut texture.image);
    } else if texture.alpha == AlphaMode::Opaque {
        for texel in texture.image.rgba.as_chunks_mut::<4>().0 {
            texel[3] = 255;
        }
    }
    texture
}

/// The image with 1 − glossiness · alpha in green.
fn roughness(image: &Image, glossiness: f32) -> Image {
    let table: [u8; 256] = std::array::from_fn(|alpha| {
        let rough = 255.0 - glossiness * alpha as f32;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the factor is in 0..=1, so the result in 0..=255"
        )]
        {
            libm::roundf(rough) as u8
        }
    });
    let texels = image.rgba.as_chunks::<4>().0.iter();
    Image {
        width: image.width,
        height: image.height,
        rgba: texels
            .flat_map(|texel| [0, table[usize::from(texel[3])], 0, 255])
            .collect(),
    }
}
