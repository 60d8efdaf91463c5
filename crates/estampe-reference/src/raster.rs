//! Rasterization of triangles: the samples that they cover, in exact integers.
//!
//! In · Out: three snapped positions · quads of covered samples. Precision: exact. Spec:
//! NUMERICS.md, *Coverage*; the edge functions are Pineda's (1988), the tie rule is Direct3D's
//! top-left rule.
//!
//! ```text
//!   y down:   a ───▶ b      E(x, y) = (bx − ax)·(y − ay) − (by − ay)·(x − ax)
//!                  +        is positive below a left-to-right edge: on its inside
//! ```
//!
//! The rejected alternative, barycentric weights in floating point, leaves holes and double hits
//! along shared edges where a weight that should be 0 is rounded to either side.

use crate::cull::doubled_area;
use crate::viewport::PixelBounds;

/// The sample positions in a pixel, in 1/16 pixel: Vulkan's and Direct3D's standard positions. One
/// sample, and every number without standard positions, is at the centre.
#[must_use]
pub fn sample_positions(samples: u32) -> &'static [[u8; 2]] {
    match samples {
        2 => &[[12, 12], [4, 4]],
        4 => &[[6, 2], [14, 6], [2, 10], [10, 14]],
        8 => &[
            [9, 5],
            [7, 11],
            [13, 9],
            [5, 3],
            [3, 13],
            [1, 7],
            [11, 15],
            [15, 1],
        ],
        16 => &[
            [9, 9],
            [7, 5],
            [5, 10],
            [12, 7],
            [3, 6],
            [10, 13],
            [13, 11],
            [11, 3],
            [6, 14],
            [8, 1],
            [4, 2],
            [2, 12],
            [0, 8],
            [15, 4],
            [14, 15],
            [1, 0],
        ],
        _ => &[[8, 8]],
    }
}

/// The mask of all samples of a pixel.
#[must_use]
pub fn all_samples(samples: u32) -> u16 {
    sample_positions(samples)
        .iter()
        .fold(0, |mask, _| mask << 1 | 1)
}

/// The position of a sample in 1/256 pixel.
#[must_use]
pub fn sample_subpixel(pixel: [i64; 2], sample: [u8; 2]) -> [i64; 2] {
    [0, 1].map(|axis| 256 * pixel[axis] + 16 * i64::from(sample[axis]))
}

/// A 2×2 quad of pixels and the samples that a primitive covers in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QuadCoverage {
    /// The upper left pixel; both coordinates are even.
    pub origin: [u32; 2],
    /// Bit s of element `lane` is set if sample s of that pixel is covered. The lanes are left top,
    /// right top, left bottom, right bottom.
    pub samples: [u16; 4],
}

impl QuadCoverage {
    /// The pixel of a lane.
    #[must_use]
    pub fn pixel(origin: [u32; 2], lane: usize) -> [u32; 2] {
        [
            origin[0] + u32::from(lane % 2 == 1),
            origin[1] + u32::from(lane >= 2),
        ]
    }
}

/// An edge of a triangle that is wound so that its inside is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    a: [i64; 2],
    b: [i64; 2],
}

impl Edge {
    /// The edge from `a` to `b`.
    #[must_use]
    pub fn new(a: [i32; 2], b: [i32; 2]) -> Self {
        Self {
            a: a.map(i64::from),
            b: b.map(i64::from),
        }
    }

    /// E: positive inside. |coordinates| < 2²³, so differences are below 2²⁴ and no product exceeds
    /// 2⁴⁸.
    #[must_use]
    pub fn function(&self, [x, y]: [i64; 2]) -> i64 {
        let ([ax, ay], [bx, by]) = (self.a, self.b);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    }

