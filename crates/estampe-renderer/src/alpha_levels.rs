//! Mip levels of colours whose alpha is their coverage.
//!
//! ```text
//!   level n + 1    the mean of four texels, each with the weight of its alpha, so that what is
//!                  invisible has no colour in a smaller level
//!   filled         invisible texels take the colours of the smaller level, so that filters between
//!                  visible and invisible ones find no foreign colour there
//!   cut-outs       alpha is scaled so that each level keeps as many of a hundred texels as level 0
//!                  (I. Castaño, "Computing Alpha Mipmaps", 2010)
//! ```
//!
//! Sides are halved and rounded down as those of [`estampe::Device::generate_mips`].

use estampe::box_filter::{Averaged, halve_rows};
use estampe_scene::Image;

/// A level: sRGB with straight alpha.
#[derive(Debug, Clone, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    /// Words with red in the lowest byte.
    texels: Vec<u32>,
}

/// The place of alpha in a texel.
const ALPHA: u32 = 24;
/// The bits of red, green and blue.
const COLOR: u32 = 0x00FF_FFFF;

/// True if some texel of an image is not opaque.
pub(crate) fn has_alpha(image: &Image) -> bool {
    image.rgba.chunks_exact(4).any(|texel| texel[3] < 255)
}

/// The bytes of all levels of an image; with a cutoff, texels whose alpha is less are cut out.
pub(crate) fn levels(image: &Image, cutoff: Option<u8>) -> Vec<Vec<u8>> {
    let (width, height) = (image.width as usize, image.height as usize);
    let texels = image.rgba.as_chunks::<4>().0.iter();
    let texels: Vec<u32> = texels.map(|&texel| u32::from_le_bytes(texel)).collect();
    if texels.len() != width * height || texels.is_empty() {
        return vec![image.rgba.clone()];
    }
    let mut levels = vec![Level {
        width,
        height,
        texels,
    }];
    while let Some(last) = levels.last().filter(|last| last.width.max(last.height) > 1) {
        levels.push(last.half());
    }
    for index in (1..levels.len()).rev() {
        let (finer, coarser) = levels.split_at_mut(index);
        finer[index - 1].fill(&coarser[0]);
    }
    if let Some(cutoff) = cutoff {
        let wanted = levels[0].kept(cutoff);
        for level in &mut levels[1..] {
            level.keep(wanted, cutoff);
        }
    }
    let bytes = |level: &Level| {
        let texels = level.texels.iter();
        texels.flat_map(|texel| texel.to_le_bytes()).collect()
    };
    levels.iter().map(bytes).collect()
}

impl Level {
    /// The level of half the size.
    fn half(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut texels = vec![0; width * height];
        let row = |y: usize| &self.texels[y * self.width..(y + 1) * self.width];
        for (y, half) in texels.chunks_exact_mut(width).enumerate() {
            let below = (2 * y + 1).min(self.height - 1);
            halve_rows(row(2 * y), row(below), half, Averaged::Weighted);
        }
        Self {
            width,
            height,
            texels,
        }
    }

    /// Gives invisible texels the colours of the next level.
    fn fill(&mut self, coarser: &Self) {
        for (index, texel) in self.texels.iter_mut().enumerate() {
            if *texel >> ALPHA == 0 {
                let (x, y) = (index % self.width, index / self.width);
                let (x, y) = (
                    (x / 2).min(coarser.width - 1),
                    (y / 2).min(coarser.height - 1),
                );
                *texel = coarser.texels[y * coarser.width + x] & COLOR;
            }
        }
    }

    /// The texels that a cutoff keeps, and all texels.
    fn kept(&self, cutoff: u8) -> [usize; 2] {
        let kept = self
            .texels
            .iter()
            .filter(|&texel| texel >> ALPHA >= cutoff.into());
        [kept.count(), self.texels.len()]
    }

