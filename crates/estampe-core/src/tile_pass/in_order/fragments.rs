//! Lists of fragments that fill packets, and the pixels of the packet that is being filled.

use crate::raster::MAX_PACKETS;
use crate::raster::small::PIXELS;
use estampe_simd::{LANES, Lanes, SimdBase, u32x16};
use std::hint::select_unpredictable;

/// Listed pixels that have passed the early tests.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct Fragments {
    /// Which they are among their triangles' pixels, as in a
    /// [`PixelList`](crate::raster::pixel_list::PixelList).
    pixels: [u32; Self::ROOM],
    /// Where they are in the tile: packet·16 + lane.
    places: [u32; Self::ROOM],
    /// Their samples, one bit each.
    samples: [u32; Self::ROOM],
    len: usize,
}

impl Default for Fragments {
    fn default() -> Self {
        Self {
            pixels: [0; Self::ROOM],
            places: [0; Self::ROOM],
            samples: [0; Self::ROOM],
            len: 0,
        }
    }
}

impl Fragments {
    /// The index of the first one. So many lanes before it may be loaded with it.
    const FIRST: usize = LANES;

    /// The most fragments: all pixels of sixteen small triangles.
    pub(super) const MOST: usize = PIXELS * LANES;

    /// Sixteen more, because so many are written at a time.
    const ROOM: usize = Self::FIRST + Self::MOST + LANES;

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Adds those of sixteen fragments that are in a mask: pixels, places, samples.
    #[inline(always)]
    pub(super) fn add<S: Lanes>(&mut self, s: S, kept: u16, of: [u32x16<S>; 3]) {
        let mut order = [0; LANES];
        let count = s.list_bits(kept, 0, &mut order);
        let order = u32x16::load_array(s, order);
        let lists = [&mut self.pixels, &mut self.places, &mut self.samples];
        for (list, values) in lists.into_iter().zip(of) {
            if let Some(to) = chunk_from(list, Self::FIRST + self.len) {
                s.permute(values, order).store_array(to);
            }
        }
        self.len += count;
        debug_assert!(self.len <= Self::MOST, "{} fragments", self.len);
    }

    /// Sixteen fragments: pixels, places, samples. The lane of fragment `from` is `lane`.
    #[inline(always)]
    pub(super) fn sixteen(&self, from: usize, lane: usize) -> [&[u32; LANES]; 3] {
        let first = Self::FIRST + from - lane % LANES;
        [
            sixteen_of(&self.pixels, first),
            sixteen_of(&self.places, first),
            sixteen_of(&self.samples, first),
        ]
    }

    /// Repeats the last fragment behind the end, and the first before the beginning: numbers of
    /// others could be slow.
    #[inline(always)]
    pub(super) fn end(&mut self) {
        let end = Self::FIRST + self.len;
        for list in [&mut self.pixels, &mut self.places, &mut self.samples] {
            let (first, last) = (list[Self::FIRST], list[(end - 1) % Self::ROOM]);
            if let Some(before) = list.first_chunk_mut() {
                *before = [first; Self::FIRST];
            }
            if let Some(behind) = chunk_from(list, end) {
                *behind = [last; LANES];
            }
        }
    }
}

#[inline(always)]
fn chunk_from(list: &mut [u32; Fragments::ROOM], from: usize) -> Option<&mut [u32; LANES]> {
    list.get_mut(from..).and_then(<[u32]>::first_chunk_mut)
}

#[inline(always)]
fn sixteen_of(list: &[u32; Fragments::ROOM], from: usize) -> &[u32; LANES] {
    let sixteen = list.get(from..).and_then(<[u32]>::first_chunk);
    sixteen.unwrap_or(&[0; LANES])
}

/// Which pixels of the tile the last packet holds.
#[derive(Debug)]
pub(super) struct LastPacket {
    /// By pixel: the number of the last packet that holds it.
    packet_of: [u32; MAX_PACKETS * LANES],
    /// The number of the last packet.
    number: u32,
}

impl Default for LastPacket {
    fn default() -> Self {
        Self {
            packet_of: [0; MAX_PACKETS * LANES],
            number: 0,
        }
    }
}

impl LastPacket {
    /// Begins a packet, which holds no pixel yet.
    #[inline(always)]
    pub(super) fn begin(&mut self) {
        if self.number == u32::MAX {
            self.number = 0;
            self.packet_of.fill(0);
        }
        self.number += 1;
    }

    /// Notes all pixels of a packet of the tile.
    #[inline(always)]
    pub(super) fn add_whole(&mut self, packet: u16) {
        let (packets, _) = self.packet_of.as_chunks_mut::<LANES>();
        packets[usize::from(packet) % MAX_PACKETS] = [self.number; LANES];
    }

    /// Adds the pixels of some lanes. Returns the first lane that the packet cannot take, because
    /// it holds its pixel already, or [`LANES`]; with this lane another packet must begin.
    #[inline(always)]
    pub(super) fn add(&mut self, places: &[u32; LANES], lanes: u16) -> usize {
        let mut again = 0u32;
        for (lane, place) in places.iter().enumerate() {
            let of_pixel = &mut self.packet_of[*place as usize % (MAX_PACKETS * LANES)];
            again |= u32::from(*of_pixel == self.number) << lane;
            let is_added = lanes >> lane & 1 == 1;
            *of_pixel = select_unpredictable(is_added, self.number, *of_pixel);
        }
        let again = again & u32::from(lanes);
        (again | 1 << LANES).trailing_zeros() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packet_takes_no_pixel_twice() {
        let mut places = [0; LANES];
        for (place, number) in places.iter_mut().zip(100..) {
            *place = number;
        }
        let mut last = LastPacket::default();
        last.begin();
        assert_eq!(last.add(&places, 0x00FF), LANES);
        // The second half is new, the first one is not asked for.
        assert_eq!(last.add(&places, 0xFF00), LANES);
        assert_eq!(last.add(&places, 0x0C00), 10);
        last.begin();
        places[9] = places[3];
        assert_eq!(last.add(&places, u16::MAX), 9);
        last.begin();
        assert_eq!(last.add(&places, !(1 << 3)), LANES);
        last.begin();
        last.add_whole(6);
        assert_eq!(last.add(&places, u16::MAX), 0, "place 100 is in packet 6");
    }
}