    /// Returns true if points on the edge itself belong to the triangle: the edge is a *top* edge
    /// (horizontal, with the inside below) or a *left* edge (the inside is to the right).
    #[must_use]
    pub fn is_top_or_left(&self) -> bool {
        let ([ax, ay], [bx, by]) = (self.a, self.b);
        let is_top = by == ay && bx > ax;
        let is_left = by < ay;
        is_top || is_left
    }

    /// Returns true if the edge covers a point: the point is inside, or it is on the edge and the
    /// edge is top or left.
    #[must_use]
    pub fn covers(&self, point: [i64; 2]) -> bool {
        let e = self.function(point);
        e > 0 || e == 0 && self.is_top_or_left()
    }
}

/// The edges of a triangle, in the direction that makes its inside positive; `None` if it has no
/// area.
#[must_use]
pub fn edges([a, b, c]: [[i32; 2]; 3]) -> Option<[Edge; 3]> {
    let [a, b, c] = match doubled_area([a, b, c]) {
        0 => return None,
        area if area > 0 => [a, b, c],
        _ => [a, c, b],
    };
    Some([Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)])
}

/// The bounding box of a triangle: for x, then y, the least and the greatest coordinate.
#[must_use]
pub fn extent(corners: [[i32; 2]; 3]) -> [[i64; 2]; 2] {
    [0, 1].map(|axis| {
        let along = corners.map(|corner| i64::from(corner[axis]));
        [
            along[0].min(along[1]).min(along[2]),
            along[0].max(along[1]).max(along[2]),
        ]
    })
}

/// The quads with samples that a triangle covers, row by row.
#[must_use]
pub fn triangle(corners: [[i32; 2]; 3], bounds: &PixelBounds, samples: u32) -> Vec<QuadCoverage> {
    let Some(edges) = edges(corners) else {
        return Vec::new();
    };
    cover(extent(corners), bounds, samples, |point| {
        edges.iter().all(|edge| edge.covers(point))
    })
}

/// The quads with samples for which `covers` holds, among the pixels of `bounds` that a box
/// touches. The box is the least and the greatest x, then y, in 1/256 pixel.
#[must_use]
pub fn cover(
    extent: [[i64; 2]; 2],
    bounds: &PixelBounds,
    samples: u32,
    covers: impl Fn([i64; 2]) -> bool,
) -> Vec<QuadCoverage> {
    cover_pixels(extent, bounds, |pixel| {
        let mut mask = 0;
        for (s, &sample) in sample_positions(samples).iter().enumerate() {
            mask |= u16::from(covers(sample_subpixel(pixel, sample))) << s;
        }
        mask
    })
}

/// The quads with a pixel whose mask by `mask_of` is not 0, among the pixels of `bounds` that a box
/// touches. The box is the least and the greatest x, then y, in 1/256 pixel.
#[must_use]
pub fn cover_pixels(
    extent: [[i64; 2]; 2],
    bounds: &PixelBounds,
    mask_of: impl Fn([i64; 2]) -> u16,
) -> Vec<QuadCoverage> {
    let quads_along = |axis: usize, range: &std::ops::Range<u32>| {
        let [low, high] = extent[axis].map(|subpixels| subpixels.div_euclid(256));
        let low = low.max(i64::from(range.start));
        let high = high.min(i64::from(range.end) - 1);
        (low.div_euclid(2)..=high.div_euclid(2)).filter(move |_| low <= high)
    };
    let mut quads = Vec::new();
    for quad_y in quads_along(1, &bounds.y) {
        for quad_x in quads_along(0, &bounds.x) {
            let origin = [quad_x * 2, quad_y * 2];
            let masks = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, below]| {
                let pixel = [origin[0] + right, origin[1] + below];
                if bounds.contains(pixel) {
                    mask_of(pixel)
                } else {
                    0
                }
            });
            if masks != [0; 4] {
                let within = |at: i64| u32::try_from(at).expect("bounds begin at 0 or later");
                quads.push(QuadCoverage {
                    origin: origin.map(within),
                    samples: masks,
                });
            }
        }
    }
    quads
}
