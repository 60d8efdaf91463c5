//! Blocks of 4 × 4 texels, decoded by `bcdec_rs`.

/// Formats of blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BlockFormat {
    /// Colours, with alpha of one bit.
    Bc1,
    /// Colours, with alpha of four bits.
    Bc2,
    /// Colours, with interpolated alpha.
    Bc3,
    /// One channel from 0 to 1.
    Bc4,
    /// One channel from −1 to 1.
    Bc4Signed,
    /// Two channels from 0 to 1.
    Bc5,
    /// Two channels from −1 to 1.
    Bc5Signed,
    /// Colours with alpha, in eight modes.
    Bc7,
}

impl BlockFormat {
    /// Bytes of a block.
    pub(super) fn len_bytes(self) -> usize {
        match self {
            Self::Bc1 | Self::Bc4 | Self::Bc4Signed => 8,
            Self::Bc2 | Self::Bc3 | Self::Bc5 | Self::Bc5Signed | Self::Bc7 => 16,
        }
    }

    /// The RGBA of a block's texels, row by row. `block` has this format's length.
    pub(super) fn decode(self, block: &[u8]) -> [[u8; 4]; 16] {
        let mut texels = [[0; 4]; 16];
        let rgba = texels.as_flattened_mut();
        match self {
            Self::Bc1 => bcdec_rs::bc1(block, rgba, 16),
            Self::Bc2 => bcdec_rs::bc2(block, rgba, 16),
            Self::Bc3 => bcdec_rs::bc3(block, rgba, 16),
            Self::Bc7 => bcdec_rs::bc7(block, rgba, 16),
            Self::Bc4 | Self::Bc4Signed => {
                let mut values = [0.0; 16];
                let is_signed = self == Self::Bc4Signed;
                bcdec_rs::bc4_float(block, &mut values, 4, is_signed);
                for (texel, value) in texels.iter_mut().zip(values) {
                    let grey = unorm8(if is_signed { value } else { value * 2.0 - 1.0 });
                    *texel = [grey, grey, grey, 255];
                }
            }
            Self::Bc5 | Self::Bc5Signed => {
                let mut values = [0.0; 32];
                let is_signed = self == Self::Bc5Signed;
                bcdec_rs::bc5_float(block, &mut values, 8, is_signed);
                for (texel, value) in texels.iter_mut().zip(values.as_chunks::<2>().0) {
                    let [x, y] = value.map(|v| if is_signed { v } else { v * 2.0 - 1.0 });
                    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
                    *texel = [unorm8(x), unorm8(y), unorm8(z), 255];
                }
            }
        }
        texels
    }
}

/// A number from −1 to 1 as a byte, rounded.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it is clamped, and NaN becomes 0"
)]
fn unorm8(value: f32) -> u8 {
    ((value * 0.5 + 0.5).clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}
