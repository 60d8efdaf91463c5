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
//! They keep their order, and no packet holds a pixel twice. Each kind of value is listed first,
//! packet after packet, and then taken from the list sixteen by sixteen: no branch depends on how
//! many are left of a packet, which cannot be predicted. Where a register holds half of a packet,
//! only where they come from is listed, and their values are gathered: there are fewer packets
//! after than before, and a list takes two permutations and two stores for each.

use super::{CAPACITY, FragmentQueue};
use crate::fragment::fill::{lanes_between, masks_of, samples_of};
use crate::fragment::last_packet::LastPacket;
use crate::fragment::place::{Place, indices_of};
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, Packing, Select, SimdBase, bits_of_packets, f32x16, u32x16,
};
use estampe_types::shader::DepthOutput;

/// Values in a list: those of all fragments of a full queue. Sixteen are written at a time, so
/// there is room behind the last one.
const ROOM: usize = (CAPACITY + 1) * LANES;

/// The bit beside a fragment's samples that says that its primitive faces the viewer.
const FRONT: u32 = 1 << 31;

/// The fragments that are left of a batch, in order: memory of one worker.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct Survivors {
    /// By packet: how its lanes that are left move together, and which these are.
    orders: [[u32; LANES]; CAPACITY],
    lanes: [u16; CAPACITY],
    /// By packet: how many are left of those before.
    firsts: [usize; CAPACITY],
    /// How many are left of all.
    len: usize,
    /// Where they come from: packet·16 + lane, where values are gathered.
    sources: [u32; ROOM],
    /// By packet: its pixels, and their samples, where they are gathered from.
    unlisted: [[u32; LANES]; 2 * CAPACITY],
    /// The pixels where they are, and their samples, one bit each, with [`FRONT`].
    places: [u32; ROOM],
    samples: [u32; ROOM],
    /// One value of each.
    values: [f32; ROOM],
    /// By packet that they are moved to: its first fragment.
    begins: [usize; CAPACITY],
    /// The pixels of that packet.
    pixels: LastPacket,
}

impl Default for Survivors {
    fn default() -> Self {
        Self {
            orders: [[0; LANES]; CAPACITY],
            lanes: [0; CAPACITY],
            firsts: [0; CAPACITY],
            len: 0,
            sources: [0; ROOM],
            unlisted: [[0; LANES]; 2 * CAPACITY],
            places: [0; ROOM],
            samples: [0; ROOM],
            values: [0.0; ROOM],
            begins: [0; CAPACITY],
            pixels: LastPacket::default(),
        }
    }
}

