//! Colours: the 8-bit codes of an attachment or texture, and the linear numbers that they stand for.
//!
//! In · Out: codes R, G, B, A · linear values 0..=1. Spec: NUMERICS.md, *Per-sample operations*.

use crate::arithmetic::clamp;
use estampe_types::{TextureFormat, srgb};

/// 1/255, rounded to f32: what codes are multiplied by.
pub const INVERSE_255: f32 = 1.0 / 255.0;

/// The linear values of stored codes: c·(1/255); R, G and B of sRGB by the table.
#[must_use]
pub fn decode(format: TextureFormat, codes: [u8; 4]) -> [f32; 4] {
    let unorm = |code: u8| f32::from(code) * INVERSE_255;
    let channel = |code: u8| {
        if format.is_srgb() {
            srgb::LINEAR_FROM_SRGB[usize::from(code)]
        } else {
            unorm(code)
        }
    };
    let [r, g, b, a] = codes;
    [channel(r), channel(g), channel(b), unorm(a)]
}

/// The codes that store linear values.
#[must_use]
pub fn encode(format: TextureFormat, linear: [f32; 4]) -> [u8; 4] {
    let channel = if format.is_srgb() {
        srgb_code
    } else {
        unorm_code
    };
    let [r, g, b, a] = linear;
    [channel(r), channel(g), channel(b), unorm_code(a)]
}

/// ⌊x·255 + ½⌋ of x confined to 0..=1; NaN gives 0.
#[must_use]
pub fn unorm_code(value: f32) -> u8 {
    code_of(clamp(value, 0.0, 1.0) * 255.0 + 0.5)
}

/// How many of the 255 thresholds are at or below the value; NaN gives 0. Counted one by one.
#[must_use]
pub fn srgb_code(linear: f32) -> u8 {
    let below = srgb::THRESHOLDS
        .iter()
        .filter(|&&threshold| threshold <= linear)
        .count();
    u8::try_from(below).expect("there are 255 thresholds")
}

/// The code that stands for the samples of one pixel: their mean, of codes where the channel is
/// unorm (alpha always), of linear values where it is sRGB. The sum is taken in order.
#[must_use]
pub fn resolve(format: TextureFormat, samples: &[[u8; 4]]) -> [u8; 4] {
    let inverse_count = 1.0 / samples.len() as f32;
    std::array::from_fn(|channel| {
        let codes = samples.iter().map(|codes| codes[channel]);
        if format.is_srgb() && channel < 3 {
            let sum = codes.fold(0.0, |sum, code| {
                sum + srgb::LINEAR_FROM_SRGB[usize::from(code)]
            });
            srgb_code(sum * inverse_count)
        } else {
            let sum = codes.fold(0.0, |sum, code| sum + f32::from(code));
            code_of(sum * inverse_count + 0.5)
        }
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is within 0..256"
)]
fn code_of(value: f32) -> u8 {
    value.floor() as u8
}
