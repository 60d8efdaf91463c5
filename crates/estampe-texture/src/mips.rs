//! Mip generation of four 8-bit channels by a 2×2 box filter.
//! [`MipGeneration::Full`](crate::MipGeneration::Full) states the rule.

use estampe_format::box_filter::{self, Averaged};
use estampe_types::{MipLevel, TextureFormat};

/// Makes level `to` the half of level `from`, in the texels of all levels.
pub(crate) fn halve_level(texels: &mut [u32], from: MipLevel, to: MipLevel, format: TextureFormat) {
    let averaged = Averaged::of(format.is_srgb());
    let (above, half) = texels.split_at_mut(to.offset as usize);
    let above = &above[from.offset as usize..];
    let width = from.width as usize;
    let row = |y: u32| {
        let first = y as usize * width;
        &above[first..first + width]
    };
    for (y, half) in (0..to.height).zip(half.chunks_exact_mut(to.width as usize)) {
        let (upper, lower) = (row(2 * y), row((2 * y + 1).min(from.height - 1)));
        box_filter::halve_rows(upper, lower, half, averaged);
    }
}

/// The function that averages four texels of four 8-bit channels.
pub(crate) fn mean_of_four(format: TextureFormat) -> impl Fn([u32; 4]) -> u32 {
    let averaged = Averaged::of(format.is_srgb());
    move |four| box_filter::mean(four, averaged)
}
