//! Formats of textures and render targets: WebGPU's list, one line each.

/// Encoding of a texel. Channels are packed from the lowest bit of the lowest byte on, R first; the
/// `Bgra` formats have B first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TexelEncoding {
    /// 8 bits per channel, c / 255.
    Unorm8,
    /// 8 bits per channel, max(c / 127, −1).
    Snorm8,
    /// 8-bit unsigned integers.
    Uint8,
    /// 8-bit signed integers.
    Sint8,
    /// 16 bits per channel, c / 65535.
    Unorm16,
    /// 16 bits per channel, max(c / 32767, −1).
    Snorm16,
    /// 16-bit unsigned integers.
    Uint16,
    /// 16-bit signed integers.
    Sint16,
    /// 16-bit floats.
    Float16,
    /// 32-bit unsigned integers.
    Uint32,
    /// 32-bit signed integers.
    Sint32,
    /// 32-bit floats.
    Float32,
    /// Three channels of 10 bits and one of 2: c / 1023 and c / 3.
    Unorm10_2,
    /// Three channels of 10 bits and one of 2: unsigned integers.
    Uint10_2,
    /// Three unsigned floats, each with 5 bits of exponent; 6, 6 and 5 bits of mantissa.
    Ufloat11_10,
    /// Three mantissas of 9 bits that share one exponent of 5 bits.
    SharedExponent,
    /// 8-bit stencil.
    Stencil,
    /// 16-bit fixed-point depth.
    Depth16,
    /// 24-bit fixed-point depth.
    Depth24,
    /// 32-bit float depth.
    Depth32,
    /// Compressed blocks of several texels.
    Compressed,
}

/// Type of the values that a shader reads from a texture, or writes to a target. (WebGPU's
/// `GPUTextureSampleType`; here all floats can be filtered.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleType {
    /// Floating-point or normalised numbers.
    Float,
    /// Unsigned integers.
    Uint,
    /// Signed integers.
    Sint,
    /// Depths.
    Depth,
}

