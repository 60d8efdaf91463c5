//! Errors of textures, views and samplers.

use super::{Extent3d, TextureUsages};
use estampe_types::TextureFormat;

/// The reason why a texture, a view or a sampler was not created, or texels were not copied.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A rule of the descriptor, of a view or of a sampler.
    #[error(transparent)]
    Rule(#[from] estampe_texture::TextureError),
    /// Too many layers, or a side of a 1D or 3D texture that is too long.
    #[error("{value} {what} exceed the limit {limit_name} = {limit}")]
    Limit {
        /// What is limited: layers, or texels of a side.
        what: &'static str,
        /// The number of them.
        value: u32,
        /// The limit's name.
        limit_name: &'static str,
        /// The limit.
        limit: u32,
    },
    /// A use that the texture was not created for.
    #[error("{texture} was created without TextureUsages::{}: add it to its usage", names(*needed))]
    Usage {
        /// The texture.
        texture: String,
        /// The use.
        needed: TextureUsages,
    },
    /// The system has not enough memory.
    #[error("no memory for an image of {bytes} bytes")]
    OutOfMemory {
        /// The bytes that it takes.
        bytes: u64,
    },
    /// A region that is not in the texture, or that cuts blocks.
    #[error(
        "texels ({}, {}, {}) to ({}, {}, {}) of level {level} of {texture}: the level has {}x{}x{}, and a \
         region begins and ends at blocks of {}x{} texels or at the level's end",
        origin[0], origin[1], origin[2],
        u64::from(origin[0]) + u64::from(size.width),
        u64::from(origin[1]) + u64::from(size.height),
        u64::from(origin[2]) + u64::from(size.depth_or_array_layers),
        level_size.width, level_size.height, level_size.depth_or_array_layers,
        block[0], block[1]
    )]
    Region {
        /// The texture.
        texture: String,
        /// The mip level.
        level: u32,
        /// The first texel of the region.
        origin: [u32; 3],
        /// The size of the region.
        size: Extent3d,
        /// The size of the level; zeros if the texture does not have it.
        level_size: Extent3d,
        /// The size of a block of the format, in texels.
        block: [u32; 2],
    },
    /// The host's memory does not hold the region.
    #[error(
        "a region of {texture} takes {expected} bytes with {bytes_per_row} bytes a row, and {actual} are given"
    )]
    Bytes {
        /// The texture.
        texture: String,
        /// The bytes that the region takes.
        expected: u64,
        /// The least bytes from row to row.
        bytes_per_row: u64,
        /// The bytes that are given.
        actual: u64,
    },
    /// An operation that the texture's format or samples do not allow.
    #[error("{texture} of format {} with {samples} samples: {rule}", format.name())]
    Unsupported {
        /// The texture.
        texture: String,
        /// Its format.
        format: TextureFormat,
        /// Its samples per texel.
        samples: u32,
        /// The rule that it breaks.
        rule: &'static str,
    },
}

fn names(usages: TextureUsages) -> String {
    let names: Vec<&str> = usages.iter_names().map(|(name, _)| name).collect();
    names.join(" | ")
}
