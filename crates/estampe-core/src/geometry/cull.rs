//! Culling (A2): sixteen triangles at a time, most of which end here.
//!
//! *In* vertices of sixteen triangles · *Out* which of them are visible, and which are to be
//! clipped · *Space* window, 1/256 pixel · *Precision* exact.
//!
//! In a mesh of a million triangles three of four face away, have no area or have no sample's
//! centre in their box; they are dropped before anything is computed for them alone. Areas are
//! 32-bit products where a triangle's extent is below 2¹⁵ (128 pixels); those of larger ones are
//! computed one by one in 64 bits.

use super::plan::GeometryPlan;
use super::shaded_vertices::{NEEDS_CLIPPING, PackedVertex};
use estampe_simd::{
    Bytes, LANES, Lane, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, outline, u32x16,
};
use std::ops::Range;

/// Sixteen assembled triangles: the vertices that they join, and where these lie in the window.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct TriangleGroup {
    /// The sub-draw's vertices of each triangle.
    pub(crate) vertices: [[u32; 3]; LANES],
    /// x and y of each, corner by corner.
    positions: [[u64; LANES]; 3],
}

impl TriangleGroup {
    /// Reads x and y of the vertices, each pair as one load of 64 bits: on Zen 4 48 of these take
    /// half of the time of six gathers. On Intel it is the other way round: see
    /// [`WindowTriangles::gather`].
    #[inline(always)]
    pub(crate) fn read_positions(&mut self, window: &[PackedVertex]) {
        for (lane, vertices) in self.vertices.iter().enumerate() {
            for (positions, &vertex) in self.positions.iter_mut().zip(vertices) {
                // In range: a sub-draw's vertices are all that its indices name.
                let [x, y, ..] = window[vertex as usize];
                positions[lane] = u64::from(x) | u64::from(y) << 32;
            }
        }
    }
}

impl TriangleGroup {
    /// Reads x and y of the vertices in some lanes. Returns true if one needs clipping.
    #[inline(always)]
    pub(crate) fn read_lanes(&mut self, lanes: Range<usize>, window: &[PackedVertex]) -> bool {
        let mut needs_clipping = false;
        for (at, vertices) in self.vertices[lanes.clone()].iter().enumerate() {
            for (positions, &vertex) in self.positions.iter_mut().zip(vertices) {
                let [x, y, ..] = window[vertex as usize];
                needs_clipping |= x.cast_signed() == NEEDS_CLIPPING;
                positions[lanes.start + at] = u64::from(x) | u64::from(y) << 32;
            }
        }
        needs_clipping
    }
}

/// Sixteen triangles in the window: x and y of their three vertices.
pub(crate) struct WindowTriangles<S: Lanes> {
    pub(crate) x: [i32x16<S>; 3],
    pub(crate) y: [i32x16<S>; 3],
}

impl<S: Lanes> WindowTriangles<S> {
    #[inline(always)]
    pub(crate) fn new(s: S, group: &TriangleGroup) -> Self {
        let [x0, y0] = xy_of(s, &group.positions[0]);
        let [x1, y1] = xy_of(s, &group.positions[1]);
        let [x2, y2] = xy_of(s, &group.positions[2]);
        Self {
            x: [x0, x1, x2],
            y: [y0, y1, y2],
        }
    }

    /// The triangles that join these vertices, of which the window has fewer than 2²⁹.
    #[inline(always)]
    pub(crate) fn gather(s: S, window: &[PackedVertex], vertices: &[u32x16<S>; 3]) -> Self {
        let words = window.as_flattened();
        let [x0, y0] = s.gather_pair(words, vertices[0] << 2);
        let [x1, y1] = s.gather_pair(words, vertices[1] << 2);
        let [x2, y2] = s.gather_pair(words, vertices[2] << 2);
        Self {
            x: [x0.bitcast(), x1.bitcast(), x2.bitcast()],
            y: [y0.bitcast(), y1.bitcast(), y2.bitcast()],
        }
    }

    /// The doubled signed area of one triangle in 1/256 pixel², exact.
    pub(crate) fn doubled_area(&self, lane: Lane) -> i64 {
        let x = |corner: usize| i64::from(self.x[corner].as_slice()[lane.get()]);
        let y = |corner: usize| i64::from(self.y[corner].as_slice()[lane.get()]);
        (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0))
    }
}

#[inline(always)]
fn xy_of<S: Lanes>(s: S, words: &[u64; LANES]) -> [i32x16<S>; 2] {
    outline!(s, {
        let (mut low, mut high) = (s.splat_u64x8(0), s.splat_u64x8(0));
        low.as_mut_slice().copy_from_slice(&words[..LANES / 2]);
        high.as_mut_slice().copy_from_slice(&words[LANES / 2..]);
        let (x, y) = s.deinterleave_u32x16(low.bitcast(), high.bitcast());
        [x.bitcast(), y.bitcast()]
    })
}

