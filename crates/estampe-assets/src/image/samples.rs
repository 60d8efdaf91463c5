//! Images that the tests of all formats share.

use estampe_scene::Image;

/// An image of noise with runs, in which at least every `opaque_in`-th texel is opaque.
pub(super) fn noise(width: u32, height: u32, seed: u64) -> Image {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut rgba = Vec::new();
    let mut texel = [0; 4];
    while rgba.len() < (width * height * 4) as usize {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        if state & 0b11_0000 != 0 {
            texel = (state >> 8).to_le_bytes()[..4]
                .try_into()
                .expect("four bytes");
        }
        rgba.extend_from_slice(&texel);
    }
    Image {
        width,
        height,
        rgba,
    }
}

/// The image with alpha 255.
pub(super) fn opaque(mut image: Image) -> Image {
    for texel in image.rgba.as_chunks_mut::<4>().0 {
        texel[3] = 255;
    }
    image
}

/// A smooth disc on a plain background: similar to a rendered image for a compressor.
pub(super) fn disc(width: u32, height: u32) -> Image {
    let mut image = Image::filled(width, height, [0xf2, 0xf2, 0xf2, 255]);
    let (rx, ry) = (width as f32 / 2.0, height as f32 / 2.0);
    for (i, texel) in image.rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let x = ((i as u32 % width) as f32 + 0.5 - rx) / rx;
        let y = ((i as u32 / width) as f32 + 0.5 - ry) / ry;
        let z2 = 0.8 - x * x - y * y;
        if z2 > 0.0 {
            let lit = (0.5 * z2.sqrt() + 0.3 * x - 0.2 * y + 0.3).clamp(0.0, 1.0) * 255.0;
            *texel = [lit as u8, (lit * 0.9) as u8, (lit * 0.7) as u8, 255];
        }
    }
    image
}

/// A generator of random numbers that are the same on every machine.
#[derive(Debug)]
pub(super) struct Random(fastrand::Rng);

impl Random {
    /// Random numbers from a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// The next number.
    pub(super) fn next(&mut self) -> u64 {
        self.0.u64(..)
    }

    /// A number below `end`.
    pub(super) fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end)
    }

    /// `bytes` with one to eight positions changed, cut off, or doubled.
    pub(super) fn mutated(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(8) {
            if bytes.is_empty() {
                return bytes;
            }
            let at = self.below(bytes.len());
            match self.below(8) {
                0 => bytes.truncate(at),
                1 => bytes.insert(at, self.next() as u8),
                2 => {
                    let end = (at + 1 + self.below(16)).min(bytes.len());
                    let piece = bytes[at..end].to_vec();
                    bytes.splice(at..at, piece);
                }
                3 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][self.below(5)],
                4 => bytes[at] ^= 1 << self.below(8),
                // Changes near the start, where sizes and types are.
                5 => bytes[at % 32.min(at + 1)] = self.next() as u8,
                _ => bytes[at] = self.next() as u8,
            }
        }
        bytes
    }
}
