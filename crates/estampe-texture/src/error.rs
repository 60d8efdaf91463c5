//! What can be wrong with a texture.

use estampe_types::{TextureDimension, TextureFormat};

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
    #[error("{texels} texels in all levels exceed 2^31 − 1 words of four bytes")]
    TooManyTexels {
        /// Texels of all levels.
        texels: u64,
    },
    /// A level's bytes do not fill it, or overfill it.
    #[error("level {level} takes {expected} bytes, not {actual}")]
    ByteCount {
        /// Which level; 0 is the full size.
        level: usize,
        /// What the level takes.
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
    /// Other layers or depth than the dimension allows, or a row of some height.
    #[error(
        "a {dimension:?} texture has 1 to {most} layers or slices, not {slices}, and a D1 texture has height 1, \
         not {height}"
    )]
    Slices {
        /// Along how many axes it is filtered.
        dimension: TextureDimension,
        /// Height in texels.
        height: u32,
        /// The depth or layers that were asked for.
        slices: u32,
        /// The most that there may be.
        most: u32,
    },
    /// Blocks, depth or stencil in one or three dimensions.
    #[error("textures of {format:?} are 2D: choose TextureDimension::D2")]
    NotFlat {
        /// The format.
        format: TextureFormat,
    },
    /// A number of samples that does not exist, or more than one where there is but one.
    #[error(
        "{samples} samples: textures have 1 sample; 2D textures of one level and no blocks have 1, 2, 4, 8 or 16"
    )]
    Samples {
        /// The number that was asked for.
        samples: u32,
    },
    /// Rows that overlap.
    #[error(
        "a row of level {level} has {bytes_per_row} bytes and an image {rows_per_image} rows: bytes_per_row and \
         rows_per_image cannot be less"
    )]
    RowLayout {
        /// Which level; 0 is the full size.
        level: usize,
        /// The least bytes from row to row.
        bytes_per_row: u64,
        /// The least rows from slice to slice.
        rows_per_image: u64,
    },
    /// Levels are to be made of a format of integers, depth or stencil.
    #[error("levels of {format:?} cannot be made: give their data, or choose MipGeneration::None")]
    MipGeneration {
        /// The format.
        format: TextureFormat,
    },
    /// A format whose texels shaders cannot store.
    #[error(
        "{format:?} cannot be stored to: choose a colour format without blocks, sRGB or shared exponent"
    )]
    NotStorable {
        /// The format.
        format: TextureFormat,
    },
    /// There is no memory for it.
    #[error("no memory for a texture of {bytes} bytes")]
    OutOfMemory {
        /// Its size.
        bytes: u64,
    },
    /// A part of a texture that it does not have.
    #[error("the view asks for {what}, which the texture does not have")]
    View {
        /// What is missing.
        what: &'static str,
    },
    /// A sampler that cannot sample the texture, or none.
    #[error("{what}")]
    Sampler {
        /// The rule that was broken.
        what: &'static str,
    },
    /// A format that cannot be made from 8-bit RGBA bytes.
    #[error("{format:?} cannot be filled with four 8-bit channels")]
    Format {
        /// The format.
        format: TextureFormat,
    },
}
