//! Blocks of 16×16 pixels blended *over* what is there, from interpolated colours.
//!
//! The case that fills screens: a shader that passes its colour on, straight alpha, one sample of
//! unorm8. Colours go from the planes to the attachment in registers, without a shader and without
//! a queue. Triangles that follow each other are *layers*, which are collected and blended
//! together, block by block: a packet of texels is loaded and stored once for up to eight of them.
//!
//! ```text
//!   triangle ─▶ depth test of its whole blocks ─▶ layer ─▶ ... ─▶ all layers of a block
//! ```
//!
//! What is stored is what [`color_writer`](super::color_writer) stores: the formula of
//! docs/NUMERICS.md, each operation rounded ([`exact`]). Most codes are found by an [`estimate`],
//! which knows when it is not certain of one.

mod estimate;
mod exact;
mod layers;

pub(super) use estimate::{raised_codes, texels};
pub(crate) use layers::Layers;

use super::compare::compare;
use super::sample_tests::SampleTests;
use crate::bounds::plane::Plane;
use crate::fragment::interpolate::{DepthPlane, PlaneBlock, PlaneOrigin, VaryingPlanes};
use crate::raster::{TileShape, packet_origin};
use estampe_simd::{LANES, Lanes, Select, SimdBase, f32x16};

/// Planes of a triangle's colour: R, G, B and straight alpha, linear in the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColorPlanes {
    origin: PlaneOrigin,
    channels: [Plane; 4],
}

impl ColorPlanes {
    /// The first four varyings of a triangle whose 1/w are equal; `is_bgra` says that texels have
    /// blue in the low byte.
    #[inline(always)]
    pub(crate) fn new(origin: PlaneOrigin, planes: &VaryingPlanes<'_>, is_bgra: bool) -> Self {
        let mut channels = [planes.of(0), planes.of(1), planes.of(2), planes.of(3)];
        if is_bgra {
            channels.swap(0, 2);
        }
        Self { origin, channels }
    }
}

/// A block of a tile: sixteen packets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileBlock {
    /// The block's first pixel in the target.
    pixel: [i32; 2],
    /// Its first packet in the tile.
    first_packet: usize,
}

impl TileBlock {
    /// Block number `block` of a tile, 0 to 15.
    #[inline(always)]
    pub(crate) fn new(tile: TileShape, block: u32) -> Self {
        let (x, y) = packet_origin(block * 16);
        Self {
            pixel: [tile.x + x, tile.y + y],
            first_packet: block as usize * LANES,
        }
    }
}

/// The lanes of each packet of a block in which a triangle passes the depth test; depth is written
/// if the state says so. The tests must be of depth alone.
#[inline(always)]
pub(crate) fn test_block<S: Lanes>(
    s: S,
    tests: &SampleTests,
    plane: &DepthPlane,
    block: TileBlock,
    stored: &mut [[f32; LANES]],
) -> [u16; LANES] {
    debug_assert!(tests.is_depth_alone(), "stencil is tested packet by packet");
    let mut masks = [u16::MAX; LANES];
    let Some(state) = tests.depth else {
        return masks;
    };
    let steps = PlaneBlock::new(s, &plane.origin, &plane.z, block.pixel, [0.5; 2]);
    let lines = stored[block.first_packet..].iter_mut();
    for (packet, (mask, line)) in masks.iter_mut().zip(lines).enumerate() {
        let new = tests.stored.of(s, steps.at(packet));
        let old = f32x16::load_array_ref(s, line);
        let passes = compare(state.compare, new, old);
        if state.write_enabled {
            passes.select(new, old).store_array(line);
        }
        *mask = s.bits_of_mask(passes);
    }
    masks
}
