//! The codes of one packet blended as docs/NUMERICS.md writes it, each operation rounded.
//!
//! What is left out changes nothing: the blend of values in 0..=1 is not clamped, because it is at
//! least 0, and exceeds 1 by rounding alone, which gives the code 255 as well.

use super::ColorPlanes;
use crate::fragment::interpolate::evaluate;
use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, SimdCvtTruncate, f32x16, i32x16, u32x16};

/// The codes of `CHANNELS` channels of a packet that begins at a pixel, blended over codes. What is
/// opaque stays so: three channels are enough where all codes of alpha are 255.
#[inline(always)]
pub(super) fn blend<S: Lanes, const CHANNELS: usize>(
    s: S,
    colors: &ColorPlanes,
    pixel: [i32; 2],
    below: &[u32x16<S>; 4],
) -> [u32x16<S>; 4] {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let distances = colors.origin.distances(s, pixel, [0.5; 2]);
    let alpha = saturate(s, evaluate(s, &colors.channels[3], distances));
    let rest = splat(1.0) - alpha;
    let mut codes = *below;
    let mut channel = 0;
    while channel < CHANNELS {
        let below: i32x16<S> = below[channel].bitcast();
        let below = f32x16::float_from(below) * (1.0 / 255.0);
        let mut source = alpha;
        if channel < 3 {
            let value = evaluate(s, &colors.channels[channel], distances);
            source = saturate(s, value) * alpha;
        }
        codes[channel] = unorm_code(source + below * rest);
        channel += 1;
    }
    codes
}

/// ⌊x·255 + ½⌋ of a value that is at least 0, and above 1 by less than 1/512.
#[inline(always)]
fn unorm_code<S: Lanes>(value: f32x16<S>) -> u32x16<S> {
    i32x16::truncate_from(value * 255.0 + 0.5).bitcast()
}

/// 0..=1, NaN being 0.
#[inline(always)]
fn saturate<S: Lanes>(s: S, value: f32x16<S>) -> f32x16<S> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    s.min_f32(s.max_f32(value, zero), one)
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_opaque_stays_so() {
        // As `blend` would compute it, for alphas of every exponent and many mantissas.
        for bits in (0..=1.0f32.to_bits()).step_by(997) {
            let alpha = f32::from_bits(bits);
            let below = 255.0 * (1.0 / 255.0f32);
            let blended = alpha + below * (1.0 - alpha);
            let code = blended * 255.0 + 0.5;
            assert!((255.0..256.0).contains(&code), "{alpha}");
        }
    }
}
