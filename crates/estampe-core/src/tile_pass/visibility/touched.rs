//! The packets of the tile that the triangles of a run touch.
//!
//! Where a triangle's ids may stand is known when it is covered, and noted for the resolve, which
//! compares the ids of these packets with the triangle's. To ask each packet which triangles it
//! shows, one after the other, is a chain of loads whose length nobody can predict: frames of four
//! samples took a tenth longer, those of one sample a fifteenth.

use crate::raster::Covered;

/// Triangles that touch more packets show most of them whole; these are found packet by packet.
const MOST_PACKETS: usize = 32;

/// A triangle, and where its packets begin.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    id: u32,
    first: u32,
}

/// The packets that triangles touch, in the order of the triangles' ids.
#[derive(Debug, Default)]
pub(super) struct TouchedPackets {
    triangles: Vec<Triangle>,
    packets: Vec<u8>,
}

impl TouchedPackets {
    /// Notes the packets of a triangle, which comes after those that were noted before.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
    pub(super) fn add<const N: usize>(&mut self, id: u32, list: &[Covered<N>]) {
        if list.is_empty() || list.len() > MOST_PACKETS {
            return;
        }
        self.begin(id);
        let packets = list.iter().map(|item| item.packet as u8);
        self.packets.extend(packets);
    }

    /// Notes the packets of a small triangle: the first ones of four.
    #[inline(always)]
    pub(super) fn add_small(&mut self, id: u32, (packets, count): ([u8; 4], u32)) {
        self.begin(id);
        let end = self.packets.len() + count as usize;
        // Four are written, whatever their number.
        self.packets.extend(packets);
        self.packets.truncate(end);
    }

    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a few for each triangle of a run"
    )]
    fn begin(&mut self, id: u32) {
        debug_assert!(
            self.triangles.last().is_none_or(|last| last.id < id),
            "triangles come in the order of their ids"
        );
        let first = self.packets.len() as u32;
        self.triangles.push(Triangle { id, first });
    }

    /// The number of the first triangle whose id is not below one.
    pub(super) fn from(&self, id: u32) -> usize {
        self.triangles.partition_point(|triangle| triangle.id < id)
    }

    /// A triangle's id and packets, given its number; `None` if there is none, or its id is not
    /// below `end`.
    #[inline(always)]
    pub(super) fn before(&self, number: usize, end: u32) -> Option<(u32, &[u8])> {
        let Triangle { id, first } = *self.triangles.get(number)?;
        if id >= end {
            return None;
        }
        let rest = self.packets.get(first as usize..)?;
        let packets = match self.triangles.get(number + 1) {
            Some(next) => rest.get(..(next.first - first) as usize)?,
            None => rest,
        };
        Some((id, packets))
    }

    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.triangles.clear();
        self.packets.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_keep_their_packets() {
        let list = |packets: &[u16]| -> Vec<Covered<1>> {
            let items = packets.iter().map(|&packet| Covered { packet, masks: [1] });
            items.collect()
        };
        let mut touched = TouchedPackets::default();
        touched.add(3, &list(&[7, 255, 0]));
        // Nothing is noted of a triangle that is not shown, or too large.
        touched.add(4, &list(&[]));
        touched.add(5, &list(&[1; MOST_PACKETS + 1]));
        touched.add_small(8, ([1, 2, 3, 4], 2));
        touched.add_small(9, ([5, 6, 7, 8], 0));
        touched.add_small(10, ([9, 8, 7, 6], 4));
        let all: [(u32, &[u8]); 4] = [
            (3, &[7, 255, 0]),
            (8, &[1, 2]),
            (9, &[]),
            (10, &[9, 8, 7, 6]),
        ];
        for (number, expected) in all.into_iter().enumerate() {
            assert_eq!(touched.before(number, 11), Some(expected));
            assert_eq!(touched.before(number, expected.0), None);
        }
        assert_eq!(touched.before(4, u32::MAX), None);
        assert_eq!([0, 3, 4, 9, 11].map(|id| touched.from(id)), [0, 0, 1, 2, 4]);
        touched.clear();
        assert_eq!(touched.before(0, u32::MAX), None);
    }
}
