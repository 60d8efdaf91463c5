//! Alpha tests of fragments that are not shaded yet.
//!
//! In: an [`AlphaTest`], the planes of texture coordinates · Out: of sixteen fragments those that
//! may have an effect.\
//! Precision: conservative. Texels that are read by rounding alone have weights below 1/256, which
//! the map allows for.

use super::cross_triangle::{CrossPlanes, evaluate as evaluate_lanes};
use super::interpolate::{TriangleInterpolant, evaluate, smooth_derivatives};
use crate::bounds::lane_order::LaneOrder;
use estampe_simd::{Bytes, LANES, Lanes, SimdBase, SimdCvtTruncate, f32x16, i32x16, u32x16};
use estampe_types::shader::{ALPHA_CELLS, ALPHA_STEPS, AlphaMap, AlphaTest};

/// Coordinates from here on are not looked up if they repeat: they hardly say which texel they are
/// in.
const MOST: f32 = 16_384.0;

/// Where sixteen fragments are in the texture of a test.
#[derive(Clone, Copy)]
pub(crate) struct AlphaPlaces<S: Lanes> {
    /// u and v.
    at: [f32x16<S>; 2],
    /// Their derivatives along x, then along y.
    derivatives: [[f32x16<S>; 2]; 2],
    layer: i32x16<S>,
}

impl CrossPlanes {
    /// The places of fragments of sixteen triangles, given by their distances from the planes'
    /// origins.
    #[inline(always)]
    pub(crate) fn alpha_places<S: Lanes>(
        &self,
        s: S,
        order: impl LaneOrder<S>,
        test: &AlphaTest,
        distances: [f32x16<S>; 2],
    ) -> AlphaPlaces<S> {
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let [origin, dx, dy] = &self.iw;
        let w = one / evaluate_lanes(s, [origin, dx, dy], order, distances);
        let of_iw = [order.permuted(s, &dx.0), order.permuted(s, &dy.0)];
        let (mut at, mut x, mut y) = ([w; 2], [w; 2], [w; 2]);
        for (axis, scalar) in test.at.into_iter().enumerate() {
            let (dx, dy) = (&self.dx[scalar], &self.dy[scalar]);
            let plane = [&self.corners[0][scalar], dx, dy];
            at[axis] = evaluate_lanes(s, plane, order, distances) * w;
            let slopes = [order.permuted(s, &dx.0), order.permuted(s, &dy.0)];
            [x[axis], y[axis]] = smooth_derivatives(slopes, at[axis], of_iw, w);
        }
        let layer = match test.layer {
            Some(scalar) => order.permuted(s, &self.corners[0][scalar].0).bitcast(),
            None => SimdBase::splat(s, 0),
        };
        AlphaPlaces {
            at,
            derivatives: [x, y],
            layer,
        }
    }
}

impl TriangleInterpolant<'_> {
    /// The places of a packet's fragments.
    #[inline(always)]
    pub(crate) fn alpha_places<S: Lanes>(
        &self,
        s: S,
        test: &AlphaTest,
        pixel: [i32; 2],
    ) -> AlphaPlaces<S> {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let distances = self.origin.distances(s, pixel, [0.5; 2]);
        let (mut w, mut of_iw) = (splat(1.0), [splat(0.0); 2]);
        if !self.equal_w {
            w /= evaluate(s, &self.iw, distances);
            of_iw = [splat(self.iw.dx), splat(self.iw.dy)];
        }
        let (mut at, mut x, mut y) = ([w; 2], [w; 2], [w; 2]);
        for (axis, scalar) in test.at.into_iter().enumerate() {
            let plane = self.planes.of(scalar);
            at[axis] = evaluate(s, &plane, distances) * w;
            let slopes = [splat(plane.dx), splat(plane.dy)];
            [x[axis], y[axis]] = smooth_derivatives(slopes, at[axis], of_iw, w);
        }
        let layer = test
            .layer
            .map_or(0.0, |scalar| self.planes.of(scalar).origin);
        AlphaPlaces {
            at,
            derivatives: [x, y],
            layer: SimdBase::splat(s, layer.to_bits().cast_signed()),
        }
    }
}

