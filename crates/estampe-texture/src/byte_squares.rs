//! Squares of texels of one byte, so that linear filtering loads one word for each lane and level.
//!
//! In: texels of one byte, a word each · Out: for each, a word of it and its neighbours.
//!
//! Glyphs, masks and soft sprites are such textures. Weights of texels across a clamped or mirrored
//! edge are 0, so the neighbours of repeated textures serve all address modes.

use crate::SampledTexture;
use estampe_types::{Lines, TexelData};

impl SampledTexture {
    /// Makes the squares of the texels if filtering reads them, and if a pass before has sampled
    /// the texture. The results are the same.
    pub(crate) fn make_squares(&self) {
        if self.reads_squares {
            let texture = &self.view.texture;
            texture.squares.make(|| squares_of(texture));
        }
    }
}

/// The squares of a texture of one sample whose texels are bytes; none where texels are missing.
fn squares_of(texture: &TexelData) -> Lines<u32> {
    let Some(mut words) = Lines::zeros(texture.texels.len()) else {
        return Lines::default();
    };
    for (number, level) in texture.levels.iter().enumerate() {
        let [width, height] = [level.width, level.height].map(|side| side as usize);
        let (image, begin) = (width.saturating_mul(height), level.offset as usize);
        let slices = texture.shape.slices(number) as usize;
        let range = begin..begin.saturating_add(image.saturating_mul(slices));
        let Some(texels) = texture.texels.get(range.clone()).filter(|_| image > 0) else {
            continue;
        };
        let images = texels.chunks_exact(image);
        for (texels, squares) in images.zip(words[range].chunks_exact_mut(image)) {
            for (y, squares) in squares.chunks_exact_mut(width).enumerate() {
                let row = |y: usize| &texels[y % height * width..][..width];
                fill_row([row(y), row(y + 1)], squares);
            }
        }
    }
    words
}

/// Fills a row of squares from two rows of texels.
fn fill_row([upper, lower]: [&[u32]; 2], squares: &mut [u32]) {
    let square = |[a, b, c, d]: [u32; 4]| a & 0xFF | (b & 0xFF) << 8 | (c & 0xFF) << 16 | d << 24;
    let pairs = upper.windows(2).zip(lower.windows(2));
    for (to, (upper, lower)) in squares.iter_mut().zip(pairs) {
        *to = square([upper[0], upper[1], lower[0], lower[1]]);
    }
    if let (Some(to), [a, .., b], [c, .., d]) = (squares.last_mut(), upper, lower) {
        *to = square([*b, *a, *d, *c]);
    } else if let (Some(to), [a], [c]) = (squares.last_mut(), upper, lower) {
        *to = square([*a, *a, *c, *c]);
    }
}
