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
    let start = texels.len();
    texels.resize(start + to.width as usize * to.height as usize, 0);
    let (above, half) = texels.split_at_mut(start);
    let above = &above[from.offset as usize..];
    // Each form is compiled with its mean, so that the one of integers is done in lanes.
    if format.is_srgb() {
        halve(above, from, half, to, mean_srgb);
    } else {
        halve(above, from, half, to, mean_unorm);
    }
}

/// Writes each texel of the half as the mean of four of the level above.
#[inline(always)]
fn halve(
    above: &[u32],
    from: MipLevel,
    half: &mut [u32],
    to: MipLevel,
    mean: impl Fn([u32; 4]) -> u32,
) {
    let width = from.width as usize;
    let row = |y: u32| {
        let first = y as usize * width;
        &above[first..first + width]
    };
    let rows = half.chunks_exact_mut(to.width as usize);
    for (y, half) in (0..to.height).zip(rows) {
        let (upper, lower) = (row(2 * y), row((2 * y + 1).min(from.height - 1)));
        if width == 1 {
            half[0] = mean([upper[0], upper[0], lower[0], lower[0]]);
            continue;
        }
        let (pairs_above, _) = upper.as_chunks::<2>();
        let (pairs_below, _) = lower.as_chunks::<2>();
        for ((half, above), below) in half.iter_mut().zip(pairs_above).zip(pairs_below) {
            *half = mean([above[0], above[1], below[0], below[1]]);
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
