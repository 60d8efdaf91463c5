//! Finds the textures of materials, each file once.

use super::deferred::{Encoded, Origin};
use super::load::Context;
use super::resources::ResourceError;
use crate::{AssetError, Location};
use estampe_scene::{AlphaMode, Image};
use std::borrow::Cow;
use std::collections::HashMap;

/// A texture as named by a material.
#[derive(Debug, Clone)]
pub(super) struct TextureName {
    /// The file's name, relative to `folder` or to the model.
    pub(super) name: String,
    /// Folder of the file that names it, relative to the model, with its last separator; may be
    /// empty.
    pub(super) folder: String,
    /// The file that names it, for messages.
    pub(super) named_in: String,
    pub(super) location: Location,
}

/// The textures found so far.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// Indices of images by the resolved names of base colour and opacity; `None` is a file that
    /// failed before.
    known: HashMap<[Option<String>; 2], Option<usize>>,
}

/// The text of a name in a file: UTF-8, else Latin-1, in which every byte is a character.
pub(super) fn text_of_name(name: &[u8]) -> String {
    match std::str::from_utf8(name) {
        Ok(text) => text.to_owned(),
        Err(_) => name.iter().map(|&byte| char::from(byte)).collect(),
    }
}

impl Textures {
    /// The image of a base-colour texture, to be decoded later. If `opacity` is given, its alpha is
    /// that file's brightness. Without a base colour it is white. Failures are warnings.
    pub(super) fn load(
        &mut self,
        base: Option<&TextureName>,
        opacity: Option<&TextureName>,
        context: &mut Context<'_>,
    ) -> Option<usize> {
        let resolved = [base, opacity].map(|name| find(name?, context));
        let resolved = match resolved {
            // One file for both means that its own alpha is used.
            [Some(base), Some(opacity)] if base == opacity => [Some(base), None],
            other => other,
        };
        if resolved == [None, None] {
            return None;
        }
        if let Some(&known) = self.known.get(&resolved) {
            return known;
        }
        let mut read = |resolved: &Option<String>, name: Option<&TextureName>| {
            encoded(resolved.as_deref()?, name?, context)
        };
        let color = read(&resolved[0], base);
        let mask = read(&resolved[1], opacity);
        let image = context.images.add_texture(color, mask);
        self.known.insert(resolved, image);
        image
    }
}

/// The bytes of a file, with an image within the limits.
fn encoded<'a>(
    resolved: &str,
    name: &TextureName,
    context: &mut Context<'a>,
) -> Option<Encoded<'a>> {
    let origin = Origin::Named {
        file: name.named_in.clone(),
        location: Some(name.location),
        name: name.name.clone(),
    };
    let unreadable = |error: ResourceError| AssetError::io(error.to_string(), "");
    let read = context
        .resources
        .read(resolved, context.images.bytes_left());
    let encoded = read.map_err(unreadable).and_then(|bytes| {
        let bytes = Cow::Owned(bytes);
        context
            .images
            .encoded(bytes, origin.clone(), context.limits)
    });
    encoded
        .map_err(|error| origin.warn(&error, &mut context.warnings))
        .ok()
}

fn find(name: &TextureName, context: &mut Context<'_>) -> Option<String> {
    let beside = format!("{}{}", name.folder, name.name);
    let found = match context.find_side_file(&beside) {
        Err(ResourceError::NotFound) if !name.folder.is_empty() => {
            context.find_side_file(&name.name)
        }
        found => found,
    };
    found
        .or_else(|error| context.search_texture(&name.name, error))
        .map_err(|error| warn(name, &error.to_string(), context))
        .ok()
}

fn warn(name: &TextureName, reason: &str, context: &mut Context<'_>) {
    context.warnings.add(&name.named_in, name.location, || {
        format!("the texture `{}` is omitted: {reason}", name.name)
    });
}

/// `color` with the brightness of `mask` (its alpha, if it has any) as alpha; nearest texel if the
/// sizes differ.
pub(super) fn with_opacity(mut color: Image, mask: &Image) -> Image {
    let has_alpha = mask
        .rgba
        .as_chunks::<4>()
        .0
        .iter()
        .any(|texel| texel[3] != 255);
    let nearest = |at: u32, size: u32, of: u32| {
        let scaled = (u64::from(at) * 2 + 1) * u64::from(of) / (u64::from(size) * 2);
        u32::try_from(scaled).expect("it is below `of`")
    };
    for y in 0..color.height {
        let mask_y = nearest(y, color.height, mask.height);
        for x in 0..color.width {
            let [r, g, b, a] = mask.texel(nearest(x, color.width, mask.width), mask_y);
            let at = (y as usize * color.width as usize + x as usize) * 4;
            color.rgba[at + 3] = if has_alpha { a } else { brightness([r, g, b]) };
        }
    }
    color
}

/// The mean of the three, rounded.
fn brightness(rgb: [u8; 3]) -> u8 {
    let sum: u16 = rgb.iter().map(|&value| u16::from(value)).sum();
    u8::try_from((sum + 1) / 3).expect("a mean of bytes is a byte")
}

/// Classifies an alpha channel: all 255 is opaque, 0 and 255 a mask, all else blends. All 0 becomes
/// opaque: some programs write it into an unused channel.
pub(super) fn classify_alpha(image: &mut Image) -> AlphaMode {
    let texels = image.rgba.as_chunks_mut::<4>().0;
    if texels.iter().all(|texel| texel[3] == 255) {
        return AlphaMode::Opaque;
    }
    if texels.iter().all(|texel| texel[3] == 0) {
        for texel in texels {
            texel[3] = 255;
        }
        return AlphaMode::Opaque;
    }
    let is_binary = texels.iter().all(|texel| texel[3] == 0 || texel[3] == 255);
    if is_binary {
        AlphaMode::Mask
    } else {
        AlphaMode::Blend
    }
}