/// Sixteen classified triangles, as masks of lanes. Triangles in neither mask are culled.
pub(crate) struct Classified<S: Lanes> {
    /// To be set up.
    pub(crate) visible: u16,
    /// To be clipped, because at least one vertex needs it.
    pub(crate) clipped: u16,
    /// The doubled signed areas of the visible ones in 1/256 pixel², rounded once.
    pub(crate) doubled_area: f32x16<S>,
}

/// Classifies the triangles of the lanes in `active`.
#[inline(always)]
pub(crate) fn classify<S: Lanes>(
    s: S,
    plan: &GeometryPlan,
    triangles: &WindowTriangles<S>,
    active: u16,
) -> Classified<S> {
    let (masks, area) = cull(s, plan, triangles, active);
    let (mut visible, mut doubled_area) = (masks.small, f32x16::float_from(area));
    if masks.large != 0 {
        let mut areas = doubled_area.to_array();
        for lane in Lane::all_of(masks.large) {
            let exact = triangles.doubled_area(lane);
            // One rounding.
            *lane.of_mut(&mut areas) = exact as f32;
            if !plan.facing.drops(exact) {
                visible |= lane.bit();
            }
        }
        doubled_area = f32x16::load_array(s, areas);
    }
    Classified {
        visible,
        clipped: masks.clipped,
        doubled_area,
    }
}

/// Masks of lanes after the tests that take no 64-bit arithmetic.
struct CullMasks {
    /// Visible.
    small: u16,
    /// Visible unless the area, which takes 64 bits, is zero or has the culled side's sign.
    large: u16,
    /// To be clipped.
    clipped: u16,
}

/// Tests the triangles of the lanes in `active`; the second value is their doubled area, right of
/// small ones.
#[inline(always)]
fn cull<S: Lanes>(
    s: S,
    plan: &GeometryPlan,
    WindowTriangles { x, y }: &WindowTriangles<S>,
    active: u16,
) -> (CullMasks, i32x16<S>) {
    outline!(s, {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        // A vertex that needs clipping has the least x there is.
        let (x_min, x_max) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        let (y_min, y_max) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        let clipped = s.bits_of_mask(x_min.simd_eq(splat(NEEDS_CLIPPING)));
        let unclipped = active & !clipped;

        // The box's sample centres: a column is inside when some sample of it can be.
        let [first, last] = plan.sample_range.map(splat);
        let column = [(x_min - last + 255) >> 8, (x_max - first) >> 8];
        let row = [(y_min - last + 255) >> 8, (y_max - first) >> 8];
        let rect = plan.rect;
        let holds_samples = column[0].simd_le(column[1])
            & row[0].simd_le(row[1])
            & column[1].simd_ge(splat(rect.x0))
            & column[0].simd_lt(splat(rect.x1))
            & row[1].simd_ge(splat(rect.y0))
            & row[0].simd_lt(splat(rect.y1));
        let holds_samples = s.bits_of_mask(holds_samples) & unclipped;

        let limit = splat(1 << 15);
        let is_small = (x_max - x_min).simd_lt(limit) & (y_max - y_min).simd_lt(limit);
        let is_small = s.bits_of_mask(is_small);

        // Below 2¹⁵ each product is below 2³⁰ in magnitude, so the difference fits 32 bits.
        let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        let clockwise = s.bits_of_mask(area.simd_gt(splat(0)));
        let counter_clockwise = s.sign_bits(area);
        let mut kept = 0;
        if !plan.facing.drops_clockwise {
            kept |= clockwise;
        }
        if !plan.facing.drops_counter_clockwise {
            kept |= counter_clockwise;
        }
        let masks = CullMasks {
            small: holds_samples & is_small & kept,
            large: holds_samples & !is_small,
            clipped: active & clipped,
        };
        (masks, area)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

    #[test]
    fn positions_are_gathered_as_they_are_read() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 8
        };
        let window: Vec<PackedVertex> = (0..50).map(|_| [0; 4].map(|_| random())).collect();
        for level in Level::all_available() {
            let mut group = TriangleGroup::default();
            for vertex in group.vertices.as_flattened_mut() {
                *vertex = random() % 50;
            }
            group.vertices[3] = [49; 3];
            group.read_positions(&window);
            dispatch!(level, s => {
                let of_corner = |corner: usize| group.vertices.map(|vertices| vertices[corner]);
                let vertices = [
                    u32x16::load_array(s, of_corner(0)),
                    u32x16::load_array(s, of_corner(1)),
                    u32x16::load_array(s, of_corner(2)),
                ];
                let read = WindowTriangles::new(s, &group);
                let gathered = WindowTriangles::gather(s, &window, &vertices);
                for corner in 0..3 {
                    let [x, y] = [read.x[corner], read.y[corner]].map(|all| all.to_array());
                    assert_eq!(gathered.x[corner].to_array(), x, "{level:?}");
                    assert_eq!(gathered.y[corner].to_array(), y, "{level:?}");
                }
            });
        }
    }
}
