//! Lines: values along the way from one end to the other.

use super::Interpolant;
use super::pixels::WindowPixels;
use super::triangle::smooth_derivatives;
use super::varyings::VaryingSource;
use crate::bounds::lines::LinePrimitive;
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
    line: LinePrimitive,
    axis: LineAxis,
    /// The rectangle's width, where the line is one.
    rectangle: Option<f32>,
    /// The way from the start to the end in 1/256 pixel.
    way: [i32; 2],
    /// True if the dot product of that way and the way to a pixel of the line fits 32 bits.
    is_short: bool,
    source: VaryingSource<'a>,
}

/// How far pixels whose values are asked for lie beyond a line's end, or beside it, at most: half
/// its width, and a packet. In 1/256 pixel.
const MARGIN: i64 = 2048;

impl<'a> LineInterpolant<'a> {
    #[inline]
    pub(crate) fn new(line: LinePrimitive, style: &LineStyle, source: VaryingSource<'a>) -> Self {
        let [a, b] = &line.ends;
        let way = [b.x - a.x, b.y - a.y];
        let longest = way.map(i64::from).map(i64::abs);
        let longest = longest[0].max(longest[1]);
        let rectangle = match style.shape {
            LineShape::Columns { .. } => None,
            LineShape::Rectangle { width, .. } => Some(width),
        };
        let most = longest + i64::from(style.reach()) + MARGIN;
        Self {
            line,
            axis: LineAxis::new(&line),
            rectangle,
            way,
            is_short: 2 * longest * most < 1 << 31,
            source,
        }
    }

    /// The line.
    #[inline(always)]
    pub(crate) fn primitive(&self) -> &LinePrimitive {
        &self.line
    }

    /// The part of each pixel that the line's rectangle covers, from 0 to 1, estimated with sixteen
    /// points; 1 if the line has no rectangle.
    pub(crate) fn coverage(&self, [x, y]: [i32; 2]) -> Packet<f32> {
        let rectangle = self
            .rectangle
            .and_then(|width| LineRectangle::new(&self.line, width));
        let mut covered = Packet([1.0; LANES]);
        if let Some(rectangle) = rectangle {
            for (lane, covered) in covered.0.iter_mut().enumerate() {
                let pixel = [x + i32::from(LANE_X[lane]), y + i32::from(LANE_Y[lane])];
                *covered = rectangle.sixteenths(pixel) as f32 * (1.0 / 16.0);
            }
        }
        covered
    }