impl Survivors {
    /// Lists those of packets at some places, given the lanes of each sample that are left, and the
    /// lanes that face the viewer.
    #[inline(always)]
    fn list<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        places: &[Place],
        (masks, front): (&[[u16; N]], &[u16]),
    ) {
        let mut len = 0;
        let packets = places.iter().zip(masks).zip(front);
        let lists = self.orders.iter_mut().zip(&mut self.lanes);
        let lists = lists.zip(&mut self.firsts);
        for (((place, masks), front), ((order, lanes), first)) in packets.zip(lists) {
            *lanes = any_of(masks);
            let packing = Packing::new(s, *lanes);
            packing.store_order(order);
            let samples = samples_and_front(s, masks, *front);
            if let Some(to) = sixteen_mut(&mut self.places, len) {
                packing.store(s, place.pixels(s), to);
            }
            if let Some(to) = sixteen_mut(&mut self.samples, len) {
                packing.store(s, samples, to);
            }
            *first = len;
            len += packing.count();
        }
        self.end_list(len);
    }

    /// [`Survivors::list`] by gathers.
    #[inline(always)]
    fn list_sources<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        places: &[Place],
        (masks, front): (&[[u16; N]], &[u16]),
    ) {
        let mut len = 0;
        let packets = places.iter().zip(masks).zip(front);
        let unlisted = self.unlisted.as_chunks_mut().0;
        for (((place, masks), front), ([pixels, samples], first)) in
            packets.zip(unlisted.iter_mut().zip((0..).step_by(LANES)))
        {
            place.pixels(s).store_array(pixels);
            samples_and_front(s, masks, *front).store_array(samples);
            if let Some(to) = sixteen_mut(&mut self.sources, len) {
                len += s.list_bits(any_of(masks), first, to);
            }
        }
        // Those behind the last one are lanes, too.
        if let Some(behind) = sixteen_mut(&mut self.sources, len) {
            *behind = [0; LANES];
        }
        for from in (0..len).step_by(LANES) {
            let sources = u32x16::load_array_ref(s, sixteen(&self.sources, from));
            let lines = indices_of(s, sources, [2, 0]);
            let [places, samples] = s.gather_lines(self.unlisted.as_flattened(), lines);
            if let Some(to) = sixteen_mut(&mut self.places, from) {
                places.store_array(to);
            }
            if let Some(to) = sixteen_mut(&mut self.samples, from) {
                samples.store_array(to);
            }
        }
        self.end_list(len);
    }

    /// Notes how many are listed.
    #[inline(always)]
    fn end_list(&mut self, len: usize) {
        self.len = len;
        // What lies behind the last one must be pixels of the tile, too.
        if let Some(&last) = self.places.get(len.wrapping_sub(1))
            && let Some(behind) = sixteen_mut(&mut self.places, len)
        {
            *behind = [last; LANES];
        }
    }

    /// How many of those from one on a packet takes, which holds no pixel twice.
    #[inline(always)]
    fn packet_from<S: Lanes>(&mut self, s: S, from: usize) -> usize {
        let end = LANES.min(self.len - from);
        let pixels = (sixteen(&self.places, from), lanes_between(0, end));
        self.pixels.begin_with(s, pixels, false).min(end)
    }

    /// Moves their values from so many packets to those that they fill. There are `each` values of
    /// a fragment.
    #[inline(always)]
    fn move_values<S: Lanes>(
        &mut self,
        s: S,
        packets: &mut [Packet<f32>],
        each: usize,
        [before, after]: [usize; 2],
    ) {
        if const { S::HAS_WINDOWS } {
            return self.gather_values(s, packets, each, after);
        }
        for number in 0..each {
            let packings = self.orders.iter().zip(&self.lanes).take(before);
            let of_packets = packets[number..].iter().step_by(each);
            for ((packet, (order, lanes)), first) in of_packets.zip(packings).zip(&self.firsts) {
                let packing = Packing::load(s, order, *lanes);
                if let Some(to) = sixteen_mut(&mut self.values, *first) {
                    packing.store_f32(s, f32x16::load_array_ref(s, &packet.0), to);
                }
            }
            let of_packets = packets[number..].iter_mut().step_by(each);
            for (packet, begin) in of_packets.zip(&self.begins[..after]) {
                packet.0 = *sixteen(&self.values, *begin);
            }
        }
    }
}

impl Survivors {
    /// [`Survivors::move_values`] by gathers. Packets are written in order, each after it was read:
    /// a packet's pixels differ, so it ends one of those that are filled at most, and none of them
    /// has fragments of packets before its number.
    #[inline(always)]
    fn gather_values<S: Lanes>(
        &self,
        s: S,
        packets: &mut [Packet<f32>],
        each: usize,
        after: usize,
    ) {
        for (number, &begin) in self.begins[..after].iter().enumerate() {
            let sources = sixteen(&self.sources, begin);
            debug_assert!(
                sources[0] as usize / LANES >= number,
                "values are read first"
            );
            let lines = indices_of(s, u32x16::load_array_ref(s, sources), [each, 0]);
            let (fours, end) = (each / 4 * 4, number * each);
            for first in (0..fours).step_by(4) {
                let values = &bits_of_packets(packets)[first * LANES..];
                let [a, b, c, d] = s.gather_lines(values, lines);
                if let Some([to_a, to_b, to_c, to_d]) = packets[end + first..].first_chunk_mut() {
                    for (value, to) in [(a, to_a), (b, to_b), (c, to_c), (d, to_d)] {
                        let value: f32x16<S> = value.bitcast();
                        value.store_array(&mut to.0);
                    }
                }
            }
            for first in fours..each {
                let values = &bits_of_packets(packets)[first * LANES..];
                let value: f32x16<S> = s.gather(values, lines).bitcast();
                value.store_array(&mut packets[end + first].0);
            }
        }
    }
}