/// The fragments that may have an effect; with `quads`, all of a quad if one of them may.
#[inline(always)]
pub(crate) fn may_pass<S: Lanes>(
    s: S,
    test: &AlphaTest,
    places: &AlphaPlaces<S>,
    quads: bool,
) -> u16 {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let map = &*test.map;
    let [u, v] = places.at;
    let rho2 = if test.of_quads {
        let first = lanes_of_quads(s, 0);
        let from_first = [u - s.permute_f32(u, first), v - s.permute_f32(v, first)];
        let all = squared(map, from_first);
        s.max_f32(
            s.permute_f32(all, lanes_of_quads(s, 1)),
            s.permute_f32(all, lanes_of_quads(s, 2)),
        )
    } else {
        let [x, y] = places.derivatives;
        s.max_f32(squared(map, x), squared(map, y))
    };
    let row = row_of(s, map, (rho2, places.layer)) + cell(s, v, map.repeats[1]);
    let words = s.gather(&map.rows, row.bitcast());
    let column: u32x16<S> = cell(s, u, map.repeats[0]).bitcast();
    let one = <u32x16<S> as SimdBase<S>>::splat(s, 1);
    let passes = ((words >> column) & one).simd_eq(one);
    // Numbers that are not finite give NaN, which is not 0.
    let mut is_known = ((u + v + rho2) * 0.0).simd_eq(splat(0.0));
    if map.repeats[0] | map.repeats[1] {
        is_known &= s
            .max_f32(s.max_f32(u, -u), s.max_f32(v, -v))
            .simd_lt(splat(MOST));
    }
    let lanes = s.bits_of_mask(passes | !is_known);
    if quads { whole_quads(lanes) } else { lanes }
}

/// All lanes of the quads of which one is in a mask.
#[inline(always)]
pub(crate) fn whole_quads(lanes: u16) -> u16 {
    ((lanes | lanes >> 1 | lanes >> 2 | lanes >> 3) & 0x1111) * 0xF
}

/// The squared length of a derivative in texels of the base level.
#[inline(always)]
fn squared<S: Lanes>(map: &AlphaMap, [u, v]: [f32x16<S>; 2]) -> f32x16<S> {
    let (x, y) = (u * map.size[0], v * map.size[1]);
    x * x + y * y
}

/// The first row of cells of each lane's step and layer.
#[inline(always)]
fn row_of<S: Lanes>(s: S, map: &AlphaMap, (rho2, layer): (f32x16<S>, i32x16<S>)) -> i32x16<S> {
    let whole = |value: u32| <i32x16<S> as SimdBase<S>>::splat(s, value.cast_signed());
    // Two for each power of 2.
    const { assert!(ALPHA_STEPS == 4) }
    let bits: i32x16<S> = rho2.bitcast();
    let step = (bits >> 22) - whole(2 * 127);
    let step = step.max(whole(map.steps[0])).min(whole(map.steps[1]));
    let layer = layer.max(whole(0)).min(whole(map.layers.saturating_sub(1)));
    (step * whole(map.layers) + layer) << ALPHA_CELLS.ilog2()
}

/// The cell along an axis.
#[inline(always)]
fn cell<S: Lanes>(s: S, at: f32x16<S>, repeats: bool) -> i32x16<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let (at, last) = (at * ALPHA_CELLS as f32, splat(ALPHA_CELLS as f32 - 1.0));
    if repeats {
        i32x16::truncate_from(s.floor_f32(at)) & i32x16::truncate_from(last)
    } else {
        i32x16::truncate_from(s.min_f32(s.max_f32(at, splat(0.0)), last))
    }
}

/// The lanes of one fragment of each quad.
#[inline(always)]
fn lanes_of_quads<S: Lanes>(s: S, lane: u32) -> u32x16<S> {
    const FIRST: [u32; LANES] = [0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12];
    u32x16::load_array(s, FIRST) + lane
}
