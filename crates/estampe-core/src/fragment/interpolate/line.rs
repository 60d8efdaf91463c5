//! Lines: values along the way from one end to the other.

use super::Interpolant;
use super::varyings::VaryingSource;
use crate::bounds::primitives::LinePrimitive;
use crate::geometry::line_style::{
    LineAxis, LineRectangle, LineShape, LineStyle, along, length_squared,
};
use estampe_simd::{
    LANE_X, LANE_Y, LANES, Lanes, Packet, SimdBase, SimdCvtFloat, f32x16, i32x16, outline,
};
use estampe_types::Interpolation;

/// A line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineInterpolant<'a> {
    line: &'a LinePrimitive,
    axis: LineAxis,
    /// The rectangle's width, where the line is one.
    rectangle: Option<f32>,
    source: VaryingSource<'a>,
}

impl<'a> LineInterpolant<'a> {
    pub(crate) fn new(
        line: &'a LinePrimitive,
        style: &LineStyle,
        source: VaryingSource<'a>,
    ) -> Self {
        Self {
            line,
            axis: LineAxis::new(line),
            rectangle: match style.shape {
                LineShape::Columns { .. } => None,
                LineShape::Rectangle { width, .. } => Some(width),
            },
            source,
        }
    }

    /// The part of each pixel that the line's rectangle covers, from 0 to 1, estimated with sixteen
    /// points; 1 if the line has no rectangle.
    pub(crate) fn coverage(&self, [x, y]: [i32; 2]) -> Packet<f32> {
        let rectangle = self
            .rectangle
            .and_then(|width| LineRectangle::new(self.line, width));
        let mut covered = Packet([1.0; LANES]);
        if let Some(rectangle) = rectangle {
            for (lane, covered) in covered.0.iter_mut().enumerate() {
                let pixel = [x + i32::from(LANE_X[lane]), y + i32::from(LANE_Y[lane])];
                *covered = rectangle.sixteenths(pixel) as f32 * (1.0 / 16.0);
            }
        }
        covered
    }

    /// The fraction of the way to the end at an offset in the pixels, in pixels: of a rectangle
    /// that of the nearest point of the line.
    #[inline(always)]
    fn fraction_at<S: Lanes>(&self, s: S, pixel: [i32; 2], offset: [f32; 2]) -> f32x16<S> {
        if self.rectangle.is_none() {
            return self.fraction(s, pixel);
        }
        f32x16::load_array(s, self.rectangle_fraction(pixel, offset))
    }

    #[inline(never)]
    #[expect(clippy::cast_possible_truncation, reason = "an offset is below 1")]
    fn rectangle_fraction(&self, [x, y]: [i32; 2], offset: [f32; 2]) -> [f32; LANES] {
        let [right, below] = offset.map(|pixels| (pixels * 256.0) as i32);
        let squared = length_squared(self.line) as f32;
        std::array::from_fn(|lane| {
            let at = [
                (x + i32::from(LANE_X[lane])) * 256 + right,
                (y + i32::from(LANE_Y[lane])) * 256 + below,
            ];
            along(self.line, at) as f32 / squared
        })
    }

    /// The fraction of the way to the end, at the pixels' centres along the major axis.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "coordinates are below 2²⁴")]
    fn fraction<S: Lanes>(&self, s: S, [x, y]: [i32; 2]) -> f32x16<S> {
        outline!(s, {
            let (pixel, lanes) = if self.axis.x_major {
                (x, &LANE_X)
            } else {
                (y, &LANE_Y)
            };
            let mut steps = [0; LANES];
            for (step, lane) in steps.iter_mut().zip(lanes) {
                *step = i32::from(*lane) * 256;
            }
            let first = pixel * 256 + 128 - self.axis.start[0] as i32;
            let along = i32x16::load_array(s, steps) + <i32x16<S> as SimdBase<S>>::splat(s, first);
            let delta = <f32x16<S> as SimdBase<S>>::splat(s, self.axis.delta[0] as f32);
            f32x16::float_from(along) / delta
        })
    }
}

/// `a + (b − a)·t`.
#[inline(always)]
fn mix<S: Lanes>(s: S, a: f32, b: f32, t: f32x16<S>) -> f32x16<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    splat(a) + splat(b - a) * t
}

impl<S: Lanes> Interpolant<S> for LineInterpolant<'_> {
    #[inline(always)]
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        mix(s, a.z, b.z, self.fraction_at(s, pixel, sample))
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        if a.iw.to_bits() == b.iw.to_bits() {
            return SimdBase::splat(s, a.iw);
        }
        mix(s, a.iw, b.iw, self.fraction_at(s, pixel, [0.5; 2]))
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        let [a, b] = &self.line.ends;
        let (from, to) = (self.source.of(a.vertex), self.source.of(b.vertex));
        let provoking = self.source.of(self.line.provoking);
        let t = self.fraction_at(s, pixel, [0.5; 2]);
        let perspective = a.iw.to_bits() != b.iw.to_bits();
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let w = one / mix(s, a.iw, b.iw, t);
        for (k, packet) in out.iter_mut().enumerate() {
            let value = match self.source.modes[k] {
                Interpolation::Flat => SimdBase::splat(s, provoking[k]),
                Interpolation::Smooth if perspective => mix(s, from[k] * a.iw, to[k] * b.iw, t) * w,
                _ => mix(s, from[k], to[k], t),
            };
            value.store_array(&mut packet.0);
        }
    }
}
