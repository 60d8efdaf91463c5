//! Encoded texels of every format: their values by the specifications, and that encoding restores
//! them.

use estampe_format::TexelCodec;
use estampe_texture::{
    AddressMode, BorderColor, Coordinates, Limits, MipGeneration, SampledTexture,
    SamplerDescriptor, TexelDescriptor, TexelView,
};
use estampe_types::{SampleType, TexelEncoding, TextureAspect, TextureFormat as F, Vec2};

fn decode(format: F, word: u32) -> [f32; 4] {
    TexelCodec::new(format).decode(&[word, 0, 0, 0])
}

fn encode(format: F, value: [f32; 4]) -> [u32; 4] {
    TexelCodec::new(format).encode(value)
}

/// Rows: F2.
#[test]
fn numbers_of_the_specifications() {
    let tiny = 2.0_f32.powi(-24);
    for (format, word, wanted) in [
        (F::R8Unorm, 255, [1.0, 0.0, 0.0, 1.0]),
        (F::Rg8Snorm, 0x81_80, [-1.0, -1.0, 0.0, 1.0]),
        (F::Rg8Snorm, 0x7F_00, [0.0, 1.0, 0.0, 1.0]),
        (F::Rg16Snorm, 0x8000_7FFF, [1.0, -1.0, 0.0, 1.0]),
        (F::Rg16Unorm, 0xFFFF_0000, [0.0, 1.0, 0.0, 1.0]),
        (F::Rgb10a2Unorm, 0xFFFF_FFFF, [1.0; 4]),
        (F::Rgb10a2Unorm, 0x4000_03FF, [1.0, 0.0, 0.0, 1.0 / 3.0]),
        (F::Rg16Float, 0xC000_3C00, [1.0, -2.0, 0.0, 1.0]),
        (F::R16Float, 0x0001, [tiny, 0.0, 0.0, 1.0]),
        (F::R16Float, 0x7BFF, [65504.0, 0.0, 0.0, 1.0]),
        (F::R16Float, 0x7C00, [f32::INFINITY, 0.0, 0.0, 1.0]),
        // 1, 1 and 1; the greatest finite numbers.
        (
            F::Rg11b10Ufloat,
            0x3C0 | 0x3C0 << 11 | 0x1E0 << 22,
            [1.0; 4],
        ),
        (
            F::Rg11b10Ufloat,
            0x7BF | 0x7BF << 11 | 0x3DF << 22,
            [65024.0, 65024.0, 64512.0, 1.0],
        ),
        // 256·2^(16 − 24) and the greatest number.
        (F::Rgb9e5Ufloat, 256 | 16 << 27, [1.0, 0.0, 0.0, 1.0]),
        (
            F::Rgb9e5Ufloat,
            511 << 9 | 31 << 27,
            [0.0, 65408.0, 0.0, 1.0],
        ),
        (F::Depth16Unorm, 0xFFFF, [1.0, 0.0, 0.0, 1.0]),
        (F::Depth24Plus, 0xAAFF_FFFF, [1.0, 0.0, 0.0, 1.0]),
    ] {
        assert_eq!(decode(format, word), wanted, "{format:?} {word:#x}");
    }
    let bits = |format, word| decode(format, word).map(f32::to_bits);
    let minus = u32::MAX;
    assert_eq!(bits(F::Rg8Uint, 0x80FF), [255, 128, 0, 1]);
    assert_eq!(bits(F::Rg8Sint, 0x01FF), [minus, 1, 0, 1]);
    assert_eq!(bits(F::R16Sint, 0x8000), [0xFFFF_8000, 0, 0, 1]);
    assert_eq!(bits(F::R32Uint, 0x7FA0_0001), [0x7FA0_0001, 0, 0, 1]);
    assert_eq!(bits(F::Rgb10a2Uint, 0xC010_0403), [3, 1, 1, 3]);
    assert_eq!(bits(F::Stencil8, 0x1FE), [0xFE, 0, 0, 1]);
    let stencil = TexelCodec::of_aspect(F::Depth24PlusStencil8, TextureAspect::Stencil);
    assert_eq!(stencil.units(&[0xAB00_0001])[0].to_bits(), 0xAB);
    let stencil = TexelCodec::of_aspect(F::Depth32FloatStencil8, TextureAspect::Stencil);
    assert_eq!(
        stencil.units(&[0x3F80_0000, 0xFFFF_FF12])[0].to_bits(),
        0x12
    );
}

