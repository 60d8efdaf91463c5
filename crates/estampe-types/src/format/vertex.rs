//! Formats of vertex attributes and indices.

/// How an attribute lies in a vertex buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum VertexFormat {
    /// One 32-bit float.
    Float32,
    /// Two.
    Float32x2,
    /// Three.
    Float32x3,
    /// Four.
    Float32x4,
    /// Two 8-bit unsigned normalised numbers: c / 255.
    Unorm8x2,
    /// Four.
    Unorm8x4,
    /// Two 16-bit unsigned normalised numbers: c / 65535.
    Unorm16x2,
    /// Four.
    Unorm16x4,
}

impl VertexFormat {
    /// How many numbers it holds.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Float32 => 1,
            Self::Float32x2 | Self::Unorm8x2 | Self::Unorm16x2 => 2,
            Self::Float32x3 => 3,
            Self::Float32x4 | Self::Unorm8x4 | Self::Unorm16x4 => 4,
        }
    }

    /// How many bytes it takes.
    #[must_use]
    pub const fn size_bytes(self) -> usize {
        match self {
            Self::Unorm8x2 => 2,
            Self::Float32 | Self::Unorm8x4 | Self::Unorm16x2 => 4,
            Self::Float32x2 | Self::Unorm16x4 => 8,
            Self::Float32x3 => 12,
            Self::Float32x4 => 16,
        }
    }
}

/// How wide an index is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum IndexFormat {
    /// 8 bits.
    Uint8,
    /// 16 bits.
    Uint16,
    /// 32 bits.
    #[default]
    Uint32,
}
