//! Packets that share a run of the program.
//!
//! Packets of one colour: nothing varies over their primitives, so the program is run for one
//! packet of all. Windows and panels of user interfaces are such primitives: one colour, at one
//! place of a texture.

use super::FragmentQueue;
use crate::fragment::place::Place;
use crate::pipeline::RenderPipeline;
use estampe_simd::{LANES, Lanes, Level, Packet, f32x16};
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
        // Nothing changes over the primitives: all derivatives are 0.
        out.fill(Packet::default());
        for (out, varying) in out.iter_mut().zip(varyings) {
            out.0 = [*varying; LANES];
        }
        self.shade(level, pipeline, bindings);
        self.empty_solid();
    }

    /// The colours of [`FragmentQueue::shade_solid`].
    #[inline(always)]
    pub(crate) fn solid_colors(&self) -> &[Packet<f32>] {
        &self.colors[..self.colors_each * 4]
    }

    /// Of these colours that of a target, or the varyings that are passed on as it.
    #[inline(always)]
    pub(crate) fn solid_color(&self, target: usize) -> Option<&[Packet<f32>; 4]> {
        let colors = if self.color_passthrough {
            &self.varyings
        } else {
            &self.colors
        };
        colors.get(target * 4..)?.first_chunk()
    }

    /// Sets colours that [`FragmentQueue::solid_colors`] gave before, in place of shading.
    #[inline(always)]
    pub(crate) fn set_solid_colors(&mut self, colors: &[Packet<f32>]) {
        debug_assert_eq!(self.len, 0, "packets of other primitives are still queued");
        self.shaded_len = 1;
        for (to, color) in self.colors.iter_mut().zip(colors) {
            *to = *color;
        }
    }

    /// Adds a packet that has the colours of [`FragmentQueue::shade_solid`]. The queue must not be
    /// full.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
    pub(crate) fn push_solid(&mut self, packet: usize, masks: [u16; N]) {
        self.take_slot(Place::Packet(packet as u16), masks, 0);
    }

    /// Removes the packets, but keeps the colours of [`FragmentQueue::shade_solid`].
    #[inline(always)]
    pub(crate) fn empty_solid(&mut self) {
        self.len = 0;
    }
}

/// Replaces some lanes of a packet.
#[inline(always)]
pub(crate) fn replace<S: Lanes>(s: S, packet: &mut Packet<f32>, lanes: u16, by: f32x16<S>) {
    s.replace_f32(&mut packet.0, lanes, by);
}
