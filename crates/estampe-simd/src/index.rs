//! Indices that cannot be out of range: a lane of a packet, and a packet of a tile.
//!
//! Both are bytes that index arrays of a fixed length, so that no access needs a modulo or a bounds
//! check, and a number that would be out of range is found where it is made, not where it is used.

use crate::{LANES, Packet};
use std::ops::{Index, IndexMut};

/// A lane: below [`LANES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lane(u8);

impl Lane {
    /// Every lane, in order.
    pub const ALL: [Self; LANES] = {
        let mut all = [Self(0); LANES];
        let mut lane: u8 = 0;
        while (lane as usize) < LANES {
            all[lane as usize] = Self(lane);
            lane += 1;
        }
        all
    };

    /// The lane of a number below [`LANES`].
    ///
    /// # Panics
    /// In debug builds when the number is not a lane's. In release builds it is taken modulo
    /// [`LANES`].
    #[inline(always)]
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "masked to four bits")]
    pub fn new(number: usize) -> Self {
        debug_assert!(number < LANES, "{number} is no lane");
        Self((number % LANES) as u8)
    }

    /// The lane of the lowest bit that is set; none in an empty mask.
    #[inline(always)]
    #[must_use]
    pub fn first_of(mask: u16) -> Option<Self> {
        (mask != 0).then(|| Self::new(mask.trailing_zeros() as usize))
    }

    /// The lanes whose bits are set in a mask, in ascending order.
    #[inline(always)]
    pub fn all_of(mask: u16) -> LanesOf {
        LanesOf(mask)
    }

    /// The lane's number.
    #[inline(always)]
    #[must_use]
    pub fn get(self) -> usize {
        // The mask lets the compiler drop bounds checks on arrays of sixteen.
        usize::from(self.0) & (LANES - 1)
    }

    /// The mask of this lane alone.
    #[inline(always)]
    #[must_use]
    pub fn bit(self) -> u16 {
        1 << self.get()
    }

    /// Returns true if a mask contains the lane.
    #[inline(always)]
    #[must_use]
    pub fn is_in(self, mask: u16) -> bool {
        mask & self.bit() != 0
    }

    /// The lane's element of an array of sixteen.
    #[inline(always)]
    #[must_use]
    pub fn of<T: Copy>(self, values: &[T; LANES]) -> T {
        values[self.get()]
    }

    /// The lane's place in an array of sixteen.
    #[inline(always)]
    #[must_use]
    pub fn of_mut<T>(self, values: &mut [T; LANES]) -> &mut T {
        &mut values[self.get()]
    }
}

impl<T> Index<Lane> for Packet<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, lane: Lane) -> &T {
        &self.0[lane.get()]
    }
}

impl<T> IndexMut<Lane> for Packet<T> {
    #[inline(always)]
    fn index_mut(&mut self, lane: Lane) -> &mut T {
        &mut self.0[lane.get()]
    }
}

/// The lanes of a mask, in ascending order: see [`Lane::all_of`].
#[derive(Debug, Clone)]
pub struct LanesOf(u16);

impl Iterator for LanesOf {
    type Item = Lane;

    #[inline(always)]
    fn next(&mut self) -> Option<Lane> {
        let lane = Lane::first_of(self.0)?;
        self.0 &= self.0 - 1;
        Some(lane)
    }

    #[inline(always)]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let count = self.0.count_ones() as usize;
        (count, Some(count))
    }
}

impl ExactSizeIterator for LanesOf {}

/// A packet of 4×4 pixels in a tile, in Morton order: a tile has at most [`PacketIndex::COUNT`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PacketIndex(pub u8);

impl PacketIndex {
    /// Packets of the largest tile.
    pub const COUNT: usize = 256;

    /// The packet of a number below [`PacketIndex::COUNT`].
    ///
    /// # Panics
    /// In debug builds when the number is not a packet's. In release builds it is taken modulo
    /// [`PacketIndex::COUNT`].
    #[inline(always)]
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "masked to eight bits")]
    pub fn new(number: usize) -> Self {
        debug_assert!(number < Self::COUNT, "{number} is no packet of a tile");
        Self((number % Self::COUNT) as u8)
    }

    /// The packet's number.
    #[inline(always)]
    #[must_use]
    pub fn get(self) -> usize {
        usize::from(self.0)
    }

    /// The packet's element of an array with one for each packet of a tile.
    #[inline(always)]
    #[must_use]
    pub fn of<T: Copy>(self, values: &[T; Self::COUNT]) -> T {
        values[self.get()]
    }

    /// The packet's place in an array with one for each packet of a tile.
    #[inline(always)]
    #[must_use]
    pub fn of_mut<T>(self, values: &mut [T; Self::COUNT]) -> &mut T {
        &mut values[self.get()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_masks_lanes_come_in_ascending_order() {
        let numbers = |mask| -> Vec<usize> { Lane::all_of(mask).map(Lane::get).collect() };
        assert_eq!(numbers(0), []);
        assert_eq!(numbers(0b1000_0000_0001_0110), [1, 2, 4, 15]);
        assert_eq!(numbers(u16::MAX), (0..LANES).collect::<Vec<_>>());
        assert_eq!(Lane::all_of(0b101).len(), 2);
        assert_eq!(Lane::first_of(0), None);
        assert_eq!(Lane::first_of(0b1100), Some(Lane::ALL[2]));
    }

    #[test]
    fn lanes_and_packets_index_what_they_number() {
        let values = std::array::from_fn(|at| at);
        let mut packet = Packet(values);
        for (at, lane) in Lane::ALL.into_iter().enumerate() {
            assert_eq!((lane, lane.of(&values)), (Lane::new(at), at));
            assert_eq!((lane.bit(), packet[lane]), (1 << at, at));
            packet[lane] += 1;
            assert_eq!(packet[lane], at + 1);
        }
        let values: [usize; PacketIndex::COUNT] = std::array::from_fn(|at| at);
        for at in [0, 17, 255] {
            assert_eq!(PacketIndex::new(at).of(&values), at);
        }
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "16 is no lane")]
    fn a_number_that_is_no_lane_is_found_at_once() {
        let _ = Lane::new(16);
    }
}
