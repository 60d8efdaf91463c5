//! Formats of vertex attributes and indices.

/// How a number of an attribute becomes what a shader reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VertexEncoding {
    /// A float of 16 or 32 bits, as it is.
    Float,
    /// An unsigned code c of n bits: c / (2ⁿ − 1), in 0..=1.
    Unorm,
    /// A signed code c of n bits: max(c / (2ⁿ⁻¹ − 1), −1), in −1..=1.
    Snorm,
    /// An unsigned integer. Shaders get the bits of a 32-bit integer:
    /// [`Real::to_bits`](crate::Real::to_bits) reads it.
    Uint,
    /// A signed integer, which shaders get like an unsigned one.
    Sint,
}

macro_rules! vertex_formats {
    ($($(#[$doc:meta])* $name:ident: $encoding:ident, $components:literal x $bits:literal;)+) => {
        /// How an attribute lies in a vertex buffer. (WebGPU's `GPUVertexFormat`.)
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum VertexFormat {
            $($(#[$doc])* $name,)+
            /// Three 10-bit unsigned normalised numbers from the lowest bits on, then one of 2 bits.
            Unorm10_10_10_2,
            /// Four 8-bit unsigned normalised numbers that lie as b, g, r, a and are read as r, g, b, a.
            Unorm8x4Bgra,
        }

        impl VertexFormat {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$name,)+ Self::Unorm10_10_10_2, Self::Unorm8x4Bgra];

            /// How many numbers it holds.
            #[must_use]
            pub const fn components(self) -> usize {
                match self {
                    $(Self::$name => $components,)+
                    Self::Unorm10_10_10_2 | Self::Unorm8x4Bgra => 4,
                }
            }

            /// How many bytes it takes.
            #[must_use]
            pub const fn size_bytes(self) -> usize {
                match self {
                    $(Self::$name => $components * $bits / 8,)+
                    Self::Unorm10_10_10_2 | Self::Unorm8x4Bgra => 4,
                }
            }

            /// What its numbers are.
            #[must_use]
            pub const fn encoding(self) -> VertexEncoding {
                match self {
                    $(Self::$name => VertexEncoding::$encoding,)+
                    Self::Unorm10_10_10_2 | Self::Unorm8x4Bgra => VertexEncoding::Unorm,
                }
            }
        }
    };
}

vertex_formats! {
    /// One 32-bit float.
    Float32: Float, 1 x 32;
    /// Two.
    Float32x2: Float, 2 x 32;
    /// Three.
    Float32x3: Float, 3 x 32;
    /// Four.
    Float32x4: Float, 4 x 32;
    /// One 16-bit float.
    Float16: Float, 1 x 16;
    /// Two.
    Float16x2: Float, 2 x 16;
    /// Four.
    Float16x4: Float, 4 x 16;
    /// One 8-bit unsigned normalised number: c / 255.
    Unorm8: Unorm, 1 x 8;
    /// Two.
    Unorm8x2: Unorm, 2 x 8;
    /// Four.
    Unorm8x4: Unorm, 4 x 8;
    /// One 8-bit signed normalised number: c / 127, at least −1.
    Snorm8: Snorm, 1 x 8;
    /// Two.
    Snorm8x2: Snorm, 2 x 8;
    /// Four.
    Snorm8x4: Snorm, 4 x 8;
    /// One 16-bit unsigned normalised number: c / 65535.
    Unorm16: Unorm, 1 x 16;
    /// Two.
    Unorm16x2: Unorm, 2 x 16;
    /// Four.
    Unorm16x4: Unorm, 4 x 16;
    /// One 16-bit signed normalised number: c / 32767, at least −1.
    Snorm16: Snorm, 1 x 16;
    /// Two.
    Snorm16x2: Snorm, 2 x 16;
    /// Four.
    Snorm16x4: Snorm, 4 x 16;
    /// One 8-bit unsigned integer.
    Uint8: Uint, 1 x 8;
    /// Two.
    Uint8x2: Uint, 2 x 8;
    /// Four.
    Uint8x4: Uint, 4 x 8;
    /// One 8-bit signed integer.
    Sint8: Sint, 1 x 8;
    /// Two.
    Sint8x2: Sint, 2 x 8;
    /// Four.
    Sint8x4: Sint, 4 x 8;
    /// One 16-bit unsigned integer.
    Uint16: Uint, 1 x 16;
    /// Two.
    Uint16x2: Uint, 2 x 16;
    /// Four.
    Uint16x4: Uint, 4 x 16;
    /// One 16-bit signed integer.
    Sint16: Sint, 1 x 16;
    /// Two.
    Sint16x2: Sint, 2 x 16;
    /// Four.
    Sint16x4: Sint, 4 x 16;
    /// One 32-bit unsigned integer.
    Uint32: Uint, 1 x 32;
    /// Two.
    Uint32x2: Uint, 2 x 32;
    /// Three.
    Uint32x3: Uint, 3 x 32;
    /// Four.
    Uint32x4: Uint, 4 x 32;
    /// One 32-bit signed integer.
    Sint32: Sint, 1 x 32;
    /// Two.
    Sint32x2: Sint, 2 x 32;
    /// Three.
    Sint32x3: Sint, 3 x 32;
    /// Four.
    Sint32x4: Sint, 4 x 32;
}

impl VertexFormat {
    /// What a component that the format lacks reads as, as bits: (0, 0, 0, 1), the 1 an integer where the
    /// others are.
    #[must_use]
    pub const fn missing(self, component: usize) -> u32 {
        match (component, self.encoding()) {
            (3, VertexEncoding::Uint | VertexEncoding::Sint) => 1,
            (3, _) => 1.0_f32.to_bits(),
            _ => 0,
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

impl IndexFormat {
    /// The greatest index, which ends a primitive where a pipeline has
    /// [primitive restart](crate::state::PrimitiveState::primitive_restart).
    #[must_use]
    pub const fn restart(self) -> u32 {
        match self {
            Self::Uint8 => 0xFF,
            Self::Uint16 => 0xFFFF,
            Self::Uint32 => u32::MAX,
        }
    }
}
