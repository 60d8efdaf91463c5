//! Covered samples of a tile as masks, by packet: what several primitives cover together.

use super::{Covered, MAX_PACKETS};

/// The samples of a tile that are covered.
#[derive(Debug)]
pub(crate) struct PacketMasks<const N: usize> {
    /// By packet and sample: the covered lanes.
    masks: [[u16; N]; MAX_PACKETS],
    /// The packets in which something is covered, one bit each.
    packets: [u64; MAX_PACKETS / 64],
}

impl<const N: usize> Default for PacketMasks<N> {
    fn default() -> Self {
        Self {
            masks: [[0; N]; MAX_PACKETS],
            packets: [0; MAX_PACKETS / 64],
        }
    }
}

impl<const N: usize> PacketMasks<N> {
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.packets == [0; MAX_PACKETS / 64]
    }

    /// The number of packets in which something is covered.
    #[inline(always)]
    pub(crate) fn packets(&self) -> u32 {
        self.packets
            .iter()
            .map(|packets| packets.count_ones())
            .sum()
    }

    /// The lanes of a packet of which any sample is covered.
    #[inline(always)]
    pub(crate) fn any(&self, packet: usize) -> u16 {
        let masks = &self.masks[packet % MAX_PACKETS];
        masks.iter().fold(0, |any, mask| any | mask)
    }

    /// Returns true if some sample of a list is covered already.
    #[inline(always)]
    pub(crate) fn overlaps(&self, list: &[Covered<N>]) -> bool {
        let both = list.iter().fold(0, |both, item| {
            let masks = &self.masks[usize::from(item.packet) % MAX_PACKETS];
            let pairs = masks.iter().zip(item.masks);
            pairs.fold(both, |both, (mask, more)| both | mask & more)
        });
        both != 0
    }

    /// Adds the samples of a list.
    #[inline(always)]
    pub(crate) fn add(&mut self, list: &[Covered<N>]) {
        for item in list {
            let packet = usize::from(item.packet) % MAX_PACKETS;
            self.packets[packet / 64] |= 1 << (packet % 64);
            for (mask, more) in self.masks[packet].iter_mut().zip(item.masks) {
                *mask |= more;
            }
        }
    }

    /// Gives each packet with covered samples to a function, in the order of their numbers, and
    /// forgets them.
    #[inline(always)]
    pub(crate) fn take_each(&mut self, mut take: impl FnMut(usize, [u16; N])) {
        for (word, packets) in self.packets.iter_mut().enumerate() {
            while *packets != 0 {
                let packet = (word * 64 + packets.trailing_zeros() as usize) % MAX_PACKETS;
                *packets &= *packets - 1;
                take(packet, std::mem::replace(&mut self.masks[packet], [0; N]));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_added_until_they_are_taken() {
        let mut covered = PacketMasks::<2>::default();
        let of = |packet, masks| Covered { packet, masks };
        covered.add(&[of(255, [1, 6]), of(3, [8, 0])]);
        covered.add(&[of(3, [16, 0])]);
        assert_eq!(
            [covered.any(255), covered.any(3), covered.any(4)],
            [7, 24, 0]
        );
        assert_eq!(covered.packets(), 2);
        assert!(covered.overlaps(&[of(4, [1, 1]), of(3, [16, 0])]));
        assert!(
            !covered.overlaps(&[of(4, [1, 1]), of(3, [32, 24])]),
            "of other samples"
        );
        let mut taken = Vec::new();
        covered.take_each(|packet, masks| taken.push((packet, masks)));
        assert_eq!(taken, [(3, [24, 0]), (255, [1, 6])]);
        assert!(covered.is_empty() && covered.any(3) == 0);
    }
}
