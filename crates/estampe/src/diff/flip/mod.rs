//! FLIP: the difference that an observer perceives when two images alternate in one place.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: *FLIP: A Difference Evaluator
//! for Alternating Images*, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020 (the form for low
//! dynamic range), at 67 pixels per degree: a 3840-pixel screen, 0.7 m wide, seen from 0.7 m.
//!
//! ```text
//!   sRGB -> YCxCz -> contrast sensitivity -> RGB, clamped -> L*a*b*, Hunt -> HyAB --+
//!                    (invisible detail)                                            colour ΔE
//!   sRGB -> Y -----> edges and points (Gaussian derivatives) ------------- features ΔF
//!                                                                          FLIP = ΔE^(1 − ΔF)
//! ```
//!
//! Every filter is separable: the contrast-sensitivity kernels are Gaussians or the sum of two, the
//! feature kernels products of a derivative and a Gaussian. That makes 15 passes of about 20 taps
//! per image; the kernels in two dimensions would take 441 taps each. Images are processed in tiles
//! with the filters' reach around them, so that only the memory of the result grows with the image.
//!
//! The paper has no alpha. A pixel that is not opaque looks different over different backgrounds,
//! so such images are compared over black and over white, and each pixel counts with the larger
//! difference.

mod color;
mod features;
mod kernel;
mod tile;

use estampe_scene::Image;

use color::Colors;
use kernel::Kernels;
use tile::{Area, Observer, TILE_HEIGHT, TILE_WIDTH, Tile};

/// Pixels per degree of visual angle: 0.7 m · (3840 px / 0.7 m) · π / 180.
const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// The perceived difference of two images, pixel by pixel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FlipMap {
    /// Width in pixels.
    pub(crate) width: u32,
    /// Height in pixels.
    pub(crate) height: u32,
    /// Row by row from the top; 0 for no perceived difference, at most 1.
    pub(crate) values: Vec<f32>,
}

impl FlipMap {
    /// The mean over all pixels.
    pub(crate) fn mean(&self) -> f64 {
        let total: f64 = self.values.iter().map(|&v| f64::from(v)).sum();
        total / self.values.len().max(1) as f64
    }

    /// The largest value.
    pub(crate) fn max(&self) -> f32 {
        self.values.iter().copied().fold(0.0, f32::max)
    }
}

/// Compares two images of one size.
///
/// # Panics
/// If the sizes differ.
pub(crate) fn flip(a: &Image, b: &Image) -> FlipMap {
    assert_eq!(
        (a.width, a.height),
        (b.width, b.height),
        "the caller compares sizes first"
    );
    let is_opaque = |image: &Image| image.rgba.as_chunks::<4>().0.iter().all(|t| t[3] == 255);
    let grounds: &[u8] = if is_opaque(a) && is_opaque(b) {
        &[0]
    } else {
        &[0, 255]
    };

    let (width, height) = (a.width as usize, a.height as usize);
    let mut values = vec![0.0_f32; width * height];
    let observer = Observer {
        kernels: Kernels::new(PIXELS_PER_DEGREE),
        colors: Colors::new(),
    };
    let (mut tile_a, mut tile_b) = (Tile::default(), Tile::default());
    for top in (0..height).step_by(TILE_HEIGHT) {
        for left in (0..width).step_by(TILE_WIDTH) {
            let area = Area {
                left,
                top,
                width: TILE_WIDTH.min(width - left),
                height: TILE_HEIGHT.min(height - top),
            };
            for &ground in grounds {
                tile_a.fill(a, area, ground, &observer);
                tile_b.fill(b, area, ground, &observer);
                for row in 0..area.height {
                    let start = (top + row) * width + left;
                    let out = &mut values[start..start + area.width];
                    for (column, value) in out.iter_mut().enumerate() {
                        let at = row * area.width + column;
                        *value = value.max(difference(&tile_a, &tile_b, at, &observer.colors));
                    }
                }
            }
        }
    }
    FlipMap {
        width: a.width,
        height: a.height,
        values,
    }
}

/// ΔE^(1 − ΔF) of the pixel at index `at` in both tiles.
fn difference(a: &Tile, b: &Tile, at: usize, colors: &Colors) -> f32 {
    let color = colors.difference(a.colors[at], b.colors[at]);
    if color == 0.0 {
        return 0.0;
    }
    let feature = features::difference(a.features[at], b.features[at]);
    libm::powf(color, 1.0 - feature).min(1.0)
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "small pictures have small coordinates"
)]
mod tests;
