//! Packets in the queue whose lanes are pixels, or quads, of any triangles, anywhere in the tile.

use super::shared::replace;
use super::{CAPACITY, FragmentQueue};
use crate::depth_format::clamp_depth;
use crate::fragment::interpolate::{PixelInterpolant, WindowPixels};
use crate::fragment::place::Place;
use crate::fragment::quad::QUAD;
use estampe_simd::{LANES, Lanes, Packet, SimdBase, f32x16};
use std::hint::select_unpredictable;

/// Sixteen pixels of triangles that are shaded alike.
#[derive(Debug, Clone)]
pub(crate) struct PixelPacket<'a, const N: usize> {
    /// Where they are: packet·16 + lane. Those of a mask are different pixels.
    pub(crate) places: &'a [u32; LANES],
    /// True if they are four quads.
    pub(crate) are_quads: bool,
    /// By sample: the covered lanes.
    pub(crate) masks: [u16; N],
    /// The lanes whose triangle faces the viewer.
    pub(crate) front: u16,
}

impl<const N: usize> PixelPacket<'_, N> {
    /// Their place as one. It is made where it is stored: copies of it wait for its parts.
    #[inline(always)]
    pub(crate) fn place(&self) -> Place {
        if self.are_quads {
            return Place::of_quads(self.places);
        }
        Place::of_pixels(self.places)
    }
}

/// Where the inputs of a queued packet go.
#[derive(Debug)]
pub(crate) struct PacketInputs<'a> {
    pub(crate) varyings: &'a mut [Packet<f32>],
    /// Window position (x, y, z, 1/w), if it is read.
    pub(crate) position: Option<&'a mut [Packet<f32>; 4]>,
    /// By sample: depths, if they are tested after shading.
    pub(crate) depths: &'a mut [Packet<f32>],
    /// The range that depths are clamped to.
    pub(crate) depth_range: [f32; 2],
    /// The lanes to set; all, if the packet has just begun.
    pub(crate) lanes: u16,
}

impl<const N: usize> FragmentQueue<N> {
    /// The lanes that are used of the packet that is being filled with pixels; 0 if there is none.
    #[inline(always)]
    pub(crate) fn open_pixels(&self) -> usize {
        self.open_pixels.map_or(0, |(_, used)| used % LANES)
    }

    /// Ends the packet that is being filled with pixels.
    #[inline(always)]
    pub(crate) fn close_pixels(&mut self) {
        self.open_pixels = None;
    }

    /// Adds some lanes of a packet of pixels to the one that is being filled, from its first lane
    /// that is not used on, or begins one, for which there must be room in the queue. Gives where
    /// their inputs go.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 4096 pixels")]
    pub(crate) fn push_pixels(
        &mut self,
        packet: &PixelPacket<'_, N>,
        lanes: u16,
    ) -> PacketInputs<'_> {
        // Quads that come later would be drawn before these pixels.
        self.close_quads();
        let is_first = lanes & 1 == 1;
        let slot = match self.open_pixels {
            Some((slot, _)) if !is_first => slot % CAPACITY,
            _ => self.begin(packet.place(), [0; N], 0).0,
        };
        let shaded = self.shaded(slot);
        let used = LANES - lanes.leading_zeros() as usize;
        self.open_pixels = (used < LANES).then_some((slot, used));
        if !is_first {
            match &mut self.places[slot] {
                Place::Pixels(to) => {
                    for (lane, (to, from)) in to.iter_mut().zip(packet.places).enumerate() {
                        *to = select_unpredictable(lanes >> lane & 1 == 1, *from as u16, *to);
                    }
                }
                Place::Quads(to) => {
                    let from = packet.places.iter().step_by(QUAD);
                    for (quad, (to, from)) in to.iter_mut().zip(from).enumerate() {
                        let from = (*from / QUAD as u32) as u16;
                        *to = select_unpredictable(lanes >> (quad * QUAD) & 1 == 1, from, *to);
                    }
                }
                Place::Packet(_) => {}
            }
        }
        let mut any = 0;
        for (to, mask) in self.masks[slot].iter_mut().zip(packet.masks) {
            *to |= mask;
            any |= mask;
        }
        self.coverage[shaded] |= any;
        self.front_facing[shaded] |= packet.front;
        let depths = if self.needs.depth {
            &mut self.depths[slot * N..][..self.samples.count()]
        } else {
            &mut []
        };
        PacketInputs {
            varyings: &mut self.varyings[shaded * self.scalars..][..self.scalars],
            position: self.needs.position.then_some(&mut self.positions[shaded]),
            depths,
            depth_range: self.needs.depth_range,
            // Lanes that are used later may hold anything until then.
            lanes: if is_first { u16::MAX } else { lanes },
        }
    }

    /// [`FragmentQueue::push_pixels`] of a primitive. Lanes that are not pushed are pixels too.
    #[inline(always)]
    pub(crate) fn push_pixels_of<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        (packet, lanes): (&PixelPacket<'_, N>, u16),
        pixels: WindowPixels<S>,
    ) {
        let is_first = lanes & 1 == 1;
        if !is_first {
            interpolant.varyings_of(s, pixels, &mut self.spare);
        }
        let (needs, samples) = (self.needs, self.samples);
        let spare = std::mem::take(&mut self.spare);
        let inputs = self.push_pixels(packet, lanes);
        if is_first {
            interpolant.varyings_of(s, pixels, inputs.varyings);
        } else {
            for (to, value) in inputs.varyings.iter_mut().zip(&spare) {
                replace(s, to, inputs.lanes, f32x16::load_array_ref(s, &value.0));
            }
        }
        if let Some(to) = inputs.position {
            let position = needs.position_of(s, interpolant, pixels);
            for (to, value) in to.iter_mut().zip(&position) {
                replace(s, to, inputs.lanes, f32x16::load_array_ref(s, &value.0));
            }
        }
        for (to, offset) in inputs.depths.iter_mut().zip(samples.offsets()) {
            let depth = interpolant.depth_of(s, pixels, offset);
            let depth = clamp_depth(s, depth, inputs.depth_range);
            replace(s, to, inputs.lanes, depth);
        }
        self.spare = spare;
    }
}
