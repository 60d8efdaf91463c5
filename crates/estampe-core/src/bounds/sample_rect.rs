//! The samples of a viewport.
//!
//! ```text
//!     x = 10.6       pixel 10 of four samples: those at 10.6875 and beyond are inside the
//!      ┊ ▪           viewport, the others are not, so that the pixel is neither inside nor outside
//!     ▫┊    ▪
//!      ┊▫
//! ```
//!
//! *Space* window, 1/256 pixel · *Precision* exact: samples lie at multiples of 1/16 pixel.

use super::pixel_rect::PixelRect;
use estampe_types::state::Viewport;

/// The half-open rectangle of window positions at which a sample lies in a viewport, in 1/256
/// pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SampleRect {
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

impl SampleRect {
    /// A sample is inside where X ≤ x < X + W. Positions are integers in 1/256 pixel, so that an
    /// edge is rounded up.
    pub(crate) fn new(viewport: &Viewport) -> Self {
        // In f64 sum and product are exact: an edge just before a sample stays there.
        let [x, y, width, height] =
            [viewport.x, viewport.y, viewport.width, viewport.height].map(f64::from);
        Self {
            x0: rounded_up(x),
            y0: rounded_up(y),
            x1: rounded_up(x + width),
            y1: rounded_up(y + height),
        }
    }

    /// The pixels whose sample at this offset, in 1/256 pixel, is inside.
    #[inline]
    pub(crate) fn pixels_of(&self, [x, y]: [i32; 2]) -> PixelRect {
        // ⌈(edge − offset) / 256⌉: edges are below 2²⁵.
        let first = |edge: i32, offset: i32| (edge - offset + 255) >> 8;
        PixelRect {
            x0: first(self.x0, x),
            y0: first(self.y0, y),
            x1: first(self.x1, x),
            y1: first(self.y1, y),
        }
    }

    /// The pixels of which any sample may be inside, and those of which all are; offsets of samples
    /// lie from `least` to `most`.
    pub(crate) fn any_and_all(&self, [least, most]: [i32; 2]) -> [PixelRect; 2] {
        let (first, last) = (self.pixels_of([least; 2]), self.pixels_of([most; 2]));
        let any = PixelRect {
            x0: last.x0,
            y0: last.y0,
            ..first
        };
        let all = PixelRect {
            x0: first.x0,
            y0: first.y0,
            ..last
        };
        [any, all]
    }
}

/// An edge in pixels as the least integer that is not below it, in 1/256 pixel.
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
fn rounded_up(edge: f64) -> i32 {
    // A pixel more than any target has, on both sides, so that no sum overflows.
    const FARTHEST: f64 = 16_777_216.0;
    (edge * 256.0).ceil().clamp(-FARTHEST, FARTHEST) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn viewport(x: f32, width: f32) -> SampleRect {
        SampleRect::new(&Viewport {
            x,
            y: -3.0,
            width,
            height: 5.0,
            min_depth: 0.0,
            max_depth: 1.0,
        })
    }

    #[test]
    fn a_pixel_at_the_edge_is_inside_by_its_samples() {
        let rect = viewport(10.6, 5.0);
        // 10.6 is 2713.6 / 256, so that offsets from 154 on are inside pixel 10; 15.6 likewise ends
        // in pixel 15.
        let columns = |offset| {
            let PixelRect { x0, x1, .. } = rect.pixels_of([offset, 128]);
            [x0, x1]
        };
        assert_eq!(columns(32), [11, 16]);
        assert_eq!(columns(153), [11, 16]);
        assert_eq!(columns(154), [10, 15]);
        assert_eq!(columns(224), [10, 15]);
        let [any, all] = rect.any_and_all([32, 224]);
        assert_eq!([any.x0, any.x1, all.x0, all.x1], [10, 16, 11, 15]);
        assert_eq!([any.y0, any.y1, all.y0, all.y1], [-3, 2, -3, 2]);
    }

    #[test]
    fn one_sample_is_inside_by_its_pixels_center() {
        for step in 0..64_i16 {
            let x = f32::from(step) / 16.0 - 2.0;
            let [any, all] = viewport(x, 1.25).any_and_all([128; 2]);
            assert_eq!(any, all);
            let center_first = |edge: f32| {
                let pixels = (-8..8).find(|pixel| *pixel as f32 + 0.5 >= edge);
                pixels.unwrap()
            };
            assert_eq!([any.x0, any.x1], [center_first(x), center_first(x + 1.25)]);
        }
    }
}
