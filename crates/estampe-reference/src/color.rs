//! Colours: the codes of an attachment's texels, and the numbers that they stand for.
//!
//! In · Out: codes R, G, B, A · numbers. Each [`Channel`](crate::channel::Channel) alone. Spec: NUMERICS.md, *Formats*.

use crate::channel::channels;
use estampe_types::TextureFormat;

/// 1/255, rounded to f32: what codes of 8 bits are multiplied by.
pub const INVERSE_255: f32 = 1.0 / 255.0;

/// The codes of a texel's R, G, B and A; 0 for a channel that the format lacks.
pub type Codes = [u32; 4];

/// The numbers of stored codes.
#[must_use]
pub fn decode(format: TextureFormat, codes: Codes) -> [f32; 4] {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].decode(codes[index]))
}

/// The codes that store numbers; for integer formats their bits.
#[must_use]
pub fn encode(format: TextureFormat, color: [f32; 4]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].encode(color[index]))
}

/// The codes that a clear stores.
#[must_use]
pub fn clear_codes(format: TextureFormat, color: [f64; 4]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].clear_code(color[index]))
}

/// The codes that stand for the samples of one pixel: their mean.
#[must_use]
pub fn resolve(format: TextureFormat, samples: &[Codes]) -> Codes {
    let channels = channels(format);
    std::array::from_fn(|index| channels[index].resolve(samples.iter().map(|codes| codes[index])))
}

/// A texel's bytes: the channels from the lowest bit of the lowest byte on.
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
    // In `Bgra` formats all channels have 8 bits.
    for (channel, code) in channels.iter().zip(in_order) {
        texel |= u128::from(code) << shift;
        shift += channel.bits();
    }
    texel.to_le_bytes()[..format.block_bytes() as usize].to_vec()
}
