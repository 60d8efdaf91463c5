//! Encoding of three numbers with one exponent (RGB9E5).
//!
//! In · Out: R, G, B · a texel. Precision: f32 in the order of NUMERICS.md, *Textures*, *Mip
//! levels*. Spec: Vulkan, *Shared Exponent Format*, with N = 9, B = 15.

use crate::arithmetic::{clamp, max};

/// The greatest number: 511 · 2⁷.
const GREATEST: f32 = 65_408.0;

/// The texel nearest to three numbers.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mantissa is at most 512"
)]
pub fn encode(rgb: [f32; 3]) -> u32 {
    // `max` and `min` give the limit for NaN.
    let rgb = rgb.map(|channel| clamp(channel, 0.0, GREATEST));
    let greatest = max(max(rgb[0], rgb[1]), rgb[2]);
    // 2^e ≤ greatest < 2^(e + 1), at least e = −16.
    let floor_of_log2 = (-16..16)
        .rev()
        .find(|&e| power_of_two(e) <= greatest)
        .unwrap_or(-16);
    let mantissa =
        |channel: f32, exponent: i32| (channel / power_of_two(exponent - 24) + 0.5).floor() as u32;
    let preliminary = floor_of_log2 + 16;
    let exponent = if mantissa(greatest, preliminary) == 512 {
        preliminary + 1
    } else {
        preliminary
    };
    let [r, g, b] = rgb.map(|channel| mantissa(channel, exponent));
    r | g << 9 | b << 18 | exponent.cast_unsigned() << 27
}

fn power_of_two(exponent: i32) -> f32 {
    if exponent < 0 {
        1.0 / power_of_two(-exponent)
    } else {
        (0..exponent).fold(1.0, |power, _| power * 2.0)
    }
}