    /// Scales alpha so that the cutoff keeps the wanted share of texels.
    fn keep(&mut self, [kept, all]: [usize; 2], cutoff: u8) {
        if kept == 0 || kept == all || cutoff == 0 {
            return;
        }
        let mut count_of = [0_usize; 256];
        for texel in &self.texels {
            count_of[(texel >> ALPHA) as usize] += 1;
        }
        // kept ÷ all of the texels, rounded; the two are bounded by the size of images.
        let wanted = (self.texels.len() * kept + all / 2) / all;
        let mut sum = 0;
        let threshold = (1..=255_u8).rev().find(|&code| {
            sum += count_of[usize::from(code)];
            sum >= wanted
        });
        // Alpha at the threshold becomes the cutoff, and what is less stays less.
        let threshold = u32::from(threshold.unwrap_or(1));
        for texel in &mut self.texels {
            let scaled = (*texel >> ALPHA) * u32::from(cutoff) / threshold;
            *texel = *texel & COLOR | scaled.min(255) << ALPHA;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{has_alpha, levels};
    use estampe_scene::Image;

    fn image(width: u32, height: u32, texel: impl Fn(usize, usize) -> [u8; 4]) -> Image {
        let (w, h) = (width as usize, height as usize);
        let texels = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
        Image {
            width,
            height,
            rgba: texels.flat_map(|(x, y)| texel(x, y)).collect(),
        }
    }

    /// Green leaves on invisible black stay green in every level.
    #[test]
    fn what_is_invisible_has_no_colour() {
        let leaves = image(16, 8, |x, y| match (x / 3 + y / 3) % 2 {
            0 => [20, 200, 40, 255],
            _ => [0, 0, 0, 0],
        });
        assert!(has_alpha(&leaves));
        let made = levels(&leaves, None);
        assert_eq!(
            made.iter().map(Vec::len).collect::<Vec<_>>(),
            [512, 128, 32, 8, 4]
        );
        for (number, level) in made.iter().enumerate() {
            for texel in level.chunks(4) {
                assert_eq!(texel[..3], [20, 200, 40], "level {number}");
            }
        }
        // Alpha is that of the image, and its mean.
        let alphas = |level: &[u8]| level.iter().skip(3).step_by(4).copied().collect::<Vec<_>>();
        assert_eq!(alphas(&made[0]), alphas(&leaves.rgba));
        assert!((100..156).contains(&made[4][3]));
    }

    /// Opaque images have means in linear light.
    #[test]
    fn opaque_images_have_plain_means() {
        let opaque = image(4, 4, |x, y| {
            [[0, 60, 120, 180][x], [0, 70, 140, 210][y], 9, 255]
        });
        assert!(!has_alpha(&opaque));
        let own = levels(&opaque, None);
        let first: Vec<u8> = own[1][..4].to_vec();
        // The mean of 0 and 60, and of 0 and 70, in linear light.
        assert_eq!(first, [41, 49, 9, 255]);
    }

    /// A thin ring would be cut out as a whole in smaller levels.
    #[test]
    fn smaller_levels_keep_the_share_of_cut_outs() {
        let ring = image(64, 64, |x, y| {
            let across = |at: usize, middle: f64| {
                let at = f64::from(u32::try_from(at).expect("small"));
                (at - middle) * (at - middle)
            };
            let radius = (across(x, 29.3) + across(y, 33.9)).sqrt();
            if (24.0..26.0).contains(&radius) {
                [90, 60, 30, 255]
            } else {
                [0, 0, 0, 0]
            }
        });
        let share = |level: &[u8]| {
            let kept = level.chunks(4).filter(|texel| texel[3] >= 128).count();
            let count = |number: usize| f64::from(u32::try_from(number).expect("few"));
            count(kept) / count(level.len() / 4)
        };
        let whole = share(&ring.rgba);
        assert!(
            (whole - 0.0767).abs() < 0.01,
            "π·(26² − 24²) ÷ 64²: {whole}"
        );
        assert_eq!(share(&levels(&ring, None)[3]), 0.0);
        for level in &levels(&ring, Some(128))[..4] {
            assert!((share(level) - whole).abs() < 0.06, "{}", share(level));
            assert!(share(level) > 0.05);
        }
    }

    #[test]
    fn hostile_images_have_one_level() {
        let mut broken = image(4, 4, |_, _| [1, 2, 3, 4]);
        broken.rgba.truncate(20);
        assert_eq!(levels(&broken, Some(200)).len(), 1);
        assert_eq!(levels(&image(1, 1, |_, _| [0; 4]), Some(0)).len(), 1);
        assert_eq!(levels(&image(3, 1, |_, _| [0; 4]), Some(255)).len(), 2);
    }
}
