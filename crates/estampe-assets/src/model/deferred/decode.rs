//! Decoding of the images, and the materials that depend on it.

use super::{AlphaRule, Deferred, DeferredImages, Encoded, Origin, Source, TextureDetail};
use super::{TextureAlpha, retain_textures};
use crate::image::{Reduced, Reduction, TexelContent, decode, decode_with_alpha};
use crate::model::load::Context;
use crate::model::textures::{classify_alpha, with_opacity};
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Image, Scene};

/// The image, if it could be decoded, and what could not.
type Decoded = (Option<Reduced>, Vec<(Origin, AssetError)>);

/// Decodes the images of a scene by several threads, each to the first level that is needed, and
/// returns their whole sizes. Failures are warnings, and remove the textures.
pub(in crate::model) fn decode_all(
    scene: &mut Scene,
    detail: &dyn TextureDetail,
    context: &mut Context<'_>,
) -> Vec<(u32, u32)> {
    let DeferredImages {
        images,
        alpha_rules,
        ..
    } = std::mem::replace(&mut context.images, DeferredImages::new(context.limits));
    if images.is_empty() {
        return Vec::new();
    }
    let sizes: Vec<(u32, u32)> = images.iter().map(|image| image.size).collect();
    let coverings = coverings(scene, &alpha_rules, images.len());
    let reductions = reductions(scene, &images, detail, context.limits);
    let glossiness: Vec<Option<f32>> = { images.iter() }
        .map(|image| match image.source {
            Source::Roughness { glossiness, .. } => Some(glossiness),
            _ => None,
        })
        .collect();
    let wanted: Vec<Wanted> = { reductions.into_iter().zip(coverings).zip(&sizes) }
        .map(|((reduction, covering), &size)| Wanted {
            reduction,
            covering,
            least: context.limits.least_level(size),
        })
        .collect();
    let mut decoded = decoded(images, &wanted, context);
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
    let kept = { sizes.into_iter().zip(&decoded) }.filter(|(_, image)| image.is_some());
    let kept = kept.map(|(size, _)| size).collect();
    scene.images = { decoded.drain(..).flatten() }
        .map(|reduced| reduced.image)
        .collect();
    kept
}

/// The level that is wanted of an image, and the use of its alpha.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    reduction: Reduction,
    covering: Covering,
    /// The level of the limit, which every image has at least.
    least: u32,
}

/// How materials use the alpha of a base colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Covering {
    /// They ignore it, or there is none.
    Unused,
    /// They blend with it.
    Blended,
    /// They blend where some alpha is between 0 and 255; where there is 0 and 255 they cut out.
    ByContent,
    /// They cut out, or use it in different ways: the smaller levels are made of the whole image.
    CutOut,
}

impl Covering {
    fn of(mode: AlphaMode) -> Self {
        match mode {
            AlphaMode::Opaque => Self::Unused,
            AlphaMode::Blend => Self::Blended,
            AlphaMode::Mask => Self::CutOut,
        }
    }

    /// The use by a rule.
    fn of_rule(chosen: TextureAlpha) -> Self {
        match chosen {
            TextureAlpha::Opaque => Self::Unused,
            TextureAlpha::Auto => Self::ByContent,
            TextureAlpha::Blend => Self::Blended,
            TextureAlpha::Mask => Self::CutOut,
        }
    }
}

