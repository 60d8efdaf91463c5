//! Perspective division and viewport: from clip space to window space, snapped to 1/256 pixel.
//!
//! In · Out: clip vertices · window vertices. Space: clip space, y up, to window space, y down.
//! Spec: NUMERICS.md, *From clip space to the window*.

use crate::ClipVertex;
use crate::arithmetic::{clamp, max, min, round_half_even};
use crate::raster::sample_positions;
use estampe_types::state::{ScissorRect, Viewport};
use std::ops::Range;

/// The least window coordinate inside the guard band, in pixels.
pub const GUARD_BAND_MIN: f32 = -8192.0;
/// The greatest window coordinate inside the guard band, in pixels.
pub const GUARD_BAND_MAX: f32 = 24_575.0;

/// The least window coordinate of a snapped vertex. Clipped vertices lie up to a pixel outside the
/// guard band, plus or minus their rounding.
const SNAPPED_MIN: f32 = GUARD_BAND_MIN - 2.0;
const SNAPPED_MAX: f32 = GUARD_BAND_MAX + 2.0;

/// The viewport as scale and offset of NDC x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewportTransform {
    /// `sx`, `sy`, `sz`.
    pub scale: [f32; 3],
    /// `ox`, `oy`, `oz`.
    pub offset: [f32; 3],
    /// The least and the greatest depth of the viewport.
    pub depth_range: [f32; 2],
    /// If set, depth is clamped instead of clipped.
    pub unclipped_depth: bool,
}

/// The least w of a position if depth is not clipped: 2⁻²⁰.
pub const LEAST_W: f32 = 1.0 / 1_048_576.0;

/// If depth is not clipped, the depth of vertices is clamped to this magnitude: 2²⁴.
pub const FARTHEST: f32 = 16_777_216.0;

/// Returns true if a viewport draws: its numbers are within the limits of the arithmetic.
#[must_use]
pub fn is_drawable(viewport: &Viewport) -> bool {
    let v = viewport;
    let are_places = [v.x, v.y].map(|edge| (-32_768.0..=32_767.0).contains(&edge));
    let are_sizes = [v.width, v.height].map(|size| 0.0 < size && size <= 32_768.0);
    let are_depths = [v.min_depth, v.max_depth].map(|depth| (0.0..=1.0).contains(&depth));
    [are_places, are_sizes, are_depths] == [[true; 2]; 3]
}

/// A position in window space, before snapping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowPosition {
    /// Pixels from the left edge.
    pub x: f32,
    /// Pixels from the top edge, downwards.
    pub y: f32,
    /// Depth.
    pub z: f32,
    /// 1 ÷ w of clip space.
    pub inverse_w: f32,
}

/// A vertex in window space, snapped.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowVertex {
    /// x and y in 1/256 pixel.
    pub snapped: [i32; 2],
    /// Depth, not clamped to the viewport's range.
    pub z: f32,
    /// 1 ÷ w of clip space.
    pub inverse_w: f32,
    /// The scalars of the varyings, in order, as the shader wrote them.
    pub varyings: Vec<f32>,
}

impl ViewportTransform {
    /// The scale and offset of a viewport; depth is clipped.
    #[must_use]
    pub fn new(viewport: &Viewport) -> Self {
        let v = viewport;
        let scale_x = v.width * 0.5;
        Self {
            scale: [scale_x, v.height * -0.5, v.max_depth - v.min_depth],
            offset: [v.x + scale_x, v.y + v.height * 0.5, v.min_depth],
            depth_range: [min(v.min_depth, v.max_depth), max(v.min_depth, v.max_depth)],
            unclipped_depth: false,
        }
    }

    /// The transform with depth clipping off (`true`) or on.
    #[must_use]
    pub fn with_unclipped_depth(self, unclipped_depth: bool) -> Self {
        Self {
            unclipped_depth,
            ..self
        }
    }

    /// Divides by w and maps NDC to the window.
    #[must_use]
    pub fn window(&self, [x, y, z, w]: [f32; 4]) -> WindowPosition {
        let inverse_w = 1.0 / w;
        let map =
            |value: f32, axis: usize| (value * inverse_w) * self.scale[axis] + self.offset[axis];
        let z = map(z, 2);
        WindowPosition {
            x: map(x, 0),
            y: map(y, 1),
            z: if self.unclipped_depth {
                clamp(z, -FARTHEST, FARTHEST)
            } else {
                z
            },
            inverse_w,
        }
    }

