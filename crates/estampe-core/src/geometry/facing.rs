//! Facing (A2): which triangles are seen from the front, and which of the two sides is culled.

use estampe_types::state::{CullMode, FrontFace, PrimitiveState};

/// The signs of area that are front facing, and those that are culled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facing {
    /// True if triangles that are clockwise in the window (area > 0, y down) are front facing.
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

    /// Returns true if a triangle of this doubled area is dropped; area 0 always is.
    #[inline(always)]
    pub(crate) fn drops(self, doubled_area: i64) -> bool {
        match doubled_area.signum() {
            0 => true,
            1 => self.drops_clockwise,
            _ => self.drops_counter_clockwise,
        }
    }

    /// Returns true if a triangle of this doubled area is front facing.
    #[inline(always)]
    pub(crate) fn is_front(self, doubled_area: i64) -> bool {
        (doubled_area > 0) == self.clockwise_is_front
    }
}
