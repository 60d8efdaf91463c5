//! Numbers of vertex attributes.
//!
//! *Spec* WebGPU, Vertex Formats. Integers arrive as bits.

use crate::{half, integer};
use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, outline, u32x16};
use estampe_types::{VertexEncoding, VertexFormat};

/// Reads the numbers of one vertex format.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexCodec {
    format: VertexFormat,
    encoding: VertexEncoding,
    /// Bits of a component; of packed formats their average.
    bits: u32,
}

/// The position of a component in an attribute.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// The word of the attribute, 0 to 3.
    word: usize,
    /// Its lowest bit.
    shift: u32,
    /// Its bits, 2 to 32.
    bits: u32,
}

impl VertexCodec {
    /// The codec of a format.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "an attribute has at most 128 bits"
    )]
    pub fn new(format: VertexFormat) -> Self {
        Self {
            format,
            encoding: format.encoding(),
            bits: (format.size_bytes() * 8 / format.components()) as u32,
        }
    }

    /// Words of 32 bits that hold the first components, at most as many as the format has: 0 to 4.
    #[must_use]
    pub fn words(&self, components: usize) -> usize {
        match components.min(self.format.components()) {
            0 => 0,
            // In packed formats, later components may lie before earlier ones, in the one word.
            count => (0..count).map(|k| self.place(k).word).max().unwrap_or(0) + 1,
        }
    }

    #[inline(always)]
    fn place(&self, component: usize) -> Place {
        let component = component & 3;
        let (first, bits) = match self.format {
            VertexFormat::Unorm10_10_10_2 => {
                ([0, 10, 20, 30][component], [10, 10, 10, 2][component])
            }
            VertexFormat::Unorm8x4Bgra => ([16, 8, 0, 24][component], 8),
            _ => ([0, 1, 2, 3][component] * self.bits, self.bits),
        };
        Place {
            word: first as usize / 32,
            shift: first % 32,
            bits,
        }
    }

    /// A component, below the format's number of them, of the words of one attribute.
    #[must_use]
    pub fn decode(&self, words: [u32; 4], component: usize) -> f32 {
        let Place { word, shift, bits } = self.place(component);
        let code = words[word & 3] >> shift & (u32::MAX >> (32 - bits));
        let signed = integer::sign_extended(code, bits);
        match self.encoding {
            VertexEncoding::Unorm => code as f32 * unorm_unit(bits),
            VertexEncoding::Snorm => {
                let value = signed as f32 * snorm_unit(bits);
                if value > -1.0 { value } else { -1.0 }
            }
            VertexEncoding::Sint => f32::from_bits(signed.cast_unsigned()),
            VertexEncoding::Float if bits == 16 => half::decode(code),
            VertexEncoding::Float | VertexEncoding::Uint => f32::from_bits(code),
        }
    }

    /// [`decode`](Self::decode) of the words of sixteen attributes.
    #[inline(always)]
    pub fn decode_lanes<S: Lanes>(
        &self,
        s: S,
        words: &[u32x16<S>; 4],
        component: usize,
    ) -> f32x16<S> {
        outline!(s, {
            let Place { word, shift, bits } = self.place(component);
            // The code in the highest bits; from there it comes down with or without its sign.
            let unused = 32 - bits;
            let top = words[word & 3] << (unused - shift);
            let signed: i32x16<S> = top.bitcast();
            match self.encoding {
                VertexEncoding::Unorm => {
                    let code: i32x16<S> = (top >> unused).bitcast();
                    f32x16::float_from(code) * unorm_unit(bits)
                }
                VertexEncoding::Snorm => {
                    let least = <f32x16<S> as SimdBase<S>>::splat(s, -1.0);
                    let value = f32x16::float_from(signed >> unused) * snorm_unit(bits);
                    s.max_f32(value, least)
                }
                VertexEncoding::Sint => (signed >> unused).bitcast(),
                VertexEncoding::Float if bits == 16 => half::decode_lanes(s, top >> unused),
                VertexEncoding::Float | VertexEncoding::Uint => (top >> unused).bitcast(),
            }
        })
    }
}

/// 1/(2ⁿ − 1) rounded to f32, for n up to 16.
#[inline(always)]
fn unorm_unit(bits: u32) -> f32 {
    1.0 / (u32::MAX >> (32 - bits)) as f32
}

/// 1/(2ⁿ⁻¹ − 1) rounded to f32, for n up to 16.
#[inline(always)]
fn snorm_unit(bits: u32) -> f32 {
    1.0 / (u32::MAX >> (32 - bits) >> 1) as f32
}
