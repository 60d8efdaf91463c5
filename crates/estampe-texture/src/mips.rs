//! Mip generation of four 8-bit channels by a 2×2 box filter.
//! [`MipGeneration::Full`](crate::MipGeneration::Full) states the rule.

use estampe_format::srgb;
use estampe_types::{MipLevel, TextureFormat};

/// Appends level `to`, the half of level `from`, to the texels of all levels above it.
pub(crate) fn append_half(
    texels: &mut Vec<u32>,
    from: MipLevel,
    to: MipLevel,
    format: TextureFormat,
) {
    let mean = mean_of_four(format);
    let width = from.width as usize;
    let start = from.offset as usize;
    for y in 0..to.height {
        let upper = start + (2 * y) as usize * width;
        let lower = start + (2 * y + 1).min(from.height - 1) as usize * width;
        for x in 0..to.width {
            let left = (2 * x) as usize;
            let right = (2 * x + 1).min(from.width - 1) as usize;
            let four = [
                texels[upper + left],
                texels[upper + right],
                texels[lower + left],
                texels[lower + right],
            ];
            texels.push(mean(four));
        }
    }
}

/// The function that averages four texels of four 8-bit channels.
pub(crate) fn mean_of_four(format: TextureFormat) -> fn([u32; 4]) -> u32 {
    if format.is_srgb() {
        mean_srgb
    } else {
        mean_unorm
    }
}

/// Each channel is (a + b + c + d + 2) / 4. Two channels are summed in one word, 16 bits each.
fn mean_unorm(four: [u32; 4]) -> u32 {
    const EVEN: u32 = 0x00FF_00FF;
    let (mut even, mut odd) = (0x0002_0002, 0x0002_0002);
    for texel in four {
        even += texel & EVEN;
        odd += (texel >> 8) & EVEN;
    }
    (even >> 2) & EVEN | ((odd >> 2) & EVEN) << 8
}

/// Averages R, G and B as linear values, and alpha as unorm.
fn mean_srgb(four: [u32; 4]) -> u32 {
    let table = &*srgb::LINEAR_FROM_SRGB;
    let mut texel = mean_unorm(four) & 0xFF00_0000;
    for shift in [0, 8, 16] {
        let [a, b, c, d] = four.map(|t| table[(t >> shift & 0xFF) as usize]);
        let linear = ((a + b) + (c + d)) * 0.25;
        texel |= u32::from(srgb::encode(linear)) << shift;
    }
    texel
}
