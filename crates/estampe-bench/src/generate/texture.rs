//! Square tileable textures with their mip levels.

use super::noise::fractal_noise;
use super::normalize;

/// The levels of a square texture of 8-bit channels, RGBA unless said otherwise.
#[derive(Debug, Clone)]
pub struct MipChain {
    /// The first level's side in texels, a power of two.
    pub size: u32,
    /// The texels of each level, row by row, and layer after layer.
    pub levels: Vec<Vec<u8>>,
}

/// Two colours in squares, 16 per side, darkened by noise. `size` is a power of two, at least 256.
#[must_use]
pub fn diffuse_texture(size: u32, seed: u32) -> MipChain {
    const EVEN: [u32; 3] = [255, 208, 144];
    const ODD: [u32; 3] = [112, 160, 240];
    let square = size / 16;
    MipChain::below(size, |x, y| {
        let brightness = 64 + fractal_noise(x, y, size, seed) * 191 / 255;
        let is_even = (x / square + y / square).is_multiple_of(2);
        let tint = if is_even { EVEN } else { ODD };
        let [red, green, blue] = tint.map(|channel| byte(channel * brightness / 255));
        [red, green, blue, 255]
    })
}

/// Tangent-space normals of the same noise as a height field: (−8∂x, −8∂y, 64) normalised, where ∂
/// is the difference of a texel's neighbours; stored as ⌊n·127.5 + 128⌋.
#[must_use]
pub fn normal_texture(size: u32, seed: u32) -> MipChain {
    let mut heights = Vec::with_capacity((size * size) as usize);
    for y in 0..size {
        heights.extend((0..size).map(|x| f64::from(fractal_noise(x, y, size, seed))));
    }
    let height = |x: u32, y: u32| heights[(y % size * size + x % size) as usize];
    MipChain::below(size, |x, y| {
        let slope_x = height(x + 1, y) - height(x + size - 1, y);
        let slope_y = height(x, y + 1) - height(x, y + size - 1);
        let normal = normalize([-slope_x * 8.0, -slope_y * 8.0, 64.0]);
        let [x, y, z] = normal.map(|component| {
            let code = (component * 127.5 + 128.0).floor().min(255.0);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number in 0..=255"
            )]
            let code = code as u8;
            code
        });
        [x, y, z, 255]
    })
}

impl MipChain {
    /// All mip levels: the first from a function of the texel, the others by halving.
    pub(crate) fn below(size: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Self {
        let mut first = Vec::with_capacity((size * size * 4) as usize);
        for y in 0..size {
            for x in 0..size {
                first.extend(texel(x, y));
            }
        }
        Self::halving(size, 4, first)
    }

    /// All mip levels of texels with so many channels, down to 1×1, by halving the first.
    pub(crate) fn halving(size: u32, channels: usize, first: Vec<u8>) -> Self {
        let mut levels = vec![first];
        let mut side = size as usize;
        while side > 1 {
            levels.push(halved(&levels[levels.len() - 1], side, channels));
            side /= 2;
        }
        Self { size, levels }
    }

    /// A texture with these layers, all of the same size.
    pub(crate) fn of_layers(layers: &[Self]) -> Self {
        let level = |number: usize| {
            let layers = layers.iter();
            layers.flat_map(move |layer| layer.levels[number].iter().copied())
        };
        let count = layers[0].levels.len();
        Self {
            size: layers[0].size,
            levels: (0..count).map(|number| level(number).collect()).collect(),
        }
    }
}

/// The next mip level of one with this side: each texel is the mean of four, rounded half up.
fn halved(texels: &[u8], side: usize, channels: usize) -> Vec<u8> {
    let mut below = Vec::with_capacity(texels.len() / 4);
    for rows in texels.chunks_exact(side * channels * 2) {
        let (upper, lower) = rows.split_at(side * channels);
        let pairs = (upper.chunks_exact(channels * 2)).zip(lower.chunks_exact(channels * 2));
        for (top, bottom) in pairs {
            for channel in 0..channels {
                let sum = [
                    top[channel],
                    top[channel + channels],
                    bottom[channel],
                    bottom[channel + channels],
                ]
                .map(u32::from)
                .iter()
                .sum::<u32>();
                below.push(byte((sum + 2) / 4));
            }
        }
    }
    below
}

/// A number of at most 255 as a byte.
fn byte(value: u32) -> u8 {
    u8::try_from(value).expect("the mean or a share of bytes is a byte")
}
