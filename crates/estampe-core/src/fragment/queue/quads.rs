//! Quads in the queue: packets whose four quads belong to different places or triangles.

use super::{CAPACITY, FragmentQueue};
use crate::fragment::interpolate::TriangleInterpolant;
use crate::fragment::place::Place;
use crate::fragment::quad::{QUAD, QUADS};
use estampe_simd::Lanes;

/// A quad of a triangle.
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
    /// Queues four quads of a triangle as a packet.
    #[inline(always)]
    pub(crate) fn push_four_quads<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
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
        if self.shares_colors(place, masks) {
            return;
        }
        let (slot, shaded) = self.begin(place, masks, if front { u16::MAX } else { 0 });
        let distances = triangle.distances_of_quads(s, [a.pixel, b.pixel, c.pixel, d.pixel]);
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        triangle.varyings_at(s, distances, out);
        for (quad, from) in quads.iter().enumerate() {
            self.set_quad(s, triangle, from, (slot, quad));
        }
    }

    /// Interpolates up to four quads of a triangle, for [`FragmentQueue::push_quad`].
    #[inline(always)]
    pub(crate) fn interpolate_quads<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
        quads: &[QuadPlace<N>; QUADS],
    ) {
        let [a, b, c, d] = quads;
        let distances = triangle.distances_of_quads(s, [a.pixel, b.pixel, c.pixel, d.pixel]);
        triangle.varyings_at(s, distances, &mut self.spare);
    }

    /// Queues one of the quads that [`FragmentQueue::interpolate_quads`] was last called for, in a
    /// packet that it shares with quads of other triangles. The queue must not be [full of
    /// quads](FragmentQueue::is_full_of_quads).
    #[inline(always)]
    pub(crate) fn push_quad<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
        (at, from): (usize, &QuadPlace<N>),
        front: bool,
    ) {
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
        let out = &mut self.varyings[shaded * self.scalars..][..self.scalars];
        let at = at % QUADS * QUAD;
        for (to, from) in out.iter_mut().zip(&self.spare) {
            to.0[shift..shift + QUAD].copy_from_slice(&from.0[at..at + QUAD]);
        }
        self.set_quad(s, triangle, from, (slot, quad));
    }

    /// Position and depths of a quad, where they are needed.
    #[inline(always)]
    fn set_quad<S: Lanes>(
        &mut self,
        s: S,
        triangle: &TriangleInterpolant<'_>,
        from: &QuadPlace<N>,
        (slot, quad): (usize, usize),
    ) {
        let range = self.needs.depth_range;
        if self.needs.position {
            let positions = &mut self.positions[usize::from(self.shaded_of[slot]) % CAPACITY];
            triangle.quad_position(s, from.pixel, quad, range, positions);
        }
        if self.needs.depth {
            let depths = &mut self.depths[slot * N..][..self.samples.count()];
            for (depth, offset) in depths.iter_mut().zip(self.samples.offsets()) {
                let to = &mut depth.0[quad % QUADS * QUAD..][..QUAD];
                triangle.quad_depth(s, from.pixel, offset, range, to);
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
