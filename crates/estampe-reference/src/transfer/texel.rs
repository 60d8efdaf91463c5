//! The bytes of a texel, and of its depth and its stencil.
//!
//! ```text
//!   depth24plus            d d d 0            depth            d d d 0
//!   depth24plus-stencil8   d d d s            depth, stencil   d d d 0    s
//!   depth32float-stencil8  d d d d s 0 0 0    depth, stencil   d d d d    s
//! ```

use estampe_types::{TextureAspect, TextureFormat};

/// Returns true if texels of the format have the aspect.
#[must_use]
pub fn has_aspect(format: TextureFormat, aspect: TextureAspect) -> bool {
    match aspect {
        TextureAspect::All => true,
        TextureAspect::Depth => format.has_depth(),
        TextureAspect::Stencil => format.has_stencil(),
    }
}

/// The bytes of an aspect of a texel that has it, of one sample; or of a block.
#[must_use]
pub fn aspect_of(format: TextureFormat, aspect: TextureAspect, texel: &[u8]) -> Vec<u8> {
    use TextureFormat as F;
    match (format, aspect) {
        (F::Depth24PlusStencil8, TextureAspect::Depth) => [&texel[..3], &[0]].concat(),
        (F::Depth24PlusStencil8, TextureAspect::Stencil) => vec![texel[3]],
        (F::Depth32FloatStencil8, TextureAspect::Depth) => texel[..4].to_vec(),
        (F::Depth32FloatStencil8, TextureAspect::Stencil) => vec![texel[4]],
        _ => texel.to_vec(),
    }
}

/// Replaces an aspect of a texel. Bytes that belong to no aspect stay zero.
pub fn set_aspect(format: TextureFormat, aspect: TextureAspect, texel: &mut [u8], bytes: &[u8]) {
    use TextureFormat as F;
    match (format, aspect) {
        (F::Depth24Plus, _) | (F::Depth24PlusStencil8, TextureAspect::Depth) => {
            texel[..3].copy_from_slice(&bytes[..3]);
        }
        (F::Depth24PlusStencil8, TextureAspect::Stencil) => texel[3] = bytes[0],
        (F::Depth32FloatStencil8, TextureAspect::Depth) => texel[..4].copy_from_slice(bytes),
        (F::Depth32FloatStencil8, TextureAspect::Stencil) => texel[4] = bytes[0],
        (F::Depth32FloatStencil8, TextureAspect::All) => texel[..5].copy_from_slice(&bytes[..5]),
        _ => texel.copy_from_slice(bytes),
    }
}

/// The number of bytes of an aspect of a texel, or of a block.
#[must_use]
pub fn aspect_bytes(format: TextureFormat, aspect: TextureAspect) -> usize {
    let zeros = vec![0; format.block_bytes() as usize];
    aspect_of(format, aspect, &zeros).len()
}
