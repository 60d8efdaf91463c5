//! Three mantissas of 9 bits and one exponent of 5 (`Rgb9e5Ufloat`): R in the lowest bits, the
//! exponent in the highest.
//!
//! *Spec* Vulkan, Shared Exponent Format, and `EXT_texture_shared_exponent`: N = 9, B = 15. A
//! channel is m·2^(e − 24).

use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};

/// The texel nearest to three numbers. Negative ones and NaN count as 0, those above 65408 as that.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "confined to the format's range"
)]
#[must_use]
pub fn encode(rgb: [f32; 3]) -> u32 {
    /// (2⁹ − 1)/2⁹ · 2¹⁶.
    const GREATEST: f32 = 65_408.0;
    let rgb = rgb.map(|x| if x > 0.0 { x.min(GREATEST) } else { 0.0 });
    let most = rgb[0].max(rgb[1]).max(rgb[2]);
    let floor_of_log2 = (most.to_bits() >> 23).cast_signed() - 127;
    let preliminary = floor_of_log2.max(-16) + 16;
    // Powers of two, so dividing by them is exact but for denormal results, which count as 0
    // anyway.
    let scale = |exponent: i32| f32::from_bits(((exponent - 15 - 9 + 127) << 23).cast_unsigned());
    let greatest = (most / scale(preliminary) + 0.5).floor();
    let exponent = preliminary + i32::from(greatest >= 512.0);
    let [r, g, b] = rgb.map(|x| (x / scale(exponent) + 0.5).floor() as u32);
    r | g << 9 | b << 18 | exponent.cast_unsigned() << 27
}

/// A texel's three numbers, exactly.
#[inline(always)]
#[must_use]
pub fn decode(texel: u32) -> [f32; 3] {
    let scale = f32::from_bits(((texel >> 27) + 127 - 24) << 23);
    [texel, texel >> 9, texel >> 18].map(|mantissa| (mantissa & 0x1FF) as f32 * scale)
}

/// [`decode`] of sixteen texels.
#[inline(always)]
pub fn decode_lanes<S: Lanes>(s: S, texel: u32x16<S>) -> [f32x16<S>; 3] {
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    let scale: f32x16<S> = (((texel >> 27) + splat(127 - 24)) << 23).bitcast();
    let mut channels = [scale; 3];
    let mut left = texel;
    for channel in &mut channels {
        let mantissa: i32x16<S> = (left & splat(0x1FF)).bitcast();
        *channel = f32x16::float_from(mantissa) * scale;
        left >>= 9;
    }
    channels
}
