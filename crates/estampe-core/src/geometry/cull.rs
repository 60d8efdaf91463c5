//! Culling (A2): sixteen triangles at a time, most of which end here.
//!
//! *In* vertices of sixteen triangles · *Out* which of them go on, and how · *Space* window, 1/256 pixel
//! · *Precision* exact.
//!
//! In a mesh of a million triangles three of four face away, have no area or hold no sample's centre;
//! they are dropped before anything is computed for them alone. Areas are 32-bit products where a
//! triangle's extent is below 2¹⁵ (128 pixels); larger ones are left to exact 64-bit code.

use super::shading::{NEEDS_CLIPPING, WindowRow};
use super::viewport::PixelRect;
use estampe_simd::{Bytes, LANES, Lanes, SimdBase, i32x16};
use estampe_types::state::{CullMode, FrontFace, PrimitiveState};

/// What culling needs besides the triangles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CullState {
    /// Where pixels may change.
    pub(crate) rect: PixelRect,
    pub(crate) facing: Facing,
    /// The least and the greatest offset of a sample inside its pixel, in 1/256 pixel.
    pub(crate) sample_range: [i32; 2],
}

/// Which signs of area face the viewer, and which are dropped.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facing {
    /// Whether triangles that are clockwise in the window (area > 0, y down) face the viewer.
    pub(crate) clockwise_is_front: bool,
    pub(crate) drops_clockwise: bool,
    pub(crate) drops_counter_clockwise: bool,
}

impl Facing {
    pub(crate) fn new(state: &PrimitiveState) -> Self {
        let clockwise_is_front = state.front_face == FrontFace::Cw;
        let drops = |front: bool| match state.cull_mode {
            CullMode::None => false,
            CullMode::Front => front,
            CullMode::Back => !front,
        };
        Self {
            clockwise_is_front,
            drops_clockwise: drops(clockwise_is_front),
            drops_counter_clockwise: drops(!clockwise_is_front),
        }
    }

    /// Whether a triangle of this doubled area is dropped.
    #[inline(always)]
    pub(crate) fn drops(self, doubled_area: i64) -> bool {
        match doubled_area.signum() {
            0 => true,
            1 => self.drops_clockwise,
            _ => self.drops_counter_clockwise,
        }
    }

    /// Whether a triangle of this doubled area faces the viewer.
    #[inline(always)]
    pub(crate) fn is_front(self, doubled_area: i64) -> bool {
        (doubled_area > 0) == self.clockwise_is_front
    }
}

/// Sixteen triangles on their way to being judged.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct TriangleGroup {
    /// The item's vertices of each.
    pub(crate) vertices: [[u32; 3]; LANES],
    /// x and y of each, corner by corner.
    positions: [[u64; LANES]; 3],
}

impl TriangleGroup {
    /// Reads where the vertices are. x and y are one load of 64 bits: on Zen 4 48 of these take half of the
    /// time of six gathers.
    #[inline(always)]
    pub(crate) fn read_positions(&mut self, window: &[WindowRow]) {
        for (lane, vertices) in self.vertices.iter().enumerate() {
            for (positions, &vertex) in self.positions.iter_mut().zip(vertices) {
                // In range: an item's vertices are all that its indices name.
                let row = &window[vertex as usize];
                positions[lane] = u64::from(row[0]) | u64::from(row[1]) << 32;
            }
        }
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
        let [x0, y0] = columns(s, &group.positions[0]);
        let [x1, y1] = columns(s, &group.positions[1]);
        let [x2, y2] = columns(s, &group.positions[2]);
        Self {
            x: [x0, x1, x2],
            y: [y0, y1, y2],
        }
    }

    /// The doubled signed area of one triangle in 1/256 pixel², exact.
    pub(crate) fn doubled_area(&self, lane: usize) -> i64 {
        let x = |corner: usize| i64::from(self.x[corner].as_slice()[lane]);
        let y = |corner: usize| i64::from(self.y[corner].as_slice()[lane]);
        (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0))
    }
}

#[inline(always)]
fn columns<S: Lanes>(s: S, words: &[u64; LANES]) -> [i32x16<S>; 2] {
    let (mut low, mut high) = (s.splat_u64x8(0), s.splat_u64x8(0));
    low.as_mut_slice().copy_from_slice(&words[..LANES / 2]);
    high.as_mut_slice().copy_from_slice(&words[LANES / 2..]);
    let (x, y) = s.deinterleave_u32x16(low.bitcast(), high.bitcast());
    [x.bitcast(), y.bitcast()]
}

/// What becomes of sixteen triangles, as masks of lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Verdict {
    /// To be set up; their area was computed.
    pub(crate) small: u16,
    /// To be set up if their area, computed in 64 bits, has the right sign.
    pub(crate) large: u16,
    /// A vertex needs clipping.
    pub(crate) clip: u16,
}

/// Judges the triangles of the lanes in `live`; the second value is their doubled area.
#[inline(always)]
pub(crate) fn cull<S: Lanes>(
    s: S,
    state: &CullState,
    WindowTriangles { x, y }: &WindowTriangles<S>,
    live: u16,
) -> (Verdict, i32x16<S>) {
    let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
    // A vertex that needs clipping has the least x there is.
    let (x_min, x_max) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    let (y_min, y_max) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
    let clipped = s.bits_of_mask(x_min.simd_eq(splat(NEEDS_CLIPPING)));
    let unclipped = live & !clipped;

    // The box's sample centres: a column is inside when some sample of it can be.
    let [first, last] = state.sample_range.map(splat);
    let column = [(x_min - last + 255) >> 8, (x_max - first) >> 8];
    let row = [(y_min - last + 255) >> 8, (y_max - first) >> 8];
    let rect = state.rect;
    let seen = column[0].simd_le(column[1])
        & row[0].simd_le(row[1])
        & column[1].simd_ge(splat(rect.x0))
        & column[0].simd_lt(splat(rect.x1))
        & row[1].simd_ge(splat(rect.y0))
        & row[0].simd_lt(splat(rect.y1));
    let seen = s.bits_of_mask(seen) & unclipped;

    let limit = splat(1 << 15);
    let is_small = (x_max - x_min).simd_lt(limit) & (y_max - y_min).simd_lt(limit);
    let is_small = s.bits_of_mask(is_small);

    // Below 2¹⁵ each product is below 2³⁰ in magnitude, so the difference fits 32 bits.
    let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    let clockwise = s.bits_of_mask(area.simd_gt(splat(0)));
    let counter_clockwise = s.sign_bits(area);
    let mut kept = 0;
    if !state.facing.drops_clockwise {
        kept |= clockwise;
    }
    if !state.facing.drops_counter_clockwise {
        kept |= counter_clockwise;
    }
    let verdict = Verdict {
        small: seen & is_small & kept,
        large: seen & !is_small,
        clip: live & clipped,
    };
    (verdict, area)
}
