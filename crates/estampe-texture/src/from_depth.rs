//! Conversion of a depth image to a texture.

use crate::{LevelData, MipGeneration, TexelDescriptor, TextureError};
use estampe_types::{Limits, ShadowMap, TexelData, TextureFormat};

/// Copies a depth image, such as a depth attachment of an earlier pass, to a texture of
/// [`TextureFormat::Depth32Float`], which can be sampled, gathered and compared like any other
/// texture. [`sample_compare_level`](crate::sample_compare_level) reads the image without a copy.
///
/// # Errors
/// [`TextureError`] when the image is empty, or memory is short.
pub fn texture_from_depth(depth: &ShadowMap) -> Result<TexelData, TextureError> {
    let (width, height) = (depth.width(), depth.height());
    let descriptor = TexelDescriptor::new_2d(width, height, TextureFormat::Depth32Float);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let bytes: Vec<u8> = places
        .flat_map(|(x, y)| depth.texel(x, y).to_le_bytes())
        .collect();
    let data = [LevelData::tight(&bytes)];
    descriptor.create(&data, MipGeneration::None, &Limits::default())
}
