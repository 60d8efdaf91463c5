//! Codecs of attachments against the codec of one texel, for every renderable format.

use super::{packets, same, spread_bits, values};
use crate::{AttachmentCodec, PacketCodec, TexelCodec, with_codec};
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::TextureFormat;

type Words = [[u32; LANES]; 4];
type Numbers = [[f32; LANES]; 4];

fn renderable() -> impl Iterator<Item = TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    all.filter(|format| format.is_renderable())
}

#[inline(always)]
fn load_words<S: Lanes>(s: S, words: Words) -> [u32x16<S>; 4] {
    words.map(|word| u32x16::load_array(s, word))
}

#[inline(always)]
fn load_numbers<S: Lanes>(s: S, numbers: Numbers) -> [f32x16<S>; 4] {
    numbers.map(|number| f32x16::load_array(s, number))
}

#[inline(always)]
fn encode<S: Lanes, C: PacketCodec<S>>(s: S, codec: C, color: Numbers) -> Words {
    codec
        .encode(s, load_numbers(s, color))
        .map(|word| word.to_array())
}

#[inline(always)]
fn encode_units<S: Lanes, C: PacketCodec<S>>(s: S, codec: C, means: Numbers) -> Words {
    codec
        .encode_units(s, load_numbers(s, means))
        .map(|word| word.to_array())
}

#[inline(always)]
fn decode<S: Lanes, C: PacketCodec<S>>(s: S, codec: C, words: Words) -> [Numbers; 2] {
    let words = load_words(s, words);
    let numbers = codec.decode(s, words).map(|number| number.to_array());
    [
        numbers,
        codec.units(s, words).map(|number| number.to_array()),
    ]
}

#[inline(always)]
fn words_of<S: Lanes, C: PacketCodec<S>>(_: S, _: C) -> usize {
    C::WORDS
}

// Each operation is entered in one place, because each entry is compiled for ten codecs at every
// level.

#[inline(never)]
fn encoded(level: Level, codec: AttachmentCodec, color: Numbers) -> Words {
    dispatch!(level, s => with_codec!(codec, c => encode(s, c, color)))
}

#[inline(never)]
fn encoded_units(level: Level, codec: AttachmentCodec, means: Numbers) -> Words {
    dispatch!(level, s => with_codec!(codec, c => encode_units(s, c, means)))
}

/// Numbers and units.
#[inline(never)]
fn decoded(level: Level, codec: AttachmentCodec, words: Words) -> [Numbers; 2] {
    dispatch!(level, s => with_codec!(codec, c => decode(s, c, words)))
}

/// Lane `lane` of four arrays.
fn lane_of<T: Copy>(channels: [[T; LANES]; 4], lane: usize) -> [T; 4] {
    channels.map(|channel| channel[lane])
}