macro_rules! formats {
    ($(
        $(#[$doc:meta])*
        $format:ident $name:literal {
            encoding: $encoding:ident,
            channels: $channels:literal,
            srgb: $srgb:literal,
            block: [$width:literal, $height:literal],
            bytes: $bytes:literal
        }
    )*) => {
        /// Format of the texels of a texture or render target.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum TextureFormat {
            $($(#[$doc])* $format,)*
        }

        impl TextureFormat {
            /// Every format.
            pub const ALL: &[Self] = &[$(Self::$format),*];

            /// The format's name in WebGPU.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$format => $name,)* }
            }

            /// The encoding of the format's texels.
            #[must_use]
            pub const fn encoding(self) -> TexelEncoding {
                match self { $(Self::$format => TexelEncoding::$encoding,)* }
            }

            /// Number of stored channels, 1 to 4. Other channels read as 0, alpha as 1.
            #[must_use]
            pub const fn components(self) -> usize {
                match self { $(Self::$format => $channels,)* }
            }

            /// True if R, G and B are encoded as sRGB.
            #[must_use]
            pub const fn is_srgb(self) -> bool {
                match self { $(Self::$format => $srgb,)* }
            }

            /// Width and height of a compressed block in texels; 1×1 for uncompressed formats.
            #[must_use]
            pub const fn block_size(self) -> [u32; 2] {
                match self { $(Self::$format => [$width, $height],)* }
            }

            /// Bytes of a compressed block, or of a texel of an uncompressed format.
            #[must_use]
            pub const fn block_bytes(self) -> u32 {
                match self { $(Self::$format => $bytes,)* }
            }
        }
    };
}

formats! {
    /// One 8-bit unsigned normalised channel.
    R8Unorm "r8unorm" { encoding: Unorm8, channels: 1, srgb: false, block: [1, 1], bytes: 1 }
    /// One 8-bit signed normalised channel.
    R8Snorm "r8snorm" { encoding: Snorm8, channels: 1, srgb: false, block: [1, 1], bytes: 1 }
    /// One 8-bit unsigned integer channel.
    R8Uint "r8uint" { encoding: Uint8, channels: 1, srgb: false, block: [1, 1], bytes: 1 }
    /// One 8-bit signed integer channel.
    R8Sint "r8sint" { encoding: Sint8, channels: 1, srgb: false, block: [1, 1], bytes: 1 }
    /// Two 8-bit unsigned normalised channels.
    Rg8Unorm "rg8unorm" { encoding: Unorm8, channels: 2, srgb: false, block: [1, 1], bytes: 2 }
    /// Two 8-bit signed normalised channels.
    Rg8Snorm "rg8snorm" { encoding: Snorm8, channels: 2, srgb: false, block: [1, 1], bytes: 2 }
    /// Two 8-bit unsigned integer channels.
    Rg8Uint "rg8uint" { encoding: Uint8, channels: 2, srgb: false, block: [1, 1], bytes: 2 }
    /// Two 8-bit signed integer channels.
    Rg8Sint "rg8sint" { encoding: Sint8, channels: 2, srgb: false, block: [1, 1], bytes: 2 }
    /// Four 8-bit unsigned normalised channels.
    Rgba8Unorm "rgba8unorm" { encoding: Unorm8, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// Four 8-bit unsigned normalised channels, R, G and B encoded as sRGB.
    Rgba8UnormSrgb "rgba8unorm-srgb" { encoding: Unorm8, channels: 4, srgb: true, block: [1, 1], bytes: 4 }
    /// Four 8-bit unsigned normalised channels, B first.
    Bgra8Unorm "bgra8unorm" { encoding: Unorm8, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// Four 8-bit unsigned normalised channels, B first, R, G and B encoded as sRGB.
    Bgra8UnormSrgb "bgra8unorm-srgb" { encoding: Unorm8, channels: 4, srgb: true, block: [1, 1], bytes: 4 }
    /// Four 8-bit signed normalised channels.
    Rgba8Snorm "rgba8snorm" { encoding: Snorm8, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// Four 8-bit unsigned integer channels.
    Rgba8Uint "rgba8uint" { encoding: Uint8, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// Four 8-bit signed integer channels.
    Rgba8Sint "rgba8sint" { encoding: Sint8, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// One 16-bit unsigned normalised channel.
    R16Unorm "r16unorm" { encoding: Unorm16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// One 16-bit signed normalised channel.
    R16Snorm "r16snorm" { encoding: Snorm16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// One 16-bit unsigned integer channel.
    R16Uint "r16uint" { encoding: Uint16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// One 16-bit signed integer channel.
    R16Sint "r16sint" { encoding: Sint16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// One 16-bit float channel.
    R16Float "r16float" { encoding: Float16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// Two 16-bit unsigned normalised channels.
    Rg16Unorm "rg16unorm" { encoding: Unorm16, channels: 2, srgb: false, block: [1, 1], bytes: 4 }
    /// Two 16-bit signed normalised channels.
    Rg16Snorm "rg16snorm" { encoding: Snorm16, channels: 2, srgb: false, block: [1, 1], bytes: 4 }
    /// Two 16-bit unsigned integer channels.
    Rg16Uint "rg16uint" { encoding: Uint16, channels: 2, srgb: false, block: [1, 1], bytes: 4 }
    /// Two 16-bit signed integer channels.
    Rg16Sint "rg16sint" { encoding: Sint16, channels: 2, srgb: false, block: [1, 1], bytes: 4 }
    /// Two 16-bit float channels.
    Rg16Float "rg16float" { encoding: Float16, channels: 2, srgb: false, block: [1, 1], bytes: 4 }
    /// Four 16-bit unsigned normalised channels.
    Rgba16Unorm "rgba16unorm" { encoding: Unorm16, channels: 4, srgb: false, block: [1, 1], bytes: 8 }
    /// Four 16-bit signed normalised channels.
    Rgba16Snorm "rgba16snorm" { encoding: Snorm16, channels: 4, srgb: false, block: [1, 1], bytes: 8 }
    /// Four 16-bit unsigned integer channels.
    Rgba16Uint "rgba16uint" { encoding: Uint16, channels: 4, srgb: false, block: [1, 1], bytes: 8 }
    /// Four 16-bit signed integer channels.
    Rgba16Sint "rgba16sint" { encoding: Sint16, channels: 4, srgb: false, block: [1, 1], bytes: 8 }
    /// Four 16-bit float channels.
    Rgba16Float "rgba16float" { encoding: Float16, channels: 4, srgb: false, block: [1, 1], bytes: 8 }
    /// One 32-bit unsigned integer channel.
    R32Uint "r32uint" { encoding: Uint32, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// One 32-bit signed integer channel.
    R32Sint "r32sint" { encoding: Sint32, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// One 32-bit float channel.
    R32Float "r32float" { encoding: Float32, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// Two 32-bit unsigned integer channels.
    Rg32Uint "rg32uint" { encoding: Uint32, channels: 2, srgb: false, block: [1, 1], bytes: 8 }
    /// Two 32-bit signed integer channels.
    Rg32Sint "rg32sint" { encoding: Sint32, channels: 2, srgb: false, block: [1, 1], bytes: 8 }
    /// Two 32-bit float channels.
    Rg32Float "rg32float" { encoding: Float32, channels: 2, srgb: false, block: [1, 1], bytes: 8 }
    /// Four 32-bit unsigned integer channels.
    Rgba32Uint "rgba32uint" { encoding: Uint32, channels: 4, srgb: false, block: [1, 1], bytes: 16 }
    /// Four 32-bit signed integer channels.
    Rgba32Sint "rgba32sint" { encoding: Sint32, channels: 4, srgb: false, block: [1, 1], bytes: 16 }
    /// Four 32-bit float channels.
    Rgba32Float "rgba32float" { encoding: Float32, channels: 4, srgb: false, block: [1, 1], bytes: 16 }
    /// 10, 10, 10 and 2 bits, unsigned normalised, R lowest.
    Rgb10a2Unorm "rgb10a2unorm" { encoding: Unorm10_2, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// 10, 10, 10 and 2 bits, unsigned integers, R lowest.
    Rgb10a2Uint "rgb10a2uint" { encoding: Uint10_2, channels: 4, srgb: false, block: [1, 1], bytes: 4 }
    /// Unsigned floats of 11, 11 and 10 bits, R lowest.
    Rg11b10Ufloat "rg11b10ufloat" { encoding: Ufloat11_10, channels: 3, srgb: false, block: [1, 1], bytes: 4 }
    /// Three 9-bit mantissas and one 5-bit exponent.
    Rgb9e5Ufloat "rgb9e5ufloat" { encoding: SharedExponent, channels: 3, srgb: false, block: [1, 1], bytes: 4 }
    /// 8-bit stencil.
    Stencil8 "stencil8" { encoding: Stencil, channels: 1, srgb: false, block: [1, 1], bytes: 1 }
    /// 16-bit fixed-point depth.
    Depth16Unorm "depth16unorm" { encoding: Depth16, channels: 1, srgb: false, block: [1, 1], bytes: 2 }
    /// 24-bit fixed-point depth.
    Depth24Plus "depth24plus" { encoding: Depth24, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// 24-bit fixed-point depth and 8-bit stencil.
    Depth24PlusStencil8 "depth24plus-stencil8" { encoding: Depth24, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// 32-bit float depth.
    Depth32Float "depth32float" { encoding: Depth32, channels: 1, srgb: false, block: [1, 1], bytes: 4 }
    /// 32-bit float depth and 8-bit stencil.
    Depth32FloatStencil8 "depth32float-stencil8" { encoding: Depth32, channels: 1, srgb: false, block: [1, 1], bytes: 8 }
    /// BC1 (DXT1).
    Bc1RgbaUnorm "bc1-rgba-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 8 }
    /// BC1 (DXT1), sRGB.
    Bc1RgbaUnormSrgb "bc1-rgba-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 8 }
    /// BC2 (DXT3).
    Bc2RgbaUnorm "bc2-rgba-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 16 }
    /// BC2 (DXT3), sRGB.
    Bc2RgbaUnormSrgb "bc2-rgba-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 16 }
    /// BC3 (DXT5).
    Bc3RgbaUnorm "bc3-rgba-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 16 }
    /// BC3 (DXT5), sRGB.
    Bc3RgbaUnormSrgb "bc3-rgba-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 16 }
    /// BC4 (RGTC1), one channel.
    Bc4RUnorm "bc4-r-unorm" { encoding: Compressed, channels: 1, srgb: false, block: [4, 4], bytes: 8 }
    /// BC4 (RGTC1), one signed channel.
    Bc4RSnorm "bc4-r-snorm" { encoding: Compressed, channels: 1, srgb: false, block: [4, 4], bytes: 8 }
    /// BC5 (RGTC2), two channels.
    Bc5RgUnorm "bc5-rg-unorm" { encoding: Compressed, channels: 2, srgb: false, block: [4, 4], bytes: 16 }
    /// BC5 (RGTC2), two signed channels.
    Bc5RgSnorm "bc5-rg-snorm" { encoding: Compressed, channels: 2, srgb: false, block: [4, 4], bytes: 16 }
    /// BC6H, unsigned half floats.
    Bc6hRgbUfloat "bc6h-rgb-ufloat" { encoding: Compressed, channels: 3, srgb: false, block: [4, 4], bytes: 16 }
    /// BC6H, half floats.
    Bc6hRgbFloat "bc6h-rgb-float" { encoding: Compressed, channels: 3, srgb: false, block: [4, 4], bytes: 16 }
    /// BC7.
    Bc7RgbaUnorm "bc7-rgba-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 16 }
    /// BC7, sRGB.
    Bc7RgbaUnormSrgb "bc7-rgba-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 16 }
    /// ETC2, opaque.
    Etc2Rgb8Unorm "etc2-rgb8unorm" { encoding: Compressed, channels: 3, srgb: false, block: [4, 4], bytes: 8 }
    /// ETC2, opaque, sRGB.
    Etc2Rgb8UnormSrgb "etc2-rgb8unorm-srgb" { encoding: Compressed, channels: 3, srgb: true, block: [4, 4], bytes: 8 }
    /// ETC2 with one bit of alpha.
    Etc2Rgb8A1Unorm "etc2-rgb8a1unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 8 }
    /// ETC2 with one bit of alpha, sRGB.
    Etc2Rgb8A1UnormSrgb "etc2-rgb8a1unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 8 }
    /// ETC2 with EAC alpha.
    Etc2Rgba8Unorm "etc2-rgba8unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 16 }
    /// ETC2 with EAC alpha, sRGB.
    Etc2Rgba8UnormSrgb "etc2-rgba8unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 16 }
    /// EAC, one channel of 11 bits.
    EacR11Unorm "eac-r11unorm" { encoding: Compressed, channels: 1, srgb: false, block: [4, 4], bytes: 8 }
    /// EAC, one signed channel of 11 bits.
    EacR11Snorm "eac-r11snorm" { encoding: Compressed, channels: 1, srgb: false, block: [4, 4], bytes: 8 }
    /// EAC, two channels of 11 bits.
    EacRg11Unorm "eac-rg11unorm" { encoding: Compressed, channels: 2, srgb: false, block: [4, 4], bytes: 16 }
    /// EAC, two signed channels of 11 bits.
    EacRg11Snorm "eac-rg11snorm" { encoding: Compressed, channels: 2, srgb: false, block: [4, 4], bytes: 16 }
    /// ASTC (LDR), blocks of 4×4 texels.
    Astc4x4Unorm "astc-4x4-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [4, 4], bytes: 16 }
    /// ASTC (LDR), blocks of 4×4 texels, sRGB.
    Astc4x4UnormSrgb "astc-4x4-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [4, 4], bytes: 16 }
    /// ASTC (LDR), blocks of 5×4 texels.
    Astc5x4Unorm "astc-5x4-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [5, 4], bytes: 16 }
    /// ASTC (LDR), blocks of 5×4 texels, sRGB.
    Astc5x4UnormSrgb "astc-5x4-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [5, 4], bytes: 16 }
    /// ASTC (LDR), blocks of 5×5 texels.
    Astc5x5Unorm "astc-5x5-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [5, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 5×5 texels, sRGB.
    Astc5x5UnormSrgb "astc-5x5-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [5, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 6×5 texels.
    Astc6x5Unorm "astc-6x5-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [6, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 6×5 texels, sRGB.
    Astc6x5UnormSrgb "astc-6x5-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [6, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 6×6 texels.
    Astc6x6Unorm "astc-6x6-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [6, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 6×6 texels, sRGB.
    Astc6x6UnormSrgb "astc-6x6-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [6, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 8×5 texels.
    Astc8x5Unorm "astc-8x5-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [8, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 8×5 texels, sRGB.
    Astc8x5UnormSrgb "astc-8x5-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [8, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 8×6 texels.
    Astc8x6Unorm "astc-8x6-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [8, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 8×6 texels, sRGB.
    Astc8x6UnormSrgb "astc-8x6-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [8, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 8×8 texels.
    Astc8x8Unorm "astc-8x8-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [8, 8], bytes: 16 }
    /// ASTC (LDR), blocks of 8×8 texels, sRGB.
    Astc8x8UnormSrgb "astc-8x8-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [8, 8], bytes: 16 }
    /// ASTC (LDR), blocks of 10×5 texels.
    Astc10x5Unorm "astc-10x5-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [10, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 10×5 texels, sRGB.
    Astc10x5UnormSrgb "astc-10x5-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [10, 5], bytes: 16 }
    /// ASTC (LDR), blocks of 10×6 texels.
    Astc10x6Unorm "astc-10x6-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [10, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 10×6 texels, sRGB.
    Astc10x6UnormSrgb "astc-10x6-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [10, 6], bytes: 16 }
    /// ASTC (LDR), blocks of 10×8 texels.
    Astc10x8Unorm "astc-10x8-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [10, 8], bytes: 16 }
    /// ASTC (LDR), blocks of 10×8 texels, sRGB.
    Astc10x8UnormSrgb "astc-10x8-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [10, 8], bytes: 16 }
    /// ASTC (LDR), blocks of 10×10 texels.
    Astc10x10Unorm "astc-10x10-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [10, 10], bytes: 16 }
    /// ASTC (LDR), blocks of 10×10 texels, sRGB.
    Astc10x10UnormSrgb "astc-10x10-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [10, 10], bytes: 16 }
    /// ASTC (LDR), blocks of 12×10 texels.
    Astc12x10Unorm "astc-12x10-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [12, 10], bytes: 16 }
    /// ASTC (LDR), blocks of 12×10 texels, sRGB.
    Astc12x10UnormSrgb "astc-12x10-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [12, 10], bytes: 16 }
    /// ASTC (LDR), blocks of 12×12 texels.
    Astc12x12Unorm "astc-12x12-unorm" { encoding: Compressed, channels: 4, srgb: false, block: [12, 12], bytes: 16 }
    /// ASTC (LDR), blocks of 12×12 texels, sRGB.
    Astc12x12UnormSrgb "astc-12x12-unorm-srgb" { encoding: Compressed, channels: 4, srgb: true, block: [12, 12], bytes: 16 }
}

impl TextureFormat {
    /// Type of the values that shaders read or write.
    #[must_use]
    pub const fn sample_type(self) -> SampleType {
        use TexelEncoding as E;
        match self.encoding() {
            E::Uint8 | E::Uint16 | E::Uint32 | E::Uint10_2 | E::Stencil => SampleType::Uint,
            E::Sint8 | E::Sint16 | E::Sint32 => SampleType::Sint,
            E::Depth16 | E::Depth24 | E::Depth32 => SampleType::Depth,
            _ => SampleType::Float,
        }
    }

    /// True for all formats except depth and stencil formats.
    #[must_use]
    pub const fn is_color(self) -> bool {
        !self.has_depth() && !self.has_stencil()
    }

    /// True if the format has a depth aspect.
    #[must_use]
    pub const fn has_depth(self) -> bool {
        matches!(self.sample_type(), SampleType::Depth)
    }

    /// True if the format has a stencil aspect.
    #[must_use]
    pub const fn has_stencil(self) -> bool {
        matches!(
            self,
            Self::Stencil8 | Self::Depth24PlusStencil8 | Self::Depth32FloatStencil8
        )
    }

    /// True if the format stores compressed blocks of several texels.
    #[must_use]
    pub const fn is_compressed(self) -> bool {
        matches!(self.encoding(), TexelEncoding::Compressed)
    }

    /// True if a colour attachment can have the format: every colour format that is neither
    /// compressed nor `Rgb9e5Ufloat`.
    #[must_use]
    pub const fn is_renderable(self) -> bool {
        self.is_color()
            && !self.is_compressed()
            && !matches!(self.encoding(), TexelEncoding::SharedExponent)
    }

    /// True if colours can be blended: every renderable format that is not an integer format.
    #[must_use]
    pub const fn is_blendable(self) -> bool {
        self.is_renderable() && matches!(self.sample_type(), SampleType::Float)
    }

    /// The format with the same texels whose colours are sRGB, or are not; itself if there is none.
    #[must_use]
    pub fn with_srgb(self, is_srgb: bool) -> Self {
        let plain = |format: Self| format.name().trim_end_matches("-srgb");
        let is_counterpart =
            |format: &Self| format.is_srgb() == is_srgb && plain(*format) == plain(self);
        let found = Self::ALL.iter().copied().find(is_counterpart);
        found.unwrap_or(self)
    }

    /// True if B is stored first.
    #[must_use]
    pub const fn is_bgra(self) -> bool {
        matches!(self, Self::Bgra8Unorm | Self::Bgra8UnormSrgb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counterparts_differ_in_srgb_alone() {
        use TextureFormat as F;
        assert_eq!(F::Bgra8Unorm.with_srgb(true), F::Bgra8UnormSrgb);
        assert_eq!(F::Bc7RgbaUnormSrgb.with_srgb(false), F::Bc7RgbaUnorm);
        assert_eq!(F::R8Unorm.with_srgb(true), F::R8Unorm);
        for &format in F::ALL.iter().filter(|format| format.is_srgb()) {
            let plain = format.with_srgb(false);
            assert!(
                !plain.is_srgb() && plain.with_srgb(true) == format,
                "{}",
                format.name()
            );
        }
    }

    #[test]
    fn names_are_distinct_and_sizes_fit_their_encodings() {
        let mut names: Vec<_> = TextureFormat::ALL.iter().map(|f| f.name()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), TextureFormat::ALL.len());
        for &format in TextureFormat::ALL {
            use TexelEncoding as E;
            let channel = match format.encoding() {
                E::Unorm8 | E::Snorm8 | E::Uint8 | E::Sint8 => 1,
                E::Unorm16 | E::Snorm16 | E::Uint16 | E::Sint16 | E::Float16 => 2,
                E::Uint32 | E::Sint32 | E::Float32 => 4,
                _ => continue,
            };
            let bytes = format.components() * channel;
            assert_eq!(format.block_bytes() as usize, bytes, "{}", format.name());
        }
    }
}
