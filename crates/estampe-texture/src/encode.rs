//! Numbers as the bits that a format stores: for mip levels and storage textures. The rules are `docs/NUMERICS.md`'s,
//! *Formats*: those of render targets.

use estampe_types::srgb::srgb_from_linear;
use estampe_types::{TexelEncoding, TextureFormat};

/// A texel's words from what a shader gives: numbers, of integer formats their bits. Formats of blocks, depth and
/// stencil give zeros.
pub(crate) fn encode(format: TextureFormat, value: [f32; 4]) -> [u32; 4] {
    use TexelEncoding as E;
    let components = format.components();
    let mut words = [0; 4];
    let [r, g, b, a] = value;
    match format.encoding() {
        E::Unorm8 if format.is_srgb() => {
            let of = |x: f32| u32::from(srgb_from_linear(x));
            words[0] = of(r) | of(g) << 8 | of(b) << 16 | unorm(a, 255.0) << 24;
        }
        E::Unorm8 => words[0] = packed(value, components, 8, |x| unorm(x, 255.0)),
        E::Snorm8 => words[0] = packed(value, components, 8, |x| snorm(x, 127.0)),
        E::Uint8 => words[0] = packed(value, components, 8, |x| uint(x, 8)),
        E::Sint8 => words[0] = packed(value, components, 8, |x| sint(x, 8)),
        E::Unorm16 => words = halves(value, components, |x| unorm(x, 65535.0)),
        E::Snorm16 => words = halves(value, components, |x| snorm(x, 32767.0)),
        E::Uint16 => words = halves(value, components, |x| uint(x, 16)),
        E::Sint16 => words = halves(value, components, |x| sint(x, 16)),
        E::Float16 => words = halves(value, components, |x| u32::from(half_from_float(x))),
        E::Uint32 | E::Sint32 => {
            for (word, x) in words.iter_mut().zip(value).take(components) {
                *word = x.to_bits();
            }
        }
        E::Float32 => {
            for (word, x) in words.iter_mut().zip(value).take(components) {
                *word = if x.is_nan() { 0x7FC0_0000 } else { x.to_bits() };
            }
        }
        E::Unorm10_2 => {
            let of = |x: f32| unorm(x, 1023.0);
            words[0] = of(r) | of(g) << 10 | of(b) << 20 | unorm(a, 3.0) << 30;
        }
        E::Uint10_2 => {
            words[0] = uint(r, 10) | uint(g, 10) << 10 | uint(b, 10) << 20 | uint(a, 2) << 30;
        }
        E::Ufloat11_10 => {
            let [r, g, b] = [small_float(r, 6), small_float(g, 6), small_float(b, 5)];
            words[0] = r | g << 11 | b << 22;
        }
        E::SharedExponent => words[0] = shared_exponent([r, g, b]),
        _ => {}
    }
    words
}

/// Channels of 8 bits in one word.
fn packed(value: [f32; 4], components: usize, bits: u32, code: impl Fn(f32) -> u32) -> u32 {
    let mut word = 0;
    for (k, x) in (0..).zip(value).take(components) {
        word |= code(x) << (k * bits);
    }
    word
}

/// Channels of 16 bits, two to a word.
fn halves(value: [f32; 4], components: usize, code: impl Fn(f32) -> u32) -> [u32; 4] {
    let mut words = [0; 4];
    for (k, x) in value.into_iter().enumerate().take(components) {
        words[k / 2] |= code(x) << (16 * (k & 1));
    }
    words
}

/// `floor(x·M + 0.5)` of x confined to 0..=1; NaN gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "confined to 0..=M"
)]
fn unorm(x: f32, most: f32) -> u32 {
    let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
    (x * most + 0.5).floor() as u32
}

