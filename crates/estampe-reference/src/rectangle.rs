//! Rectangular lines: coverage of the rectangle around a line, by samples or, for smooth lines, in
//! sixteenths as alpha.
//!
//! In · Out: two snapped positions and a width · quads of covered samples, and interpolants.
//! Precision: the corners are rounded to 1/256 pixel, the rest of the coverage is exact. Spec:
//! NUMERICS.md, *Lines and points*; Vulkan, "Rectangular lines".
//!
//! ```text
//!   a − h ────────────▶ b − h     h = (−Δy, Δx) · half the width ÷ the length, rounded
//!     ▲       a ──▶ b     │       (across the line; y down: h points below a line that runs to
//!   a + h ◀──────────── b + h     the right)
//! ```

use crate::WindowVertex;
use crate::arithmetic::round_half_even;
use crate::fragment::{CENTER, Surface};
use crate::line::{derivatives_of_ends, mix_ends};
use crate::raster::{self, Edge, QuadCoverage, sample_subpixel};
use crate::viewport::PixelBounds;
use estampe_types::shader::Interpolation;

/// A line and its rectangle.
#[derive(Debug, Clone, Copy)]
pub struct LineRectangle {
    start: [i32; 2],
    end: [i32; 2],
    edges: Option<[Edge; 4]>,
    corners: [[i32; 2]; 4],
}

impl LineRectangle {
    /// The rectangle of a line with a width in pixels. It covers nothing if it has no area.
    #[must_use]
    pub fn new(start: [i32; 2], end: [i32; 2], width: f32) -> Self {
        let delta = [0, 1].map(|axis: usize| end[axis] - start[axis]);
        let [dx, dy] = delta.map(|subpixels| subpixels as f32);
        let across = (width * 128.0) / length(start, end);
        let h = [round_half_even(-dy * across), round_half_even(dx * across)];
        let minus = |p: [i32; 2]| [p[0] - h[0], p[1] - h[1]];
        let plus = |p: [i32; 2]| [p[0] + h[0], p[1] + h[1]];
        let corners = [minus(start), minus(end), plus(end), plus(start)];
        let cross = i64::from(delta[0]) * i64::from(h[1]) - i64::from(delta[1]) * i64::from(h[0]);
        let edges = [0, 1, 2, 3].map(|k: usize| Edge::new(corners[k], corners[(k + 1) % 4]));
        Self {
            start,
            end,
            edges: (cross > 0).then_some(edges),
            corners,
        }
    }

    /// Returns true if a point in 1/256 pixel is inside, by the fill rule of triangles.
    #[must_use]
    pub fn covers(&self, point: [i64; 2]) -> bool {
        self.edges
            .is_some_and(|edges| edges.iter().all(|edge| edge.covers(point)))
    }

    /// The number of a pixel's sixteen points, a grid of four by four, that are inside.
    #[must_use]
    pub fn sixteenths(&self, pixel: [i64; 2]) -> u8 {
        let places = [2, 6, 10, 14];
        let mut inside = 0;
        for y in places {
            for x in places {
                inside += u8::from(self.covers(sample_subpixel(pixel, [x, y])));
            }
        }
        inside
    }

    /// The quads with samples inside the rectangle.
    #[must_use]
    pub fn cover(&self, bounds: &PixelBounds, samples: u32) -> Vec<QuadCoverage> {
        raster::cover(self.extent(), bounds, samples, |point| self.covers(point))
    }

    /// The quads with pixels that have at least one of the sixteen points inside; all samples of
    /// these pixels are covered.
    #[must_use]
    pub fn cover_smooth(&self, bounds: &PixelBounds, samples: u32) -> Vec<QuadCoverage> {
        raster::cover(self.extent(), bounds, samples, |[x, y]| {
            self.sixteenths([x.div_euclid(256), y.div_euclid(256)]) > 0
        })
    }

    fn extent(&self) -> [[i64; 2]; 2] {
        [0, 1].map(|axis: usize| {
            let along = self.corners.map(|corner| i64::from(corner[axis]));
            let (least, greatest) = (along.iter().min(), along.iter().max());
            [least, greatest].map(|end| *end.expect("four corners"))
        })
    }

