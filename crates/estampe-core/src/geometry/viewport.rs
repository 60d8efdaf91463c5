//! From clip space to the window (A4, X5).
//!
//! *In* clip-space vertices · *Out* snapped window positions, depth and 1/w · *Precision* f32, then
//! 1/256 pixel · *Spec* Vulkan §Coordinate Transformations; `docs/NUMERICS.md`.

use estampe_simd::{Lanes, Select, SimdBase, f32x16, i32x16, mask32x16, outline};
use estampe_types::state::Viewport;

/// The least window coordinate that needs no clipping, in pixels.
pub(crate) const GUARD_MIN: f32 = -8192.0;
/// The greatest: the guard band is 2¹⁵ pixels in all, so differences of positions in 1/256 pixel
/// fit 24 bits and products of two of them 48.
pub(crate) const GUARD_MAX: f32 = 24_575.0;

/// The least w that is not clipped where depth is not.
pub(crate) const LEAST_W: f32 = 1.0 / 1_048_576.0;

/// The largest magnitude of a vertex's depth where depth is not clipped; the depth is clamped to
/// it.
const FARTHEST: f32 = 16_777_216.0;

/// The viewport's constants, as `docs/NUMERICS.md` rounds them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ViewportTransform {
    pub(crate) scale: [f32; 3],
    pub(crate) offset: [f32; 3],
    /// The range that depth is clamped to.
    pub(crate) depth_range: [f32; 2],
    /// True if depth is not clipped.
    pub(crate) unclipped_depth: bool,
}

/// A vertex in the window, before it is snapped.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projected {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) iw: f32,
}

/// Sixteen vertices in the window, snapped; those that are not inside need clipping.
pub(crate) struct ProjectedLanes<S: Lanes> {
    pub(crate) x: i32x16<S>,
    pub(crate) y: i32x16<S>,
    pub(crate) z: f32x16<S>,
    pub(crate) iw: f32x16<S>,
    pub(crate) inside: mask32x16<S>,
}

impl ViewportTransform {
    pub(crate) fn new(viewport: &Viewport, unclipped_depth: bool) -> Self {
        let (sx, sy) = (viewport.width * 0.5, viewport.height * -0.5);
        let (near, far) = (viewport.min_depth, viewport.max_depth);
        Self {
            scale: [sx, sy, far - near],
            offset: [viewport.x + sx, viewport.y + viewport.height * 0.5, near],
            // Two tests, so that ±0 comes out as min and max of NUMERICS.md give it.
            depth_range: [
                if near < far { near } else { far },
                if near > far { near } else { far },
            ],
            unclipped_depth,
        }
    }

    /// One vertex; meaningless unless w > 0.
    pub(crate) fn project(&self, [x, y, z, w]: [f32; 4]) -> Projected {
        let iw = 1.0 / w;
        let mut z = (z * iw) * self.scale[2] + self.offset[2];
        if self.unclipped_depth {
            // NaN becomes the least, as in the lanes.
            z = if z > -FARTHEST {
                z.min(FARTHEST)
            } else {
                -FARTHEST
            };
        }
        Projected {
            x: (x * iw) * self.scale[0] + self.offset[0],
            y: (y * iw) * self.scale[1] + self.offset[1],
            z,
            iw,
        }
    }

    /// Returns true if a position lies between the planes that bound depth, or, where depth is not
    /// clipped, if its w is at least [`LEAST_W`].
    pub(crate) fn is_in_depth(&self, [_, _, z, w]: [f32; 4]) -> bool {
        if self.unclipped_depth {
            w >= LEAST_W
        } else {
            (0.0..=w).contains(&z) && w > 0.0
        }
    }

