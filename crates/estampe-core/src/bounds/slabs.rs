//! Slabs: memory in which the packets of many chunks lie one behind the other.
//!
//! A chunk has up to a megabyte of packets. In memory of their own they would be on pages of 4 kB,
//! of which a mesh fills thousands, and the processor would look for a page at almost each packet
//! that it writes, and once more at each that a tile reads. A slab is large enough for huge pages.
//!
//! A chunk that is being made [borrows](Slabs::lend) a slab, adds its packets behind those of other
//! chunks, and gives it back: where its packets are is its [`Place`].

use estampe_simd::advise_huge_pages;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Bytes of a large slab.
const LARGE_BYTES: usize = 16 << 20;

/// Memory of all chunks' packets of one kind.
#[derive(Debug)]
pub(crate) struct Slabs<P> {
    slabs: Vec<Slab<P>>,
}

#[derive(Debug)]
struct Slab<P> {
    /// Packets, those behind the used ones of an earlier pass.
    memory: Vec<P>,
    used: usize,
    is_lent: bool,
}

/// Slabs that threads borrow. One in which a thread panicked is as any other: a slab that did not
/// come back is empty.
#[derive(Debug)]
pub(crate) struct SharedSlabs<P>(Mutex<Slabs<P>>);

/// A slab that a chunk adds packets to.
#[derive(Debug)]
pub(crate) struct LentSlab<P> {
    /// Packets of other chunks up to `first`, and then stale ones.
    pub(crate) memory: Vec<P>,
    pub(crate) first: usize,
    number: usize,
}

/// Where the packets of a chunk are.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Place {
    slab: usize,
    first: usize,
    len: usize,
}

/// The packets that chunks are expected to have.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Expected {
    /// Of one chunk, at most.
    pub(crate) most: usize,
    /// Of all chunks that one thread makes next, about.
    pub(crate) share: usize,
}

impl<P> Default for Slabs<P> {
    fn default() -> Self {
        Self { slabs: Vec::new() }
    }
}

impl<P> Default for SharedSlabs<P> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<P> SharedSlabs<P> {
    /// See [`Slabs::lend`].
    pub(crate) fn lend(&self, expected: Expected) -> LentSlab<P> {
        let mut slabs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slabs.lend(expected)
    }

    /// See [`Slabs::take_back`].
    pub(crate) fn take_back(&self, lent: LentSlab<P>, len: usize) -> Place {
        let mut slabs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slabs.take_back(lent, len)
    }