/// The lanes of all samples.
#[inline(always)]
fn any_of<const N: usize>(masks: &[u16; N]) -> u16 {
    masks.iter().fold(0, |any, mask| any | mask)
}

/// The samples of sixteen fragments, and [`FRONT`].
#[inline(always)]
fn samples_and_front<S: Lanes, const N: usize>(s: S, masks: &[u16; N], front: u16) -> u32x16<S> {
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    let is_front = s.mask_from_bits(front);
    samples_of(s, masks) | is_front.select(splat(FRONT), splat(0))
}

/// Sixteen values of a list.
#[inline(always)]
fn sixteen<T: Copy>(list: &[T; ROOM], from: usize) -> &[T; LANES] {
    let sixteen = list.get(from..).and_then(<[T]>::first_chunk);
    sixteen.unwrap_or_else(|| unreachable!("fragment {from} of a batch"))
}

#[inline(always)]
fn sixteen_mut<T>(list: &mut [T; ROOM], from: usize) -> Option<&mut [T; LANES]> {
    list.get_mut(from..).and_then(<[T]>::first_chunk_mut)
}

impl<const N: usize> FragmentQueue<N> {
    /// Moves what is left of the shaded packets into fewer ones, if most of their lanes are empty.
    /// Returns how many packets there were and how many there are, or zeros if there is nothing to
    /// gain. Each packet must have a run of the program of its own.
    #[inline(always)]
    pub(crate) fn gather_survivors<S: Lanes>(
        &mut self,
        s: S,
        survivors: &mut Survivors,
    ) -> [u64; 2] {
        let before = self.len.min(CAPACITY);
        let counts = self.masks[..before]
            .iter()
            .map(|of| any_of(of).count_ones());
        let count: u32 = counts.sum();
        if self.color_passthrough || count as usize * 2 > before * LANES {
            return [0; 2];
        }
        debug_assert!(
            (0..before).all(|slot| self.shaded(slot) == slot),
            "packets share no colours"
        );
        let fragments = (&self.masks[..before], &self.front_facing[..before]);
        if const { S::HAS_WINDOWS } {
            survivors.list_sources(s, &self.places[..before], fragments);
        } else {
            survivors.list(s, &self.places[..before], fragments);
        }
        let (mut after, mut from) = (0, 0);
        while from < survivors.len {
            debug_assert!(after < before, "a packet opens one more at most");
            let taken = survivors.packet_from(s, from);
            let lanes = lanes_between(0, taken);
            let samples = sixteen(&survivors.samples, from);
            let front = s.sign_bits(u32x16::load_array_ref(s, samples).bitcast());
            self.places[after] = Place::of_pixels(sixteen(&survivors.places, from));
            self.masks[after] = masks_of(s, samples, lanes);
            self.front_facing[after] = front & lanes;
            survivors.begins[after] = from;
            after += 1;
            from += taken;
        }
        let packets = [before, after];
        survivors.move_values(s, &mut self.colors, self.colors_each * 4, packets);
        if self.needs.depth {
            survivors.move_values(s, &mut self.depths, N, packets);
        }
        if self.depth_output != DepthOutput::None {
            survivors.move_values(s, &mut self.depth_out, 1, packets);
        }
        (self.len, self.shaded_len) = (after, after);
        packets.map(|count| count as u64)
    }
}