/// Rows: F2.
#[test]
fn every_code_decodes_to_a_number_that_encodes_to_it() {
    use TexelEncoding as E;
    for &format in F::ALL {
        if format.is_compressed() || !format.is_color() || format.is_bgra() {
            continue;
        }
        let codec = TexelCodec::new(format);
        let mask: u32 = match format.block_bytes() {
            1 => 0xFF,
            2 => 0xFFFF,
            _ => u32::MAX,
        };
        // All 16-bit patterns in both halves, and spread over the word.
        for code in 0..1_u32 << 16 {
            for word in [code | code << 16, code.wrapping_mul(0x9E37_79B1)] {
                let words = [word & mask, word, !word, word.rotate_left(7)];
                let words = &words[..codec.words()];
                let value = codec.decode(words);
                if codec.sample_type() == SampleType::Float && value.iter().any(|x| x.is_nan()) {
                    continue;
                }
                let again = codec.encode(value);
                let same_number = codec.decode(&again);
                assert_eq!(
                    same_number.map(f32::to_bits),
                    value.map(f32::to_bits),
                    "{format:?} {words:x?}"
                );
                // Two encoded snorm values mean −1, and a number has several shared exponents.
                if !matches!(
                    format.encoding(),
                    E::Snorm8 | E::Snorm16 | E::SharedExponent
                ) {
                    assert_eq!(&again[..codec.words()], words, "{format:?}");
                }
            }
        }
    }
}

#[test]
fn numbers_between_codes_go_to_the_nearest() {
    let ulp = 2.0_f32.powi(-10);
    for (x, code) in [
        (1.0 + ulp * 0.5, 0x3C00),
        (1.0 + ulp * 1.5, 0x3C02),
        (1.0 + ulp * 0.500_1, 0x3C01),
        (65519.9, 0x7BFF),
        (65520.0, 0x7C00),
        (-1e30, 0xFC00),
        (-0.0, 0x8000),
        (2.0_f32.powi(-25), 0),
        (2.0_f32.powi(-25) * 1.001, 1),
        (2.0_f32.powi(-14) - 2.0_f32.powi(-26), 0x0400),
        (f32::NAN, 0x7E00),
        (1e-40, 0),
    ] {
        assert_eq!(encode(F::R16Float, [x; 4])[0], code, "{x}");
    }
    let rgb = |x| encode(F::Rg11b10Ufloat, [x; 4])[0];
    let all = |a: u32, b: u32| a | a << 11 | b << 22;
    assert_eq!(rgb(-1.0), 0);
    assert_eq!(rgb(1e9), all(0x7BF, 0x3DF));
    assert_eq!(rgb(f32::INFINITY), all(0x7C0, 0x3E0));
    assert_eq!(rgb(f32::NAN), all(0x7E0, 0x3F0));
    assert_eq!(
        encode(F::Rgb9e5Ufloat, [f32::NAN, -1.0, 1e9, 0.0])[0],
        511 << 18 | 31 << 27
    );
    // 511.75 rounds up to 512, which takes the next exponent.
    let beyond = 511.75 / 512.0;
    assert_eq!(encode(F::Rgb9e5Ufloat, [beyond; 4])[0] >> 27, 16);
    let int = |x: i32| f32::from_bits(x.cast_unsigned());
    assert_eq!(
        encode(F::Rg8Sint, [int(-300), int(300), 0.0, 0.0])[0],
        0x7F80
    );
    assert_eq!(encode(F::Rg8Uint, [int(-1), int(7), 0.0, 0.0])[0], 0x07FF);
    assert_eq!(encode(F::Rg8Snorm, [f32::NAN, -7.0, 0.0, 0.0])[0], 0x8100);
}

/// One is one in units times the factor, for borders and the greatest codes.
#[test]
fn borders_are_exact() {
    for &format in F::ALL {
        if format.is_compressed() || format.is_bgra() {
            continue;
        }
        let limits = Limits::default();
        let texture = TexelDescriptor::new_2d(1, 1, format)
            .create(&[], MipGeneration::None, &limits)
            .expect("every format has 2D textures");
        let view = TexelView::of(texture).expect("it has a level");
        let sampler = SamplerDescriptor {
            address_mode_u: AddressMode::ClampToBorder,
            border_color: BorderColor::OpaqueWhite,
            ..SamplerDescriptor::default()
        };
        let sampled = SampledTexture::new(view, sampler).expect("the sampler fits");
        let codec = TexelCodec::new(format);
        let one = if codec.is_integer() {
            f32::from_bits(1)
        } else {
            1.0
        };
        let wanted = [0, 1, 2, 3].map(|k| {
            if k < format.components() || k == 3 {
                one
            } else {
                0.0
            }
        });
        let found = sampled.sample(Coordinates::d2(Vec2::new(5.0, 0.5)));
        assert_eq!(crate::array(found), wanted, "{format:?}");
    }
}
