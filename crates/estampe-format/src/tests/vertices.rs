//! Vertex formats against numbers of the specification, and sixteen against one.

use super::{packets, spread_bits};
use crate::vertex::VertexCodec;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, u32x16};
use estampe_types::VertexFormat;

#[test]
fn numbers_of_the_specification() {
    use VertexFormat as F;
    let decode = |format, words, component| VertexCodec::new(format).decode(words, component);
    assert_eq!(decode(F::Unorm8x4, [0xFF00_0000, 0, 0, 0], 3), 1.0);
    assert_eq!(decode(F::Unorm8x4Bgra, [0x0000_00FF, 0, 0, 0], 2), 1.0);
    assert_eq!(decode(F::Unorm8x4Bgra, [0x00FF_0000, 0, 0, 0], 0), 1.0);
    assert_eq!(decode(F::Snorm8x2, [0x807F, 0, 0, 0], 0), 1.0);
    assert_eq!(decode(F::Snorm8x2, [0x807F, 0, 0, 0], 1), -1.0);
    assert_eq!(decode(F::Snorm16x4, [0, 0x8001_0000, 0, 0], 3), -1.0);
    assert_eq!(decode(F::Unorm10_10_10_2, [0xC000_0000, 0, 0, 0], 3), 1.0);
    assert_eq!(decode(F::Unorm10_10_10_2, [0x3FF << 10, 0, 0, 0], 1), 1.0);
    assert_eq!(decode(F::Float16x4, [0, 0xC000_0000, 0, 0], 3), -2.0);
    assert_eq!(decode(F::Float32x3, [0, 0, 0x3F80_0000, 0], 2), 1.0);
    assert_eq!(
        decode(F::Uint8x4, [0x00FE_0000, 0, 0, 0], 2).to_bits(),
        0xFE
    );
    let minus = (-2_i32).cast_unsigned();
    assert_eq!(
        decode(F::Sint16x2, [0xFFFE_0000, 0, 0, 0], 1).to_bits(),
        minus
    );
    assert_eq!(decode(F::Sint32x2, [0, minus, 0, 0], 1).to_bits(), minus);
}

#[test]
fn components_lie_in_the_words_before_them() {
    use VertexFormat as F;
    for (format, words) in [
        (F::Float32x3, [0, 1, 2, 3, 3]),
        (F::Float16x4, [0, 1, 1, 2, 2]),
        (F::Unorm8x4Bgra, [0, 1, 1, 1, 1]),
        (F::Unorm10_10_10_2, [0, 1, 1, 1, 1]),
        (F::Snorm8x2, [0, 1, 1, 1, 1]),
    ] {
        let codec = VertexCodec::new(format);
        assert_eq!(
            [0, 1, 2, 3, 4].map(|count| codec.words(count)),
            words,
            "{format:?}"
        );
    }
}

#[inline(never)]
fn decoded(level: Level, codec: VertexCodec, words: [[u32; LANES]; 4]) -> [[f32; LANES]; 4] {
    #[inline(always)]
    fn run<S: Lanes>(s: S, codec: VertexCodec, words: [[u32; LANES]; 4]) -> [[f32; LANES]; 4] {
        let words = words.map(|word| u32x16::load_array(s, word));
        [0, 1, 2, 3].map(|component| codec.decode_lanes(s, &words, component).to_array())
    }
    dispatch!(level, s => run(s, codec, words))
}

#[test]
fn sixteen_attributes_are_decoded_like_one() {
    let halves = (0..=0xFFFF_u32).map(|code| code << 16 | code);
    let words = Vec::from_iter(halves.chain(spread_bits(4096)));
    for &format in VertexFormat::ALL {
        let codec = VertexCodec::new(format);
        for level in Level::all_available() {
            for packet in packets(&words) {
                let mut words = [packet; 4];
                for (k, word) in words.iter_mut().enumerate() {
                    word.rotate_left(k);
                }
                let numbers = decoded(level, codec, words);
                for (component, numbers) in numbers.iter().enumerate().take(format.components()) {
                    for (lane, number) in numbers.iter().enumerate() {
                        let one = codec.decode(words.map(|word| word[lane]), component);
                        assert_eq!(number.to_bits(), one.to_bits(), "{format:?} {level:?}");
                    }
                }
            }
        }
    }
}
