//! Packets whose memory outlives a chunk's contents.
//!
//! A packet is about 1 KB, and to fill it with zeros before it is written would cost as much as
//! writing it.

use super::primitives::TrianglePacket;
use super::slabs::{Expected, LentSlab, Place, SharedSlabs, Slabs};

/// Packets of a chunk that are written over what their memory held before.
#[derive(Debug)]
pub(crate) struct StalePackets<P> {
    /// While packets are added: their memory.
    slab: LentSlab<P>,
    /// After that: where they are.
    place: Place,
    len: usize,
    /// The number of packets up to the last that is more than a number.
    written: usize,
}

impl<P> Default for StalePackets<P> {
    fn default() -> Self {
        Self {
            slab: LentSlab::default(),
            place: Place::default(),
            len: 0,
            written: 0,
        }
    }
}

impl<P: Default> StalePackets<P> {
    /// Forgets the packets, and borrows memory for others.
    pub(crate) fn open(&mut self, slabs: &SharedSlabs<P>, expected: Expected) {
        (self.len, self.written, self.place) = (0, 0, Place::default());
        self.slab = slabs.lend(expected);
    }

    /// Gives the memory back.
    pub(crate) fn close(&mut self, slabs: &SharedSlabs<P>) {
        let slab = std::mem::take(&mut self.slab);
        self.place = slabs.take_back(slab, self.written);
    }

    /// Adds a packet whose contents are stale: the caller writes every field that is read.
    #[inline(always)]
    pub(crate) fn push(&mut self) -> &mut P {
        let at = self.slab.first + self.len;
        if at >= self.slab.memory.len() {
            self.add_memory();
        }
        self.len += 1;
        self.written = self.len;
        &mut self.slab.memory[at]
    }

    /// The memory of the packet that is added next, if it was taken before.
    #[inline(always)]
    pub(crate) fn upcoming(&self) -> Option<&P> {
        self.slab.memory.get(self.slab.first + self.len)
    }

    /// The number of packets.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Adds a packet as [`StalePackets::push`] whose number is `number`, behind any that are
    /// numbers and nothing else.
    #[inline(always)]
    pub(crate) fn push_as(&mut self, number: usize) -> &mut P {
        debug_assert!(self.len <= number, "packets come in order");
        self.len = number;
        self.push()
    }

    /// Adds a packet that has a number and nothing else.
    #[inline(always)]
    fn push_number(&mut self) {
        self.len += 1;
    }

    /// The last packet, while packets are added.
    #[inline(always)]
    pub(crate) fn last(&self) -> Option<&P> {
        self.slab
            .memory
            .get(self.slab.first + self.len.checked_sub(1)?)
    }

    /// The last packet, while packets are added.
    #[inline(always)]
    pub(crate) fn last_mut(&mut self) -> Option<&mut P> {
        let last = self.slab.first + self.len.checked_sub(1)?;
        self.slab.memory.get_mut(last)
    }

    /// Removes the last packet.
    #[inline(always)]
    pub(crate) fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
        self.written = self.written.min(self.len);
    }

    /// A slab has room for all packets that are expected; clipping may add more.
    #[cold]
    fn add_memory(&mut self) {
        let needed = self.slab.first + self.len + 1;
        self.slab.memory.resize_with(needed, P::default);
    }

    /// All packets, after they were added.
    #[inline(always)]
    pub(crate) fn packets<'s>(&self, slabs: &'s Slabs<P>) -> &'s [P] {
        slabs.packets(self.place)
    }
}

/// The packets of a chunk's triangles.
///
/// Of packets that are taken apart nothing is kept but their numbers: they are made in one place,
/// so that they stay in the cache. Such a number's memory, if there is any, holds anything.
#[derive(Debug, Default)]
pub(crate) struct TrianglePackets {
    kept: StalePackets<TrianglePacket>,
    /// The last packet that was not to be kept.
    passing: Box<TrianglePacket>,
    /// True if that is the last packet.
    is_last_passing: bool,
}

impl TrianglePackets {
    /// Adds a packet whose contents are stale: the caller writes every field.
    #[inline(always)]
    pub(crate) fn push_stale(&mut self) -> &mut TrianglePacket {
        self.is_last_passing = false;
        self.kept.push()
    }

    /// Adds a packet as [`TrianglePackets::push_stale`], which is kept until the next one is added.
    #[inline(always)]
    pub(crate) fn push_passing(&mut self) -> &mut TrianglePacket {
        self.is_last_passing = true;
        self.kept.push_number();
        &mut self.passing
    }

    /// See [`StalePackets::upcoming`].
    #[inline(always)]
    pub(crate) fn upcoming(&self) -> Option<&TrianglePacket> {
        self.kept.upcoming()
    }

    /// The number of packets.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.kept.len()
    }

    /// The last packet, and its number, while packets are added.
    #[inline(always)]
    pub(crate) fn last(&self) -> Option<(&TrianglePacket, usize)> {
        let number = self.len().checked_sub(1)?;
        if self.is_last_passing {
            return Some((&self.passing, number));
        }
        self.kept.last().map(|packet| (packet, number))
    }

    /// See [`StalePackets::open`].
    pub(crate) fn open(&mut self, slabs: &SharedSlabs<TrianglePacket>, expected: Expected) {
        self.kept.open(slabs, expected);
    }

    /// See [`StalePackets::close`].
    pub(crate) fn close(&mut self, slabs: &SharedSlabs<TrianglePacket>) {
        self.kept.close(slabs);
    }

    /// See [`StalePackets::packets`].
    #[inline(always)]
    pub(crate) fn packets<'s>(&self, slabs: &'s Slabs<TrianglePacket>) -> &'s [TrianglePacket] {
        self.kept.packets(slabs)
    }
}