    /// Sixteen vertices: x and y snapped, z, 1/w, and which of them need no clipping.
    #[inline(always)]
    pub(crate) fn project_lanes<S: Lanes>(
        &self,
        s: S,
        [x, y, z, w]: [f32x16<S>; 4],
    ) -> ProjectedLanes<S> {
        outline!(s, {
            let splat = |value: f32| <f32x16<S> as SimdBase<S>>::splat(s, value);
            let iw = splat(1.0) / w;
            let xw = (x * iw) * splat(self.scale[0]) + splat(self.offset[0]);
            let yw = (y * iw) * splat(self.scale[1]) + splat(self.offset[1]);
            let mut zw = (z * iw) * splat(self.scale[2]) + splat(self.offset[2]);
            let zero = splat(0.0);
            let (low, high) = (splat(GUARD_MIN), splat(GUARD_MAX));
            // An infinite w has a finite inverse, but the vertex is not finite.
            let infinity = splat(f32::INFINITY);
            let in_depth = if self.unclipped_depth {
                zw = s.min_f32(s.max_f32(zw, splat(-FARTHEST)), splat(FARTHEST));
                let magnitude = s.max_f32(z, -z);
                w.simd_ge(splat(LEAST_W)) & magnitude.simd_lt(infinity)
            } else {
                z.simd_ge(zero) & z.simd_le(w) & w.simd_gt(zero)
            };
            let inside = in_depth
                & w.simd_lt(infinity)
                & iw.simd_lt(infinity)
                & xw.simd_ge(low)
                & xw.simd_le(high)
                & yw.simd_ge(low)
                & yw.simd_le(high);
            let (x, y) = (snap_lanes(s, xw), snap_lanes(s, yw));
            ProjectedLanes {
                x,
                y,
                z: zw,
                iw,
                inside,
            }
        })
    }
}

/// Returns true if a window position lies within the guard band; false for NaN.
pub(crate) fn is_within_guard_band(x: f32, y: f32) -> bool {
    (GUARD_MIN..=GUARD_MAX).contains(&x) && (GUARD_MIN..=GUARD_MAX).contains(&y)
}

/// Rounds a window coordinate to 1/256 pixel, half to even. Clipped vertices lie up to a pixel
/// outside the guard band; the clamp is for those that rounding moved further, or that overflowed.
/// NaN gives the least value.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the clamp keeps it below 2²³"
)]
pub(crate) fn snap(coordinate: f32) -> i32 {
    let (low, high) = (GUARD_MIN - 2.0, GUARD_MAX + 2.0);
    let at_least = if coordinate > low { coordinate } else { low };
    (at_least.min(high) * 256.0).round_ties_even() as i32
}

/// Snaps sixteen coordinates within the guard band as [`snap`] does; the result for others is
/// unspecified.
///
/// `round_to_i32` is exact up to 2²² = 16384 pixels. Greater values are multiples of ½, so 2²² is
/// subtracted without rounding and added again as an integer.
#[inline(always)]
fn snap_lanes<S: Lanes>(s: S, coordinate: f32x16<S>) -> i32x16<S> {
    let scaled = coordinate * 256.0;
    let base = <f32x16<S> as SimdBase<S>>::splat(s, 4_194_304.0);
    let high = scaled.simd_ge(base);
    let rounded = s.round_to_i32(high.select(scaled - base, scaled));
    let back = <i32x16<S> as SimdBase<S>>::splat(s, 1 << 22);
    high.select(rounded + back, rounded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{LANES, Level, dispatch};

    #[inline(always)]
    fn snapped<S: Lanes>(s: S, values: [f32; LANES]) -> [i32; LANES] {
        snap_lanes(s, f32x16::load_array(s, values)).to_array()
    }

    #[test]
    fn sixteen_snap_like_one() {
        let mut value = GUARD_MIN;
        while value < GUARD_MAX {
            let values: [f32; LANES] =
                std::array::from_fn(|i| (value + i as f32 * 7.001_953).min(GUARD_MAX));
            for level in Level::all_available() {
                let got = dispatch!(level, s => snapped(s, values));
                assert_eq!(got, values.map(snap), "{level:?} {values:?}");
            }
            value += 13.37;
        }
        let ties: [f32; LANES] = std::array::from_fn(|i| 16_383.0 + (i as f32 * 0.5 + 0.5) / 256.0);
        for level in Level::all_available() {
            assert_eq!(
                dispatch!(level, s => snapped(s, ties)),
                ties.map(snap),
                "{level:?}"
            );
        }
    }
}
