//! Bresenham lines of the pipeline, by Vulkan's rule, one pixel wide or more.
//!
//! In · Out: two window vertices · pixels, and interpolants. Precision: coverage exact, the rest
//! f32 in the order of NUMERICS.md, *Lines and points*.
//!
//! ```text
//!   x-major:  in every column whose centre lies between the ends, the pixel in whose row the
//!             line is at that centre; the start is included, the end is not, so that the lines
//!             of a strip share no pixel
//! ```
//!
//! A line that is W whole pixels wide is moved by −(W − 1)/2 pixels along its minor axis; then W
//! pixels are covered in each column, from there on. Integer lines, which draw both ends, are in
//! [`bresenham`](crate::bresenham).

use crate::WindowVertex;
use crate::arithmetic::floor_div;
use crate::fragment::Surface;
use crate::viewport::PixelBounds;
use estampe_types::shader::Interpolation;
use std::ops::Range;

/// The centre of pixel 0, in 1/256 pixel.
const HALF_PIXEL: i64 = 128;

/// A line between snapped positions, with its major axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinePath {
    start: [i64; 2],
    end: [i64; 2],
    /// 0 where the line is x-major (|Δx| ≥ |Δy|), 1 where it is y-major.
    major: usize,
}

impl LinePath {
    /// The line between two snapped positions.
    #[must_use]
    pub fn new(start: [i32; 2], end: [i32; 2]) -> Self {
        let (start, end) = (start.map(i64::from), end.map(i64::from));
        let [width, height] = [0, 1].map(|axis| (end[axis] - start[axis]).abs());
        Self {
            start,
            end,
            major: usize::from(width < height),
        }
    }

    /// The line, widened to `width` pixels: moved along its minor axis by half of the additional
    /// width.
    #[must_use]
    pub fn widened(mut self, width: i64) -> Self {
        let minor = 1 - self.major;
        self.start[minor] -= 128 * (width - 1);
        self.end[minor] -= 128 * (width - 1);
        self
    }

    /// The number of columns that it covers.
    #[must_use]
    pub fn length(&self) -> u32 {
        let columns = self.columns();
        u32::try_from(columns.end - columns.start).unwrap_or(0)
    }

    /// Δ along an axis.
    fn delta(&self, axis: usize) -> i64 {
        self.end[axis] - self.start[axis]
    }

    /// The columns (rows, if the line is y-major) whose centre c lies in the half-open range:
    /// `start ≤ c < end` if the line runs forward, `end < c ≤ start` if it runs back.
    fn columns(&self) -> Range<i64> {
        let (start, end) = (self.start[self.major], self.end[self.major]);
        // The first column whose centre is at or after a coordinate.
        let at_or_after = |place: i64| (place - HALF_PIXEL + 255).div_euclid(256);
        if start < end {
            at_or_after(start)..at_or_after(end)
        } else {
            at_or_after(end + 1)..at_or_after(start + 1)
        }
    }

    /// The pixel of a column: the row in which the line is at the column's centre, exactly.
    fn pixel(&self, column: i64) -> [i64; 2] {
        let minor = 1 - self.major;
        let along = 256 * column + HALF_PIXEL - self.start[self.major];
        // minor(c) = start + along·Δminor/Δmajor, and its pixel is ⌊minor(c)/256⌋.
        let delta_major = i128::from(self.delta(self.major));
        let numerator = i128::from(self.start[minor]) * delta_major
            + i128::from(along) * i128::from(self.delta(minor));
        let row = floor_div(numerator, 256 * delta_major);
        let row = i64::try_from(row).expect("a place between the line's ends");
        if self.major == 0 {
            [column, row]
        } else {
            [row, column]
        }
    }

    /// The pixels inside `bounds`, in order from the start.
    #[must_use]
    pub fn pixels(&self, bounds: &PixelBounds) -> Vec<[u32; 2]> {
        let columns = self.wide_pixels(1, bounds);
        columns.into_iter().map(|(_, pixel)| pixel).collect()
    }

    /// The pixels inside `bounds` of a line that is `width` pixels wide, in order from the start,
    /// each with the number of its column, counted from the start.
    #[must_use]
    pub fn wide_pixels(&self, width: i64, bounds: &PixelBounds) -> Vec<(u32, [u32; 2])> {
        let limits = [&bounds.x, &bounds.y][self.major];
        let all = self.columns();
        let columns = all.start.max(i64::from(limits.start))..all.end.min(i64::from(limits.end));
        let runs_back = self.delta(self.major) < 0;
        let narrow = |at: i64| u32::try_from(at).expect("bounds begin at 0 or later");
        let mut pixels = Vec::new();
        for column in columns {
            let number = if runs_back {
                all.end - 1 - column
            } else {
                column - all.start
            };
            for across in 0..width {
                let mut pixel = self.pixel(column);
                pixel[1 - self.major] += across;
                if bounds.contains(pixel) {
                    pixels.push((narrow(number), pixel.map(narrow)));
                }
            }
        }
        if runs_back {
            pixels.reverse();
        }
        pixels
    }

