//! Compressed blocks, decoded when a texture is made.
//!
//! BC1 to BC7 are [`bcdec_rs`]'s, ASTC [`astc_decode`]'s; ETC2 and EAC are ours, because the libraries give 8 of
//! EAC's 11 bits. This module alone names the libraries.

mod etc;

use estampe_types::TextureFormat;

/// The most texels and words of a decoded block: 12×12 of ASTC, one word each.
pub(crate) const MAX_WORDS: usize = 144;

/// Decodes a block to the words of [`Texture::stored_format`](estampe_types::Texture::stored_format), row by row.
/// `block` has the format's number of bytes; formats without blocks give nothing.
pub(crate) fn decode(format: TextureFormat, block: &[u8], words: &mut [u32; MAX_WORDS]) {
    use TextureFormat as F;
    match format {
        F::Bc1RgbaUnorm | F::Bc1RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc1(block, to, 16)),
        F::Bc2RgbaUnorm | F::Bc2RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc2(block, to, 16)),
        F::Bc3RgbaUnorm | F::Bc3RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc3(block, to, 16)),
        F::Bc7RgbaUnorm | F::Bc7RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc7(block, to, 16)),
        F::Bc4RUnorm | F::Bc4RSnorm => {
            let mut to = [0.0; 16];
            bcdec_rs::bc4_float(block, &mut to, 4, format == F::Bc4RSnorm);
            floats(words, &to);
        }
        F::Bc5RgUnorm | F::Bc5RgSnorm => {
            let mut to = [0.0; 32];
            bcdec_rs::bc5_float(block, &mut to, 8, format == F::Bc5RgSnorm);
            floats(words, &to);
        }
        F::Bc6hRgbUfloat | F::Bc6hRgbFloat => {
            let mut to = [0; 48];
            bcdec_rs::bc6h_half(block, &mut to, 12, format == F::Bc6hRgbFloat);
            for (texel, rgb) in words.chunks_exact_mut(2).zip(to.as_chunks::<3>().0) {
                let [r, g, b] = rgb.map(u32::from);
                texel.copy_from_slice(&[r | g << 16, b | 0x3C00 << 16]);
            }
        }
        _ if format.block_size() != [4, 4] || is_astc(format) => astc(format, block, words),
        _ => etc::decode(format, block, words),
    }
}

fn is_astc(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Astc4x4Unorm | TextureFormat::Astc4x4UnormSrgb
    )
}

/// Sixteen texels of four bytes.
fn bytes(words: &mut [u32], decode: impl FnOnce(&mut [u8])) {
    let mut to = [0; 64];
    decode(&mut to);
    for (word, bytes) in words.iter_mut().zip(to.as_chunks::<4>().0) {
        *word = u32::from_le_bytes(*bytes);
    }
}

fn floats(words: &mut [u32], from: &[f32]) {
    for (word, value) in words.iter_mut().zip(from) {
        *word = value.to_bits();
    }
}

fn astc(format: TextureFormat, block: &[u8], words: &mut [u32; MAX_WORDS]) {
    let (Ok(block), [width, height]) = (block.try_into(), format.block_size()) else {
        return;
    };
    let footprint = astc_decode::Footprint::new(width, height);
    astc_decode::astc_decode_block(block, footprint, |x, y, rgba| {
        if let Some(word) = words.get_mut((y * width + x) as usize) {
            *word = u32::from_le_bytes(rgba);
        }
    });
}
