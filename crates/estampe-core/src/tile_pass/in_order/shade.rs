//! From coverage to the queue: whole packets, or quads that share packets, or [pixels](super::dense)
//! that do.
//!
//! A primitive that covers a few pixels leaves most lanes of its packets idle: a glyph of 10×14
//! pixels uses 36 % of them, a line a quarter. So a packet of which the primitive covers no pixel
//! in some quad is taken apart, and its quads fill packets together with those of others. Order is
//! kept: a quad whose pixels are already in the queue, in the packet that is being filled or behind
//! it, closes that packet.

use super::InOrder;
use super::small::Listing;
use crate::fragment::interpolate::{
    Interpolant, LineOrPoint, PixelInterpolant, TriangleInterpolant,
};
use crate::fragment::quad::QUADS;
use crate::fragment::queue::{PrimitivePacket, QuadPlace};
use crate::raster::{Covered, packet_origin};
use estampe_simd::{Lanes, dispatch};

/// The quads of a tile, one bit each, that were queued since the packet that is being filled was
/// begun.
#[derive(Debug, Clone, Default)]
pub(super) struct PendingQuads {
    bits: [u64; 16],
}

impl PendingQuads {
    #[inline(always)]
    fn clear(&mut self) {
        self.bits = [0; 16];
    }

    /// Adds quads of a packet: bit 4·i of `quads` is quad i, packed to four bits.
    #[inline(always)]
    fn add(&mut self, place: u16, quads: u64) {
        self.bits[usize::from(place >> 6) % 16] |= quads << (place & 63);
    }

    #[inline(always)]
    fn contains(&self, place: u16) -> bool {
        self.bits[usize::from(place >> 6) % 16] >> (place & 63) & 1 == 1
    }
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// A line's or point's list: test, then queue.
    #[inline(always)]
    pub(super) fn covered<S: Lanes>(&mut self, s: S, interpolant: &LineOrPoint<'_>, front: bool) {
        if !self.test_early(s, interpolant, front) {
            return;
        }
        self.end_solid();
        if const { S::IS_SCALAR } || !self.shares_packets {
            self.queue_line_packets(interpolant, front);
        } else if self.is_shown() || self.listing == Listing::Pixels && self.lists_lines() {
            // Quads would be drawn after pixels of later lines, which fill the open packet.
            self.queue_line_pixels(interpolant, front);
        } else {
            // Pixels would be slower than quads: a line or point has few.
            self.queue_line_quads(interpolant, front);
        }
    }

