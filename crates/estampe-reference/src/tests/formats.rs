//! Codes of every channel and format, computed by hand.

use super::*;
use crate::channel::{Channel, channels, quantised_depth};
use crate::color::{bytes, clear_codes, decode, encode, resolve};
use TextureFormat as F;

/// Rows: O8.
#[test]
fn every_code_survives_decoding_and_encoding() {
    let survives = |channel: Channel, code: u32| {
        let value = channel.decode(code);
        assert!(
            value.is_nan() || channel.encode(value) == code,
            "{channel:?} {code:#x}"
        );
    };
    for channel in [
        Channel::Unorm(2),
        Channel::Unorm(8),
        Channel::Unorm(10),
        Channel::Unorm(16),
        Channel::Srgb,
        Channel::Half,
        Channel::SmallFloat(6),
        Channel::SmallFloat(5),
    ] {
        (0..1 << channel.bits()).for_each(|code| survives(channel, code));
    }
    // The least code of two's complement decodes to −1 too, and encodes to the next code.
    for bits in [8, 16] {
        let channel = Channel::Snorm(bits);
        let lowest = 1_u32 << (bits - 1);
        (0..1 << bits)
            .filter(|&code| code != lowest)
            .for_each(|code| survives(channel, code));
        assert_eq!(channel.decode(lowest), -1.0);
        assert_eq!(channel.decode(lowest + 1), -1.0);
        assert_eq!(channel.decode(lowest - 1), 1.0);
    }
}

/// Rows: O8.
#[test]
fn normalised_numbers_round_to_the_nearest_code() {
    let all = |channel: Channel, pairs: &[(f32, u32)]| {
        for &(value, code) in pairs {
            assert_eq!(channel.encode(value), code, "{channel:?} of {value}");
        }
    };
    // ½·65535 + ½ = 32768; ½·1023 + ½ = 512; ½·3 + ½ = 2.
    all(
        Channel::Unorm(16),
        &[(0.5, 32_768), (f32::NAN, 0), (9.0, 65_535), (-1.0, 0)],
    );
    all(
        Channel::Unorm(10),
        &[(0.5, 512), (0.2499, 256), (1.0, 1023)],
    );
    all(Channel::Unorm(2), &[(0.5, 2), (0.166, 0), (0.167, 1)]);
    // ½·127 = 63.5 is 64, −63.5 is −64: ties to even; −127 is 0x81.
    all(
        Channel::Snorm(8),
        &[
            (0.5, 64),
            (-0.5, 0xC0),
            (2.5 / 127.0, 2),
            (-1.0, 0x81),
            (-7.0, 0x81),
            (f32::NAN, 0),
            (7.0, 127),
        ],
    );
    all(
        Channel::Snorm(16),
        &[(-1.0, 0x8001), (0.25, 8192), (f32::NEG_INFINITY, 0x8001)],
    );
}

/// Rows: O8.
#[test]
fn small_floats_round_to_even() {
    let ulp = 1.0 / 1024.0;
    let half = Channel::Half;
    for (value, code) in [
        (1.0, 0x3C00),
        (-2.0, 0xC000),
        (1.0 + ulp / 2.0, 0x3C00),
        (1.0 + ulp * 1.5, 0x3C02),
        (65_504.0, 0x7BFF),
        (65_519.996, 0x7BFF),
        (65_520.0, 0x7C00),
        (1e30, 0x7C00),
        (f32::NEG_INFINITY, 0xFC00),
        (f32::NAN, 0x7E00),
        (-0.0, 0x8000),
        // 2⁻¹⁴ is the least normal number, 2⁻²⁴ the least denormal; half of it goes to 0, one and a
        // half times to 2.
        (6.103_515_6e-5, 0x0400),
        (5.960_464_5e-8, 1),
        (2.980_232_2e-8, 0),
        (8.940_697e-8, 2),
        (1e-45, 0),
    ] {
        assert_eq!(half.encode(value), code, "{value}");
    }
    let eleven = Channel::SmallFloat(6);
    for (value, code) in [
        (1.0, 0x3C0),
        (65_024.0, 0x7BF),
        (1e9, 0x7BF),
        (f32::INFINITY, 0x7C0),
        (f32::NAN, 0x7E0),
        (-1.0, 0),
        (f32::NEG_INFINITY, 0),
        (-0.0, 0),
        // 2⁻²⁰ is the least denormal.
        (9.536_743e-7, 1),
    ] {
        assert_eq!(eleven.encode(value), code, "{value}");
    }
    let ten = Channel::SmallFloat(5);
    for (value, code) in [
        (64_512.0, 0x3DF),
        (65_535.0, 0x3DF),
        (f32::INFINITY, 0x3E0),
        (f32::NAN, 0x3F0),
    ] {
        assert_eq!(ten.encode(value), code, "{value}");
    }

    // No other value is nearer; between two equally near ones the even one is chosen.
    let mut random = Random::new(81);
    for _ in 0..20_000 {
        let value = f32::from_bits(random.next()).abs();
        for channel in [half, eleven, ten] {
            let code = channel.encode(value);
            let greatest =
                channel.decode((0x1F << (channel.bits() - 5 - u32::from(channel == half))) - 1);
            if !value.is_finite() || value > greatest {
                continue;
            }
            let distance = |code: u32| (f64::from(channel.decode(code)) - f64::from(value)).abs();
            for neighbour in [code.saturating_sub(1), code + 1] {
                if neighbour != code && channel.decode(neighbour).is_finite() {
                    let (own, other) = (distance(code), distance(neighbour));
                    assert!(
                        own < other || own == other && code % 2 == 0,
                        "{channel:?} of {value}"
                    );
                }
            }
        }
    }
}

