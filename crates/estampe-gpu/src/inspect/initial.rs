//! The oracle's target at the beginning of a pass: cleared, or with what the attachments hold.

use crate::Context;
use crate::pass::{Attachments, PassErrorKind, Use};
use crate::texture::words_of;
use estampe_core::LoadOp;
use estampe_reference::{PixelBounds, Target, channel, color};
use estampe_types::{TexelEncoding, TextureFormat};

/// The format in which the oracle draws a hole; nothing of it is told.
const HOLE: TextureFormat = TextureFormat::Rgba8Unorm;

/// The target of a pass, of which some pixels are stored.
pub(super) fn target(
    context: &Context,
    attachments: &Attachments<'_>,
    stored: PixelBounds,
) -> Result<Target, PassErrorKind> {
    let size = attachments.size;
    let formats = attachments.formats.iter().copied();
    let formats: Vec<_> = formats.map(|format| format.unwrap_or(HOLE)).collect();
    let depth_stencil = attachments.depth_stencil.as_ref();
    let depth_format = depth_stencil.map(|(image, _)| image.view.format());
    let mut target = Target::of_part(
        [size.width, size.height],
        size.samples,
        &formats,
        depth_format,
        stored,
    );
    let (load_colors, load_depth, load_stencil) = attachments.loads();
    let with_format = (0..formats.len()).filter(|&at| attachments.formats[at].is_some());
    let colors = with_format.zip(attachments.colors.iter().zip(load_colors));
    for (index, (attachment, load)) in colors {
        match load {
            LoadOp::Clear(clear) => target.clear_color(index, clear),
            LoadOp::Load => {
                let format = formats[index];
                let first = index * target.len();
                for (at, words) in texels(context, &attachment.image, &target)? {
                    target.color[first + at] = codes(format, &words);
                }
            }
        }
    }
    let Some((image, _)) = depth_stencil else {
        return Ok(target);
    };
    match load_depth {
        LoadOp::Clear(depth) => target.clear_depth(depth),
        LoadOp::Load if !target.depth.is_empty() => {
            for (at, words) in texels(context, image, &target)? {
                target.depth[at] = depth_of(image.view.format(), &words);
            }
        }
        LoadOp::Load => {}
    }
    match load_stencil {
        LoadOp::Clear(stencil) => target.clear_stencil(stencil),
        LoadOp::Load if !target.stencil.is_empty() => {
            for (at, words) in texels(context, image, &target)? {
                target.stencil[at] = stencil_of(image.view.format(), &words);
            }
        }
        LoadOp::Load => {}
    }
    Ok(target)
}

/// The words of the stored samples of an attachment, each with its index in the target.
fn texels(
    context: &Context,
    image: &Use<'_>,
    target: &Target,
) -> Result<Vec<(usize, Vec<u32>)>, PassErrorKind> {
    let texture = image.view.texture();
    let data = texture.lock().rows(texture, context);
    let data = data.map_err(|error| PassErrorKind::Texture {
        attachment: image.role.to_string(),
        error,
    })?;
    let each = data.words_per_texel();
    let words = &data.texels[words_of(&data, image.key)];
    let mut texels = Vec::with_capacity(target.len());
    for y in target.stored().y.clone() {
        for x in target.stored().x.clone() {
            let pixel = y as usize * target.width as usize + x as usize;
            for sample in 0..target.samples {
                let at = (pixel * target.samples as usize + sample as usize) * each;
                texels.push((target.index([x, y], sample), words[at..at + each].to_vec()));
            }
        }
    }
    Ok(texels)
}

/// The codes of a texel in row order, in which red is first in every format.
fn codes(format: TextureFormat, words: &[u32]) -> color::Codes {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let [first, g, third, a] = color::codes(format, &bytes[..format.block_bytes() as usize]);
    if format.is_bgra() {
        [third, g, first, a]
    } else {
        [first, g, third, a]
    }
}

fn depth_of(format: TextureFormat, words: &[u32]) -> f32 {
    match format.encoding() {
        TexelEncoding::Depth16 => (words[0] & 0xFFFF) as f32 / 65_535.0,
        TexelEncoding::Depth24 => (words[0] & 0x00FF_FFFF) as f32 / 16_777_215.0,
        _ => channel::loaded_depth(f32::from_bits(words[0])),
    }
}

fn stencil_of(format: TextureFormat, words: &[u32]) -> u8 {
    let bytes = match format {
        TextureFormat::Depth24PlusStencil8 => return words[0].to_le_bytes()[3],
        TextureFormat::Depth32FloatStencil8 => words[1].to_le_bytes(),
        _ => words[0].to_le_bytes(),
    };
    bytes[0]
}