/// `floor(x·M + 0.5)` of x confined to −1..=1, in two's complement; NaN gives 0.
#[expect(clippy::cast_possible_truncation, reason = "confined to −M..=M")]
fn snorm(x: f32, most: f32) -> u32 {
    let x = if x.is_nan() { 0.0 } else { x.clamp(-1.0, 1.0) };
    let code = (x * most + 0.5).floor() as i32;
    let bits = if most < 128.0 { 0xFF } else { 0xFFFF };
    code.cast_unsigned() & bits
}

fn uint(x: f32, bits: u32) -> u32 {
    x.to_bits().min((1 << bits) - 1)
}

fn sint(x: f32, bits: u32) -> u32 {
    let (least, most) = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1);
    x.to_bits().cast_signed().clamp(least, most).cast_unsigned() & ((1 << bits) - 1)
}

/// To nearest, ties to even; denormals are kept, from 65520 on it is infinite; NaN gives 0x7E00.
pub(crate) fn half_from_float(x: f32) -> u16 {
    let bits = x.to_bits();
    let (sign, magnitude) = (bits >> 16 & 0x8000, bits & 0x7FFF_FFFF);
    let code = if magnitude > 0x7F80_0000 {
        return 0x7E00;
    } else {
        small_magnitude(magnitude, 10).min(0x7C00)
    };
    u16::try_from(sign | code).unwrap_or_default()
}

/// An unsigned float of five bits of exponent: negative numbers give 0, large ones the greatest finite code.
fn small_float(x: f32, mantissa: u32) -> u32 {
    let infinite = 31 << mantissa;
    if x.is_nan() {
        infinite | 1 << (mantissa - 1)
    } else if x <= 0.0 {
        0
    } else if x == f32::INFINITY {
        infinite
    } else {
        small_magnitude(x.to_bits(), mantissa).min(infinite - 1)
    }
}

/// The bits of a positive number with five bits of exponent (bias 15) and a shorter mantissa, to nearest, ties to
/// even: what is beyond the range has the exponent 31 or more.
fn small_magnitude(bits: u32, mantissa: u32) -> u32 {
    let exponent = (bits >> 23).cast_signed() - 127;
    let cut = 23 - mantissa;
    if exponent >= -14 {
        // A carry out of the mantissa belongs into the exponent.
        let rebased = bits - ((127 - 15) << 23);
        let half_up = (1 << (cut - 1)) - 1 + (rebased >> cut & 1);
        return (rebased + half_up) >> cut;
    }
    // Denormals: the whole mantissa in units of 2^(−14 − mantissa).
    let shift = cut + (-14 - exponent).cast_unsigned();
    if shift > 25 {
        return 0;
    }
    let whole = bits & 0x7F_FFFF | 0x80_0000;
    let half_up = (1 << (shift - 1)) - 1 + (whole >> shift & 1);
    (whole + half_up) >> shift
}

/// Vulkan's and OpenGL's conversion of three numbers to a shared exponent (N = 9, B = 15).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "confined to the format's range"
)]
fn shared_exponent(rgb: [f32; 3]) -> u32 {
    /// (2⁹ − 1)/2⁹ · 2¹⁶.
    const GREATEST: f32 = 65_408.0;
    let rgb = rgb.map(|x| if x > 0.0 { x.min(GREATEST) } else { 0.0 });
    let most = rgb[0].max(rgb[1]).max(rgb[2]);
    let floor_of_log2 = (most.to_bits() >> 23).cast_signed() - 127;
    let preliminary = floor_of_log2.max(-16) + 16;
    // Powers of two, so dividing by them is exact but for denormal results, which count as 0 anyway.
    let scale = |exponent: i32| f32::from_bits(((exponent - 15 - 9 + 127) << 23).cast_unsigned());
    let greatest = (most / scale(preliminary) + 0.5).floor();
    let exponent = preliminary + i32::from(greatest >= 512.0);
    let [r, g, b] = rgb.map(|x| (x / scale(exponent) + 0.5).floor() as u32);
    r | g << 9 | b << 18 | exponent.cast_unsigned() << 27
}
