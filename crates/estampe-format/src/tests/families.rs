//! One family of encodings at a time.

use super::{packets, same, spread_bits, values};
use crate::depth::FixedDepth;
use crate::{float32, half, integer, normalized, shared_exponent, small_float, srgb};
use estampe_simd::{Bytes, LANES, Lanes, Level, SimdBase, dispatch, f32x16, i32x16, u32x16};
use estampe_types::TextureFormat;

/// Compares lanes with single values, bit by bit, on numbers.
macro_rules! check_encode {
    ($values:expr, $one:expr, $s:ident, $x:ident $(, $factor:ident)? => $lanes:expr) => {
        for level in Level::all_available() {
            for packet in packets(&$values) {
                #[inline(always)]
                fn run<S: Lanes>($s: S, packet: [f32; LANES] $(, $factor: f32)?) -> [u32; LANES] {
                    let $x = f32x16::load_array($s, packet);
                    let code: u32x16<S> = Bytes::bitcast($lanes);
                    code.to_array()
                }
                let codes = dispatch!(level, s => run(s, packet $(, $factor)?));
                for (value, code) in packet.into_iter().zip(codes) {
                    let expected: u32 = $one(value);
                    assert_eq!(code, expected, "{level:?} {value:e} {:#x}", value.to_bits());
                }
            }
        }
    };
}

/// Compares lanes with single values, on codes.
macro_rules! check_decode {
    ($codes:expr, $one:expr, $s:ident, $x:ident $(, $factor:ident)? => $lanes:expr) => {
        for level in Level::all_available() {
            for packet in packets(&$codes) {
                #[inline(always)]
                fn run<S: Lanes>($s: S, packet: [u32; LANES] $(, $factor: f32)?) -> [f32; LANES] {
                    let $x = u32x16::load_array($s, packet);
                    let value: f32x16<S> = $lanes;
                    value.to_array()
                }
                let values = dispatch!(level, s => run(s, packet $(, $factor)?));
                for (code, value) in packet.into_iter().zip(values) {
                    let expected: f32 = $one(code);
                    assert_eq!(value.to_bits(), expected.to_bits(), "{level:?} {code:#x}");
                }
            }
        }
    };
}

#[test]
fn every_half_is_decoded() {
    let codes = Vec::from_iter(0..=0xFFFF_u32);
    check_decode!(codes, half::decode, s, code => half::decode_lanes(s, code));
    check_decode!(codes, half::decode, s, code => half::decode_pair(s, code | (!code << 16))[0]);
    check_decode!(codes, half::decode, s, code => half::decode_pair(s, (code << 16) | (!code >> 16))[1]);
    assert_eq!(half::decode(0x3C00), 1.0);
    assert_eq!(half::decode(0xC000), -2.0);
    assert_eq!(half::decode(1), 2.0_f32.powi(-24));
    assert_eq!(half::decode(0x7BFF), 65_504.0);
    assert_eq!(half::decode(0xFC00), f32::NEG_INFINITY);
    assert_eq!(half::decode(0xFE01).to_bits(), 0xFFC0_2000);
    // A signalling NaN becomes quiet.
    assert_eq!(half::decode(0x7C01).to_bits(), 0x7FC0_2000);
}

#[test]
fn every_half_survives_and_neighbours_round_to_the_nearer() {
    let mut values = values();
    for code in 0..0x7C00_u32 {
        let value = half::decode(code);
        assert_eq!(half::encode(value), code);
        assert_eq!(half::encode(-value), code | 0x8000);
        let next = half::decode(code + 1);
        if next.is_finite() {
            let middle = (value + next) / 2.0;
            assert_eq!(half::encode(middle), code + (code & 1), "ties to even");
            assert_eq!(half::encode(middle.next_down()), code);
            assert_eq!(half::encode(middle.next_up()), code + 1);
            values.extend([value, -middle, middle.next_down(), middle.next_up()]);
        }
    }
    assert_eq!(half::encode(65_519.0), 0x7BFF);
    assert_eq!(half::encode(65_520.0), 0x7C00);
    assert_eq!(half::encode(f32::MAX), 0x7C00);
    assert_eq!(half::encode(-f32::NAN), 0x7E00);
    assert_eq!(half::encode(1.0), 0x3C00);
    check_encode!(values, half::encode, s, x => half::encode_lanes(s, x));
    let pair = |value| half::encode(value) | half::encode(-value) << 16;
    check_encode!(values, pair, s, x => half::encode_pair(s, [x, -x]));
}