    /// With s the start, e the end and p the point: (p − s)·(e − s) and (e − s)·(e − s). Exact.
    fn along(&self, point: [i64; 2]) -> [i64; 2] {
        let way = [0, 1].map(|axis: usize| i64::from(self.end[axis]) - i64::from(self.start[axis]));
        let to = [0, 1].map(|axis: usize| point[axis] - i64::from(self.start[axis]));
        [
            to[0] * way[0] + to[1] * way[1],
            way[0] * way[0] + way[1] * way[1],
        ]
    }

    /// The position along the line of its point nearest to a sample: 0 at the start, 1 at the end.
    #[must_use]
    pub fn fraction(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32 {
        let [product, square] = self.along(sample_subpixel(pixel.map(i64::from), sample));
        product as f32 / square as f32
    }

    /// How the position along the line changes from a pixel to the next one on the right, and to
    /// the next one below.
    #[must_use]
    pub fn slopes(&self) -> [f32; 2] {
        let [_, square] = self.along([0; 2]);
        [0, 1].map(|axis: usize| 256.0 * (self.end[axis] - self.start[axis]) as f32 / square as f32)
    }

    /// The distance from the start to a pixel's centre along the line, in 1/65536 pixel, rounded
    /// down; 0 before the start.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "`as` saturates: what lies before the start is 0"
    )]
    pub fn distance_65536(&self, pixel: [u32; 2]) -> u64 {
        let [product, _] = self.along(sample_subpixel(pixel.map(i64::from), CENTER));
        let subpixels = product as f32 / length(self.start, self.end);
        (f64::from(subpixels) * 256.0) as u64
    }

    /// The line's length in 1/65536 pixel, rounded to nearest, ties to even.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "lengths are positive and below 2³⁵"
    )]
    pub fn length_65536(&self) -> u64 {
        (f64::from(length(self.start, self.end)) * 256.0).round_ties_even() as u64
    }
}

/// A length in 1/256 pixel.
fn length(start: [i32; 2], end: [i32; 2]) -> f32 {
    let [dx, dy] = [0, 1].map(|axis: usize| (end[axis] - start[axis]) as f32);
    (dx * dx + dy * dy).sqrt()
}

/// The interpolants of a rectangular line.
#[derive(Debug, Clone, Copy)]
pub struct RectangleSurface<'a> {
    /// The line's rectangle.
    pub rectangle: LineRectangle,
    /// Its start and end.
    pub ends: [&'a WindowVertex; 2],
    /// The interpolation of each scalar of the varyings.
    pub modes: &'a [Interpolation],
    /// The provoking vertex's varyings.
    pub flat: &'a [f32],
    /// If set, alpha is multiplied by coverage.
    pub is_smooth: bool,
}

impl Surface for RectangleSurface<'_> {
    fn depth(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32 {
        let [a, b] = self.ends;
        a.z + (b.z - a.z) * self.rectangle.fraction(pixel, sample)
    }

    fn inverse_w(&self, pixel: [u32; 2]) -> f32 {
        let [a, b] = self.ends;
        a.inverse_w + (b.inverse_w - a.inverse_w) * self.rectangle.fraction(pixel, CENTER)
    }

    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32> {
        let t = self.rectangle.fraction(pixel, CENTER);
        mix_ends(self.ends, self.modes, self.flat, t)
    }

    fn derivatives_at(&self, pixel: [u32; 2], _place: [u8; 2]) -> Vec<[f32; 2]> {
        let t = self.rectangle.fraction(pixel, CENTER);
        let slopes = self.rectangle.slopes();
        derivatives_of_ends(self.ends, self.modes, &self.varyings(pixel), (t, slopes))
    }

    fn alpha(&self, pixel: [u32; 2]) -> Option<f32> {
        let sixteenths = self.rectangle.sixteenths(pixel.map(i64::from));
        self.is_smooth.then(|| f32::from(sixteenths) / 16.0)
    }
}
