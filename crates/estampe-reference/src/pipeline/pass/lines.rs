//! Lines: columns of pixels, or rectangles, with their stipple.

use super::{Parent, Pass, face_of, moved};
use crate::clip::clip_line;
use crate::cull::Face;
use crate::line::{LinePath, LineSurface};
use crate::raster::{QuadCoverage, all_samples};
use crate::rectangle::{LineRectangle, RectangleSurface};
use crate::{ClipVertex, WindowVertex};
use estampe_types::state::{LineRasterization, LineStipple, ProvokingVertex};

impl Pass<'_> {
    /// Draws a line, clipped.
    pub(super) fn line(&mut self, ends: &[ClipVertex; 2], parent: Option<Parent<'_>>) {
        let Some(kept) = clip_line(ends, &self.viewport) else {
            return;
        };
        let [start, end] = kept
            .each_ref()
            .map(|vertex| moved(self.viewport.place(vertex), parent));
        self.counts.rasterized += 1;
        self.observer
            .piece(&[start.clone(), end.clone()], face_of(parent));
        let provoking = match self.state.primitive.provoking_vertex {
            ProvokingVertex::First => &ends[0],
            ProvokingVertex::Last => &ends[1],
        };
        let flat = parent.map_or(&provoking.varyings[..], |parent| parent.flat);
        if self.state.primitive.line.rasterization == LineRasterization::Bresenham {
            self.columns([&start, &end], flat, face_of(parent));
        } else {
            self.rectangle([&start, &end], flat, face_of(parent));
        }
    }

    /// Draws a Bresenham line: columns of pixels.
    fn columns(&mut self, ends: [&WindowVertex; 2], flat: &[f32], face: Face) {
        let [start, end] = ends.map(|end| end.snapped);
        let path = LinePath::new(start, end);
        let line = self.state.primitive.line;
        let width = whole_width(line.width);
        // A line covers all samples of its pixels.
        let all_samples = all_samples(self.target.samples);
        let stipple = self.stipple;
        let quads: Vec<_> = path
            .widened(width)
            .wide_pixels(width, &self.bounds)
            .into_iter()
            .filter(|(column, _)| shows(line.stipple, stipple + u64::from(*column)))
            .map(|(_, [x, y])| {
                let mut samples = [0; 4];
                samples[(x % 2 + 2 * (y % 2)) as usize] = all_samples;
                QuadCoverage {
                    origin: [x - x % 2, y - y % 2],
                    samples,
                }
            })
            .collect();
        self.stipple += u64::from(path.length());
        let interface = self.interface;
        let surface = LineSurface {
            path,
            ends,
            modes: &interface.varyings,
            flat,
        };
        self.fragments(&quads, &surface, face);
    }

    /// Draws a rectangular line.
    fn rectangle(&mut self, ends: [&WindowVertex; 2], flat: &[f32], face: Face) {
        let [start, end] = ends.map(|end| end.snapped);
        let line = self.state.primitive.line;
        let rectangle = LineRectangle::new(start, end, line.width);
        let is_smooth = line.rasterization == LineRasterization::RectangularSmooth;
        let samples = self.target.samples;
        let mut quads = if is_smooth {
            rectangle.cover_smooth(&self.bounds, samples)
        } else {
            rectangle.cover(&self.bounds, samples)
        };
        for quad in &mut quads {
            for lane in 0..4 {
                let along = rectangle.distance_65536(QuadCoverage::pixel(quad.origin, lane));
                if !shows(line.stipple, (self.stipple + along) / 65_536) {
                    quad.samples[lane] = 0;
                }
            }
        }
        self.stipple += rectangle.length_65536();
        let interface = self.interface;
        let surface = RectangleSurface {
            rectangle,
            ends,
            modes: &interface.varyings,
            flat,
            is_smooth,
        };
        self.fragments(&quads, &surface, face);
    }
}

/// The number of pixels in a column of a line of this width: ⌊w + ½⌋, at least 1.
fn whole_width(width: f32) -> i64 {
    let halves = f64::from(width) * 2.0;
    // ⌊w + ½⌋ is the greatest n with 2n − 1 ≤ 2w.
    (1..=64)
        .rev()
        .find(|&n: &i32| f64::from(2 * n - 1) <= halves)
        .unwrap_or(1)
        .into()
}

/// Returns true if a stipple pattern draws fragment `number` of the line.
fn shows(stipple: Option<LineStipple>, number: u64) -> bool {
    stipple.is_none_or(|LineStipple { factor, pattern }| {
        let bit = number / u64::from(factor) % 16;
        pattern & 1 << bit != 0
    })
}
