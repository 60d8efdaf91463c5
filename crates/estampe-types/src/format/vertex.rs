//! Formats of vertex attributes and indices.

/// Conversion from a stored component of an attribute to the value that a shader reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VertexEncoding {
    /// A float of 16 or 32 bits, unchanged.
    Float,
    /// An unsigned integer c of n bits: c / (2ⁿ − 1), in 0..=1.
    Unorm,
    /// A signed integer c of n bits: max(c / (2ⁿ⁻¹ − 1), −1), in −1..=1.
    Snorm,
    /// An unsigned integer. The shader's number has the bits of the 32-bit integer, which
    /// [`Real::to_bits`](crate::Real::to_bits) reads.
    Uint,
    /// A signed integer, sign-extended to 32 bits; read as `Uint` is.
    Sint,
}

macro_rules! vertex_formats {
    ($($(#[$doc:meta])* $name:ident: $encoding:ident, $components:literal x $bits:literal;)+) => {
        /// Format of an attribute in a vertex buffer. (WebGPU's `GPUVertexFormat`.)
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum VertexFormat {
            $($(#[$doc])* $name,)+
            /// Three 10-bit unsigned normalised numbers from the lowest bits on, then one of 2
            /// bits.
            Unorm10_10_10_2,
            /// Four 8-bit unsigned normalised numbers, stored as b, g, r, a and read as r, g, b, a.
            Unorm8x4Bgra,
        }

        impl VertexFormat {
            /// Every format.
            pub const ALL: &[Self] = &[$(Self::$name,)+ Self::Unorm10_10_10_2, Self::Unorm8x4Bgra];

            /// Number of components.
            #[must_use]
            pub const fn components(self) -> usize {
                match self {
                    $(Self::$name => $components,)+
                    Self::Unorm10_10_10_2 | Self::Unorm8x4Bgra => 4,
                }
            }

            /// Size in bytes.
            #[must_use]
            pub const fn size_bytes(self) -> usize {
                match self {
                    $(Self::$name => $components * $bits / 8,)+
                    Self::Unorm10_10_10_2 | Self::Unorm8x4Bgra => 4,
                }
            }

            /// Encoding of the components.
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
    /// Two 32-bit floats.
    Float32x2: Float, 2 x 32;
    /// Three 32-bit floats.
    Float32x3: Float, 3 x 32;
    /// Four 32-bit floats.
    Float32x4: Float, 4 x 32;
    /// One 16-bit float.
    Float16: Float, 1 x 16;
    /// Two 16-bit floats.
    Float16x2: Float, 2 x 16;
    /// Four 16-bit floats.
    Float16x4: Float, 4 x 16;
    /// One 8-bit unsigned normalised number: c / 255.
    Unorm8: Unorm, 1 x 8;
    /// Two 8-bit unsigned normalised numbers.
    Unorm8x2: Unorm, 2 x 8;
    /// Four 8-bit unsigned normalised numbers.
    Unorm8x4: Unorm, 4 x 8;
    /// One 8-bit signed normalised number: c / 127, at least −1.
    Snorm8: Snorm, 1 x 8;
    /// Two 8-bit signed normalised numbers.
    Snorm8x2: Snorm, 2 x 8;
    /// Four 8-bit signed normalised numbers.
    Snorm8x4: Snorm, 4 x 8;
    /// One 16-bit unsigned normalised number: c / 65535.
    Unorm16: Unorm, 1 x 16;
    /// Two 16-bit unsigned normalised numbers.
    Unorm16x2: Unorm, 2 x 16;
    /// Four 16-bit unsigned normalised numbers.
    Unorm16x4: Unorm, 4 x 16;
    /// One 16-bit signed normalised number: c / 32767, at least −1.
    Snorm16: Snorm, 1 x 16;
    /// Two 16-bit signed normalised numbers.
    Snorm16x2: Snorm, 2 x 16;
    /// Four 16-bit signed normalised numbers.
    Snorm16x4: Snorm, 4 x 16;
    /// One 8-bit unsigned integer.
    Uint8: Uint, 1 x 8;
    /// Two 8-bit unsigned integers.
    Uint8x2: Uint, 2 x 8;
    /// Four 8-bit unsigned integers.
    Uint8x4: Uint, 4 x 8;
    /// One 8-bit signed integer.
    Sint8: Sint, 1 x 8;
    /// Two 8-bit signed integers.
    Sint8x2: Sint, 2 x 8;
    /// Four 8-bit signed integers.
    Sint8x4: Sint, 4 x 8;
    /// One 16-bit unsigned integer.
    Uint16: Uint, 1 x 16;
    /// Two 16-bit unsigned integers.
    Uint16x2: Uint, 2 x 16;
    /// Four 16-bit unsigned integers.
    Uint16x4: Uint, 4 x 16;
    /// One 16-bit signed integer.
    Sint16: Sint, 1 x 16;
    /// Two 16-bit signed integers.
    Sint16x2: Sint, 2 x 16;
    /// Four 16-bit signed integers.
    Sint16x4: Sint, 4 x 16;
    /// One 32-bit unsigned integer.
    Uint32: Uint, 1 x 32;
    /// Two 32-bit unsigned integers.
    Uint32x2: Uint, 2 x 32;
    /// Three 32-bit unsigned integers.
    Uint32x3: Uint, 3 x 32;
    /// Four 32-bit unsigned integers.
    Uint32x4: Uint, 4 x 32;
    /// One 32-bit signed integer.
    Sint32: Sint, 1 x 32;
    /// Two 32-bit signed integers.
    Sint32x2: Sint, 2 x 32;
    /// Three 32-bit signed integers.
    Sint32x3: Sint, 3 x 32;
    /// Four 32-bit signed integers.
    Sint32x4: Sint, 4 x 32;
}

impl VertexFormat {
    /// Bits of a component that the format does not store: one of (0, 0, 0, 1), where the 1 is an
    /// integer in integer formats.
    #[must_use]
    pub const fn missing(self, component: usize) -> u32 {
        match (component, self.encoding()) {
            (3, VertexEncoding::Uint | VertexEncoding::Sint) => 1,
            (3, _) => 1.0_f32.to_bits(),
            _ => 0,
        }
    }
}

/// Size of an index.
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
    /// The greatest index of the format. With [primitive
    /// restart](crate::state::PrimitiveState::primitive_restart) it ends a primitive.
    #[must_use]
    pub const fn restart(self) -> u32 {
        match self {
            Self::Uint8 => 0xFF,
            Self::Uint16 => 0xFFFF,
            Self::Uint32 => u32::MAX,
        }
    }
}