#[test]
fn small_floats_are_the_nearest_in_range() {
    let mut values = values();
    for code in 0..31 << 6 {
        let (value, next) = (
            small_float::decode::<6>(code),
            small_float::decode::<6>(code + 1),
        );
        assert_eq!(small_float::encode::<6>(value), code);
        values.extend([value, (value + next) / 2.0]);
    }
    for code in 0..31 << 5 {
        let (value, next) = (
            small_float::decode::<5>(code),
            small_float::decode::<5>(code + 1),
        );
        assert_eq!(small_float::encode::<5>(value), code);
        values.extend([value, (value + next) / 2.0]);
    }
    assert_eq!(small_float::encode::<6>(-3.0), 0);
    assert_eq!(small_float::decode::<6>(small_float::encode::<6>(1.0)), 1.0);
    assert_eq!(
        small_float::decode::<5>(small_float::encode::<5>(64_512.0)),
        64_512.0
    );
    assert_eq!(small_float::encode::<6>(f32::INFINITY), 0x7C0);
    assert_eq!(small_float::encode::<6>(f32::MAX), 0x7BF);
    assert_eq!(small_float::encode::<5>(1e9), 0x3DF);
    assert_eq!(small_float::encode::<5>(f32::NAN), 0x3F0);
    assert_eq!(small_float::encode::<6>(f32::NAN), 0x7E0);
    check_encode!(values, small_float::encode::<6>, s, x => small_float::encode_lanes::<S, 6>(s, x));
    check_encode!(values, small_float::encode::<5>, s, x => small_float::encode_lanes::<S, 5>(s, x));
    let codes = Vec::from_iter(0..0x800_u32);
    check_decode!(codes, small_float::decode::<6>, s, c => small_float::decode_lanes::<S, 6>(s, c));
    let codes = Vec::from_iter(0..0x400_u32);
    check_decode!(codes, small_float::decode::<5>, s, c => small_float::decode_lanes::<S, 5>(s, c));
}

#[test]
fn a_shared_exponent_is_decoded_in_lanes() {
    let texels = Vec::from_iter(spread_bits(4096));
    check_decode!(texels, |t| shared_exponent::decode(t)[0], s, t => shared_exponent::decode_lanes(s, t)[0]);
    check_decode!(texels, |t| shared_exponent::decode(t)[1], s, t => shared_exponent::decode_lanes(s, t)[1]);
    check_decode!(texels, |t| shared_exponent::decode(t)[2], s, t => shared_exponent::decode_lanes(s, t)[2]);
    let texel = shared_exponent::encode([1.0, 0.5, 65_536.0]);
    assert_eq!(shared_exponent::decode(texel), [0.0, 0.0, 65_408.0]);
    let texel = shared_exponent::encode([1.0, 0.25, f32::NAN]);
    assert_eq!(shared_exponent::decode(texel), [1.0, 0.25, 0.0]);
}

