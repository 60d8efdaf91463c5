//! Encoding, decoding, clearing and resolving of the four channels of a colour attachment's texel.
//!
//! In · Out: codes R, G, B, A · numbers. Each [`Channel`](crate::channel::Channel) is converted
//! separately. Spec: NUMERICS.md, *Formats*.

use crate::channel::channels;
use estampe_types::TextureFormat;

/// 1/255, rounded to f32: the factor of 8-bit unorm codes.
pub const INVERSE_255: f32 = 1.0 / 255.0;

/// The codes (encoded values) of a texel's R, G, B and A; 0 for a channel that the format lacks.
pub type Codes = [u32; 4];

/// Decodes stored codes; sRGB becomes linear.
#[must_use]
pub fn decode(format: TextureFormat, codes: Codes) -> [f32; 4] {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].decode(codes[index]))
}

/// Encodes a linear colour. For integer formats the f32 hold integers as bits.
#[must_use]
pub fn encode(format: TextureFormat, color: [f32; 4]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].encode(color[index]))
}

/// The codes that a clear to `color` stores.
#[must_use]
pub fn clear_codes(format: TextureFormat, color: [f64; 4]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].clear_code(color[index]))
}

/// The resolved codes of one pixel's samples: their mean, channel by channel.
#[must_use]
pub fn resolve(format: TextureFormat, samples: &[Codes]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].resolve(samples.iter().map(|codes| codes[index])))
}

/// A texel's bytes in memory: the channels are packed from the lowest bit of the lowest byte on.
#[must_use]
pub fn bytes(format: TextureFormat, [r, g, b, a]: Codes) -> Vec<u8> {
    let channels = channels(format);
    let in_order = if format.is_bgra() {
        [b, g, r, a]
    } else {
        [r, g, b, a]
    };
    let mut texel = 0_u128;
    let mut shift = 0;
    // All channels of `Bgra` formats have 8 bits, so swapping R and B moves no boundary.
    for (channel, code) in channels.iter().zip(in_order) {
        texel |= u128::from(code) << shift;
        shift += channel.bits();
    }
    texel.to_le_bytes()[..format.block_bytes() as usize].to_vec()
}

/// The codes of a texel's bytes: the inverse of [`bytes`].
#[must_use]
pub fn codes(format: TextureFormat, texel: &[u8]) -> Codes {
    let mut sixteen = [0; 16];
    sixteen[..texel.len()].copy_from_slice(texel);
    let mut left = u128::from_le_bytes(sixteen);
    let in_order = channels(format).map(|channel| {
        let field = left & ((1 << channel.bits()) - 1);
        left >>= channel.bits();
        u32::try_from(field).expect("at most 32 bits")
    });
    let [first, g, third, a] = in_order;
    if format.is_bgra() {
        [third, g, first, a]
    } else {
        [first, g, third, a]
    }
}