/// Rows: O8.
#[test]
fn integers_are_clamped_to_their_range() {
    let of = |bits: u32| f32::from_bits(bits);
    assert_eq!(Channel::Uint(8).encode(of(300)), 255);
    assert_eq!(Channel::Uint(8).encode(of(u32::MAX)), 255);
    assert_eq!(Channel::Uint(10).encode(of(1024)), 1023);
    assert_eq!(Channel::Uint(32).encode(of(u32::MAX)), u32::MAX);
    assert_eq!(Channel::Sint(8).encode(of(-129_i32 as u32)), 0x80);
    assert_eq!(Channel::Sint(16).encode(of(40_000)), 0x7FFF);
    assert_eq!(Channel::Sint(32).encode(of(0x8000_0000)), 0x8000_0000);
    assert_eq!(Channel::Float.encode(-0.0), 0x8000_0000);
    assert_eq!(Channel::Float.encode(-f32::NAN), 0x7FC0_0000);

    assert_eq!(
        clear_codes(F::Rgba8Uint, [300.0, -5.0, 3.9, f64::NAN]),
        [255, 0, 3, 0]
    );
    assert_eq!(
        clear_codes(F::Rgba8Sint, [-200.7, -1.9, 127.9, 1e30]),
        [0x80, 0xFF, 127, 127]
    );
    assert_eq!(
        clear_codes(F::Rg32Uint, [4_294_967_295.0, 1.0, 1.0, 1.0]),
        [u32::MAX, 1, 0, 0]
    );
    assert_eq!(
        clear_codes(F::R16Float, [0.5, 1.0, 1.0, 1.0]),
        [0x3800, 0, 0, 0]
    );
}

/// Rows: O8.
#[test]
fn texels_are_laid_out_from_the_lowest_bit_on() {
    let word = |bits: u32| bits.to_le_bytes().to_vec();
    assert_eq!(
        bytes(F::Rgb10a2Unorm, [1, 2, 3, 1]),
        word(1 | 2 << 10 | 3 << 20 | 1 << 30)
    );
    assert_eq!(
        bytes(F::Rg11b10Ufloat, [1, 2, 3, 0]),
        word(1 | 2 << 11 | 3 << 22)
    );
    assert_eq!(bytes(F::Bgra8Unorm, [1, 2, 3, 4]), [3, 2, 1, 4]);
    assert_eq!(bytes(F::Rg16Uint, [0x102, 0x304, 0, 0]), [2, 1, 4, 3]);
    for &format in TextureFormat::ALL
        .iter()
        .filter(|format| format.is_renderable())
    {
        let bits: u32 = channels(format).iter().map(|channel| channel.bits()).sum();
        assert_eq!(bits, format.block_bytes() * 8, "{}", format.name());
        let [r, _, b, a] = decode(format, encode(format, [0.0; 4]));
        let missing = [
            r,
            b,
            if format.components() < 4 {
                1.0 - a
            } else {
                0.0
            },
        ];
        assert!(
            format.sample_type() != SampleType::Float || missing == [0.0; 3],
            "{}",
            format.name()
        );
    }
}

/// Rows: D1.
#[test]
fn depths_are_multiples_of_the_formats_step() {
    let d16 = |depth| quantised_depth(F::Depth16Unorm, depth);
    // ½ is between 32767 and 32768: to even.
    assert_eq!(d16(0.5), 32_768.0 / 65_535.0);
    assert_eq!([d16(0.0), d16(1.0)], [0.0, 1.0]);
    assert_eq!(quantised_depth(F::Depth32Float, 0.1), 0.1);
    let (mut below, mut least) = (-1.0, 1.0_f32);
    for code in (0..1 << 24)
        .step_by(97)
        .chain([(1 << 24) - 2, (1 << 24) - 1])
    {
        let depth = code as f32 / 16_777_215.0;
        for format in [F::Depth24Plus, F::Depth24PlusStencil8] {
            assert_eq!(quantised_depth(format, depth), depth, "code {code}");
        }
        assert!(depth > below);
        if code > 0 {
            least = least.min(depth);
        }
        below = depth;
    }
    assert_eq!(below, 1.0);
    // Depths between two codes go to the nearer one.
    assert_eq!(quantised_depth(F::Depth24Plus, 0.4 / 16_777_215.0), 0.0);
    assert_eq!(
        quantised_depth(F::Depth24Plus, 0.6 / 16_777_215.0),
        1.0 / 16_777_215.0
    );
}

/// Rows: R6.
#[test]
fn each_kind_of_channel_resolves_in_its_own_way() {
    let pair = |format, one: u32, other: u32| resolve(format, &[[one; 4], [other; 4]])[0];
    assert_eq!(pair(F::R16Unorm, 3, 6), 5); // 4.5 + ½
    assert_eq!(pair(F::R8Snorm, 0x80, 0x81), 0x81); // −128 counts as −127
    assert_eq!(pair(F::R8Snorm, 0xFF, 0xFE), 0xFE); // −1.5 is −2, the even one
    assert_eq!(pair(F::R16Float, 0x3C00, 0x4000), 0x3E00); // 1, 2: 1.5
    assert_eq!(pair(F::Rg11b10Ufloat, 0x3C0, 0x400), 0x3E0);
    assert_eq!(
        pair(F::R32Float, 1.0_f32.to_bits(), 4.0_f32.to_bits()),
        2.5_f32.to_bits()
    );
    assert_eq!(pair(F::R32Sint, 7, 9), 7);
    assert_eq!(pair(F::Rgb10a2Uint, 3, 1), 3);
}
