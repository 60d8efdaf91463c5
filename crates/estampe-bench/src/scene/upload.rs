//! Conversion of generated textures to textures for shaders.

use crate::generate::MipChain;
use estampe::texture::{Sampled, create_texture_with_levels};
use estampe::{Limits, SamplerDescriptor, TextureFormat};

/// The texture with its own mip levels, repeated, linear within and between levels.
pub(super) fn trilinear(chain: &MipChain) -> Sampled {
    let levels: Vec<&[u8]> = chain.levels.iter().map(Vec::as_slice).collect();
    let size = (chain.size, chain.size);
    let format = TextureFormat::Rgba8Unorm;
    let texture = create_texture_with_levels(size, format, &levels, &Limits::default())
        .expect("the generators halve a power of two below the limits");
    Sampled::new(texture, SamplerDescriptor::trilinear_repeat())
}
