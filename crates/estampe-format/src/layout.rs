//! The layout of a texel's channels: words of 32 bits, counted from the lowest bit of the lowest
//! byte.

use estampe_types::{TexelEncoding, TextureFormat};

/// The bits of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct ChannelPlace {
    /// The word, 0..4.
    pub(crate) word: usize,
    /// The lowest bit in the word.
    pub(crate) shift: u32,
    /// The number of bits, 1..=32; 0 for a channel that the format lacks.
    pub(crate) bits: u32,
}

impl ChannelPlace {
    const fn new(word: usize, shift: u32, bits: u32) -> Self {
        Self { word, shift, bits }
    }

    /// The channel's bits in its word.
    pub(crate) const fn mask(self) -> u32 {
        match self.bits {
            0 => 0,
            bits => u32::MAX >> (32 - bits) << self.shift,
        }
    }

    /// Reads the channel from a texel's words.
    #[inline(always)]
    pub(crate) fn read(self, words: [u32; 4]) -> u32 {
        (words[self.word & 3] & self.mask()) >> self.shift
    }

    /// Writes the low bits of a code into words in which the channel's bits are 0.
    #[inline(always)]
    pub(crate) fn write(self, words: &mut [u32; 4], code: u32) {
        words[self.word & 3] |= (code << self.shift) & self.mask();
    }
}

/// The places of R, G, B and A: of depth formats, the depth as the first channel. The mantissas of
/// a shared exponent are channels of 9 bits; compressed formats have none.
pub(crate) fn channels(format: TextureFormat) -> [ChannelPlace; 4] {
    use TexelEncoding as E;
    let mut places = [ChannelPlace::default(); 4];
    for (channel, place) in places.iter_mut().enumerate().take(format.components()) {
        let bits = match format.encoding() {
            E::Unorm8 | E::Snorm8 | E::Uint8 | E::Sint8 | E::Stencil => 8,
            E::Unorm16 | E::Snorm16 | E::Uint16 | E::Sint16 | E::Float16 | E::Depth16 => 16,
            E::Uint32 | E::Sint32 | E::Float32 | E::Depth32 => 32,
            E::Depth24 => 24,
            E::Unorm10_2 | E::Uint10_2 => [10, 10, 10, 2][channel],
            E::Ufloat11_10 => [11, 11, 10, 0][channel],
            E::SharedExponent => 9,
            _ => 0,
        };
        let first = match format.encoding() {
            E::Unorm10_2 | E::Uint10_2 => [0, 10, 20, 30][channel],
            E::Ufloat11_10 => [0, 11, 22, 32][channel],
            // B, G, R, A.
            _ if format.is_bgra() => [16, 8, 0, 24][channel],
            _ => [0, 1, 2, 3][channel] * bits,
        };
        *place = ChannelPlace::new(first as usize / 32, first % 32, bits);
    }
    places
}

/// The place of the stencil value of a format that has one.
pub(crate) fn stencil(format: TextureFormat) -> ChannelPlace {
    match format.encoding() {
        TexelEncoding::Depth24 => ChannelPlace::new(0, 24, 8),
        TexelEncoding::Depth32 => ChannelPlace::new(1, 0, 8),
        _ => ChannelPlace::new(0, 0, 8),
    }
}

/// Words of 32 bits of a texel; one that is smaller takes a word, in its low bits.
pub(crate) const fn words(format: TextureFormat) -> usize {
    format.block_bytes().div_ceil(4) as usize
}