#[test]
fn sixteen_colors_are_encoded_like_one() {
    let values = values();
    for format in renderable() {
        let (codec, one) = (AttachmentCodec::new(format), TexelCodec::new(format));
        for level in Level::all_available() {
            let words = dispatch!(level, s => with_codec!(codec, c => words_of(s, c)));
            assert_eq!(words, codec.words());
            assert_eq!(words, one.words());
            for packet in packets(&values) {
                // Other values in each channel.
                let mut color = [packet; 4];
                for (channel, lanes) in color.iter_mut().enumerate() {
                    lanes.rotate_left(channel * 3);
                }
                let words = encoded(level, codec, color);
                for lane in 0..LANES {
                    let value = lane_of(color, lane);
                    let name = format.name();
                    assert_eq!(
                        lane_of(words, lane),
                        one.encode(value),
                        "{name} {level:?} {value:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn sixteen_texels_are_decoded_like_one() {
    // Every code of 16 bits or fewer in every channel, and words of any bits.
    let repeated = (0..=0xFFFF_u32).map(|code| code << 16 | code);
    let words = Vec::from_iter(repeated.chain(spread_bits(1 << 16)));
    for format in renderable() {
        let (codec, one) = (AttachmentCodec::new(format), TexelCodec::new(format));
        let mut used = [0; 4];
        for channel in 0..4 {
            for (used, bits) in used.iter_mut().zip(codec.channel_bits(channel)) {
                assert_eq!(*used & bits, 0, "channels do not overlap");
                *used |= bits;
            }
        }
        for level in Level::all_available() {
            for packet in packets(&words) {
                let mut texels = [packet; 4];
                for (word, (lanes, used)) in texels.iter_mut().zip(used).enumerate() {
                    lanes.rotate_left(word);
                    *lanes = lanes.map(|lane| lane & used);
                }
                let [numbers, units] = decoded(level, codec, texels);
                for lane in 0..LANES {
                    let texel = lane_of(texels, lane);
                    let expected = [one.decode(&texel), one.units(&texel)];
                    let got = [lane_of(numbers, lane), lane_of(units, lane)];
                    let is_same = got.as_flattened().iter().zip(expected.as_flattened());
                    assert!(
                        is_same.into_iter().all(|(a, b)| same(*a, *b)),
                        "{} {level:?} {texel:x?}: {got:?}, not {expected:?}",
                        format.name()
                    );
                }
            }
        }
    }
}

#[test]
fn every_texel_is_encoded_again_as_it_was() {
    let words = Vec::from_iter(spread_bits(1 << 16));
    for format in renderable() {
        let (codec, one) = (AttachmentCodec::new(format), TexelCodec::new(format));
        let level = Level::best();
        for packet in packets(&words) {
            // Encoding makes all NaNs one, and of two codes for −1 the greater.
            let texels = packet.map(|bits| {
                let bits = [
                    bits,
                    bits.rotate_left(7),
                    bits.rotate_left(13),
                    bits.rotate_left(22),
                ];
                one.encode(one.decode(&bits))
            });
            let texels: Words = std::array::from_fn(|word| texels.map(|texel| texel[word]));
            let [numbers, units] = decoded(level, codec, texels);
            let again = encoded(level, codec, numbers);
            assert_eq!(again, texels, "{}", format.name());
            let again = encoded_units(level, codec, units);
            assert_eq!(again, texels, "units of {}", format.name());
        }
    }
}

#[test]
fn means_are_rounded_to_the_nearest_code() {
    let means = |value: f32| [[value; LANES]; 4];
    for level in Level::all_available() {
        for (format, mean, expected) in [
            (TextureFormat::Rgba8Unorm, 1.5, 0x0202_0202),
            (TextureFormat::Bgra8Unorm, 1.25, 0x0101_0101),
            (TextureFormat::R8Unorm, 254.5, 0xFF),
            (TextureFormat::Rg16Unorm, 65_534.5, 0xFFFF_FFFF),
            (TextureFormat::Rgba8Snorm, -1.5, 0xFEFE_FEFE),
            (TextureFormat::Rgba8Snorm, -0.5, 0),
            (TextureFormat::Rgba8Snorm, -1.75, 0xFEFE_FEFE),
            (TextureFormat::R16Snorm, -32_766.5, 0x8002),
            (TextureFormat::R16Snorm, -32_765.5, 0x8002),
        ] {
            let codec = AttachmentCodec::new(format);
            let words = encoded_units(level, codec, means(mean));
            assert_eq!(words[0], [expected; LANES], "{} {mean}", format.name());
        }
    }
}

#[test]
fn clear_values_are_truncated_and_confined() {
    let words = |format: TextureFormat, rgba| AttachmentCodec::new(format).clear_words(rgba);
    let rgba = [1.9, -300.5, 300.5, f64::NAN];
    assert_eq!(
        words(TextureFormat::Rgba8Uint, rgba),
        [0x00FF_0001, 0, 0, 0]
    );
    assert_eq!(
        words(TextureFormat::Rgba8Sint, rgba),
        [0x007F_8001, 0, 0, 0]
    );
    assert_eq!(
        words(TextureFormat::R32Uint, [1e20; 4]),
        [u32::MAX, 0, 0, 0]
    );
    assert_eq!(
        words(TextureFormat::R32Sint, [-1e20; 4]),
        [0x8000_0000, 0, 0, 0]
    );
    assert_eq!(
        words(TextureFormat::Bgra8Unorm, [1.0, 0.0, 0.5, 0.0]),
        [0x00FF_0080, 0, 0, 0]
    );
    assert_eq!(
        words(TextureFormat::Rg32Float, [0.1, -0.0, 0.0, 0.0]),
        [0.1_f32.to_bits(), 0x8000_0000, 0, 0]
    );
}

#[test]
fn formats_say_what_operations_they_have() {
    use TextureFormat as F;
    let codec = AttachmentCodec::new;
    assert_eq!(codec(F::Bgra8UnormSrgb).range(), Some([0.0, 1.0]));
    assert_eq!(codec(F::Rg16Snorm).range(), Some([-1.0, 1.0]));
    assert_eq!(codec(F::Rgba16Float).range(), None);
    for (format, is_logical) in [
        (F::Rgba8Unorm, true),
        (F::Rgba8UnormSrgb, false),
        (F::R16Snorm, true),
        (F::Rg32Uint, true),
        (F::R16Float, false),
        (F::R32Float, false),
        (F::Rg11b10Ufloat, false),
    ] {
        assert_eq!(codec(format).has_logic_operations(), is_logical);
    }
    assert!(codec(F::Rgb10a2Uint).is_integer() && !codec(F::Rgb10a2Unorm).is_integer());
    assert_eq!(codec(F::Bgra8Unorm).channel_bits(0), [0x00FF_0000, 0, 0, 0]);
    assert_eq!(
        codec(F::Rgb10a2Unorm).channel_bits(3),
        [0xC000_0000, 0, 0, 0]
    );
    assert_eq!(
        codec(F::Rgba16Float).channel_bits(3),
        [0, 0xFFFF_0000, 0, 0]
    );
    assert_eq!(codec(F::Rgba32Sint).channel_bits(2), [0, 0, u32::MAX, 0]);
    assert_eq!(codec(F::R8Unorm).channel_bits(1), [0; 4]);
    assert_eq!(
        codec(F::Rg11b10Ufloat).channel_bits(2),
        [0xFFC0_0000, 0, 0, 0]
    );
}

#[test]
#[should_panic(expected = "not renderable")]
fn other_formats_have_no_attachments() {
    let _ = AttachmentCodec::new(TextureFormat::Rgb9e5Ufloat);
}
