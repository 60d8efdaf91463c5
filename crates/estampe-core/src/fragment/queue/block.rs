//! Blocks of 16×16 pixels that show one triangle: sixteen packets that are queued at once.

use super::{CAPACITY, FragmentQueue, Needs};
use crate::depth_format::clamp_depth;
use crate::fragment::interpolate::{PlaneOrigin, TriangleInterpolant};
use crate::fragment::place::Place;
use crate::raster::packet_origin;
use estampe_simd::{LANES, Lanes, SimdBase, f32x16, outline};

/// A block of a triangle, of which every sample is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TriangleBlock<const N: usize> {
    /// The first packet, whose number is a multiple of sixteen.
    pub(crate) packet: u16,
    /// The first pixel in the target.
    pub(crate) pixel: [i32; 2],
    /// The masks of a packet whose samples are all covered.
    pub(crate) masks: [u16; N],
    pub(crate) front: bool,
}

impl<const N: usize> FragmentQueue<N> {
    /// Returns true if blocks can be queued: a call shades as many packets, and of each only
    /// varyings at pixels' centres and their positions are wanted.
    #[inline(always)]
    pub(crate) fn takes_blocks(&self) -> bool {
        let Needs {
            sample_index,
            coverage,
            depth,
            ..
        } = self.needs;
        let needs_more = sample_index || coverage || depth || !self.sampling.is_empty();
        self.room >= LANES && !needs_more
    }

    /// Returns true if there is room for a block.
    #[inline(always)]
    pub(crate) fn has_room_for_block(&self) -> bool {
        self.len + LANES <= self.room.min(CAPACITY)
    }

    /// Queues the packets of a block, for which there must be room.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "below CAPACITY")]
    pub(crate) fn push_block<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
        block: &TriangleBlock<N>,
    ) {
        debug_assert!(self.takes_blocks() && self.has_room_for_block());
        outline!(s, {
            let slots = self.len..self.len + LANES;
            let shaded = self.shaded_len..self.shaded_len + LANES;
            self.len = slots.end;
            self.shaded_len = shaded.end;
            self.masks[slots.clone()].fill(block.masks);
            self.sample_of[slots.clone()].fill(None);
            let places = self.places[slots.clone()].iter_mut();
            for (place, packet) in places.zip(block.packet..) {
                *place = Place::Packet(packet);
            }
            for (shaded_of, shaded) in self.shaded_of[slots].iter_mut().zip(shaded.clone()) {
                *shaded_of = (shaded % CAPACITY) as u8;
            }
            let any = block.masks.iter().fold(0, |any, mask| any | mask);
            self.coverage[shaded.clone()].fill(any);
            let front = if block.front { u16::MAX } else { 0 };
            self.front_facing[shaded.clone()].fill(front);
            let scalars = self.scalars;
            let out = &mut self.varyings[shaded.start * scalars..shaded.end * scalars];
            triangle.varyings_of_block(s, block.pixel, (out, scalars));
            if self.needs.position {
                self.position_block(s, triangle, block.pixel, shaded.start);
            }
        });
    }

    /// Stores the positions of a block's packets, from the first one on.
    #[inline(always)]
    fn position_block<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
        pixel: [i32; 2],
        first: usize,
    ) {
        let window = PlaneOrigin { x: 0.0, y: 0.0 };
        let depths = triangle.block_of(s, &triangle.z, pixel);
        let inverse_w = triangle.block_of(s, &triangle.iw, pixel);
        let range = self.needs.depth_range;
        let positions = self.positions[first..][..LANES].iter_mut();
        for ((number, [x, y, z, w]), packet) in positions.enumerate().zip(0..) {
            let (column, row) = packet_origin(packet);
            let columns = window.columns_from(s, pixel[0] + column, 0.5);
            columns.store_array(&mut x.0);
            let rows = window.rows_from(s, pixel[1] + row, 0.5);
            rows.store_array(&mut y.0);
            clamp_depth(s, depths.at(number), range).store_array(&mut z.0);
            let inverse_w: f32x16<S> = if triangle.equal_w {
                SimdBase::splat(s, triangle.iw.origin)
            } else {
                inverse_w.at(number)
            };
            inverse_w.store_array(&mut w.0);
        }
    }
}
