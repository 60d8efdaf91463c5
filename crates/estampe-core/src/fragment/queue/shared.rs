//! Packets of one colour: nothing varies over their primitives, so the program is run for one
//! packet of all.
//!
//! Windows and panels of user interfaces are such primitives: one colour, at one place of a
//! texture.

use super::FragmentQueue;
use crate::fragment::place::Place;
use crate::pipeline::RenderPipeline;
use estampe_simd::{LANES, Level};
use estampe_types::Bindings;

impl<const N: usize> FragmentQueue<N> {
    /// Shades one packet for all fragments of primitives over which nothing varies, in a queue
    /// that holds nothing else; [`FragmentQueue::push_solid`] then adds their packets.
    pub(crate) fn shade_solid(
        &mut self,
        level: Level,
        pipeline: &RenderPipeline,
        bindings: &Bindings,
        (varyings, front): (&[f32], bool),
    ) {
        debug_assert_eq!(self.len, 0, "packets of other primitives are still queued");
        let front = if front { u16::MAX } else { 0 };
        let (_, shaded) = self.begin(Place::Packet(0), [u16::MAX; N], front);
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        for (out, varying) in out.iter_mut().zip(varyings) {
            out.0 = [*varying; LANES];
        }
        self.shade(level, pipeline, bindings);
        self.empty_solid();
    }

    /// Adds a packet that has the colours of [`FragmentQueue::shade_solid`]. The queue must not be
    /// full.
    #[inline(always)]
    pub(crate) fn push_solid(&mut self, packet: u16, masks: [u16; N]) {
        self.take_slot(Place::Packet(packet), masks, 0);
    }

    /// Removes the packets, but keeps the colours of [`FragmentQueue::shade_solid`].
    #[inline(always)]
    pub(crate) fn empty_solid(&mut self) {
        self.len = 0;
    }
}
