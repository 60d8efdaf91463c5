//! Accesses to textures.

use super::Value;

/// An access to a texture. Unused fields are empty or `None`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct TextureOp {
    /// What is asked.
    pub query: TextureQuery,
    /// The position of the texture in the interface.
    pub texture: u32,
    /// The position of the sampler in the interface.
    pub sampler: Option<u32>,
    /// One to three coordinates: floats where a sampler is used (cubes: a direction), integers of
    /// texels otherwise.
    pub coordinates: Vec<Value>,
    /// The layer of an array, a signed integer.
    pub layer: Option<Value>,
    /// Texels that are added to the coordinates.
    pub offset: [i32; 3],
    /// The level of detail.
    pub level: LevelOfDetail,
    /// The depth that is compared with the texels'.
    pub reference: Option<Value>,
    /// The sample of a multisampled texture.
    pub sample: Option<Value>,
    /// The four words that are stored.
    pub stored: Vec<Value>,
    /// The lanes that run. Implicit levels of detail take derivatives of 0 in quads of which a lane
    /// is not in the mask. Results in other lanes are unspecified.
    pub mask: Value,
}

/// What is asked of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextureQuery {
    /// The filtered texel: four words.
    Sample,
    /// The filtered comparison with the reference: one word, a float.
    SampleCompare,
    /// A component (0 to 3) of the four texels that linear filtering would mix: four words.
    Gather(u8),
    /// The four comparisons: four words.
    GatherCompare,
    /// A texel: four words.
    Load,
    /// Stores a texel: no result.
    Store,
    /// Width, height and depth of a level: three words.
    Size,
    /// The number of levels: one word.
    Levels,
    /// The number of layers: one word.
    Layers,
    /// The number of samples: one word.
    Samples,
}

impl TextureQuery {
    /// True if the texture's shape is asked for: no texel is touched, and no mask counts.
    #[must_use]
    pub fn is_of_shape(self) -> bool {
        matches!(
            self,
            Self::Size | Self::Levels | Self::Layers | Self::Samples
        )
    }

    /// The number of words that the access gives.
    #[must_use]
    pub fn results(self) -> u32 {
        match self {
            Self::Sample | Self::Gather(_) | Self::GatherCompare | Self::Load => 4,
            Self::Size => 3,
            Self::SampleCompare | Self::Levels | Self::Layers | Self::Samples => 1,
            Self::Store => 0,
        }
    }
}

/// The level of detail of an access.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum LevelOfDetail {
    /// The base level, or none where a texture has none.
    Zero,
    /// From the derivatives in the quad.
    Implicit,
    /// From the derivatives in the quad, plus a float.
    Bias(Value),
    /// A float of sampled textures, an integer of loads and queries.
    Explicit(Value),
    /// From these derivatives of the coordinates, which the lane has of itself: no quad counts.
    Gradient {
        /// Along a row.
        x: Vec<Value>,
        /// Along a column.
        y: Vec<Value>,
    },
}