    /// The fraction of the way to the end, at an offset (in pixels) in sixteen pixels: of a
    /// rectangle that of the nearest point of the line, else at the pixels' centres along the major
    /// axis.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coordinates are below 2²⁴, and an offset is below 1"
    )]
    fn fraction<S: Lanes>(&self, s: S, pixels: WindowPixels<S>, offset: [f32; 2]) -> f32x16<S> {
        outline!(s, {
            let splat = |value| <i32x16<S> as SimdBase<S>>::splat(s, value);
            let WindowPixels([x, y]) = pixels;
            if self.rectangle.is_none() {
                let unit = if self.axis.x_major { x } else { y };
                let along = (unit << 8) + splat(128 - self.axis.start[0] as i32);
                let delta = <f32x16<S> as SimdBase<S>>::splat(s, self.axis.delta[0] as f32);
                return f32x16::float_from(along) / delta;
            }
            let [right, below] = offset.map(|pixels| (pixels * 256.0) as i32);
            let squared = length_squared(&self.line) as f32;
            if self.is_short {
                let [from, _] = &self.line.ends;
                let from_x = (x << 8) + splat(right - from.x);
                let from_y = (y << 8) + splat(below - from.y);
                let along = from_x * splat(self.way[0]) + from_y * splat(self.way[1]);
                return f32x16::float_from(along) / <f32x16<S> as SimdBase<S>>::splat(s, squared);
            }
            let (x, y) = (x.to_array(), y.to_array());
            let fraction = self.fraction_of_long(&x, &y, [right, below], squared);
            f32x16::load_array(s, fraction)
        })
    }

    /// [`LineInterpolant::fraction`] of a rectangle whose products need 64 bits.
    #[inline(never)]
    fn fraction_of_long(
        &self,
        x: &[i32; LANES],
        y: &[i32; LANES],
        [right, below]: [i32; 2],
        squared: f32,
    ) -> [f32; LANES] {
        let mut fraction = [0.0; LANES];
        for ((fraction, x), y) in fraction.iter_mut().zip(x).zip(y) {
            *fraction = along(&self.line, [x * 256 + right, y * 256 + below]) as f32 / squared;
        }
        fraction
    }

    #[inline(always)]
    pub(super) fn depth_of<S: Lanes>(
        &self,
        s: S,
        pixels: WindowPixels<S>,
        sample: [f32; 2],
    ) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        mix(s, a.z, b.z, self.fraction(s, pixels, sample))
    }

    #[inline(always)]
    pub(super) fn inverse_w_of<S: Lanes>(&self, s: S, pixels: WindowPixels<S>) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        if a.iw.to_bits() == b.iw.to_bits() {
            return SimdBase::splat(s, a.iw);
        }
        mix(s, a.iw, b.iw, self.fraction(s, pixels, [0.5; 2]))
    }

    #[inline(always)]
    pub(super) fn varyings_of<S: Lanes>(
        &self,
        s: S,
        pixels: WindowPixels<S>,
        out: &mut [Packet<f32>],
    ) {
        let [a, b] = &self.line.ends;
        let (from, to) = (self.source.of(a.vertex), self.source.of(b.vertex));
        // No vertex is provoking where none need be.
        let has_flat = self.source.modes.contains(&Interpolation::Flat);
        let provoking = if has_flat {
            self.line.provoking
        } else {
            a.vertex
        };
        let provoking = self.source.of(provoking);
        let t = self.fraction(s, pixels, [0.5; 2]);
        let perspective = a.iw.to_bits() != b.iw.to_bits();
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let w = one / mix(s, a.iw, b.iw, t);
        let (out, derivatives) = out.split_at_mut(self.source.modes.len());
        for (k, packet) in out.iter_mut().enumerate() {
            let value = match self.source.modes[k] {
                Interpolation::Flat => SimdBase::splat(s, provoking[k]),
                Interpolation::Smooth if perspective => mix(s, from[k] * a.iw, to[k] * b.iw, t) * w,
                _ => mix(s, from[k], to[k], t),
            };
            value.store_array(&mut packet.0);
        }
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let [slope_x, slope_y] = self.slopes();
        let (along_x, along_y) = derivatives.split_at_mut(self.source.gradients.len());
        let along = along_x.iter_mut().zip(along_y);
        for ((along_x, along_y), &k) in along.zip(self.source.gradients) {
            let [x, y] = match self.source.modes[k] {
                Interpolation::Flat => [splat(0.0); 2],
                Interpolation::Smooth if perspective => {
                    let value = f32x16::load_array_ref(s, &out[k].0);
                    let (change, of_iw) = (to[k] * b.iw - from[k] * a.iw, b.iw - a.iw);
                    smooth_derivatives(
                        [splat(change * slope_x), splat(change * slope_y)],
                        value,
                        [splat(of_iw * slope_x), splat(of_iw * slope_y)],
                        w,
                    )
                }
                _ => {
                    let change = to[k] - from[k];
                    [splat(change * slope_x), splat(change * slope_y)]
                }
            };
            x.store_array(&mut along_x.0);
            y.store_array(&mut along_y.0);
        }
    }

    /// How the fraction of the way changes from a pixel to the next one on the right, and to the
    /// next one below.
    fn slopes(&self) -> [f32; 2] {
        if self.rectangle.is_none() {
            let slope = 256.0 / self.axis.delta[0] as f32;
            return if self.axis.x_major {
                [slope, 0.0]
            } else {
                [0.0, slope]
            };
        }
        let squared = length_squared(&self.line) as f32;
        self.way.map(|way| 256.0 * way as f32 / squared)
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
        self.depth_of(s, WindowPixels::of_packet(s, pixel), sample)
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        self.inverse_w_of(s, WindowPixels::of_packet(s, pixel))
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        self.varyings_of(s, WindowPixels::of_packet(s, pixel), out);
    }
}
