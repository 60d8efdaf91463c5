//! A plain texture as the oracle samples it.

use super::{PlainImage, PlainTexture};
use crate::texture::ReferenceView;
use estampe_types::{
    Lines, MipLevel, SamplerDescriptor, TexelData, TextureFormat, TextureShape, ViewDimension,
};
use std::sync::Arc;

/// Decodes a compressed block to the words of
/// [`TexelData::stored_format`](estampe_types::TexelData::stored_format), row by row.
pub type BlockDecoder = fn(TextureFormat, &[u8]) -> Vec<u32>;

/// The texture, as a view with a format that differs at most in sRGB shows it. Blocks are decoded
/// in the texture's own format.
#[must_use]
pub fn texture(plain: &PlainTexture, format: TextureFormat, decode: BlockDecoder) -> TexelData {
    let mut texture = TexelData {
        format,
        levels: Vec::new(),
        texels: Arc::default(),
        is_opaque: false,
        alpha_maps: Arc::default(),
        squares: Arc::default(),
        shape: TextureShape {
            dimension: plain.dimension,
            depth_or_layers: plain.size[2],
            samples: plain.samples,
        },
    };
    let mut words = Vec::new();
    let mut offset = 0;
    for (level, images) in (0..).zip(&plain.levels) {
        let [width, height, slices] = plain.level_size(level);
        texture.levels.push(MipLevel {
            width,
            height,
            offset,
        });
        offset += width * height * slices * plain.samples;
        for image in images {
            if format.is_compressed() {
                words.extend(decoded(
                    image,
                    plain.format,
                    texture.words_per_texel(),
                    decode,
                ));
            } else {
                let texels = image.rows.iter().flatten().copied().collect::<Vec<u8>>();
                let texels = texels.chunks(format.block_bytes() as usize);
                words.extend(texels.flat_map(|texel| words_of(format, texel)));
            }
        }
    }
    texture.texels = Arc::new(Lines::from(words));
    texture
}

/// The 2D view of one image of a texture.
#[must_use]
pub fn image_view(
    texture: Arc<TexelData>,
    [level, layer]: [u32; 2],
    sampler: SamplerDescriptor,
) -> ReferenceView {
    ReferenceView {
        dimension: ViewDimension::D2,
        levels: [level as usize, 1],
        layers: [layer, 1],
        ..ReferenceView::of_image(texture, sampler)
    }
}

/// The words of a texel: its bytes from the lowest on, R first.
#[must_use]
pub fn words_of(format: TextureFormat, texel: &[u8]) -> Vec<u32> {
    let mut bytes = texel.to_vec();
    if format.is_bgra() {
        bytes.swap(0, 2);
    }
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let words = bytes.as_chunks().0.iter();
    words.map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

/// The texels of an image of blocks.
fn decoded(
    image: &PlainImage,
    format: TextureFormat,
    words_each: usize,
    decode: BlockDecoder,
) -> Vec<u32> {
    let [width, height] = image.size.map(|side| side as usize);
    let [block_width, block_height] = format.block_size().map(|side| side as usize);
    let mut words = vec![0; width * height * words_each];
    for (row, blocks) in image.rows.iter().enumerate() {
        let blocks = blocks.chunks(format.block_bytes() as usize);
        for (column, block) in blocks.enumerate() {
            let texels = decode(format, block);
            for (at, texel) in texels.chunks(words_each).enumerate() {
                let x = column * block_width + at % block_width;
                let y = row * block_height + at / block_width;
                if x < width && y < height && at < block_width * block_height {
                    words[(y * width + x) * words_each..][..words_each].copy_from_slice(texel);
                }
            }
        }
    }
    words
}
