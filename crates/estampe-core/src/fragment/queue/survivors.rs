//! Survivors: the fragments that are left of shaded packets, moved together.
//!
//! Most fragments of a leaf or a fence are discarded, or have no alpha that covers a sample. Tests
//! and colours after shading would go over packets of which a lane or two are left. So these lanes
//! are moved to fewer packets before:
//!
//! ```text
//!   ·a·· ··b· ···· c·d·   ─▶   abcd
//! ```
//!
//! They keep their order, and no packet holds a pixel twice. A packet opens one more at most, since
//! its own pixels are different ones: none is moved to a packet behind its own, so all are moved in
//! place.

use super::{CAPACITY, FragmentQueue, replace};
use crate::fragment::fill::{LANE_NUMBERS, lanes_between, masks_of, samples_of};
use crate::fragment::last_packet::LastPacket;
use crate::fragment::place::Place;
use estampe_simd::{Bytes, LANES, Lanes, Packet, Select, SimdBase, f32x16, u32x16};
use estampe_types::shader::DepthOutput;

/// Where fragments of a packet go.
struct Move<S: Lanes> {
    /// By lane of the packet that they go to: their lane before.
    order: u32x16<S>,
    /// The lanes that they go to.
    lanes: u16,
    /// True if they are the packet's first.
    is_first: bool,
}

impl<S: Lanes> Move<S> {
    /// Moves their values, of which each packet has some.
    #[inline(always)]
    fn packets(&self, s: S, packets: &mut [Packet<f32>], each: usize, [from, to]: [usize; 2]) {
        for number in 0..each {
            let values = f32x16::load_array_ref(s, &packets[from * each + number].0);
            let moved = s.permute_f32(values, self.order);
            let to = &mut packets[to * each + number];
            if self.is_first {
                // Lanes that are filled later, or never, may hold anything.
                moved.store_array(&mut to.0);
            } else {
                replace(s, to, self.lanes, moved);
            }
        }
    }
}

/// The fragments that are left of a batch, in order.
struct Survivors {
    /// The pixels where they are, with room to load sixteen anywhere.
    places: [u32; (CAPACITY + 1) * LANES],
    /// By packet: their lanes, in ascending order, and how many they are.
    lanes: [[u32; LANES]; CAPACITY],
    counts: [usize; CAPACITY],
    len: usize,
}

impl Survivors {
    /// Lists those of packets at some places, given the lanes that are left of each.
    #[inline(always)]
    fn list<S: Lanes>(s: S, places: &[Place], left: &[u16; CAPACITY]) -> Self {
        let mut survivors = Self {
            places: [0; (CAPACITY + 1) * LANES],
            lanes: [[0; LANES]; CAPACITY],
            counts: [0; CAPACITY],
            len: 0,
        };
        let packets = survivors.lanes.iter_mut().zip(&mut survivors.counts);
        for ((place, left), (lanes, count)) in places.iter().zip(left).zip(packets) {
            if *left == 0 {
                continue;
            }
            *count = s.list_bits(*left, 0, lanes);
            let moved = s.permute(place.pixels(s), u32x16::load_array_ref(s, lanes));
            let to = survivors.places.get_mut(survivors.len..);
            if let Some(to) = to.and_then(<[u32]>::first_chunk_mut) {
                moved.store_array(to);
            }
            survivors.len += *count;
        }
        survivors
    }

    /// The pixels of those from one on, and how many of these a packet takes, which holds no pixel
    /// twice.
    #[inline(always)]
    fn packet_from<S: Lanes>(
        &self,
        s: S,
        from: usize,
        pixels: &mut LastPacket,
    ) -> (&[u32; LANES], usize) {
        let places = self.places.get(from..).and_then(<[u32]>::first_chunk);
        let places = places.unwrap_or(&[0; LANES]);
        let end = LANES.min(self.len - from);
        let lanes = lanes_between(0, end);
        (
            places,
            pixels.begin_with(s, (places, lanes), false).min(end),
        )
    }
}

impl<const N: usize> FragmentQueue<N> {
    /// Moves what is left of the shaded packets into fewer ones, if most of their lanes are empty.
    /// Returns how many packets there were and how many there are, or zeros if there is nothing to
    /// gain. Each packet must have a run of the program of its own.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "numbers of lanes")]
    pub(crate) fn gather_survivors<S: Lanes>(&mut self, s: S, pixels: &mut LastPacket) -> [u64; 2] {
        let len = self.len.min(CAPACITY);
        let (mut left, mut count) = ([0; CAPACITY], 0);
        for (left, masks) in left.iter_mut().zip(&self.masks[..len]) {
            *left = masks.iter().fold(0, |any, mask| any | mask);
            count += left.count_ones() as usize;
        }
        if self.color_passthrough || count * 2 > len * LANES {
            return [0; 2];
        }
        let survivors = Survivors::list(s, &self.places[..len], &left);
        let (mut packets, mut slot, mut done) = (0, 0, 0);
        let mut from = 0;
        while from < survivors.len {
            let (places, taken) = survivors.packet_from(s, from, pixels);
            self.places[packets] = Place::of_pixels(places);
            let mut used = 0;
            while used < taken {
                let rest = survivors.counts[slot] - done;
                if rest == 0 {
                    (slot, done) = (slot + 1, 0);
                    continue;
                }
                debug_assert!(packets <= slot, "a packet opens one more at most");
                debug_assert_eq!(self.shaded(slot), slot, "packets share no colours");
                let end = taken.min(used + rest);
                let first = u32x16::load_array(s, LANE_NUMBERS);
                let shift = (done as u32).wrapping_sub(used as u32);
                let lanes = u32x16::load_array_ref(s, &survivors.lanes[slot]);
                let moves = Move {
                    order: s.permute(lanes, first + shift),
                    lanes: lanes_between(used, end),
                    is_first: used == 0,
                };
                self.move_fragments(s, &moves, [slot, packets]);
                done += end - used;
                used = end;
            }
            packets += 1;
            from += taken;
        }
        (self.len, self.shaded_len) = (packets, packets);
        [len as u64, packets as u64]
    }

    /// Moves some fragments of a packet to another one.
    #[inline(always)]
    fn move_fragments<S: Lanes>(&mut self, s: S, moves: &Move<S>, [from, to]: [usize; 2]) {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let samples = s.permute(samples_of(s, &self.masks[from], false), moves.order);
        let is_front = s.mask_from_bits(self.front_facing[from]);
        let front = s.permute(is_front.select(splat(u32::MAX), splat(0)), moves.order);
        let front = s.sign_bits(front.bitcast()) & moves.lanes;
        let masks: [u16; N] = masks_of(s, &samples.to_array(), moves.lanes, false);
        if moves.is_first {
            (self.masks[to], self.front_facing[to]) = ([0; N], 0);
        }
        for (to, mask) in self.masks[to].iter_mut().zip(masks) {
            *to |= mask;
        }
        self.front_facing[to] |= front;
        moves.packets(s, &mut self.colors, self.colors_each * 4, [from, to]);
        if self.needs.depth {
            moves.packets(s, &mut self.depths, N, [from, to]);
        }
        if self.depth_output != DepthOutput::None {
            moves.packets(s, &mut self.depth_out, 1, [from, to]);
        }
    }
}
