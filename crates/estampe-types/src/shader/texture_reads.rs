//! How shaders read a texture that is bound without a sampler.

use std::ops::BitOr;

/// The ways in which the shaders of a pipeline read a texture, beside its size: it need only be
/// there in the order of storage that they take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TextureReads {
    /// Comparisons with a reference, without an offset, as a shadow map is read.
    pub compares: bool,
    /// Loads of the finest level at the fragment's own pixel.
    pub at_pixel: bool,
    /// Others: any texel may be read.
    pub others: bool,
}

impl TextureReads {
    /// All ways: nothing is known.
    pub const ALL: Self = Self {
        compares: true,
        at_pixel: true,
        others: true,
    };
}

impl BitOr for TextureReads {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self {
            compares: self.compares | other.compares,
            at_pixel: self.at_pixel | other.at_pixel,
            others: self.others | other.others,
        }
    }
}
