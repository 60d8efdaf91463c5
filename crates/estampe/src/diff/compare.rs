//! The exact difference of two images, channel by channel, alpha included.

use estampe_scene::Image;

/// The difference of two images of one size. Arrays are R, G, B, A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Comparison {
    /// Pixels per image.
    pub(crate) pixels: u64,
    /// Pixels that differ in any channel.
    pub(crate) differing_pixels: u64,
    /// Pixels that differ in any channel by more than the limit.
    pub(crate) pixels_over_limit: u64,
    /// The largest absolute difference of each channel, in steps of 8 bits.
    pub(crate) max: [u8; 4],
    /// The mean absolute difference of each channel over all pixels, in steps of 8 bits.
    pub(crate) mean: [f64; 4],
}

impl Comparison {
    /// The largest difference of any channel.
    pub(crate) fn max_of_all(&self) -> u8 {
        self.max.into_iter().fold(0, u8::max)
    }

    /// The mean difference over all pixels and channels.
    pub(crate) fn mean_of_all(&self) -> f64 {
        self.mean.iter().sum::<f64>() / 4.0
    }

    /// True if every byte is the same.
    pub(crate) fn is_identical(&self) -> bool {
        self.differing_pixels == 0
    }
}

/// Compares two images; `None` if their sizes differ.
pub(crate) fn compare(a: &Image, b: &Image, limit: u8) -> Option<Comparison> {
    if (a.width, a.height) != (b.width, b.height) {
        return None;
    }
    let mut totals = [0_u64; 4];
    let mut max = [0_u8; 4];
    let (mut differing_pixels, mut pixels_over_limit) = (0, 0);
    for (a, b) in a
        .rgba
        .as_chunks::<4>()
        .0
        .iter()
        .zip(b.rgba.as_chunks::<4>().0)
    {
        if a == b {
            continue;
        }
        let mut largest = 0;
        for channel in 0..4 {
            let difference = a[channel].abs_diff(b[channel]);
            totals[channel] += u64::from(difference);
            max[channel] = max[channel].max(difference);
            largest = largest.max(difference);
        }
        differing_pixels += 1;
        pixels_over_limit += u64::from(largest > limit);
    }
    let pixels = u64::from(a.width) * u64::from(a.height);
    let mean = totals.map(|total| total as f64 / pixels.max(1) as f64);
    Some(Comparison {
        pixels,
        differing_pixels,
        pixels_over_limit,
        max,
        mean,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_maxima_and_means_of_each_channel() {
        let a = Image {
            width: 2,
            height: 2,
            rgba: vec![10; 16],
        };
        let mut b = a.clone();
        b.rgba[0] = 13; // red of (0, 0)
        b.rgba[5] = 0; // green of (1, 0)
        b.rgba[7] = 255; // alpha of (1, 0)
        let got = compare(&a, &b, 3).expect("equal sizes");
        assert_eq!(got.pixels, 4);
        assert_eq!(got.differing_pixels, 2);
        assert_eq!(got.pixels_over_limit, 1);
        assert_eq!(got.max, [3, 10, 0, 245]);
        assert_eq!(got.mean, [0.75, 2.5, 0.0, 61.25]);
        assert_eq!(got.max_of_all(), 245);
        assert_eq!(got.mean_of_all(), 64.5 / 4.0);
        assert_eq!(compare(&b, &a, 3), Some(got));
    }

    #[test]
    fn a_picture_is_identical_to_itself_and_to_no_other_size() {
        let a = Image {
            width: 3,
            height: 2,
            rgba: (0..24).collect(),
        };
        let got = compare(&a, &a, 0).expect("equal sizes");
        assert!(got.is_identical() && got.max_of_all() == 0 && got.mean_of_all() == 0.0);
        let turned = Image {
            width: 2,
            height: 3,
            rgba: a.rgba.clone(),
        };
        assert_eq!(compare(&a, &turned, 255), None);
    }
}
