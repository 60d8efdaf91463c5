//! Formats of texels, by their numbers in Vulkan.

use estampe_format::{half, srgb};
use estampe_texture::{MAX_BLOCK_WORDS, TextureFormat, decode_block};

/// The layout of an image's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TexelLayout {
    /// Bytes of channels in this order, each the index of a channel.
    Bytes(&'static [usize]),
    /// Compressed blocks.
    Blocks {
        format: TextureFormat,
        /// The blocks' alpha has no meaning.
        is_opaque: bool,
    },
}

impl TexelLayout {
    /// The layout of a `VkFormat`; `None` if it is not read. A format and its sRGB form are the
    /// same here: the texture's use says whether texels are colours.
    pub(super) fn of_vulkan(number: u32) -> Option<Self> {
        use TextureFormat as F;
        /// The ASTC formats with and without sRGB, by the size of their blocks.
        const ASTC: [F; 14] = [
            F::Astc4x4UnormSrgb,
            F::Astc5x4UnormSrgb,
            F::Astc5x5UnormSrgb,
            F::Astc6x5UnormSrgb,
            F::Astc6x6UnormSrgb,
            F::Astc8x5UnormSrgb,
            F::Astc8x6UnormSrgb,
            F::Astc8x8UnormSrgb,
            F::Astc10x5UnormSrgb,
            F::Astc10x6UnormSrgb,
            F::Astc10x8UnormSrgb,
            F::Astc10x10UnormSrgb,
            F::Astc12x10UnormSrgb,
            F::Astc12x12UnormSrgb,
        ];
        let blocks = |format| Self::Blocks {
            format,
            is_opaque: false,
        };
        Some(match number {
            9 | 15 => Self::Bytes(&[0]),
            16 | 22 => Self::Bytes(&[0, 1]),
            23 | 29 => Self::Bytes(&[0, 1, 2]),
            30 | 36 => Self::Bytes(&[2, 1, 0]),
            37 | 43 => Self::Bytes(&[0, 1, 2, 3]),
            44 | 50 => Self::Bytes(&[2, 1, 0, 3]),
            131 | 132 => Self::Blocks {
                format: F::Bc1RgbaUnorm,
                is_opaque: true,
            },
            133 | 134 => blocks(F::Bc1RgbaUnorm),
            135 | 136 => blocks(F::Bc2RgbaUnorm),
            137 | 138 => blocks(F::Bc3RgbaUnorm),
            139 => blocks(F::Bc4RUnorm),
            140 => blocks(F::Bc4RSnorm),
            141 => blocks(F::Bc5RgUnorm),
            142 => blocks(F::Bc5RgSnorm),
            143 => blocks(F::Bc6hRgbUfloat),
            144 => blocks(F::Bc6hRgbFloat),
            145 | 146 => blocks(F::Bc7RgbaUnorm),
            147 | 148 => blocks(F::Etc2Rgb8Unorm),
            149 | 150 => blocks(F::Etc2Rgb8A1Unorm),
            151 | 152 => blocks(F::Etc2Rgba8Unorm),
            153 => blocks(F::EacR11Unorm),
            154 => blocks(F::EacR11Snorm),
            155 => blocks(F::EacRg11Unorm),
            156 => blocks(F::EacRg11Snorm),
            // Without sRGB, ASTC's colours have 16 bits, of which the upper 8 are those with it.
            157..=184 => blocks(ASTC[(number as usize - 157) / 2]),
            _ => return None,
        })
    }

    /// Columns and rows of a block.
    pub(super) fn block_size(self) -> [usize; 2] {
        match self {
            Self::Bytes(_) => [1, 1],
            Self::Blocks { format, .. } => format.block_size().map(|side| side as usize),
        }
    }

    /// Bytes of a block.
    pub(super) fn block_len(self) -> usize {
        match self {
            Self::Bytes(channels) => channels.len(),
            Self::Blocks { format, .. } => format.block_bytes() as usize,
        }
    }

    /// Bytes of an image.
    pub(super) fn len_bytes(self, (width, height): (u32, u32)) -> usize {
        let [columns, rows] = self.block_size();
        (width as usize)
            .div_ceil(columns)
            .saturating_mul((height as usize).div_ceil(rows))
            .saturating_mul(self.block_len())
    }

    /// The RGBA of a block's texels, row by row: as many as its size says.
    pub(super) fn decode(self, block: &[u8], texels: &mut [[u8; 4]]) {
        match self {
            Self::Bytes(channels) => {
                let mut stored = [0; 4];
                for (&channel, &byte) in channels.iter().zip(block) {
                    stored[channel] = byte;
                }
                let [r, g, ..] = stored;
                texels[0] = match channels.len() {
                    1 => [r, r, r, 255],
                    2 => normal([r, g].map(|code| f32::from(code) / 127.5 - 1.0)),
                    3 => {
                        stored[3] = 255;
                        stored
                    }
                    _ => stored,
                };
            }
            Self::Blocks { format, is_opaque } => {
                let mut words = [0; MAX_BLOCK_WORDS];
                decode_block(format, block, &mut words);
                converted(format, &words, texels);
                if is_opaque {
                    for texel in texels {
                        texel[3] = 255;
                    }
                }
            }
        }
    }
}

/// The RGBA of words of the format in which estampe-texture stores blocks.
fn converted(format: TextureFormat, words: &[u32], texels: &mut [[u8; 4]]) {
    use TextureFormat as F;
    // Numbers from 0 to 1 as from −1 to 1.
    let spread = |value: f32, is_signed: bool| if is_signed { value } else { value * 2.0 - 1.0 };
    match format {
        F::Bc4RUnorm | F::Bc4RSnorm | F::EacR11Unorm | F::EacR11Snorm => {
            let is_signed = matches!(format, F::Bc4RSnorm | F::EacR11Snorm);
            for (texel, &word) in texels.iter_mut().zip(words) {
                let grey = unorm8(spread(f32::from_bits(word), is_signed));
                *texel = [grey, grey, grey, 255];
            }
        }
        F::Bc5RgUnorm | F::Bc5RgSnorm | F::EacRg11Unorm | F::EacRg11Snorm => {
            let is_signed = matches!(format, F::Bc5RgSnorm | F::EacRg11Snorm);
            for (texel, &pair) in texels.iter_mut().zip(words.as_chunks::<2>().0) {
                *texel = normal(pair.map(|word| spread(f32::from_bits(word), is_signed)));
            }
        }
        F::Bc6hRgbUfloat | F::Bc6hRgbFloat => {
            for (texel, [low, high]) in texels.iter_mut().zip(words.as_chunks::<2>().0) {
                let [r, g, b] = [low & 0xffff, low >> 16, high & 0xffff]
                    .map(|bits| srgb::encode(half::decode(bits)));
                *texel = [r, g, b, 255];
            }
        }
        _ => {
            for (texel, word) in texels.iter_mut().zip(words) {
                *texel = word.to_le_bytes();
            }
        }
    }
}

/// A unit vector of x and y, as a normal map stores it.
fn normal([x, y]: [f32; 2]) -> [u8; 4] {
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    [unorm8(x), unorm8(y), unorm8(z), 255]
}

/// A number from −1 to 1 as a byte, rounded.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=255"
)]
fn unorm8(value: f32) -> u8 {
    ((value.clamp(-1.0, 1.0) + 1.0) * 127.5 + 0.5) as u8
}
