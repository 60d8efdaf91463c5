//! Packets whose memory outlives a chunk's contents.
//!
//! A packet is about 1 KB, and to fill it with zeros before it is written would cost as much as
//! writing it.

use super::primitives::TrianglePacket;

/// Packets that are written over what they held before.
#[derive(Debug)]
pub(crate) struct StalePackets<P> {
    memory: Vec<P>,
    len: usize,
    /// The number of packets if no primitive is culled.
    most: usize,
}

impl<P> Default for StalePackets<P> {
    fn default() -> Self {
        Self {
            memory: Vec::new(),
            len: 0,
            most: 0,
        }
    }
}

impl<P: Default> StalePackets<P> {
    /// Adds a packet whose contents are stale: the caller writes every field that is read.
    #[inline(always)]
    pub(crate) fn push(&mut self) -> &mut P {
        if self.len >= self.memory.len() {
            self.add_memory();
        }
        self.len += 1;
        &mut self.memory[self.len - 1]
    }

    /// The memory of the packet that is added next, if it was taken before.
    #[inline(always)]
    pub(crate) fn upcoming(&self) -> Option<&P> {
        self.memory.get(self.len)
    }

    /// The number of packets.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Adds a packet that has a number and nothing else.
    #[inline(always)]
    fn push_number(&mut self) {
        self.len += 1;
    }

    /// The last packet.
    #[inline(always)]
    pub(crate) fn last_mut(&mut self) -> Option<&mut P> {
        self.memory.get_mut(self.len.checked_sub(1)?)
    }

    /// Removes the last packet.
    #[inline(always)]
    pub(crate) fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
    }

    /// Announces at most so many packets: memory is then taken at once, with the first of them.
    /// Lists that double are copied to new memory each time, as packets are aligned to lines of the
    /// cache, and the kernel clears the old as well as the new: a third of a mesh's memory.
    pub(crate) fn expect(&mut self, most: usize) {
        self.most = most;
    }

    #[cold]
    fn add_memory(&mut self) {
        let missing = self.most.saturating_sub(self.memory.len());
        self.memory.reserve_exact(missing);
        self.memory.resize_with(self.len + 1, P::default);
    }

    /// Forgets the packets and keeps the memory.
    pub(crate) fn clear(&mut self) {
        (self.len, self.most) = (0, 0);
    }
}

impl<P> std::ops::Deref for StalePackets<P> {
    type Target = [P];

    #[inline(always)]
    fn deref(&self) -> &[P] {
        &self.memory[..self.len.min(self.memory.len())]
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

    /// The last packet, and its number.
    #[inline(always)]
    pub(crate) fn last(&self) -> Option<(&TrianglePacket, usize)> {
        let number = self.len().checked_sub(1)?;
        if self.is_last_passing {
            return Some((&self.passing, number));
        }
        self.kept.get(number).map(|packet| (packet, number))
    }

    /// See [`StalePackets::expect`].
    pub(crate) fn expect(&mut self, most: usize) {
        self.kept.expect(most);
    }

    /// Forgets the packets and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.kept.clear();
    }
}

impl std::ops::Deref for TrianglePackets {
    type Target = [TrianglePacket];

    #[inline(always)]
    fn deref(&self) -> &[TrianglePacket] {
        &self.kept
    }
}
