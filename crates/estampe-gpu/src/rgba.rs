//! Textures of four 8-bit channels as rows of RGBA, for PNG files and for the `image` crate.

use crate::{Device, Texture, TextureError, TextureFormat};

/// The texels of the first mip level and layer as RGBA, row after row from the top.
pub(crate) fn read(device: &Device, texture: &Texture) -> Result<Vec<u8>, TextureError> {
    let is_bgra = is_bgra(texture.format()).ok_or_else(|| TextureError::Unsupported {
        texture: texture.name(),
        format: texture.format(),
        samples: texture.sample_count(),
        rule: "pictures are of rgba8unorm, bgra8unorm or their sRGB counterparts: blit it into one",
    })?;
    let mut texels = device.read_texture(texture)?;
    if is_bgra {
        swap_red_and_blue(&mut texels);
    }
    Ok(texels)
}

/// Returns true if blue comes first; `None` of formats that are not four channels of eight bits.
pub(crate) fn is_bgra(format: TextureFormat) -> Option<bool> {
    use TextureFormat as F;
    match format {
        F::Rgba8Unorm | F::Rgba8UnormSrgb => Some(false),
        F::Bgra8Unorm | F::Bgra8UnormSrgb => Some(true),
        _ => None,
    }
}

pub(crate) fn swap_red_and_blue(texels: &mut [u8]) {
    for texel in texels.as_chunks_mut::<4>().0 {
        texel.swap(0, 2);
    }
}
