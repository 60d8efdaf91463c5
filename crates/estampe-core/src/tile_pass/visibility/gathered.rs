//! Triangles of several packets as one packet.
//!
//! A packet's triangles are neighbours, but where they are large a tile has few of each packet: of
//! shadow volumes two. What is done for sixteen triangles at a time would be done for two, and a
//! lane's values, each in a cache line of its own, would be waited for one after the other.

use crate::bounds::primitives::TrianglePacket;
use estampe_simd::LANES;

/// Triangles of a packet that are gathered at most; more of them stay where they are.
const MOST: u32 = 8;

/// Gathered triangles, in their order.
pub(super) struct GatheredTriangles {
    /// Of each triangle its place and its depth, no more.
    packet: TrianglePacket,
    len: usize,
}

impl GatheredTriangles {
    pub(super) fn new() -> Self {
        Self {
            packet: TrianglePacket::EMPTY,
            len: 0,
        }
    }

    /// Adds the triangles of a packet. Returns false, and adds nothing, if they are not to be
    /// gathered, or do not fit.
    #[inline(always)]
    pub(super) fn add(&mut self, packet: &TrianglePacket, mut lanes: u16) -> bool {
        let count = lanes.count_ones();
        if count > MOST || self.len + count as usize > LANES {
            return false;
        }
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            self.packet.copy_window(self.len % LANES, packet, lane);
            self.len += 1;
        }
        true
    }

    /// The triangles, as the first lanes of a packet.
    pub(super) fn triangles(&self) -> (&TrianglePacket, u16) {
        let lanes = (1u32 << self.len) - 1;
        (&self.packet, u16::try_from(lanes).unwrap_or(u16::MAX))
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }
}
