//! Triangles of one colour that follow each other: the fan of a rounded panel, a window.
//!
//! Nothing varies over such a triangle, so all of its fragments have one colour, and so have those
//! of the next one if its varyings are the same. Their coverage is gathered until a primitive comes
//! that differs or overlaps. Then one packet is shaded for all of them, and the pixels of a packet
//! that several triangles share are written together.
//!
//! Gathered pixels are disjoint, so no order among them can be seen. The queue holds what was drawn
//! before: it is written first if it has a fragment at one of the pixels; otherwise it may wait.

use super::InOrder;
use crate::fragment::queue::FragmentQueue;
use crate::raster::MAX_PACKETS;
use crate::tile_pass::write_colors;
use estampe_simd::LANES;

/// Gathered coverage of triangles that have one colour.
#[derive(Debug)]
pub(super) struct Solid<const N: usize> {
    /// The varyings of all fragments, and whether the triangles face the viewer.
    varyings: Vec<f32>,
    front: bool,
    /// By packet and sample: the gathered lanes.
    masks: [[u16; N]; MAX_PACKETS],
    /// The packets in which something is gathered, one bit each.
    packets: [u64; MAX_PACKETS / 64],
}

impl<const N: usize> Default for Solid<N> {
    fn default() -> Self {
        Self {
            varyings: Vec::new(),
            front: false,
            masks: [[0; N]; MAX_PACKETS],
            packets: [0; MAX_PACKETS / 64],
        }
    }
}

impl<const N: usize> Solid<N> {
    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.packets == [0; MAX_PACKETS / 64]
    }

    #[inline(always)]
    fn has_varyings(&self, varyings: &[f32], front: bool) -> bool {
        let pairs = self.varyings.iter().zip(varyings);
        self.front == front
            && self.varyings.len() == varyings.len()
            && pairs.fold(true, |all, (a, b)| all & (a.to_bits() == b.to_bits()))
    }

    /// Gives each packet with gathered lanes to a function, in the order of their numbers, and
    /// forgets them.
    #[inline(always)]
    fn take_each(&mut self, mut take: impl FnMut(u16, [u16; N])) {
        for (word, packets) in self.packets.iter_mut().enumerate() {
            while *packets != 0 {
                let packet = word * 64 + packets.trailing_zeros() as usize;
                *packets &= *packets - 1;
                let masks = std::mem::replace(&mut self.masks[packet % MAX_PACKETS], [0; N]);
                #[expect(clippy::cast_possible_truncation, reason = "below MAX_PACKETS")]
                take(packet as u16, masks);
            }
        }
    }

    /// Returns true if a packet of the queue has a fragment at a gathered pixel.
    #[inline(always)]
    fn overlaps(&self, queue: &FragmentQueue<N>) -> bool {
        let gathered = |packet: usize| {
            let masks = &self.masks[packet % MAX_PACKETS];
            masks.iter().fold(0, |any, mask| any | mask)
        };
        let mut queued = queue.queued();
        queued.any(|(place, pixels)| place.overlaps(pixels, gathered))
    }
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Gathers the list of a triangle whose varyings are the same at all pixels.
    #[inline(always)]
    pub(super) fn gather(&mut self, varyings: &[f32], front: bool) {
        let scratch = &self.scratch.in_order;
        let (solid, items) = (&scratch.solid, scratch.list.items());
        let is_same = solid.has_varyings(varyings, front);
        let overlaps = items.iter().fold(0, |both, item| {
            let gathered = &solid.masks[usize::from(item.packet) % MAX_PACKETS];
            let pairs = gathered.iter().zip(item.masks);
            pairs.fold(both, |both, (gathered, mask)| both | gathered & mask)
        });
        if !is_same || overlaps != 0 {
            self.end_solid();
        } else if !solid.is_empty() {
            self.scratch.statistics.triangles_gathered += 1;
        }
        let scratch = &mut self.scratch.in_order;
        let solid = &mut scratch.solid;
        if !is_same {
            solid.varyings.clear();
            solid.varyings.extend_from_slice(varyings);
            solid.front = front;
        }
        for item in scratch.list.items() {
            let packet = usize::from(item.packet) % MAX_PACKETS;
            solid.packets[packet / 64] |= 1 << (packet % 64);
            for (gathered, mask) in solid.masks[packet].iter_mut().zip(item.masks) {
                *gathered |= mask;
            }
        }
    }

    /// Shades and writes what is gathered, before something else is drawn.
    #[inline(always)]
    pub(super) fn end_solid(&mut self) {
        if !self.scratch.in_order.solid.is_empty() {
            self.write_solid();
        }
    }

    #[inline(never)]
    fn write_solid(&mut self) {
        if self.scratch.in_order.solid.overlaps(&self.scratch.queue) {
            self.flush();
        }
        let (plan, level) = (self.work.plan, self.work.level);
        let scratch = &mut *self.scratch;
        let (solid, queue) = (&mut scratch.in_order.solid, &mut scratch.solid_queue);
        let (varyings, front) = (solid.varyings.as_slice(), solid.front);
        let kept = &mut scratch.in_order.solid_colors;
        let (place, found) = kept.find(varyings, front);
        if let Some(color) = found {
            queue.set_solid_colors(color);
            scratch.statistics.colors_kept += 1;
        } else {
            queue.shade_solid(level, plan.pipeline, plan.bindings, (varyings, front));
            kept.keep(place, (varyings, front), queue.solid_colors());
        }
        let (mut fragments, mut packets) = (0, 0);
        let colors = &mut self.job.colors;
        solid.take_each(|packet, masks| {
            if queue.is_full() {
                write_colors(plan, level, &queue.batch(), colors);
                queue.empty_solid();
            }
            queue.push_solid(packet, masks);
            let any = masks.iter().fold(0, |any, mask| any | mask);
            fragments += u64::from(any.count_ones());
            packets += 1;
        });
        write_colors(plan, level, &queue.batch(), colors);
        queue.clear();
        let statistics = &mut scratch.statistics;
        statistics.fragments_shaded += fragments;
        if packets > 1 {
            statistics.fragments_of_shared_colors += fragments.saturating_sub(LANES as u64);
        }
    }
}
