//! From vertices to fragments: depth and varyings of triangles, lines and points at sixteen pixels.
//!
//! Each kind of primitive is an [`Interpolant`]: a value that gives its depth at any sample and its
//! varyings at any pixel. Planes are evaluated anew at each pixel, from the first sorted vertex:
//! `p₀ + ((X − x₀)·∂p/∂x + (Y − y₀)·∂p/∂y)`.

mod block;
mod line;
mod pixels;
mod planes;
mod point;
mod triangle;
mod varyings;

pub(crate) use line::LineInterpolant;
pub(crate) use pixels::WindowPixels;
pub(crate) use planes::{DepthPlane, PlaneBlock, PlaneOrigin, evaluate};
pub(crate) use point::PointInterpolant;
pub(crate) use triangle::{TriangleInterpolant, smooth_derivatives};
pub(crate) use varyings::{VaryingPlanes, VaryingSource, set_planes};

use estampe_simd::{LANES, Lanes, Packet, f32x16};

/// A primitive whose values can be interpolated.
pub(crate) trait Interpolant<S: Lanes> {
    /// Depth at a sample offset (in pixels) of the packet's sixteen pixels, not yet clamped.
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S>;
    /// 1/w at the pixels' centres.
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S>;
    /// The varyings at the pixels' centres, as many packets as there are scalars.
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]);

    /// 1/w at a place of each pixel; of lines and points at the centres.
    #[inline(always)]
    fn inverse_w_at(&self, s: S, pixel: [i32; 2], _places: &PixelOffsets) -> f32x16<S> {
        self.inverse_w(s, pixel)
    }

    /// The varyings at a place of each pixel; of lines and points at the centres.
    #[inline(always)]
    fn varyings_in(&self, s: S, pixel: [i32; 2], _places: &PixelOffsets, out: &mut [Packet<f32>]) {
        self.varyings(s, pixel, out);
    }
}

/// A primitive that can be interpolated at any pixels.
pub(crate) trait PixelInterpolant<S: Lanes>: Interpolant<S> {
    /// The varyings at the pixels' centres.
    fn varyings_of(&self, s: S, pixels: WindowPixels<S>, out: &mut [Packet<f32>]);
    /// Depth at a sample offset (in pixels) of the pixels, not yet clamped.
    fn depth_of(&self, s: S, pixels: WindowPixels<S>, sample: [f32; 2]) -> f32x16<S>;
    /// 1/w at the pixels' centres.
    fn inverse_w_of(&self, s: S, pixels: WindowPixels<S>) -> f32x16<S>;
}

/// A line or a point: code for either is compiled once.
#[derive(Debug, Clone, Copy)]
pub(crate) enum LineOrPoint<'a> {
    Line(LineInterpolant<'a>),
    Point(PointInterpolant<'a>),
}

impl<S: Lanes> Interpolant<S> for LineOrPoint<'_> {
    #[inline(always)]
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S> {
        match self {
            Self::Line(line) => line.depth(s, pixel, sample),
            Self::Point(point) => point.depth(s, pixel, sample),
        }
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        match self {
            Self::Line(line) => line.inverse_w(s, pixel),
            Self::Point(point) => point.inverse_w(s, pixel),
        }
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        match self {
            Self::Line(line) => line.varyings(s, pixel, out),
            Self::Point(point) => point.varyings(s, pixel, out),
        }
    }
}

impl<S: Lanes> PixelInterpolant<S> for LineOrPoint<'_> {
    #[inline(always)]
    fn varyings_of(&self, s: S, pixels: WindowPixels<S>, out: &mut [Packet<f32>]) {
        match self {
            Self::Line(line) => line.varyings_of(s, pixels, out),
            Self::Point(point) => point.varyings(s, [0; 2], out),
        }
    }

    #[inline(always)]
    fn depth_of(&self, s: S, pixels: WindowPixels<S>, sample: [f32; 2]) -> f32x16<S> {
        match self {
            Self::Line(line) => line.depth_of(s, pixels, sample),
            Self::Point(point) => point.depth(s, [0; 2], sample),
        }
    }

    #[inline(always)]
    fn inverse_w_of(&self, s: S, pixels: WindowPixels<S>) -> f32x16<S> {
        match self {
            Self::Line(line) => line.inverse_w_of(s, pixels),
            Self::Point(point) => point.inverse_w(s, [0; 2]),
        }
    }
}

/// An offset in each of sixteen pixels, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PixelOffsets {
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
}

impl PixelOffsets {
    /// One offset for every pixel.
    pub(crate) fn all([x, y]: [f32; 2]) -> Self {
        Self {
            x: [x; LANES],
            y: [y; LANES],
        }
    }
}
