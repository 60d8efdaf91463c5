//! Packets that share a run of the program.
//!
//! Packets of one colour: nothing varies over their primitives, so the program is run for one
//! packet of all. Windows and panels of user interfaces are such primitives: one colour, at one
//! place of a texture.
//!
//! Packets of several primitives at one place: if fragments need no quads, each lane is shaded for
//! the primitive that it shows, and none is a helper.

use super::{CAPACITY, FragmentQueue, PrimitivePacket};
use crate::depth_format::clamp_depth;
use crate::fragment::interpolate::Interpolant;
use crate::fragment::place::Place;
use crate::pipeline::RenderPipeline;
use estampe_simd::{LANES, Lanes, Level, Packet, Select, SimdBase, f32x16};
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

    /// The slot of the packet that was queued last.
    #[inline(always)]
    pub(crate) fn last_slot(&self) -> usize {
        self.len.wrapping_sub(1) % CAPACITY
    }

    /// Adds a packet of another primitive, of which nothing but colours is asked, to the slot of a
    /// packet at the same place, in lanes that it does not use yet.
    #[inline(always)]
    pub(crate) fn join<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl Interpolant<S>,
        packet: &PrimitivePacket<N>,
        slot: usize,
    ) {
        let shaded = self.shaded(slot);
        let lanes = packet.alive.any();
        debug_assert_eq!(
            self.coverage[shaded] & lanes,
            0,
            "a lane shows one primitive"
        );
        for (mask, more) in self.masks[slot].iter_mut().zip(packet.alive.masks) {
            *mask |= more;
        }
        self.coverage[shaded] |= lanes;
        if packet.front {
            self.front_facing[shaded] |= lanes;
        } else {
            self.front_facing[shaded] &= !lanes;
        }
        if self.scalars != 0 {
            interpolant.varyings(s, packet.pixel, &mut self.spare);
        }
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        for (to, value) in out.iter_mut().zip(&self.spare) {
            replace(s, to, lanes, f32x16::load_array_ref(s, &value.0));
        }
        if self.needs.position {
            let [_, _, z, w] = &mut self.positions[shaded];
            let depth = interpolant.depth(s, packet.pixel, [0.5; 2]);
            let depth = clamp_depth(s, depth, self.needs.depth_range);
            replace(s, z, lanes, depth);
            replace(s, w, lanes, interpolant.inverse_w(s, packet.pixel));
        }
    }
}

/// Replaces some lanes of a packet.
#[inline(always)]
pub(crate) fn replace<S: Lanes>(s: S, packet: &mut Packet<f32>, lanes: u16, by: f32x16<S>) {
    let before = f32x16::load_array_ref(s, &packet.0);
    let after = s.mask_from_bits(lanes).select(by, before);
    after.store_array(&mut packet.0);
}