/// The use of each image's alpha.
fn coverings(scene: &Scene, rules: &[AlphaRule], count: usize) -> Vec<Covering> {
    let mut by_rule = vec![None; scene.materials.len()];
    for rule in rules {
        if let Some(chosen) = by_rule.get_mut(rule.material) {
            *chosen = Some(Covering::of_rule(rule.chosen));
        }
    }
    let mut uses: Vec<Option<Covering>> = vec![None; count];
    let mut add = |image: Option<usize>, covering: Covering| {
        if let Some(known) = image.and_then(|at| uses.get_mut(at)) {
            *known = match *known {
                None => Some(covering),
                Some(same) if same == covering => Some(same),
                Some(_) => Some(Covering::CutOut),
            };
        }
    };
    for (material, rule) in scene.materials.iter().zip(by_rule) {
        let own = rule.unwrap_or(Covering::of(material.alpha_mode));
        add(material.base_color_texture, own);
        let pbr = material.pbr.as_deref();
        if let Some((pbr, texture)) = pbr.and_then(|pbr| Some((pbr, pbr.base_color_texture?))) {
            let stated = pbr.alpha_mode.map_or(own, Covering::of);
            add(Some(texture.image), own);
            add(Some(texture.image), stated);
        }
    }
    let uses = uses.into_iter();
    uses.map(|covering| covering.unwrap_or(Covering::Unused))
        .collect()
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
    // A mean of roughness is not the roughness of a mean, as both are rounded.
    for (at, image) in images.iter().enumerate() {
        if let Source::Roughness { of, .. } = image.source {
            levels[of] = 0;
            levels[at] = 0;
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
    wanted: &[Wanted],
    context: &mut Context<'_>,
) -> Vec<Option<Reduced>> {
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
    let count = wanted.len();
    // Threads that have no image of their own share the rows of the others' images.
    let limits = &Limits {
        threads: context.workers.count().div_ceil(jobs.len().max(1)),
        ..context.limits.clone()
    };
    let mut results = context
        .workers
        .map(jobs, |(at, source)| (at, source.decode(wanted[at], limits)));
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
            is_solid: true,
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

    fn decode(self, wanted: Wanted, limits: &Limits) -> Decoded {
        let mut failures = Vec::new();
        let mut tried = |file: Encoded<'_>, wanted: Wanted| match file.decode(wanted, limits) {
            Ok(image) => Some(image),
            Err(error) => {
                failures.push((file.origin, error));
                None
            }
        };
        let image = match self {
            Self::File(file) => tried(file, wanted),
            Self::Texture(file) => {
                let size = file.size;
                tried(file, wanted).map(|texture| {
                    let is_whole = (texture.image.width, texture.image.height) == size;
                    with_used_alpha(texture, is_whole)
                })
            }
            Self::WithOpacity(color, opacity) => {
                // The two may have different sizes, so they are combined whole.
                let origin = opacity.origin.clone();
                let color = color.and_then(|color| tried(color, Wanted::WHOLE));
                let opacity = tried(opacity, Wanted::WHOLE);
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
                    let is_solid = alpha == AlphaMode::Opaque;
                    let reduction = wanted.of_alpha(is_solid, alpha);
                    if reduction.level > 0 {
                        match crate::image::reduced(&image, reduction, limits) {
                            Ok(reduced) => image = reduced,
                            Err(error) => {
                                failures.push((origin, error));
                                return None;
                            }
                        }
                    }
                    Some(Reduced {
                        image,
                        alpha,
                        is_solid,
                    })
                })
            }
            Self::Roughness { .. } => None,
        };
        (image, failures)
    }
}

impl Wanted {
    /// The whole image, as it is.
    const WHOLE: Self = Self {
        reduction: Reduction::NONE,
        covering: Covering::Unused,
        least: 0,
    };

    /// The reduction of an image whose alpha is known. Invisible texels have no part in the colours
    /// of smaller levels, and the renderer makes cut-outs keep the share that the whole image has.
    fn of_alpha(self, is_solid: bool, alpha: AlphaMode) -> Reduction {
        let covering = match self.covering {
            _ if is_solid => Covering::Unused,
            Covering::ByContent => Covering::of(alpha),
            covering => covering,
        };
        match covering {
            Covering::Unused => self.reduction,
            Covering::Blended => Reduction {
                content: TexelContent::Covering,
                ..self.reduction
            },
            Covering::CutOut | Covering::ByContent => Reduction {
                level: self.least,
                content: TexelContent::Covering,
            },
        }
    }
}

impl Encoded<'_> {
    /// Decodes the image as if it were solid, and once more if it is not and that matters.
    fn decode(&self, wanted: Wanted, limits: &Limits) -> Result<Reduced, AssetError> {
        let first = wanted.reduction;
        if first.level > 0 {
            let reduced = decode_with_alpha(&self.bytes, first, limits)?;
            let second = wanted.of_alpha(reduced.is_solid, reduced.alpha);
            if second == first {
                return Ok(reduced);
            }
            if second.level > 0 {
                return decode_with_alpha(&self.bytes, second, limits);
            }
        }
        let image = decode(&self.bytes, limits)?;
        // The alpha of textures is classified afterwards.
        Ok(Reduced {
            image,
            alpha: AlphaMode::Blend,
            is_solid: false,
        })
    }
}

/// A texture whose alpha is 255 if it is 0 everywhere, and its use. Of a reduced image the use is
/// known, and that of the whole one.
fn with_used_alpha(mut texture: Reduced, is_whole: bool) -> Reduced {
    if is_whole {
        texture.alpha = classify_alpha(&mut texture.image);
    } else if texture.alpha == AlphaMode::Opaque && !texture.is_solid {
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