    /// The slabs, while no thread borrows any.
    pub(crate) fn get_mut(&mut self) -> &mut Slabs<P> {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<P> Default for LentSlab<P> {
    fn default() -> Self {
        Self {
            memory: Vec::new(),
            first: 0,
            number: usize::MAX,
        }
    }
}

impl<P> Slabs<P> {
    /// Forgets the packets of all chunks, and keeps the memory.
    pub(crate) fn clear(&mut self) {
        for slab in &mut self.slabs {
            (slab.used, slab.is_lent) = (0, false);
        }
    }

    /// Lends a slab with room for a chunk's packets. More than are expected can be added, too, but
    /// then the slab may move.
    fn lend(&mut self, expected: Expected) -> LentSlab<P> {
        if expected.most == 0 {
            return LentSlab::default();
        }
        let has_room =
            |slab: &Slab<P>| !slab.is_lent && slab.memory.capacity() - slab.used >= expected.most;
        let number = match self.slabs.iter().position(has_room) {
            Some(number) => number,
            None => self.add(expected),
        };
        let slab = &mut self.slabs[number];
        slab.is_lent = true;
        LentSlab {
            memory: std::mem::take(&mut slab.memory),
            first: slab.used,
            number,
        }
    }

    /// Adds a slab: a large one where many packets are expected, for nobody knows how many chunks
    /// come. What is never used of it takes no memory.
    fn add(&mut self, Expected { most, share }: Expected) -> usize {
        let large = LARGE_BYTES / size_of::<P>();
        let packets = if share >= large / 16 { large } else { share };
        let packets = packets.max(most);
        let mut memory = Vec::with_capacity(packets);
        advise_huge_pages(memory.spare_capacity_mut());
        self.slabs.push(Slab {
            memory,
            used: 0,
            is_lent: false,
        });
        self.slabs.len() - 1
    }

    /// Takes a slab back, to which a chunk added `len` packets.
    fn take_back(&mut self, lent: LentSlab<P>, len: usize) -> Place {
        let LentSlab {
            memory,
            first,
            number,
        } = lent;
        let slab = Slab {
            memory,
            used: first + len,
            is_lent: false,
        };
        let number = match self.slabs.get_mut(number) {
            Some(place) => {
                *place = slab;
                number
            }
            // A chunk of which no packets were expected has memory of its own.
            None if len > 0 => {
                self.slabs.push(slab);
                self.slabs.len() - 1
            }
            None => return Place::default(),
        };
        Place {
            slab: number,
            first,
            len,
        }
    }

    /// The packets at a place.
    #[inline(always)]
    pub(crate) fn packets(&self, place: Place) -> &[P] {
        let Range { start, end } = place.first..place.first + place.len;
        let slab = self.slabs.get(place.slab);
        slab.and_then(|slab| slab.memory.get(start..end))
            .unwrap_or(&[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adds the packets `values` as a chunk that expects `most`.
    fn add(slabs: &mut Slabs<u32>, most: usize, values: Range<u32>) -> Place {
        let mut lent = slabs.lend(Expected { most, share: 100 });
        assert!(lent.memory.capacity() - lent.first >= most, "room for all");
        lent.memory.truncate(lent.first);
        lent.memory.extend(values.clone());
        slabs.take_back(lent, values.len())
    }

    #[test]
    fn packets_of_chunks_lie_one_behind_the_other() {
        let mut slabs = Slabs::default();
        // Twice, as memory is used again.
        for _ in 0..2 {
            slabs.clear();
            let places = [
                add(&mut slabs, 60, 0..40),
                add(&mut slabs, 60, 40..100),
                // No room is left for this one.
                add(&mut slabs, 60, 100..101),
                add(&mut slabs, 0, 0..0),
                // More than all slabs hold.
                add(&mut slabs, 5000, 101..200),
            ];
            let packets: Vec<u32> = places
                .iter()
                .flat_map(|place| slabs.packets(*place).iter().copied())
                .collect();
            assert!(packets.into_iter().eq(0..200));
            assert_eq!(places.map(|place| place.slab), [0, 0, 1, 0, 2]);
            assert_eq!(places[1].first, 40);
            assert_eq!(slabs.slabs.len(), 3, "the second time, none is added");
        }
    }

    #[test]
    fn packets_that_nobody_expected_are_kept() {
        let mut slabs = Slabs::default();
        let places = [(0, 0..30), (10, 30..31), (10, 31..80)].map(|(most, values)| {
            let mut lent = slabs.lend(Expected { most, share: 0 });
            lent.memory.truncate(lent.first);
            lent.memory.extend(values.clone());
            slabs.take_back(lent, values.len())
        });
        let packets = places.iter().flat_map(|place| slabs.packets(*place));
        assert!(packets.copied().eq(0..80));
    }

    #[test]
    fn a_lent_slab_is_not_lent_to_others() {
        let mut slabs: Slabs<u32> = Slabs::default();
        let expected = Expected { most: 10, share: 0 };
        let [one, other] = [(); 2].map(|()| slabs.lend(expected));
        assert_ne!(one.number, other.number);
        slabs.take_back(other, 0);
        let third = slabs.lend(expected);
        assert_ne!(one.number, third.number);
        // One that never comes back, as its worker panicked, is empty in the next pass.
        drop(one);
        slabs.clear();
        assert!(
            slabs
                .packets(Place {
                    slab: 0,
                    first: 0,
                    len: 3
                })
                .is_empty()
        );
        let fresh = slabs.lend(Expected { most: 20, share: 0 });
        assert!(fresh.memory.capacity() >= 20);
    }
}