#[test]
fn normalized_numbers_are_rounded_alike() {
    for bits in [2, 8, 10, 16] {
        let codes = Vec::from_iter(0..1_u32 << bits);
        let (unorm_most, snorm_most) = ((codes.len() - 1) as f32, (codes.len() / 2 - 1) as f32);
        let mut values = values();
        values.extend(codes.iter().flat_map(|&code| {
            let boundary = (code as f32 + 0.5) / unorm_most;
            [
                boundary,
                boundary.next_down(),
                boundary.next_up(),
                -boundary,
            ]
        }));
        let signed = codes.iter().map(|&code| integer::sign_extended(code, bits));
        let signed_codes = Vec::from_iter(signed.map(i32::cast_unsigned));
        check_unorm(&values, &codes, unorm_most);
        check_snorm(&values, &signed_codes, snorm_most);
        for &code in &codes {
            let value = normalized::decode_unorm(code.cast_signed(), 1.0 / unorm_most);
            let again = normalized::encode_unorm(value, unorm_most);
            assert_eq!(again, code.cast_signed(), "codes survive");
        }
    }
    assert_eq!(
        [0.5, 1.5, -0.5, -1.5].map(|codes| normalized::encode_snorm(codes / 127.0, 127.0)),
        [0, 2, 0, -2],
        "ties go to even codes"
    );
    assert_eq!(normalized::encode_unorm(f32::NAN, 255.0), 0);
    assert_eq!(normalized::encode_snorm(f32::NAN, 127.0), 0);
    assert_eq!(normalized::decode_snorm(-128, 1.0 / 127.0), -1.0);
}

fn check_unorm(values: &[f32], codes: &[u32], most: f32) {
    let unit = 1.0 / most;
    let one = |x| normalized::encode_unorm(x, most).cast_unsigned();
    check_encode!(values, one, s, x, most => normalized::encode_unorm_lanes(s, x, most));
    let one = |code: u32| normalized::decode_unorm(code.cast_signed(), unit);
    check_decode!(codes, one, s, code, unit => {
        let _ = s;
        normalized::decode_unorm_lanes(code.bitcast(), unit)
    });
}

fn check_snorm(values: &[f32], codes: &[u32], most: f32) {
    let unit = 1.0 / most;
    let one = |x| normalized::encode_snorm(x, most).cast_unsigned();
    check_encode!(values, one, s, x, most => normalized::encode_snorm_lanes(s, x, most));
    let one = |code: u32| normalized::decode_snorm(code.cast_signed(), unit);
    check_decode!(codes, one, s, code, unit => {
        normalized::decode_snorm_lanes(s, code.bitcast(), unit)
    });
}

#[test]
fn srgb_is_the_number_of_thresholds_below() {
    let values = Vec::from_iter(values().into_iter().map(normalized::saturate));
    check_encode!(values, |x| u32::from(srgb::encode(x)), s, x => srgb::encode_lanes(s, x));
    let one = |code: u32| srgb::LINEAR_FROM_SRGB[code as usize];
    check_decode!(Vec::from_iter(0..256), one, s, code => srgb::decode_lanes(s, code));
    for code in 0..=255_u8 {
        assert_eq!(srgb::encode(srgb::decode(code)), code);
        if code > 0 {
            let threshold = srgb::THRESHOLDS[usize::from(code) - 1];
            assert_eq!(srgb::encode(threshold), code);
            assert_eq!(srgb::encode(threshold.next_down()), code - 1);
        }
    }
    assert_eq!([f32::NAN, -1.0, 2.0].map(srgb::encode), [0, 0, 255]);
    // IEC 61966-2-1: 188 is about half the light; the curve begins as a line.
    assert!((srgb::decode(188) - 0.502_886_5).abs() < 1e-6);
    assert!((srgb::decode(1) - 1.0 / 255.0 / 12.92).abs() < 1e-9);
}

