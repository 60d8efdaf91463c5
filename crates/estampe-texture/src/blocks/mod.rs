//! Decoding of compressed blocks, when a texture is created.
//!
//! BC1 to BC7 are [`bcdec_rs`]'s. ETC2, EAC and ASTC are decoded by this crate: libraries gave 8 of
//! EAC's 11 bits, and decoded ASTC's sRGB as if it were linear. Only this module uses the library.

mod astc;
mod etc;

use estampe_types::TextureFormat;

/// The most texels and words of a decoded block: 12×12 of ASTC, one word each.
pub const MAX_WORDS: usize = 144;

/// Decodes a block to the words of
/// [`TexelData::stored_format`](estampe_types::TexelData::stored_format), row by row. `block` has
/// the format's number of bytes; formats without blocks give nothing.
pub fn decode(format: TextureFormat, block: &[u8], words: &mut [u32; MAX_WORDS]) {
    use TextureFormat as F;
    let is_astc_4x4 = matches!(format, F::Astc4x4Unorm | F::Astc4x4UnormSrgb);
    match format {
        F::Bc1RgbaUnorm | F::Bc1RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc1(block, to, 16)),
        F::Bc2RgbaUnorm | F::Bc2RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc2(block, to, 16)),
        F::Bc3RgbaUnorm | F::Bc3RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc3(block, to, 16)),
        F::Bc7RgbaUnorm | F::Bc7RgbaUnormSrgb => bytes(words, |to| bcdec_rs::bc7(block, to, 16)),
        F::Bc4RUnorm | F::Bc4RSnorm => {
            let mut to = [0.0; 16];
            bcdec_rs::bc4_float(block, &mut to, 4, format == F::Bc4RSnorm);
            if format == F::Bc4RSnorm && has_both_ends_at_minus_one(block) {
                to.fill(-1.0);
            }
            floats(words, &to);
        }
        F::Bc5RgUnorm | F::Bc5RgSnorm => {
            let mut to = [0.0; 32];
            bcdec_rs::bc5_float(block, &mut to, 8, format == F::Bc5RgSnorm);
            for (channel, block) in block.as_chunks::<8>().0.iter().enumerate() {
                if format == F::Bc5RgSnorm && has_both_ends_at_minus_one(block) {
                    to.iter_mut()
                        .skip(channel)
                        .step_by(2)
                        .for_each(|x| *x = -1.0);
                }
            }
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
        _ => {
            let size = format.block_size();
            match block.try_into() {
                // Only ASTC has blocks of other sizes.
                Ok(block) if size != [4, 4] || is_astc_4x4 => {
                    astc::decode(block, size, format.is_srgb(), words);
                }
                _ => etc::decode(format, block, words),
            }
        }
    }
}

/// Returns true if the endpoints of a snorm channel are −127 and −128. The order of the encoded
/// endpoints decides between the two ramps, but the library compares their numbers. The two orders
/// differ only for these endpoints. As the first endpoint is the greater, all eight steps lie
/// between two numbers −1.
fn has_both_ends_at_minus_one(channel: &[u8]) -> bool {
    channel.starts_with(&[-127_i8, -128].map(i8::cast_unsigned))
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
