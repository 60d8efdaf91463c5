//! Quads in the queue: packets whose four quads belong to different places or primitives.

use super::{CAPACITY, FragmentQueue, Needs};
use crate::depth_format::clamp_depth;
use crate::fragment::interpolate::{PixelInterpolant, WindowPixels};
use crate::fragment::place::Place;
use crate::fragment::quad::{QUAD, QUADS};
use crate::raster::SampleSet;
use estampe_simd::{Lanes, Packet, SimdBase};

/// A quad of a primitive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QuadPlace<const N: usize> {
    /// Packet·4 + quad.
    pub(crate) place: u16,
    /// By sample, in the lowest four bits.
    pub(crate) masks: [u16; N],
    /// Its first pixel in the target.
    pub(crate) pixel: [i32; 2],
}

impl<const N: usize> FragmentQueue<N> {
    /// Queues four quads of a primitive as a packet.
    #[inline(always)]
    pub(crate) fn push_four_quads<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        quads: &[QuadPlace<N>; QUADS],
        front: bool,
    ) {
        let [a, b, c, d] = quads;
        let mut masks = [0; N];
        for (quad, from) in quads.iter().enumerate() {
            for (mask, of_quad) in masks.iter_mut().zip(from.masks) {
                *mask |= of_quad << (quad * QUAD);
            }
        }
        let place = Place::Quads([a.place, b.place, c.place, d.place]);
        let (slot, shaded) = self.begin(place, masks, if front { u16::MAX } else { 0 });
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        let pixels = WindowPixels::of_quads(s, [a.pixel, b.pixel, c.pixel, d.pixel]);
        interpolant.varyings_of(s, pixels, out);
        if self.needs.position {
            self.positions[shaded] = self.needs.position_of(s, interpolant, pixels);
        }
        if self.needs.depth {
            let depths = &mut self.depths[slot * N..][..N];
            self.needs
                .depths_of(s, interpolant, (pixels, self.samples), depths);
        }
    }

    /// Interpolates up to four quads of a primitive, for [`FragmentQueue::push_quad`].
    #[inline(always)]
    pub(crate) fn interpolate_quads<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        quads: &[QuadPlace<N>; QUADS],
    ) {
        let [a, b, c, d] = quads;
        let pixels = WindowPixels::of_quads(s, [a.pixel, b.pixel, c.pixel, d.pixel]);
        interpolant.varyings_of(s, pixels, &mut self.spare);
        if self.needs.position {
            self.spare_position = self.needs.position_of(s, interpolant, pixels);
        }
        if self.needs.depth {
            let depths = &mut self.spare_depths;
            self.needs
                .depths_of(s, interpolant, (pixels, self.samples), depths);
        }
    }

    /// Queues one of the quads that [`FragmentQueue::interpolate_quads`] was last called for, in a
    /// packet that it shares with quads of other primitives. The queue must not be [full of
    /// quads](FragmentQueue::is_full_of_quads).
    #[inline(always)]
    pub(crate) fn push_quad(&mut self, (at, from): (usize, &QuadPlace<N>), front: bool) {
        let (slot, quad) = match self.open {
            Some((slot, quad)) if quad < QUADS => (slot % CAPACITY, quad),
            _ => (
                self.begin(Place::Quads([from.place; QUADS]), [0; N], 0).0,
                0,
            ),
        };
        let shaded = self.shaded(slot);
        self.open = Some((slot, quad + 1));
        let shift = quad * QUAD;
        if let Place::Quads(places) = &mut self.places[slot] {
            places[quad] = from.place;
        }
        let mut any = 0;
        for (to, mask) in self.masks[slot].iter_mut().zip(from.masks) {
            *to |= mask << shift;
            any |= mask << shift;
        }
        self.coverage[shaded] |= any;
        if front {
            self.front_facing[shaded] |= 0xF << shift;
        }
        let at = at % QUADS * QUAD;
        let copy = |to: &mut Packet<f32>, from: &Packet<f32>| {
            to.0[shift..shift + QUAD].copy_from_slice(&from.0[at..at + QUAD]);
        };
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        for (to, from) in out.iter_mut().zip(&self.spare) {
            copy(to, from);
        }
        if self.needs.position {
            for (to, from) in self.positions[shaded].iter_mut().zip(&self.spare_position) {
                copy(to, from);
            }
        }
        if self.needs.depth {
            let depths = self.depths[slot * N..].iter_mut().zip(&self.spare_depths);
            for (to, from) in depths.take(self.samples.count()) {
                copy(to, from);
            }
        }
    }

    /// Returns true if the next quad begins a new packet.
    #[inline(always)]
    pub(crate) fn begins_with_next_quad(&self) -> bool {
        self.open.is_none_or(|(_, quads)| quads >= QUADS)
    }

    /// Ends the packet that is being filled with quads.
    #[inline(always)]
    pub(crate) fn close_quads(&mut self) {
        self.open = None;
    }
}

impl Needs {
    /// Window position (x, y, z, 1/w) at any pixels.
    #[inline(always)]
    pub(super) fn position_of<S: Lanes>(
        &self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        pixels: WindowPixels<S>,
    ) -> [Packet<f32>; 4] {
        let mut position = [Packet::default(); 4];
        let [x, y, z, w] = &mut position;
        let [column, row] = pixels.coordinates([0.5; 2]);
        column.store_array(&mut x.0);
        row.store_array(&mut y.0);
        let depth = interpolant.depth_of(s, pixels, [0.5; 2]);
        clamp_depth(s, depth, self.depth_range).store_array(&mut z.0);
        interpolant.inverse_w_of(s, pixels).store_array(&mut w.0);
        position
    }

    /// The depth of each sample at any pixels.
    #[inline(always)]
    pub(super) fn depths_of<S: Lanes, const N: usize>(
        &self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        (pixels, samples): (WindowPixels<S>, SampleSet<N>),
        out: &mut [Packet<f32>],
    ) {
        let offsets = samples.offsets();
        for (depth, offset) in out.iter_mut().zip(offsets).take(samples.count()) {
            let value = interpolant.depth_of(s, pixels, offset);
            clamp_depth(s, value, self.depth_range).store_array(&mut depth.0);
        }
    }
}