#[test]
fn floats_and_integers_keep_their_bits_or_saturate() {
    let values = values();
    check_encode!(values, float32::encode, s, x => float32::encode_lanes(s, x));
    for bits in [2, 8, 10, 16, 32] {
        for level in Level::all_available() {
            for packet in packets(&Vec::from_iter(values.iter().map(|x| x.to_bits()))) {
                #[inline(always)]
                fn run<S: Lanes>(s: S, packet: [u32; LANES], bits: u32) -> [[u32; LANES]; 2] {
                    let value = u32x16::load_array(s, packet);
                    let signed: i32x16<S> = value.bitcast();
                    let signed = integer::encode_sint_lanes(s, signed, bits);
                    let signed: u32x16<S> = signed.bitcast();
                    let unsigned = integer::encode_uint_lanes(s, value, bits);
                    [unsigned.to_array(), signed.to_array()]
                }
                let [unsigned, signed] = dispatch!(level, s => run(s, packet, bits));
                for (lane, value) in packet.into_iter().enumerate() {
                    assert_eq!(unsigned[lane], integer::encode_uint(value, bits));
                    let expected = integer::encode_sint(value.cast_signed(), bits);
                    assert_eq!(signed[lane].cast_signed(), expected);
                }
            }
        }
    }
    assert_eq!(float32::encode(-f32::NAN), 0x7FC0_0000);
    assert_eq!(integer::encode_uint(300, 8), 255);
    assert_eq!(integer::encode_sint(-300, 8), -128);
    assert_eq!(integer::sign_extended(0x80, 8), -128);
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "f64 rounded to the nearest f32"
)]
#[test]
fn depth_is_the_nearest_codes_number() {
    for format in [TextureFormat::Depth16Unorm, TextureFormat::Depth24Plus] {
        let codec = FixedDepth::new(format).expect("a fixed-point depth");
        let most: u32 = if format == TextureFormat::Depth24Plus {
            0xFF_FFFF
        } else {
            0xFFFF
        };
        // Around every boundary between codes at both ends and in the middle, where 24 bits are
        // most critical.
        let mut depths = vec![0.0, -0.0, 1.0, 1.0_f32.next_down(), 0.5];
        let steps = (0..3000).flat_map(|i| [i, most / 4 + i, most / 2 - 1500 + i, most - i]);
        for code in steps.filter(|&code| code < most) {
            let boundary = ((f64::from(code) + 0.5) / f64::from(most)) as f32;
            depths.extend([boundary, boundary.next_down(), boundary.next_up()]);
        }
        depths.extend(spread_bits(20_000).map(|bits| (bits >> 8) as f32 / 16_777_216.0));
        let one = |depth| codec.stored(depth).to_bits();
        for level in Level::all_available() {
            for packet in packets(&depths) {
                #[inline(always)]
                fn run<S: Lanes>(s: S, packet: [f32; LANES], codec: FixedDepth) -> [f32; LANES] {
                    codec
                        .stored_lanes(s, f32x16::load_array(s, packet))
                        .to_array()
                }
                #[inline(always)]
                fn codes<S: Lanes>(s: S, packet: [f32; LANES], codec: FixedDepth) -> [f32; LANES] {
                    let stored = f32x16::load_array(s, packet);
                    codec.rounded_lanes(s, stored).to_array()
                }
                let stored = dispatch!(level, s => run(s, packet, codec));
                let codes = dispatch!(level, s => codes(s, stored, codec));
                let expected = stored.map(|stored| codec.code(stored) as f32);
                assert!(codes == expected, "{level:?} {stored:?}");
                for (depth, stored) in packet.into_iter().zip(stored) {
                    assert_eq!(stored.to_bits(), one(depth), "{level:?} {depth:e}");
                    let stored_again = codec.stored(stored);
                    assert!(same(stored_again, stored), "{depth:e}");
                }
            }
        }
        for code in (0..=most).step_by(97).chain([1, most - 1, most]) {
            let exact = (f64::from(code) / f64::from(most)) as f32;
            assert_eq!(codec.decode(code), exact);
            assert_eq!(codec.stored(exact), exact, "codes survive");
            assert_eq!(codec.code(exact), code, "codes are found again");
        }
    }
    assert_eq!(FixedDepth::new(TextureFormat::Depth32Float), None);
}
