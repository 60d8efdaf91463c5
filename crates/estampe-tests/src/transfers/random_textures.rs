//! Random textures and buffers, among which copies, blits and passes are possible.

use super::sequence::{Sequence, TextureShape};
use crate::Random;
use estampe_reference::transfer::mips;
use estampe_types::{TextureDimension, TextureFormat};

impl Sequence {
    /// Textures of every format in turn, each with partners, and two buffers; no operations.
    #[must_use]
    pub fn random_objects(random: &mut Random, seed: u64) -> Self {
        let count = TextureFormat::ALL.len() as u64;
        let main = TextureFormat::ALL[usize::try_from(seed % count).unwrap_or_default()];
        let second = second_format(random, main);
        let size = base_size(random);
        let mut textures = Vec::new();
        // Pairs of the same samples, so that multisampled ones can be copied.
        for format in [main, second] {
            let samples = samples(random, format);
            for _ in 0..2 {
                let format = toggled(random, format);
                textures.push(shape(random, (format, samples), size));
            }
        }
        // One sample, to be blitted, resolved and rendered to.
        let third = any_renderable(random);
        let format = random.pick(&[main, second, third]);
        let format = toggled(random, format);
        textures.push(shape(random, (format, 1), size));
        Self {
            textures,
            buffers: vec![1 << 14, 5000 + u64::from(random.below(100))],
            operations: Vec::new(),
        }
    }
}

/// A format with the same texels, sRGB or not.
pub(super) fn toggled(random: &mut Random, format: TextureFormat) -> TextureFormat {
    format.with_srgb(random.once_in(2))
}

fn any_renderable(random: &mut Random) -> TextureFormat {
    loop {
        let format = random.pick(TextureFormat::ALL);
        if format.is_renderable() {
            return format;
        }
    }
}

/// A format for the partner of a pass or blit: often depth with colour, or colour with another
/// colour.
fn second_format(random: &mut Random, main: TextureFormat) -> TextureFormat {
    use TextureFormat as F;
    let depths = [
        F::Depth16Unorm,
        F::Depth24Plus,
        F::Depth24PlusStencil8,
        F::Depth32Float,
        F::Depth32FloatStencil8,
        F::Stencil8,
    ];
    match random.below(4) {
        0 | 1 if main.is_renderable() => random.pick(&depths),
        2 => F::Rgba8Unorm,
        _ => any_renderable(random),
    }
}

/// Width and height: usually some texels, sometimes over the border of a storage block of 64×64.
fn base_size(random: &mut Random) -> [u32; 2] {
    let short = 1 + random.below(25);
    let side = 1 + random.below(25);
    match random.below(8) {
        0 => [60 + random.below(12), short],
        1 => [short, 60 + random.below(12)],
        2 => [64, 8],
        3 => [16, 16],
        _ => [short, side],
    }
}

fn samples(random: &mut Random, format: TextureFormat) -> u32 {
    if format.is_compressed() || !random.once_in(4) {
        return 1;
    }
    random.pick(&[2, 4, 4, 8, 16])
}

fn shape(
    random: &mut Random,
    (format, samples): (TextureFormat, u32),
    [width, height]: [u32; 2],
) -> TextureShape {
    use TextureDimension as D;
    // A texture of twice the size has an image of the size in its second level.
    let scale = if samples == 1 {
        random.pick(&[1, 1, 2])
    } else {
        1
    };
    let [width, height] = [width * scale, height * scale];
    let is_flat = samples > 1 || format.is_compressed() || !format.is_color();
    let (dimension, size) = match random.below(if is_flat { 6 } else { 10 }) {
        0 if samples == 1 && random.once_in(2) => {
            let side = width.max(height);
            (D::D2, [side, side, 6])
        }
        0..=3 => (D::D2, [width, height, 1]),
        4 | 5 => (D::D2, [width, height, 2 + random.below(2)]),
        6 => (D::D1, [width, 1, 1]),
        _ => (D::D3, [width, height, 1 + random.below(4)]),
    };
    let mut shape = TextureShape {
        format,
        dimension,
        size,
        levels: 1,
        samples,
        given: None,
    };
    if samples == 1 && !random.once_in(4) {
        let few = random.pick(&[2, 3, 16]);
        shape.levels = 1 + random.below(shape.most_levels().min(few));
    }
    if random.once_in(3) {
        let can_generate = mips::is_possible(format);
        let given = if can_generate {
            1 + random.below(shape.levels)
        } else {
            shape.levels
        };
        shape.given = Some((u64::from(random.bits()), given));
    }
    shape
}