    #[inline(never)]
    fn queue_line_pixels(&mut self, interpolant: &LineOrPoint<'_>, front: bool) {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.queue_dense(s, interpolant, front),
                scalar => unreachable!("the scalar level queues packets"));
        }
    }

    #[inline(never)]
    fn queue_line_packets(&mut self, interpolant: &LineOrPoint<'_>, front: bool) {
        dispatch_samples!(N, self.work.level, s => self.queue_packets(s, interpolant, front));
    }

    #[inline(never)]
    fn queue_line_quads(&mut self, interpolant: &LineOrPoint<'_>, front: bool) {
        dispatch!(@wide self.work.level, s => self.queue_quads(s, interpolant, front),
            scalar => unreachable!("the scalar level queues packets"));
    }

    /// Queues a triangle's list as packets, pixels or quads, each of which is a function of its
    /// own. The scalar level has no code for packets that primitives share: it takes the compiler
    /// too long.
    #[inline(always)]
    pub(super) fn queue_triangle(&mut self, interpolant: &TriangleInterpolant<'_>, front: bool) {
        if self.work.level.is_scalar() || !self.shares_packets {
            self.queue_triangle_packets(interpolant, front);
        } else if self.needs_no_quads && const { N <= 4 } {
            self.queue_triangle_pixels(interpolant, front);
        } else {
            self.queue_triangle_quads(interpolant, front);
        }
    }

    #[inline(never)]
    fn queue_triangle_packets(&mut self, interpolant: &TriangleInterpolant<'_>, front: bool) {
        dispatch_samples!(N, self.work.level, s => self.queue_packets(s, interpolant, front));
    }

    #[inline(never)]
    fn queue_triangle_pixels(&mut self, interpolant: &TriangleInterpolant<'_>, front: bool) {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.queue_dense(s, interpolant, front),
                scalar => unreachable!("the scalar level queues packets"));
        }
    }

    #[inline(never)]
    fn queue_triangle_quads(&mut self, interpolant: &TriangleInterpolant<'_>, front: bool) {
        dispatch!(@wide self.work.level, s => self.queue_quads(s, interpolant, front),
            scalar => unreachable!("the scalar level queues packets"));
    }

    /// Queues the list as whole packets, shading whenever the queue is full.
    #[inline(always)]
    fn queue_packets<S: Lanes>(&mut self, s: S, interpolant: &impl Interpolant<S>, front: bool) {
        let key = self.work.plan.pipeline.key();
        let mut before = 0;
        for at in 0..self.scratch.in_order.list.items().len() {
            let scratch = &self.scratch.in_order;
            let alive = scratch.list.items()[at];
            let mut covered = alive.masks;
            if key.keeps_coverage {
                // Packets that failed as a whole are missing from the list; the order is the same.
                let all = scratch.covered.items();
                while all[before].packet != alive.packet {
                    before += 1;
                }
                covered = all[before].masks;
            }
            let mut packet = PrimitivePacket {
                alive,
                covered,
                pixel: self.pixel_of(alive.packet),
                front,
                sample: None,
            };
            if !key.per_sample {
                self.queue_packet(s, interpolant, &packet);
                continue;
            }
            for (sample, &mask) in (0u8..).zip(&alive.masks).take(self.samples.count()) {
                if mask != 0 {
                    packet.sample = Some(sample);
                    self.queue_packet(s, interpolant, &packet);
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn queue_packet<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl Interpolant<S>,
        packet: &PrimitivePacket<N>,
    ) {
        if self.scratch.queue.is_full() {
            self.flush();
        }
        self.scratch.queue.push(s, interpolant, packet);
    }

    /// Queues a primitive's list: packets in which no quad is empty as they are, the others' quads
    /// apart.
    #[inline(always)]
    fn queue_quads<S: Lanes>(&mut self, s: S, interpolant: &impl PixelInterpolant<S>, front: bool) {
        let mut quads = [QuadPlace {
            place: 0,
            masks: [0; N],
            pixel: [0; 2],
        }; QUADS];
        let mut count = 0;
        for at in 0..self.scratch.in_order.list.items().len() {
            let covered = self.scratch.in_order.list.items()[at];
            let any = covered.any();
            let mut left = (any | any >> 1 | any >> 2 | any >> 3) & 0x1111;
            let pixel = self.pixel_of(covered.packet);
            if left == 0x1111 {
                let packet = PrimitivePacket {
                    alive: covered,
                    covered: covered.masks,
                    pixel,
                    front,
                    sample: None,
                };
                self.queue_packet(s, interpolant, &packet);
                self.scratch.in_order.pending.add(covered.packet * 4, 0xF);
                continue;
            }
            while left != 0 {
                let shift = left.trailing_zeros();
                left &= left - 1;
                quads[count] = quad_of(&covered, shift, pixel);
                count += 1;
                if count == QUADS {
                    self.queue_four_quads(s, interpolant, &quads, front);
                    count = 0;
                }
            }
        }
        if count != 0 {
            // Unused places repeat a quad, so that they are interpolated somewhere sensible.
            for unused in count..QUADS {
                quads[unused] = quads[0];
            }
            self.scratch.queue.interpolate_quads(s, interpolant, &quads);
            for (at, quad) in quads.iter().enumerate().take(count) {
                self.queue_quad((at, quad), front);
            }
        }
    }

    #[inline(always)]
    fn queue_four_quads<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        quads: &[QuadPlace<N>; QUADS],
        front: bool,
    ) {
        if self.scratch.queue.is_full() {
            self.flush();
        }
        self.scratch
            .queue
            .push_four_quads(s, interpolant, quads, front);
        for quad in quads {
            self.scratch.in_order.pending.add(quad.place, 1);
        }
    }

    /// Queues one quad in the packet that is being filled.
    #[inline(always)]
    fn queue_quad(&mut self, (at, quad): (usize, &QuadPlace<N>), front: bool) {
        let scratch = &mut *self.scratch;
        if scratch.in_order.pending.contains(quad.place) {
            scratch.queue.close_quads();
        }
        if scratch.queue.is_full_of_quads() {
            self.flush();
        }
        let scratch = &mut *self.scratch;
        if scratch.queue.begins_with_next_quad() {
            scratch.in_order.pending.clear();
        }
        scratch.in_order.pending.add(quad.place, 1);
        scratch.queue.push_quad((at, quad), front);
    }

    /// The first pixel of a packet of the tile, in the target.
    #[inline(always)]
    pub(super) fn pixel_of(&self, packet: u16) -> [i32; 2] {
        let (x, y) = packet_origin(u32::from(packet));
        [self.work.shape.x + x, self.work.shape.y + y]
    }
}

/// The quad of a packet whose first lane is `shift`.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a packet has four quads")]
fn quad_of<const N: usize>(covered: &Covered<N>, shift: u32, [x, y]: [i32; 2]) -> QuadPlace<N> {
    let quad = shift / 4;
    let mut masks = covered.masks;
    for mask in &mut masks {
        *mask = *mask >> shift & 0xF;
    }
    QuadPlace {
        place: covered.packet * 4 + quad as u16,
        masks,
        pixel: [
            x + (quad & 1).cast_signed() * 2,
            y + (quad >> 1).cast_signed() * 2,
        ],
    }
}
