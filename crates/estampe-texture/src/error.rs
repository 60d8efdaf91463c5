//! Errors of creating textures, views and samplers.

use estampe_types::{TextureDimension, TextureFormat};

/// The rule that the creation of a texture, a view or a sampler broke.
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
    /// The texels of all levels together exceed 2³¹ − 1 words.
    #[error("{texels} texels in all levels exceed 2^31 − 1 words of four bytes")]
    TooManyTexels {
        /// Texels of all levels.
        texels: u64,
    },
    /// The number of bytes is not that of the level.
    #[error("level {level} takes {expected} bytes, not {actual}")]
    ByteCount {
        /// The mip level; 0 is the full size.
        level: usize,
        /// The bytes that the level takes.
        expected: u64,
        /// The number that was given.
        actual: u64,
    },
    /// There is no level, or there are more than halving down to 1×1 gives.
    #[error("a texture of this size has 1 to {most} levels, not {actual}")]
    LevelCount {
        /// The number of levels of the full chain.
        most: usize,
        /// The number that was given.
        actual: usize,
    },
    /// The dimension does not allow this number of layers or slices, or a 1D texture has another
    /// height than 1.
    #[error(
        "a {dimension:?} texture has 1 to {most} layers or slices, not {slices}, and a D1 texture has height 1, \
         not {height}"
    )]
    Slices {
        /// Dimension: the number of axes along which the texture is filtered.
        dimension: TextureDimension,
        /// Height in texels.
        height: u32,
        /// The depth or the number of layers that was asked for.
        slices: u32,
        /// The most layers or slices that are allowed.
        most: u32,
    },
    /// A compressed, depth or stencil format in one or three dimensions.
    #[error("textures of {format:?} are 2D: choose TextureDimension::D2")]
    NotFlat {
        /// The format.
        format: TextureFormat,
    },
    /// The number of samples is not 1, 2, 4, 8 or 16, or this texture can only have one sample.
    #[error(
        "{samples} samples: textures have 1 sample; 2D textures of one level and no blocks have 1, 2, 4, 8 or 16"
    )]
    Samples {
        /// The number that was asked for.
        samples: u32,
    },
    /// Rows or slices overlap, because a stride is too small.
    #[error(
        "a row of level {level} has {bytes_per_row} bytes and an image {rows_per_image} rows: bytes_per_row and \
         rows_per_image cannot be less"
    )]
    RowLayout {
        /// The mip level; 0 is the full size.
        level: usize,
        /// The least bytes from row to row.
        bytes_per_row: u64,
        /// The least rows from slice to slice.
        rows_per_image: u64,
    },
    /// Mip levels cannot be generated for a format of integers, depth or stencil.
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
    /// Memory does not hold the texture.
    #[error("no memory for a texture of {bytes} bytes")]
    OutOfMemory {
        /// Size of the texture in bytes.
        bytes: u64,
    },
    /// A view asks for a part that the texture does not have.
    #[error("the view asks for {what}, which the texture does not have")]
    View {
        /// The missing part.
        what: &'static str,
    },
    /// The sampler is invalid, or it cannot sample the texture.
    #[error("{what}")]
    Sampler {
        /// The rule that was broken.
        what: &'static str,
    },
    /// The format does not have four 8-bit channels.
    #[error("{format:?} cannot be filled with four 8-bit channels")]
    Format {
        /// The format.
        format: TextureFormat,
    },
}
