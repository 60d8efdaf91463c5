//! Textures as materials use them: image, sampler, coordinates and their transform.

use super::super::document::{Document, Index, Sampler, Texture, TextureInfo, TextureSource};
use super::super::fault::{element, warn};
use crate::AssetError;
use crate::model::load::Context;
use estampe_scene::{AddressMode, TextureFilter, TextureRef, TextureSampler, UvTransform};
use glam::Vec2;

/// A texture with the image's index in the file. `None` if there is none that can be read.
pub(super) fn reference(
    info: Option<&TextureInfo>,
    pointer: &str,
    document: &Document<'_>,
    context: &mut Context<'_>,
) -> Result<Option<TextureRef>, AssetError> {
    let Some(info) = info else {
        return Ok(None);
    };
    let place = || format!("{pointer}/index");
    let texture = element(&document.textures, info.index, "texture", place)?;
    let texture_pointer = format!("/textures/{}", info.index);
    let sampler = match texture.sampler {
        Some(index) => {
            let place = || format!("{texture_pointer}/sampler");
            let sampler = element(&document.samplers, index, "sampler", place)?;
            sampler_of(sampler)
        }
        None => TextureSampler::default(),
    };
    let Some((source, property)) = source(texture) else {
        let what = "the texture has no image in PNG, JPEG, WebP, DDS or KTX2; it is left out";
        warn(context, texture_pointer, what);
        return Ok(None);
    };
    let place = || format!("{texture_pointer}/{property}");
    element(&document.images, source, "image", place)?;
    let transform = info.extensions.transform.as_deref();
    let uv_set = transform
        .and_then(|transform| transform.tex_coord)
        .unwrap_or(info.tex_coord);
    let Some(uv_set) = u8::try_from(uv_set.0).ok().filter(|&set| set < 2) else {
        let what = format!(
            "texture coordinates TEXCOORD_{uv_set} are not read, only 0 and 1; the texture is left out"
        );
        warn(context, pointer, what);
        return Ok(None);
    };
    let transform = transform.map_or(UvTransform::IDENTITY, |transform| UvTransform {
        offset: Vec2::from_array(transform.offset.unwrap_or_default()),
        rotation_rad: transform.rotation.unwrap_or_default(),
        scale: Vec2::from_array(transform.scale.unwrap_or([1.0; 2])),
    });
    Ok(Some(TextureRef {
        image: source.0,
        sampler,
        uv_set,
        transform,
    }))
}

/// The image of a texture, and the property that names it. Images of WebP, DDS and KTX2 come first:
/// the other one is for programs that do not read them, and for KTX2 of Basis Universal.
fn source(texture: &Texture) -> Option<(Index, &'static str)> {
    let of = |extension: &Option<TextureSource>| extension.as_ref()?.source;
    let extensions = &texture.extensions;
    [
        (of(&extensions.webp), "extensions/EXT_texture_webp/source"),
        (of(&extensions.dds), "extensions/MSFT_texture_dds/source"),
        (
            of(&extensions.basisu),
            "extensions/KHR_texture_basisu/source",
        ),
        (texture.source, "source"),
    ]
    .into_iter()
    .find_map(|(source, property)| Some((source?, property)))
}

/// Filters and address modes by the numbers that they have in OpenGL; the defaults for others.
fn sampler_of(sampler: &Sampler) -> TextureSampler {
    use TextureFilter::{Linear, Nearest};
    let wrap = |number: Option<Index>| match number {
        Some(Index(33071)) => AddressMode::ClampToEdge,
        Some(Index(33648)) => AddressMode::MirrorRepeat,
        _ => AddressMode::Repeat,
    };
    let (minify, mipmap) = match sampler.min_filter {
        Some(Index(9728)) => (Nearest, None),
        Some(Index(9729)) => (Linear, None),
        Some(Index(9984)) => (Nearest, Some(Nearest)),
        Some(Index(9985)) => (Linear, Some(Nearest)),
        Some(Index(9986)) => (Nearest, Some(Linear)),
        _ => (Linear, Some(Linear)),
    };
    TextureSampler {
        wrap_u: wrap(sampler.wrap_s),
        wrap_v: wrap(sampler.wrap_t),
        magnify: match sampler.mag_filter {
            Some(Index(9728)) => Nearest,
            _ => Linear,
        },
        minify,
        mipmap,
    }
}
