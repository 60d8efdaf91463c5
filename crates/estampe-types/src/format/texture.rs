//! Formats of textures and render targets: WebGPU's list, one line each.

/// How the bits of a texel are read. Channels follow each other from the lowest bit of the lowest byte on,
/// R first, but for the `Bgra` formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TexelEncoding {
    /// 8 bits a channel, c / 255.
    Unorm8,
    /// 8 bits a channel, max(c / 127, −1).
    Snorm8,
    /// 8-bit unsigned integers.
    Uint8,
    /// 8-bit signed integers.
    Sint8,
    /// 16 bits a channel, c / 65535.
    Unorm16,
    /// 16 bits a channel, max(c / 32767, −1).
    Snorm16,
    /// 16-bit unsigned integers.
    Uint16,
    /// 16-bit signed integers.
    Sint16,
    /// Half floats.
    Float16,
    /// 32-bit unsigned integers.
    Uint32,
    /// 32-bit signed integers.
    Sint32,
    /// Floats.
    Float32,
    /// Three channels of 10 bits and one of 2: c / 1023 and c / 3.
    Unorm10_2,
    /// Three channels of 10 bits and one of 2: unsigned integers.
    Uint10_2,
    /// Unsigned floats: 5 bits of exponent and 6, 6 and 5 bits of mantissa.
    Ufloat11_10,
    /// Three mantissas of 9 bits and one exponent of 5.
    SharedExponent,
    /// 8-bit stencil.
    Stencil,
    /// 16-bit fixed-point depth.
    Depth16,
    /// 24-bit fixed-point depth.
    Depth24,
    /// Float depth.
    Depth32,
    /// Blocks of several texels.
    Compressed,
}

/// What a shader gets from a texture of a format, or gives to a target of it. (WebGPU's `GPUTextureSampleType`;
/// here all floats can be filtered.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleType {
    /// Numbers.
    Float,
    /// Unsigned integers.
    Uint,
    /// Signed integers.
    Sint,
    /// Depths.
    Depth,
}

macro_rules! formats {
    ($($doc:literal $format:ident $name:literal $encoding:ident $components:literal $srgb:literal [$width:literal $height:literal] $bytes:literal;)*) => {
        /// What a texture or render target holds in each texel.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum TextureFormat {
            $(#[doc = $doc] $format,)*
        }

        impl TextureFormat {
            /// Every format.
            pub const ALL: &[Self] = &[$(Self::$format),*];

            /// Its name in WebGPU.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$format => $name,)* }
            }

            /// How its bits are read.
            #[must_use]
            pub const fn encoding(self) -> TexelEncoding {
                match self { $(Self::$format => TexelEncoding::$encoding,)* }
            }

            /// How many channels it stores, 1 to 4; others read as 0, alpha as 1.
            #[must_use]
            pub const fn components(self) -> usize {
                match self { $(Self::$format => $components,)* }
            }

            /// Whether its R, G and B are encoded as sRGB.
            #[must_use]
            pub const fn is_srgb(self) -> bool {
                match self { $(Self::$format => $srgb,)* }
            }

            /// Width and height of a block in texels: 1×1 unless it is compressed.
            #[must_use]
            pub const fn block_size(self) -> [u32; 2] {
                match self { $(Self::$format => [$width, $height],)* }
            }

            /// Bytes of a block: of a texel unless it is compressed.
            #[must_use]
            pub const fn block_bytes(self) -> u32 {
                match self { $(Self::$format => $bytes,)* }
            }
        }
    };
}

