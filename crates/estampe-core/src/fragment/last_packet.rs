//! The pixels of the packet that is being filled.

use super::fill::LANE_NUMBERS;
use crate::raster::MAX_PACKETS;
use estampe_simd::{LANES, Lanes, Select, SimdBase, SimdMask, SimdSplit, u32x16};
use std::hint::select_unpredictable;

/// Which pixels of the tile the last packet holds.
#[derive(Debug)]
pub(crate) struct LastPacket {
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
    /// Begins a packet with the pixels of some lanes; `more` says that others may be added. Returns
    /// the first lane that it cannot take, as [`LastPacket::add`] does.
    #[inline(always)]
    pub(crate) fn begin_with<S: Lanes>(
        &mut self,
        s: S,
        (places, lanes): (&[u32; LANES], u16),
        more: bool,
    ) -> usize {
        self.begin();
        if !more {
            let of_lanes = u32x16::load_array_ref(s, places);
            if let Some(again) = s.repeats(of_lanes, lanes) {
                return (u32::from(again) | 1 << LANES).trailing_zeros() as usize;
            }
            // Most often all are different, and where the two halves of a packet are registers, it
            // takes a fifth of the operations to see that.
            if const { S::HAS_WINDOWS } && are_distinct(s, of_lanes, lanes) {
                return LANES;
            }
        }
        self.add(places, lanes)
    }

    /// Begins a packet, which holds no pixel yet.
    #[inline(always)]
    fn begin(&mut self) {
        if self.number == u32::MAX {
            self.number = 0;
            self.packet_of.fill(0);
        }
        self.number += 1;
    }

    /// Notes all pixels of a packet of the tile.
    #[inline(always)]
    pub(crate) fn add_whole(&mut self, packet: u16) {
        let (packets, _) = self.packet_of.as_chunks_mut::<LANES>();
        packets[usize::from(packet) % MAX_PACKETS] = [self.number; LANES];
    }

    /// Adds the pixels of some lanes. Returns the first lane that the packet cannot take, because
    /// it holds its pixel already, or [`LANES`]; with this lane another packet must begin.
    #[inline(always)]
    pub(crate) fn add(&mut self, places: &[u32; LANES], lanes: u16) -> usize {
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

/// Returns true if the pixels of some lanes are different ones: as half words, each is compared
/// with those one to eight lanes further, around the end.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a tile has 4096 pixels")]
fn are_distinct<S: Lanes>(s: S, places: u32x16<S>, lanes: u16) -> bool {
    // No pixel of a tile, and different in each lane.
    let other = u32x16::load_array(s, LANE_NUMBERS) | (MAX_PACKETS * LANES) as u32;
    let places = s.mask_from_bits(lanes).select(places, other);
    let (low, high) = places.split();
    let places = s.narrow_u32x8(low, high);
    let equal = places.simd_eq(places.slide::<1>(places))
        | places.simd_eq(places.slide::<2>(places))
        | places.simd_eq(places.slide::<3>(places))
        | places.simd_eq(places.slide::<4>(places))
        | places.simd_eq(places.slide::<5>(places))
        | places.simd_eq(places.slide::<6>(places))
        | places.simd_eq(places.slide::<7>(places))
        | places.simd_eq(places.slide::<8>(places));
    equal.all_false()
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

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

    #[test]
    fn a_packet_may_begin_with_all_of_its_pixels() {
        let mut places = [0; LANES];
        for (place, number) in places.iter_mut().zip(100..) {
            *place = number;
        }
        places[9] = places[3];
        let mut last = LastPacket::default();
        for level in Level::all_available() {
            for more in [false, true] {
                let mut begin =
                    |lanes| dispatch!(level, s => last.begin_with(s, (&places, lanes), more));
                assert_eq!(begin(u16::MAX), 9, "{level:?}");
                assert_eq!(begin(u16::MAX), 9, "{level:?}: as new as before");
                assert_eq!(begin(!(1 << 3)), LANES, "{level:?}");
                assert_eq!(begin(0x01FF), LANES, "{level:?}");
            }
        }
        // The last packet may have more.
        places[0] = 200;
        assert_eq!(last.add(&places, 1), LANES);
        assert_eq!(last.add(&places, 0b10), 1);
    }

    #[test]
    fn any_two_lanes_may_have_the_same_pixel() {
        let mut last = LastPacket::default();
        for first in 0..LANES {
            for second in first + 1..LANES {
                let mut places = LANE_NUMBERS.map(|lane| 4000 + lane);
                places[second] = places[first];
                let without = !(1 << first);
                for level in Level::all_available() {
                    let mut begin =
                        |lanes| dispatch!(level, s => last.begin_with(s, (&places, lanes), false));
                    assert_eq!(begin(u16::MAX), second, "{level:?}, {first}");
                    assert_eq!(begin(without), LANES, "{level:?}, {first} and {second}");
                }
            }
        }
    }
}
