//! Primitives whose fragments need no quads: pixels fill packets one by one.
//!
//! A packet that the primitive covers whole is queued as it is. The pixels of all others are
//! listed, and fill packets sixteen by sixteen, the last of which stays open for the pixels of
//! primitives that follow. Order is kept: a pixel that the open packet holds, or one of the whole
//! packets behind it, closes it.

use super::fragments::Fragments;
use super::listed::place_of;
use super::{InOrder, InOrderScratch};
use crate::fragment::interpolate::{PixelInterpolant, WindowPixels};
use crate::fragment::queue::{PixelPacket, PrimitivePacket};
use estampe_simd::{Bytes, LANES, Lanes, Select, SimdBase, u32x16};

impl<const N: usize> InOrder<'_, '_, '_, N> {
    /// Queues a primitive's list.
    #[inline(always)]
    pub(super) fn queue_dense<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        front: bool,
    ) {
        const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        self.scratch.in_order.fragments.clear();
        for at in 0..self.scratch.in_order.list.items().len() {
            let covered = self.scratch.in_order.list.items()[at];
            let any = covered.any();
            if any == u16::MAX {
                let packet = PrimitivePacket {
                    alive: covered,
                    covered: covered.masks,
                    pixel: self.pixel_of(covered.packet),
                    front,
                    sample: None,
                };
                self.queue_packet(s, interpolant, &packet);
                self.scratch.in_order.last_packet.add_whole(covered.packet);
                continue;
            }
            let mut samples = zero;
            if const { N > 1 } {
                for (mask, sample) in covered.masks.into_iter().zip(0..) {
                    let bit = <u32x16<S> as SimdBase<S>>::splat(s, 1 << sample);
                    samples |= s.mask_from_bits(mask).select(bit, zero);
                }
            }
            let places = u32x16::load_array(s, NUMBERS) + u32::from(covered.packet) * 16;
            let fragments = &mut self.scratch.in_order.fragments;
            fragments.add(s, any, [zero, places, samples]);
            if fragments.len() > Fragments::MOST - LANES {
                self.fill_packets(s, interpolant, front);
            }
        }
        if self.scratch.in_order.fragments.len() != 0 {
            self.fill_packets(s, interpolant, front);
        }
    }

    /// Fills packets with the listed fragments, and empties the list.
    #[inline(always)]
    fn fill_packets<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        front: bool,
    ) {
        let tile = [self.work.shape.x, self.work.shape.y];
        self.scratch.in_order.fragments.end();
        let count = self.scratch.in_order.fragments.len();
        let mut next = 0;
        while next < count {
            let used = self.scratch.queue.open_pixels();
            if used == 0 {
                if self.scratch.queue.is_full() {
                    self.flush();
                }
                self.scratch.in_order.last_packet.begin();
            }
            let InOrderScratch {
                fragments,
                last_packet,
                ..
            } = &mut self.scratch.in_order;
            let [_, places, samples] = fragments.sixteen(next, used);
            let end = LANES.min(used + count - next);
            let wanted = lanes_between(used, end);
            let first_again = last_packet.add(places, wanted);
            let end = end.min(first_again);
            if end <= used {
                self.scratch.queue.close_pixels();
                continue;
            }
            let lanes = lanes_between(used, end);
            let mut masks = [lanes; N];
            if const { N > 1 } {
                let samples = u32x16::load_array_ref(s, samples);
                for (mask, sample) in masks.iter_mut().zip(0u32..) {
                    *mask &= s.sign_bits((samples << (31 - sample)).bitcast());
                }
            }
            let packet = PixelPacket {
                place: place_of(places, false),
                masks,
                front: if front { lanes } else { 0 },
            };
            let pixels = WindowPixels::of_places(s, u32x16::load_array_ref(s, places), tile);
            let queue = &mut self.scratch.queue;
            queue.push_pixels_of(s, interpolant, (&packet, lanes), pixels);
            if first_again < LANES {
                queue.close_pixels();
            }
            next += end - used;
        }
        self.scratch.in_order.fragments.clear();
    }
}

/// The lanes from one on, before another one.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen bits")]
pub(super) fn lanes_between(first: usize, end: usize) -> u16 {
    ((1u32 << end) - (1 << first)) as u16
}
