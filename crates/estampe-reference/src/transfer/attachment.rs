//! Images as attachments: loaded into a target before the draws of a pass, stored after them.

use super::PlainImage;
use super::texel::{aspect_of, set_aspect};
use crate::channel::loaded_depth;
use crate::{Target, color};
use estampe_types::{TexelEncoding, TextureAspect, TextureFormat};

/// Loads an image into a colour attachment of the same size; its format is the attachment's.
pub fn load_color(target: &mut Target, attachment: usize, image: &PlainImage) {
    let format = target.color_formats[attachment];
    let first = attachment * target.len();
    let samples = texels(image, format);
    for (stored, texel) in target.color[first..].iter_mut().zip(samples) {
        *stored = color::codes(format, texel);
    }
}

/// Stores a colour attachment into an image.
pub fn store_color(target: &Target, attachment: usize, image: &mut PlainImage) {
    let format = target.color_formats[attachment];
    let first = attachment * target.len();
    for (texel, codes) in texels_mut(image, format).zip(&target.color[first..]) {
        texel.copy_from_slice(&color::bytes(format, *codes));
    }
}

/// Stores the means of the samples of a colour attachment into an image of one sample.
pub fn resolve_color(target: &Target, attachment: usize, image: &mut PlainImage) {
    let format = target.color_formats[attachment];
    for (texel, codes) in texels_mut(image, format).zip(target.resolve(attachment)) {
        texel.copy_from_slice(&color::bytes(format, codes));
    }
}

/// Loads an image into the depth-stencil attachment. Depths are clamped to 0..=1, −0 stays, NaN
/// becomes 0.
///
/// # Panics
/// If the target has no depth-stencil attachment.
pub fn load_depth_stencil(target: &mut Target, image: &PlainImage) {
    let format = target.depth_stencil.expect("the target has the attachment");
    for (index, texel) in texels(image, format).enumerate() {
        if format.has_depth() {
            target.depth[index] = depth(format, texel);
        }
        if format.has_stencil() {
            target.stencil[index] = aspect_of(format, TextureAspect::Stencil, texel)[0];
        }
    }
}

/// Stores the depth-stencil attachment into an image.
///
/// # Panics
/// If the target has no depth-stencil attachment.
pub fn store_depth_stencil(target: &Target, image: &mut PlainImage) {
    let format = target.depth_stencil.expect("the target has the attachment");
    for (index, texel) in texels_mut(image, format).enumerate() {
        if format.has_depth() {
            set_depth(format, texel, target.depth[index]);
        }
        if format.has_stencil() {
            let stencil = [target.stencil[index]];
            set_aspect(format, TextureAspect::Stencil, texel, &stencil);
        }
    }
}

/// The depth of a texel as an attachment holds it.
#[must_use]
pub fn depth(format: TextureFormat, texel: &[u8]) -> f32 {
    let mut bytes = aspect_of(format, TextureAspect::Depth, texel);
    bytes.resize(4, 0);
    let code = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    match greatest_code(format) {
        Some(greatest) => code as f32 / greatest as f32,
        None => loaded_depth(f32::from_bits(code)),
    }
}

/// Sets the depth of a texel to one that the format has.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a code of at most 24 bits"
)]
pub fn set_depth(format: TextureFormat, texel: &mut [u8], depth: f32) {
    let code = match greatest_code(format) {
        // A stored depth is the f32 nearest to code ÷ greatest: the code is found again.
        Some(greatest) => (f64::from(depth) * f64::from(greatest)).round() as u32,
        None => depth.to_bits(),
    };
    let bytes = code.to_le_bytes();
    let len = aspect_of(format, TextureAspect::Depth, texel).len();
    set_aspect(format, TextureAspect::Depth, texel, &bytes[..len]);
}

/// 2ⁿ − 1 of a fixed-point depth of n bits; `None` for floats.
fn greatest_code(format: TextureFormat) -> Option<u32> {
    match format.encoding() {
        TexelEncoding::Depth16 => Some(0xFFFF),
        TexelEncoding::Depth24 => Some(0x00FF_FFFF),
        _ => None,
    }
}

/// The bytes of each sample of each texel of an image, row by row.
fn texels(image: &PlainImage, format: TextureFormat) -> impl Iterator<Item = &[u8]> {
    let rows = image.rows.iter();
    rows.flat_map(move |row| row.chunks(format.block_bytes() as usize))
}

fn texels_mut(image: &mut PlainImage, format: TextureFormat) -> impl Iterator<Item = &mut [u8]> {
    let rows = image.rows.iter_mut();
    rows.flat_map(move |row| row.chunks_mut(format.block_bytes() as usize))
}
