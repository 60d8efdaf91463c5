//! Rasterization (R1, R3, R4, R6): which samples of a tile a primitive covers.
//!
//! *In* set-up primitives · *Out* [`CoverageList`]s · *Space* window, tile by tile · *Precision*
//! exact integers · *Spec* Pineda, A Parallel Algorithm for Polygon Rasterization, 1988; Olano and
//! Greer 1997 for evaluating edges in blocks; `docs/NUMERICS.md` for the fill rule.
//!
//! A tile's 64×64 pixels are 16 blocks of 16×16, each 16 packets of 4×4, each 16 pixels, and at
//! every level the sixteen lie in the same Morton order. So one 16-lane operation evaluates an edge
//! on a whole level, and the sign bits are the answer:
//!
//! ```text
//!     64×64 ──▶ 16 blocks ──▶ 16 packets ──▶ 16 pixels        E = c + a·x + b·y ≥ 0 is inside
//!     reject: E at the block's best corner is negative;   accept: E at its worst corner is not
//! ```

mod coverage;
mod samples;
mod tile_shape;

pub(crate) mod triangle;

mod walk;

pub(crate) mod convex;

pub(crate) mod parts;

mod edge_lanes;

pub(crate) mod small;

mod covered_pixels;

mod box_packets;

pub(crate) mod small_lines;

pub(crate) mod pixel_list;

pub(crate) mod packet_edges;

pub(crate) mod pixel_box;

pub(crate) mod clip_masks;

pub(crate) mod packet_masks;

pub(crate) mod conservative;

pub(crate) mod line;

pub(crate) mod point;

pub(crate) use coverage::{CoverageList, Covered, MAX_PACKETS, rect_mask};
pub(crate) use samples::{MAX_SAMPLES, SampleSet, standard_positions};
pub(crate) use tile_shape::TileShape;
pub(crate) use walk::PacketClasses;

/// The pixel at which a packet of a tile begins.
#[inline(always)]
pub(crate) fn packet_origin(packet: u32) -> (i32, i32) {
    // Every other bit of the number, four pixels apart.
    let gather = |v: u32| {
        let v = v & 0x55;
        let v = (v | v >> 1) & 0x33;
        ((v | v >> 2) & 0x0F).cast_signed() * 4
    };
    (gather(packet), gather(packet >> 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::TileGrid;

    #[test]
    fn packets_are_numbered_as_they_are_stored() {
        let grid = TileGrid::new(64, 64, 1);
        for packet in 0..256 {
            let (x, y) = packet_origin(packet);
            assert_eq!(
                grid.packet_of(x.cast_unsigned(), y.cast_unsigned()),
                packet as usize
            );
        }
    }
}