formats! {
    "One 8-bit unsigned normalised channel." R8Unorm "r8unorm" Unorm8 1 false [1 1] 1;
    "One 8-bit signed normalised channel." R8Snorm "r8snorm" Snorm8 1 false [1 1] 1;
    "One 8-bit unsigned integer channel." R8Uint "r8uint" Uint8 1 false [1 1] 1;
    "One 8-bit signed integer channel." R8Sint "r8sint" Sint8 1 false [1 1] 1;
    "Two 8-bit unsigned normalised channels." Rg8Unorm "rg8unorm" Unorm8 2 false [1 1] 2;
    "Two 8-bit signed normalised channels." Rg8Snorm "rg8snorm" Snorm8 2 false [1 1] 2;
    "Two 8-bit unsigned integer channels." Rg8Uint "rg8uint" Uint8 2 false [1 1] 2;
    "Two 8-bit signed integer channels." Rg8Sint "rg8sint" Sint8 2 false [1 1] 2;
    "Four 8-bit unsigned normalised channels." Rgba8Unorm "rgba8unorm" Unorm8 4 false [1 1] 4;
    "Four 8-bit unsigned normalised channels, R, G and B encoded as sRGB." Rgba8UnormSrgb "rgba8unorm-srgb" Unorm8 4 true [1 1] 4;
    "Four 8-bit unsigned normalised channels, B first." Bgra8Unorm "bgra8unorm" Unorm8 4 false [1 1] 4;
    "The same, R, G and B encoded as sRGB." Bgra8UnormSrgb "bgra8unorm-srgb" Unorm8 4 true [1 1] 4;
    "Four 8-bit signed normalised channels." Rgba8Snorm "rgba8snorm" Snorm8 4 false [1 1] 4;
    "Four 8-bit unsigned integer channels." Rgba8Uint "rgba8uint" Uint8 4 false [1 1] 4;
    "Four 8-bit signed integer channels." Rgba8Sint "rgba8sint" Sint8 4 false [1 1] 4;
    "One 16-bit unsigned normalised channel." R16Unorm "r16unorm" Unorm16 1 false [1 1] 2;
    "One 16-bit signed normalised channel." R16Snorm "r16snorm" Snorm16 1 false [1 1] 2;
    "One 16-bit unsigned integer channel." R16Uint "r16uint" Uint16 1 false [1 1] 2;
    "One 16-bit signed integer channel." R16Sint "r16sint" Sint16 1 false [1 1] 2;
    "One 16-bit float channel." R16Float "r16float" Float16 1 false [1 1] 2;
    "Two 16-bit unsigned normalised channels." Rg16Unorm "rg16unorm" Unorm16 2 false [1 1] 4;
    "Two 16-bit signed normalised channels." Rg16Snorm "rg16snorm" Snorm16 2 false [1 1] 4;
    "Two 16-bit unsigned integer channels." Rg16Uint "rg16uint" Uint16 2 false [1 1] 4;
    "Two 16-bit signed integer channels." Rg16Sint "rg16sint" Sint16 2 false [1 1] 4;
    "Two 16-bit float channels." Rg16Float "rg16float" Float16 2 false [1 1] 4;
    "Four 16-bit unsigned normalised channels." Rgba16Unorm "rgba16unorm" Unorm16 4 false [1 1] 8;
    "Four 16-bit signed normalised channels." Rgba16Snorm "rgba16snorm" Snorm16 4 false [1 1] 8;
    "Four 16-bit unsigned integer channels." Rgba16Uint "rgba16uint" Uint16 4 false [1 1] 8;
    "Four 16-bit signed integer channels." Rgba16Sint "rgba16sint" Sint16 4 false [1 1] 8;
    "Four 16-bit float channels." Rgba16Float "rgba16float" Float16 4 false [1 1] 8;
    "One 32-bit unsigned integer channel." R32Uint "r32uint" Uint32 1 false [1 1] 4;
    "One 32-bit signed integer channel." R32Sint "r32sint" Sint32 1 false [1 1] 4;
    "One 32-bit float channel." R32Float "r32float" Float32 1 false [1 1] 4;
    "Two 32-bit unsigned integer channels." Rg32Uint "rg32uint" Uint32 2 false [1 1] 8;
    "Two 32-bit signed integer channels." Rg32Sint "rg32sint" Sint32 2 false [1 1] 8;
    "Two 32-bit float channels." Rg32Float "rg32float" Float32 2 false [1 1] 8;
    "Four 32-bit unsigned integer channels." Rgba32Uint "rgba32uint" Uint32 4 false [1 1] 16;
    "Four 32-bit signed integer channels." Rgba32Sint "rgba32sint" Sint32 4 false [1 1] 16;
    "Four 32-bit float channels." Rgba32Float "rgba32float" Float32 4 false [1 1] 16;
    "10, 10, 10 and 2 bits, unsigned normalised, R lowest." Rgb10a2Unorm "rgb10a2unorm" Unorm10_2 4 false [1 1] 4;
    "10, 10, 10 and 2 bits, unsigned integers, R lowest." Rgb10a2Uint "rgb10a2uint" Uint10_2 4 false [1 1] 4;
    "Unsigned floats of 11, 11 and 10 bits, R lowest." Rg11b10Ufloat "rg11b10ufloat" Ufloat11_10 3 false [1 1] 4;
    "Three 9-bit mantissas and one 5-bit exponent." Rgb9e5Ufloat "rgb9e5ufloat" SharedExponent 3 false [1 1] 4;
    "8-bit stencil." Stencil8 "stencil8" Stencil 1 false [1 1] 1;
    "16-bit fixed-point depth." Depth16Unorm "depth16unorm" Depth16 1 false [1 1] 2;
    "24-bit fixed-point depth." Depth24Plus "depth24plus" Depth24 1 false [1 1] 4;
    "24-bit fixed-point depth and 8-bit stencil." Depth24PlusStencil8 "depth24plus-stencil8" Depth24 1 false [1 1] 4;
    "32-bit float depth." Depth32Float "depth32float" Depth32 1 false [1 1] 4;
    "32-bit float depth and 8-bit stencil." Depth32FloatStencil8 "depth32float-stencil8" Depth32 1 false [1 1] 8;
    "BC1 (DXT1)." Bc1RgbaUnorm "bc1-rgba-unorm" Compressed 4 false [4 4] 8;
    "BC1 (DXT1), sRGB." Bc1RgbaUnormSrgb "bc1-rgba-unorm-srgb" Compressed 4 true [4 4] 8;
    "BC2 (DXT3)." Bc2RgbaUnorm "bc2-rgba-unorm" Compressed 4 false [4 4] 16;
    "BC2 (DXT3), sRGB." Bc2RgbaUnormSrgb "bc2-rgba-unorm-srgb" Compressed 4 true [4 4] 16;
    "BC3 (DXT5)." Bc3RgbaUnorm "bc3-rgba-unorm" Compressed 4 false [4 4] 16;
    "BC3 (DXT5), sRGB." Bc3RgbaUnormSrgb "bc3-rgba-unorm-srgb" Compressed 4 true [4 4] 16;
    "BC4 (RGTC1), one channel." Bc4RUnorm "bc4-r-unorm" Compressed 1 false [4 4] 8;
    "BC4 (RGTC1), one signed channel." Bc4RSnorm "bc4-r-snorm" Compressed 1 false [4 4] 8;
    "BC5 (RGTC2), two channels." Bc5RgUnorm "bc5-rg-unorm" Compressed 2 false [4 4] 16;
    "BC5 (RGTC2), two signed channels." Bc5RgSnorm "bc5-rg-snorm" Compressed 2 false [4 4] 16;
    "BC6H, unsigned half floats." Bc6hRgbUfloat "bc6h-rgb-ufloat" Compressed 3 false [4 4] 16;
    "BC6H, half floats." Bc6hRgbFloat "bc6h-rgb-float" Compressed 3 false [4 4] 16;
    "BC7." Bc7RgbaUnorm "bc7-rgba-unorm" Compressed 4 false [4 4] 16;
    "BC7, sRGB." Bc7RgbaUnormSrgb "bc7-rgba-unorm-srgb" Compressed 4 true [4 4] 16;
    "ETC2, opaque." Etc2Rgb8Unorm "etc2-rgb8unorm" Compressed 3 false [4 4] 8;
    "ETC2, opaque, sRGB." Etc2Rgb8UnormSrgb "etc2-rgb8unorm-srgb" Compressed 3 true [4 4] 8;
    "ETC2 with one bit of alpha." Etc2Rgb8A1Unorm "etc2-rgb8a1unorm" Compressed 4 false [4 4] 8;
    "ETC2 with one bit of alpha, sRGB." Etc2Rgb8A1UnormSrgb "etc2-rgb8a1unorm-srgb" Compressed 4 true [4 4] 8;
    "ETC2 with EAC alpha." Etc2Rgba8Unorm "etc2-rgba8unorm" Compressed 4 false [4 4] 16;
    "ETC2 with EAC alpha, sRGB." Etc2Rgba8UnormSrgb "etc2-rgba8unorm-srgb" Compressed 4 true [4 4] 16;
    "EAC, one channel of 11 bits." EacR11Unorm "eac-r11unorm" Compressed 1 false [4 4] 8;
    "EAC, one signed channel of 11 bits." EacR11Snorm "eac-r11snorm" Compressed 1 false [4 4] 8;
    "EAC, two channels of 11 bits." EacRg11Unorm "eac-rg11unorm" Compressed 2 false [4 4] 16;
    "EAC, two signed channels of 11 bits." EacRg11Snorm "eac-rg11snorm" Compressed 2 false [4 4] 16;
    "ASTC (LDR), blocks of 4×4 texels." Astc4x4Unorm "astc-4x4-unorm" Compressed 4 false [4 4] 16;
    "ASTC (LDR), blocks of 4×4 texels, sRGB." Astc4x4UnormSrgb "astc-4x4-unorm-srgb" Compressed 4 true [4 4] 16;
    "ASTC (LDR), blocks of 5×4 texels." Astc5x4Unorm "astc-5x4-unorm" Compressed 4 false [5 4] 16;
    "ASTC (LDR), blocks of 5×4 texels, sRGB." Astc5x4UnormSrgb "astc-5x4-unorm-srgb" Compressed 4 true [5 4] 16;
    "ASTC (LDR), blocks of 5×5 texels." Astc5x5Unorm "astc-5x5-unorm" Compressed 4 false [5 5] 16;
    "ASTC (LDR), blocks of 5×5 texels, sRGB." Astc5x5UnormSrgb "astc-5x5-unorm-srgb" Compressed 4 true [5 5] 16;
    "ASTC (LDR), blocks of 6×5 texels." Astc6x5Unorm "astc-6x5-unorm" Compressed 4 false [6 5] 16;
    "ASTC (LDR), blocks of 6×5 texels, sRGB." Astc6x5UnormSrgb "astc-6x5-unorm-srgb" Compressed 4 true [6 5] 16;
    "ASTC (LDR), blocks of 6×6 texels." Astc6x6Unorm "astc-6x6-unorm" Compressed 4 false [6 6] 16;
    "ASTC (LDR), blocks of 6×6 texels, sRGB." Astc6x6UnormSrgb "astc-6x6-unorm-srgb" Compressed 4 true [6 6] 16;
    "ASTC (LDR), blocks of 8×5 texels." Astc8x5Unorm "astc-8x5-unorm" Compressed 4 false [8 5] 16;
    "ASTC (LDR), blocks of 8×5 texels, sRGB." Astc8x5UnormSrgb "astc-8x5-unorm-srgb" Compressed 4 true [8 5] 16;
    "ASTC (LDR), blocks of 8×6 texels." Astc8x6Unorm "astc-8x6-unorm" Compressed 4 false [8 6] 16;
    "ASTC (LDR), blocks of 8×6 texels, sRGB." Astc8x6UnormSrgb "astc-8x6-unorm-srgb" Compressed 4 true [8 6] 16;
    "ASTC (LDR), blocks of 8×8 texels." Astc8x8Unorm "astc-8x8-unorm" Compressed 4 false [8 8] 16;
    "ASTC (LDR), blocks of 8×8 texels, sRGB." Astc8x8UnormSrgb "astc-8x8-unorm-srgb" Compressed 4 true [8 8] 16;
    "ASTC (LDR), blocks of 10×5 texels." Astc10x5Unorm "astc-10x5-unorm" Compressed 4 false [10 5] 16;
    "ASTC (LDR), blocks of 10×5 texels, sRGB." Astc10x5UnormSrgb "astc-10x5-unorm-srgb" Compressed 4 true [10 5] 16;
    "ASTC (LDR), blocks of 10×6 texels." Astc10x6Unorm "astc-10x6-unorm" Compressed 4 false [10 6] 16;
    "ASTC (LDR), blocks of 10×6 texels, sRGB." Astc10x6UnormSrgb "astc-10x6-unorm-srgb" Compressed 4 true [10 6] 16;
    "ASTC (LDR), blocks of 10×8 texels." Astc10x8Unorm "astc-10x8-unorm" Compressed 4 false [10 8] 16;
    "ASTC (LDR), blocks of 10×8 texels, sRGB." Astc10x8UnormSrgb "astc-10x8-unorm-srgb" Compressed 4 true [10 8] 16;
    "ASTC (LDR), blocks of 10×10 texels." Astc10x10Unorm "astc-10x10-unorm" Compressed 4 false [10 10] 16;
    "ASTC (LDR), blocks of 10×10 texels, sRGB." Astc10x10UnormSrgb "astc-10x10-unorm-srgb" Compressed 4 true [10 10] 16;
    "ASTC (LDR), blocks of 12×10 texels." Astc12x10Unorm "astc-12x10-unorm" Compressed 4 false [12 10] 16;
    "ASTC (LDR), blocks of 12×10 texels, sRGB." Astc12x10UnormSrgb "astc-12x10-unorm-srgb" Compressed 4 true [12 10] 16;
    "ASTC (LDR), blocks of 12×12 texels." Astc12x12Unorm "astc-12x12-unorm" Compressed 4 false [12 12] 16;
    "ASTC (LDR), blocks of 12×12 texels, sRGB." Astc12x12UnormSrgb "astc-12x12-unorm-srgb" Compressed 4 true [12 12] 16;
}