    /// Transforms and snaps a vertex after clipping. x and y are clamped to two pixels around the
    /// guard band, which changes no vertex inside the band.
    #[must_use]
    pub fn place(&self, vertex: &ClipVertex) -> WindowVertex {
        let position = self.window(vertex.position);
        let confine = |pixels| clamp(pixels, SNAPPED_MIN, SNAPPED_MAX);
        WindowVertex {
            snapped: [snap(confine(position.x)), snap(confine(position.y))],
            z: position.z,
            inverse_w: position.inverse_w,
            varyings: vertex.varyings.clone(),
        }
    }

    /// Clamps a depth to the viewport's range.
    #[must_use]
    pub fn clamp_depth(&self, depth: f32) -> f32 {
        clamp(depth, self.depth_range[0], self.depth_range[1])
    }
}

/// The nearest multiple of 1/256 pixel, ties to even, as an integer.
#[must_use]
pub fn snap(pixels: f32) -> i32 {
    round_half_even(pixels * 256.0)
}

/// A rectangle of pixels, half-open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PixelBounds {
    /// Columns.
    pub x: Range<u32>,
    /// Rows.
    pub y: Range<u32>,
}

impl PixelBounds {
    /// Viewport ∩ scissor ∩ target: the pixels that a draw may write. The columns and rows of the
    /// viewport are those in which samples may be inside; [`ViewportSamples`] decides for each
    /// sample.
    #[must_use]
    pub fn new(
        viewport: &Viewport,
        scissor: &ScissorRect,
        [width, height]: [u32; 2],
        samples: u32,
    ) -> Self {
        let offsets = sample_positions(samples).as_flattened().iter();
        let offset = |sixteenths: Option<&u8>| f64::from(*sixteenths.unwrap_or(&8)) / 16.0;
        let (least, most) = (offset(offsets.clone().min()), offset(offsets.max()));
        let axis = |start: f32, extent: f32, first: u32, count: u32, size: u32| {
            let (start, extent) = (f64::from(start), f64::from(extent));
            let end = start + extent;
            // Keep the first column if its last sample is inside, and the last column if its first
            // sample is.
            let low = start.floor() + f64::from(u8::from(start.floor() + most < start));
            let high = end.floor() + f64::from(u8::from(end.floor() + least < end));
            let low = whole(low).max(first);
            let high = whole(high).min(first.saturating_add(count)).min(size);
            low..high.max(low)
        };
        Self {
            x: axis(viewport.x, viewport.width, scissor.x, scissor.width, width),
            y: axis(
                viewport.y,
                viewport.height,
                scissor.y,
                scissor.height,
                height,
            ),
        }
    }

    /// The pixels of both rectangles.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let both = |a: &Range<u32>, b: &Range<u32>| {
            let start = a.start.max(b.start);
            start..a.end.min(b.end).max(start)
        };
        Self {
            x: both(&self.x, &other.x),
            y: both(&self.y, &other.y),
        }
    }

    /// Returns true if a pixel lies inside.
    #[must_use]
    pub fn contains(&self, [x, y]: [i64; 2]) -> bool {
        let within =
            |range: &Range<u32>, at: i64| i64::from(range.start) <= at && at < i64::from(range.end);
        within(&self.x, x) && within(&self.y, y)
    }
}

/// A non-negative number of pixels as an integer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates: beyond every target"
)]
fn whole(edge: f64) -> u32 {
    edge as u32
}

/// The samples inside a viewport: those whose positions it contains, left and top edges included.
#[derive(Debug, Clone)]
pub struct ViewportSamples {
    x: Range<f64>,
    y: Range<f64>,
}

impl ViewportSamples {
    /// The samples inside `viewport`.
    #[must_use]
    pub fn new(viewport: &Viewport) -> Self {
        let axis = |start: f32, extent: f32| f64::from(start)..f64::from(start) + f64::from(extent);
        Self {
            x: axis(viewport.x, viewport.width),
            y: axis(viewport.y, viewport.height),
        }
    }

    /// Returns true if a position in 1/256 pixel lies inside.
    #[must_use]
    pub fn contains(&self, [x, y]: [i64; 2]) -> bool {
        // Exact: positions in a target are far below 2⁵³.
        let pixels = |subpixels: i64| subpixels as f64 / 256.0;
        self.x.contains(&pixels(x)) && self.y.contains(&pixels(y))
    }
}
