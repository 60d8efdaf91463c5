//! Culling (A2): sixteen triangles at a time, most of which end here.
//!
//! *In* vertices of sixteen triangles · *Out* which of them go on, and how · *Space* window, 1/256 pixel
//! · *Precision* exact.
//!
//! In a mesh of a million triangles three of four face away, have no area or hold no sample's centre;
//! they are dropped before anything is computed for them alone. Areas are 32-bit products where a
//! triangle's extent is below 2¹⁵ (128 pixels); larger ones are left to exact 64-bit code.

use super::shading::NEEDS_CLIPPING;
use super::viewport::PixelRect;
use estampe_simd::{Bytes, LANES, Lanes, SimdBase, i32x16, u32x16};
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

/// Sixteen triangles in the window.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct WindowTriangles {
    pub(crate) x: [[i32; LANES]; 3],
    pub(crate) y: [[i32; LANES]; 3],
    /// Doubled signed area in 1/256 pixel², of those that are small.
    pub(crate) doubled_area: [i32; LANES],
}

impl Default for WindowTriangles {
    fn default() -> Self {
        Self {
            x: [[0; LANES]; 3],
            y: [[0; LANES]; 3],
            doubled_area: [0; LANES],
        }
    }
}

/// What becomes of sixteen triangles, as masks of lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Verdict {
    /// To be set up; `doubled_area` is theirs.
    pub(crate) small: u16,
    /// To be set up after their area was computed in 64 bits.
    pub(crate) large: u16,
    /// A vertex needs clipping.
    pub(crate) clip: u16,
}

/// Judges the triangles of the lanes in `live`.
#[inline(always)]
pub(crate) fn cull<S: Lanes>(
    s: S,
    state: &CullState,
    window: &[u32],
    vertices: &[[u32; LANES]; 3],
    live: u16,
    out: &mut WindowTriangles,
) -> Verdict {
    let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
    let mut x = [splat(0); 3];
    let mut y = [splat(0); 3];
    for corner in 0..3 {
        let at = u32x16::load_array_ref(s, &vertices[corner]) << 1;
        x[corner] = s.gather(window, at).bitcast();
        y[corner] = s
            .gather(window, at | <u32x16<S> as SimdBase<S>>::splat(s, 1))
            .bitcast();
        x[corner].store_array(&mut out.x[corner]);
        y[corner].store_array(&mut out.y[corner]);
    }

    // A vertex that needs clipping has the least x there is.
    let least = splat(NEEDS_CLIPPING);
    let unclipped = x[0].simd_ne(least) & x[1].simd_ne(least) & x[2].simd_ne(least);
    let unclipped = s.bits_of_mask(unclipped);
    let clip = live & !unclipped;
    if live & unclipped == 0 {
        return Verdict {
            small: 0,
            large: 0,
            clip,
        };
    }

    // The box's sample centres: a column is inside when some sample of it can be.
    let (x_min, x_max) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    let (y_min, y_max) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
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
    let seen = s.bits_of_mask(seen) & unclipped & live;

    let limit = splat(1 << 15);
    let is_small = (x_max - x_min).simd_lt(limit) & (y_max - y_min).simd_lt(limit);
    let is_small = s.bits_of_mask(is_small);

    // Below 2¹⁵ each product is below 2³⁰ in magnitude, so the difference fits 32 bits.
    let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    area.store_array(&mut out.doubled_area);
    let clockwise = s.bits_of_mask(area.simd_gt(splat(0)));
    let counter_clockwise = s.sign_bits(area);
    let mut kept = 0;
    if !state.facing.drops_clockwise {
        kept |= clockwise;
    }
    if !state.facing.drops_counter_clockwise {
        kept |= counter_clockwise;
    }
    Verdict {
        small: seen & is_small & kept,
        large: seen & !is_small,
        clip,
    }
}
