//! Depths as an attachment stores them (D1): f32 in memory, of fixed-point formats the number
//! nearest to the code's.
//!
//! Different codes have different numbers, in the same order, so that comparing numbers is
//! comparing codes.

use estampe_format::depth::FixedDepth;
use estampe_simd::{Lanes, SimdBase, f32x16, outline};
use estampe_types::TextureFormat;

/// The precision of a depth attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DepthFormat {
    Float,
    Fixed(FixedDepth),
}

impl DepthFormat {
    pub(crate) fn new(format: Option<TextureFormat>) -> Self {
        let fixed = format.and_then(FixedDepth::new);
        fixed.map_or(Self::Float, Self::Fixed)
    }

    /// A depth in 0..=1 as it is stored.
    #[inline(always)]
    pub(crate) fn stored(self, depth: f32) -> f32 {
        match self {
            Self::Float => depth,
            Self::Fixed(fixed) => fixed.stored(depth),
        }
    }

    /// Sixteen depths in 0..=1, stored or about to be, as numbers that compare as stored depths do:
    /// codes, which need no division.
    #[inline(always)]
    pub(crate) fn codes<S: Lanes>(self, s: S, depth: f32x16<S>) -> f32x16<S> {
        match self {
            Self::Float => depth,
            Self::Fixed(fixed) => fixed.rounded_lanes(s, depth),
        }
    }

    /// The distance of two neighbouring codes; 0 of float depth.
    pub(crate) fn step(self) -> f32 {
        match self {
            Self::Float => 0.0,
            Self::Fixed(fixed) => fixed.decode(1),
        }
    }

    /// [`DepthFormat::stored`] of sixteen depths.
    #[inline(always)]
    pub(crate) fn stored_lanes<S: Lanes>(self, s: S, depth: f32x16<S>) -> f32x16<S> {
        match self {
            Self::Float => depth,
            Self::Fixed(fixed) => fixed.stored_lanes(s, depth),
        }
    }
}

/// Depth clamped to the viewport's range; NaN becomes its lower end.
#[inline(always)]
pub(crate) fn clamp_depth<S: Lanes>(s: S, depth: f32x16<S>, [low, high]: [f32; 2]) -> f32x16<S> {
    outline!(s, {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        s.min_f32(s.max_f32(depth, splat(low)), splat(high))
    })
}

/// The depths of a draw as they are compared and stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StoredDepth {
    /// The range that depth is clamped to: the viewport's.
    pub(crate) range: [f32; 2],
    pub(crate) format: DepthFormat,
}

impl StoredDepth {
    /// Sixteen interpolated depths as they are stored.
    #[inline(always)]
    pub(crate) fn of<S: Lanes>(self, s: S, depth: f32x16<S>) -> f32x16<S> {
        self.format
            .stored_lanes(s, clamp_depth(s, depth, self.range))
    }
}
