//! Texel gathering of sixteen lanes at once: one channel, or the comparison, of the four texels
//! around a coordinate in the base level.
//!
//! It gives the same results as the scalar code in `view/gather.rs`, for 2D views and arrays of the
//! formats of [`PacketFormat`](super::PacketFormat). Lanes that reach a border are gathered again
//! by the scalar code.

use super::Packet;
use crate::view::coordinates::{Answers, answer, packet};
use crate::view::gather::ORDER;
use crate::view::packet_texel::{OTHERS, passes};
use crate::view::plane::Plane;
use crate::view::{PacketRequest, SampledTexture};
use crate::wrap::wrap;
use estampe_simd::{LANES, Lanes as SimdLanes, SimdBase, dispatch, f32x16};
use estampe_types::state::CompareFunction;
use estampe_types::{AddressMode, FilterMode, Int, Real, ViewDimension};

impl SampledTexture {
    /// Gathers a channel of sixteen lanes, or comparison results if the channel is `None`. Returns
    /// the lanes that the scalar code gathered; `None`, with nothing stored, if packet code cannot
    /// do it.
    #[inline(always)]
    pub(crate) fn gather_packet(
        &self,
        lanes: &PacketRequest<'_>,
        channel: Option<usize>,
        texels: &mut Answers,
    ) -> Option<u32> {
        let format = self.packets?;
        let dimension = self.view.dimension;
        let is_flat = matches!(dimension, ViewDimension::D2 | ViewDimension::D2Array);
        if lanes.count != LANES || !is_flat {
            return None;
        }
        let function = self.sampler.compare.unwrap_or(CompareFunction::Never);
        let packet = Packet {
            of: self,
            format,
            lanes,
            compares: channel.is_none().then_some(function),
            is_simple: false,
        };
        // Comparisons need one channel only, and many formats have only one.
        let again = if channel.is_none() || format.components == 1 {
            packet.enter_gather::<1>(channel, texels)
        } else {
            packet.enter_gather::<4>(channel, texels)
        }?;
        let mut left = again;
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let four = match channel {
                Some(channel) => self.gather_lane(lanes, lane, channel),
                None => self.gather_compare_lane(lanes, lane),
            };
            answer(texels, lane, four);
        }
        Some(again)
    }
}

impl Packet<'_> {
    /// Gathers with the code for all formats of up to `C` channels. The scalar SIMD level has no
    /// packet code.
    fn enter_gather<const C: usize>(
        &self,
        channel: Option<usize>,
        texels: &mut Answers,
    ) -> Option<u32> {
        let channel = channel.unwrap_or(0) & 3;
        dispatch!(@wide_move self.of.level, s => {
            Some(self.gather::<_, C>(s, channel, texels))
        }, scalar => None)
    }

    /// Gathers the packet; returns the lanes that the scalar code must gather again.
    #[inline(always)]
    fn gather<S: SimdLanes, const C: usize>(
        &self,
        s: S,
        channel: usize,
        answers: &mut Answers,
    ) -> u32 {
        let like: f32x16<S> = SimdBase::splat(s, 0.0);
        let plane = &self.of.view.planes[0];
        let at = self.coordinates(like);
        let slice = self.spots(at).slice;
        let mut outside = 0;
        let x = self.gathered(plane, at[0], 0, &mut outside);
        let y = self.gathered(plane, at[1], 1, &mut outside);
        // No bit is lost: the lanes of a packet are sixteen.
        let again = u32::try_from(outside).unwrap_or(u32::MAX);
        let one = Int::splat(slice, 1);
        let next = (x[0] + one).eq(x[1]) & (y[0] + one).eq(y[1]);
        let is_square = !u32::from(s.bits_of_mask(next)) & !again & 0xFFFF == 0;
        let [width, height, _] = plane.sides;
        let first = slice * Int::splat(slice, height);
        let width = Int::splat(slice, width);
        let rows = [(first + y[0]) * width, (first + y[1]) * width];
        let places = [
            rows[0] + x[0],
            rows[0] + x[1],
            rows[1] + x[0],
            rows[1] + x[1],
        ];
        let words = self.words(s, plane, places, is_square, [2, 2]);
        let reference = self.reference(like);
        let scale = self.of.view.codec.scale()[channel];
        // A format of one channel has alpha 1, and no other channel.
        let missing = like.splat(if channel == 3 { 1.0 } else { 0.0 });
        // A loop, so that the long code of a texel is compiled once.
        for (number, corner) in ORDER.into_iter().enumerate() {
            let mut units = [like; C];
            self.format
                .units::<S, C, OTHERS>(s, &words[corner], &mut units);
            self.missing(&mut units);
            let result = match self.compares {
                Some(function) => passes(function, reference, units[0]),
                None if channel < C => units[channel] * scale,
                None => missing * scale,
            };
            answers[number] = packet(result, 0);
        }
        again
    }

    /// The two texels that gathering reads along an axis, as `axis::gathered` finds them; lanes
    /// with a border texel are added to `outside`.
    #[inline(always)]
    fn gathered<R: Real>(
        &self,
        plane: &Plane,
        u: R,
        axis: usize,
        outside: &mut u64,
    ) -> [R::Int; 2] {
        let mode = self.mode(axis);
        let places = if mode == AddressMode::Repeat && self.lanes.offset[axis] == 0 {
            self.plain_places(plane, wrap(u, mode), axis, FilterMode::Linear)
        } else {
            self.moved_places(plane, u, axis, true, outside)
        };
        places.texels
    }
}