    /// The position of a pixel's centre along the line, on the major axis: 0 at the start, 1 at the
    /// end.
    #[must_use]
    pub fn fraction(&self, pixel: [u32; 2]) -> f32 {
        let along = 256 * i64::from(pixel[self.major]) + HALF_PIXEL - self.start[self.major];
        along as f32 / self.delta(self.major) as f32
    }
}

/// The interpolants of a line.
#[derive(Debug, Clone, Copy)]
pub struct LineSurface<'a> {
    /// The line between the snapped ends.
    pub path: LinePath,
    /// Its start and end vertices.
    pub ends: [&'a WindowVertex; 2],
    /// The interpolation of each scalar of the varyings.
    pub modes: &'a [Interpolation],
    /// The provoking vertex's varyings.
    pub flat: &'a [f32],
}

impl Surface for LineSurface<'_> {
    /// The depth at the pixel's centre, for every sample.
    fn depth(&self, pixel: [u32; 2], _sample: [u8; 2]) -> f32 {
        let [a, b] = self.ends;
        mix(a.z, b.z, self.path.fraction(pixel))
    }

    fn inverse_w(&self, pixel: [u32; 2]) -> f32 {
        let [a, b] = self.ends;
        mix(a.inverse_w, b.inverse_w, self.path.fraction(pixel))
    }

    fn varyings(&self, pixel: [u32; 2]) -> Vec<f32> {
        let t = self.path.fraction(pixel);
        mix_ends(self.ends, self.modes, self.flat, t)
    }

    fn derivatives_at(&self, pixel: [u32; 2], _place: [u8; 2]) -> Vec<[f32; 2]> {
        let slope = 256.0 / self.path.delta(self.path.major) as f32;
        let mut slopes = [0.0; 2];
        slopes[self.path.major] = slope;
        derivatives_of_ends(
            self.ends,
            self.modes,
            &self.varyings(pixel),
            (self.path.fraction(pixel), slopes),
        )
    }
}

/// The derivatives of varyings, given their values, along x and y: those of the fraction `t`
/// between two ends are `slopes`.
#[must_use]
pub fn derivatives_of_ends(
    [a, b]: [&WindowVertex; 2],
    modes: &[Interpolation],
    values: &[f32],
    (t, slopes): (f32, [f32; 2]),
) -> Vec<[f32; 2]> {
    let w_is_constant = a.inverse_w.to_bits() == b.inverse_w.to_bits();
    let w = 1.0 / mix(a.inverse_w, b.inverse_w, t);
    let derivatives = |(k, mode): (usize, &Interpolation)| match mode {
        Interpolation::Flat => [0.0; 2],
        Interpolation::Smooth if !w_is_constant => {
            let change = b.varyings[k] * b.inverse_w - a.varyings[k] * a.inverse_w;
            let of_w = b.inverse_w - a.inverse_w;
            slopes.map(|slope| (change * slope - values[k] * (of_w * slope)) * w)
        }
        Interpolation::Smooth | Interpolation::NoPerspective => {
            slopes.map(|slope| (b.varyings[k] - a.varyings[k]) * slope)
        }
    };
    modes.iter().enumerate().map(derivatives).collect()
}

/// The varyings at a fraction between two ends.
#[must_use]
pub fn mix_ends(
    [a, b]: [&WindowVertex; 2],
    modes: &[Interpolation],
    flat: &[f32],
    t: f32,
) -> Vec<f32> {
    let w_is_constant = a.inverse_w.to_bits() == b.inverse_w.to_bits();
    let w = 1.0 / mix(a.inverse_w, b.inverse_w, t);
    let value = |(k, mode): (usize, &Interpolation)| match mode {
        Interpolation::Flat => flat[k],
        Interpolation::Smooth if !w_is_constant => {
            let over_w = [a, b].map(|end| end.varyings[k] * end.inverse_w);
            mix(over_w[0], over_w[1], t) * w
        }
        Interpolation::Smooth | Interpolation::NoPerspective => {
            mix(a.varyings[k], b.varyings[k], t)
        }
    };
    modes.iter().enumerate().map(value).collect()
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}
