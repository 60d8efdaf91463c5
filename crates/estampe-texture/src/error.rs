//! What can be wrong with a texture.

use estampe_types::TextureFormat;

/// The rule that the creation of a texture broke.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A side of length zero.
    #[error("a texture has at least one texel, this one is {width}×{height}")]
    Empty {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
    },
    /// A side beyond [`Limits::max_texture_dimension_2d`](estampe_types::Limits).
    #[error("{width}×{height} texels exceed the limit max_texture_dimension_2d = {limit}")]
    TooLarge {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
        /// The limit.
        limit: u32,
    },
    /// More texels, all levels together, than offsets can count.
    #[error("{texels} texels in all levels exceed 2^31 − 1")]
    TooManyTexels {
        /// Texels of all levels.
        texels: u64,
    },
    /// A level's bytes do not fill it, or overfill it.
    #[error("level {level} takes {expected} bytes (4 a texel), not {actual}")]
    ByteCount {
        /// Which level; 0 is the full size.
        level: usize,
        /// Width · height · 4.
        expected: u64,
        /// What was given.
        actual: u64,
    },
    /// No level at all, or more than halving down to 1×1 gives.
    #[error("a texture of this size has 1 to {most} levels, not {actual}")]
    LevelCount {
        /// The length of the full chain.
        most: usize,
        /// What was given.
        actual: usize,
    },
    /// A format that cannot be made from 8-bit RGBA bytes.
    #[error("{format:?} cannot be filled with four 8-bit channels")]
    Format {
        /// The format.
        format: TextureFormat,
    },
}