impl TextureFormat {
    /// What shaders read or write.
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

    /// Whether it holds colour, or any other numbers, rather than depth or stencil.
    #[must_use]
    pub const fn is_color(self) -> bool {
        !self.has_depth() && !self.has_stencil()
    }

    /// Whether it holds depth.
    #[must_use]
    pub const fn has_depth(self) -> bool {
        matches!(self.sample_type(), SampleType::Depth)
    }

    /// Whether it holds stencil values.
    #[must_use]
    pub const fn has_stencil(self) -> bool {
        matches!(
            self,
            Self::Stencil8 | Self::Depth24PlusStencil8 | Self::Depth32FloatStencil8
        )
    }

    /// Whether it stores blocks of several texels.
    #[must_use]
    pub const fn is_compressed(self) -> bool {
        matches!(self.encoding(), TexelEncoding::Compressed)
    }

    /// Whether colours can be drawn into it: every colour format that is neither compressed nor
    /// `Rgb9e5Ufloat`.
    #[must_use]
    pub const fn is_renderable(self) -> bool {
        self.is_color()
            && !self.is_compressed()
            && !matches!(self.encoding(), TexelEncoding::SharedExponent)
    }

    /// Whether colours can be blended in it: every renderable one of numbers rather than integers.
    #[must_use]
    pub const fn is_blendable(self) -> bool {
        self.is_renderable() && matches!(self.sample_type(), SampleType::Float)
    }

    /// Whether B is stored first.
    #[must_use]
    pub const fn is_bgra(self) -> bool {
        matches!(self, Self::Bgra8Unorm | Self::Bgra8UnormSrgb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
