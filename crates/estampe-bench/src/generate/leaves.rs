//! Textures of grass and leaves with coverage in alpha, in integers.

use super::{MipChain, hash32};

/// The first layers show blades of grass, the others leaves.
const GRASS_LAYERS: u32 = 8;
const LAYERS: u32 = 16;

/// 16 layers of 128² RGBA8 with all mip levels. Colours are everywhere, so that filtering finds no
/// foreign ones at the edges.
#[must_use]
pub fn leaf_textures() -> MipChain {
    let layers: Vec<MipChain> = (0..LAYERS).map(layer).collect();
    MipChain::of_layers(&layers)
}

fn layer(layer: u32) -> MipChain {
    let is_grass = layer < GRASS_LAYERS;
    let shapes = if is_grass { 5 } else { 8 };
    MipChain::below(128, |column, row| {
        let [x, y] = [column, row].map(u32::cast_signed);
        // The greatest coverage, and the shade of its shape.
        let (mut alpha, mut shade) = (0, 0);
        for shape in 0..shapes {
            let hash = hash32(14_000 + 64 * layer + shape);
            let (inside, base) = match is_grass {
                true => (inside_blade(hash, x, y), 48 - y / 3),
                false => (inside_leaf(hash, x, y), 40),
            };
            let coverage = (inside * 64 + 128).clamp(0, 255);
            if coverage > alpha {
                (alpha, shade) = (coverage, bits(hash, 27, 31) + base);
            }
        }
        let grain = hash32((column >> 1) + 64 * (row >> 1) + 4096 * layer) & 31;
        let green = (70 + 2 * shade + grain.cast_signed()).clamp(0, 255);
        let red = if layer % 4 == 3 { green } else { green * 5 / 8 };
        [red, green, green * 3 / 8, alpha]
            .map(|channel| u8::try_from(channel).expect("clamped to bytes"))
    })
}

/// Some bits of a hash.
fn bits(hash: u32, shift: u32, mask: u32) -> i32 {
    ((hash >> shift) & mask).cast_signed()
}

/// The distance inside a blade in quarters of a texel: from the bottom upwards, bent by a parabola.
fn inside_blade(hash: u32, x: i32, y: i32) -> i32 {
    let (length, up) = (70 + bits(hash, 0, 31) + bits(hash, 5, 15), 127 - y);
    let bend = (bits(hash, 18, 63) - 32) * up * up / (128 * 96);
    let center = 40 + bits(hash, 9, 31) + bits(hash, 14, 15) + bend;
    let half_width = (9 + bits(hash, 24, 7)) * 4 * (length - up) / length;
    half_width - (x - center).abs() * 4
}

/// The same of an ellipse with axes of 20 and 11 texels, in one of eight directions.
fn inside_leaf(hash: u32, x: i32, y: i32) -> i32 {
    const DIRECTIONS: [[i32; 2]; 8] = [
        [8, 0],
        [7, 4],
        [6, 6],
        [4, 7],
        [0, 8],
        [-4, 7],
        [-6, 6],
        [-7, 4],
    ];
    let dx = x - 20 - bits(hash, 0, 63) - bits(hash, 6, 15) - bits(hash, 10, 7);
    let dy = y - 14 - bits(hash, 13, 63) - bits(hash, 19, 31);
    let [cosine, sine] = DIRECTIONS[(hash >> 24 & 7) as usize];
    let along = (dx * cosine + dy * sine) / 8;
    let across = (dy * cosine - dx * sine) / 8;
    (256 - along * along * 256 / (20 * 20) - across * across * 256 / (11 * 11)) / 8
}
