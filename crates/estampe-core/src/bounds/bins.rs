//! Bins: the entries of a chunk, sorted by the tiles that they touch.

use super::tile_costs;
use crate::layout::{BLOCK, MAX_SIDE};
use std::ops::Range;
use std::sync::atomic::AtomicU32;

/// The primitives that one bin entry stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BinEntry {
    /// Those triangles of a packet whose lanes are in the mask, in lane order.
    Triangles { packet: u32, lanes: u16 },
    /// Those lines of a packet whose lanes are in the mask, in lane order.
    Lines { packet: u32, lanes: u16 },
    /// A point.
    Point(u32),
}

// There is an entry for each packet and tile.
const _: () = assert!(size_of::<BinEntry>() == 8);

impl BinEntry {
    /// The number of primitives.
    #[inline(always)]
    pub(crate) fn count(self) -> u32 {
        match self {
            Self::Triangles { lanes, .. } | Self::Lines { lanes, .. } => lanes.count_ones(),
            Self::Point(_) => 1,
        }
    }

    /// Adds the lanes of another entry of the same packet. Returns false if it is of another kind.
    #[inline(always)]
    fn merge(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::Triangles { lanes, .. }, Self::Triangles { lanes: more, .. })
            | (Self::Lines { lanes, .. }, Self::Lines { lanes: more, .. }) => {
                *lanes |= more;
                true
            }
            _ => false,
        }
    }
}

/// Tiles that follow one another in storage order. A large triangle has one for each row of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TileSpan {
    /// The first tile, and in the low bits how many come after it.
    packed: u32,
}

impl TileSpan {
    const COUNT_BITS: u32 = 10;

    #[inline(always)]
    pub(crate) fn of_tile(tile: u32) -> Self {
        Self {
            packed: tile << Self::COUNT_BITS,
        }
    }

    /// As many tiles from a first one on, at least one, as a row of tiles has at most.
    #[inline(always)]
    pub(crate) fn new(first: u32, count: u32) -> Self {
        debug_assert!(
            first >> (32 - Self::COUNT_BITS) == 0 && (1..=1 << Self::COUNT_BITS).contains(&count)
        );
        Self {
            packed: first << Self::COUNT_BITS | (count - 1),
        }
    }

    #[inline(always)]
    fn tiles(self) -> Range<u32> {
        let first = self.packed >> Self::COUNT_BITS;
        first..first + (self.packed & ((1 << Self::COUNT_BITS) - 1)) + 1
    }
}

// The largest target has this many tiles of 32×32 pixels, and this many a row of 64×64.
const _: () = {
    let (tiles, blocks) = (MAX_SIDE.div_ceil(32), MAX_SIDE.div_ceil(BLOCK));
    assert!(tiles as u64 * tiles as u64 <= 1 << (32 - TileSpan::COUNT_BITS));
    assert!(blocks <= 1 << TileSpan::COUNT_BITS);
};

/// Memory of a worker for entries as they are written, one chunk after the other.
#[derive(Debug, Default)]
pub(crate) struct UnsortedEntries(Vec<(TileSpan, BinEntry)>);

/// Entries sorted by tile.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    /// As written: tiles and their entry, in submission order. Only those that wait are kept.
    unsorted: Vec<(TileSpan, BinEntry)>,
    /// Sorted by tile; the entries of a tile in submission order.
    sorted: Vec<BinEntry>,
    /// The index in `sorted` of the first entry of tile `first_tile + i`; one element more than
    /// there are tiles.
    starts: Vec<u32>,
    first_tile: u32,
    /// The index in `unsorted` of the first entry of the packet that is being binned: entries from
    /// there on may be merged.
    mergeable_from: usize,
    /// True if there are so many entries that those of some tiles are sorted at a time.
    waits: bool,
}

impl Bins {
    pub(crate) fn clear(&mut self) {
        self.unsorted.clear();
        self.sorted.clear();
        self.starts.clear();
        self.mergeable_from = 0;
        self.waits = false;
    }

    /// Borrows a worker's memory for the entries that are written next.
    pub(crate) fn borrow(&mut self, UnsortedEntries(memory): &mut UnsortedEntries) {
        debug_assert!(self.unsorted.is_empty(), "no entry was written");
        std::mem::swap(&mut self.unsorted, memory);
    }

    /// Gives a worker's memory back, unless its entries wait.
    pub(crate) fn give_back(&mut self, UnsortedEntries(memory): &mut UnsortedEntries) {
        if !self.waits {
            self.unsorted.clear();
            std::mem::swap(&mut self.unsorted, memory);
        }
    }

    pub(crate) fn push(&mut self, tiles: TileSpan, entry: BinEntry) {
        self.unsorted.push((tiles, entry));
    }

    /// Keeps [`Bins::push_lane`] from merging into the entries so far.
    #[inline(always)]
    pub(crate) fn end_packet(&mut self) {
        self.mergeable_from = self.unsorted.len();
    }

    /// Adds an entry for one primitive of a packet to a tile: to the packet's entry for that tile
    /// if there is one since [`Bins::end_packet`].
    #[inline(always)]
    pub(crate) fn push_lane(&mut self, tile: u32, new: BinEntry) {
        let tile = TileSpan::of_tile(tile);
        for (at, entry) in self.unsorted[self.mergeable_from..].iter_mut().rev() {
            if *at == tile && entry.merge(new) {
                return;
            }
        }
        self.unsorted.push((tile, new));
    }

    /// The runs of tiles.
    pub(crate) fn spans(&self) -> usize {
        self.unsorted.len()
    }

    /// True if the entries [wait](Bins::sort) for their band of tiles.
    pub(crate) fn waits(&self) -> bool {
        self.waits
    }

    /// Sorts the entries by tile, or lets them wait if there are more than `most`.
    pub(crate) fn sort(&mut self, most: u64) {
        let counts = self.unsorted.iter().map(|(tiles, _)| tiles.tiles().len());
        self.waits = counts.map(|tiles| tiles as u64).sum::<u64>() > most;
        if !self.waits {
            self.sort_those(TileSpan::tiles);
        }
    }

    /// Sorts the entries of a band of tiles.
    pub(crate) fn sort_band(&mut self, band: &Range<u32>) {
        self.starts.clear();
        self.sort_those(|span| {
            let Range { start, end } = span.tiles();
            start.max(band.start)..end.min(band.end)
        });
    }

    /// Sorts the entries of some tiles of each span, stably, by counting: linear in spans, in the
    /// entries and in touched tiles' span.
    fn sort_those(&mut self, of: impl Fn(TileSpan) -> Range<u32>) {
        let tiles = self.unsorted.iter().map(|(span, _)| of(*span));
        let tiles = tiles.filter(|tiles| !tiles.is_empty());
        let ends = tiles.clone().map(|tiles| tiles.end);
        let (Some(first), Some(end)) = (tiles.map(|tiles| tiles.start).min(), ends.max()) else {
            return;
        };
        self.first_tile = first;
        // First the differences of the tiles' numbers of entries.
        let tiles = (end - first) as usize;
        self.starts.resize(tiles + 2, 0);
        for (span, _) in &self.unsorted {
            let Range { start, end } = of(*span);
            if start >= end {
                continue;
            }
            let begins = &mut self.starts[(start - first) as usize + 1];
            *begins = begins.wrapping_add(1);
            let ends = &mut self.starts[(end - first) as usize + 1];
            *ends = ends.wrapping_sub(1);
        }
        self.starts.truncate(tiles + 1);
        let (mut entries, mut of_tile) = (0, 0_u32);
        for start in &mut self.starts {
            of_tile = of_tile.wrapping_add(*start);
            entries += of_tile;
            *start = entries;
        }
        self.sorted.resize(entries as usize, BinEntry::Point(0));
        // Each start is advanced while its tile is filled, then all are moved back by one tile.
        for (span, entry) in &self.unsorted {
            let Range { start, end } = of(*span);
            if start >= end {
                continue;
            }
            for start in &mut self.starts[(start - first) as usize..(end - first) as usize] {
                self.sorted[*start as usize] = *entry;
                *start += 1;
            }
        }
        for at in (1..self.starts.len()).rev() {
            self.starts[at] = self.starts[at - 1];
        }
        self.starts[0] = 0;
    }

    /// Notes the tiles that have entries in a list of bits, which are not set yet.
    pub(crate) fn note_reached(&self, reached: &mut [u64]) {
        if self.waits {
            for tile in self.unsorted.iter().flat_map(|(tiles, _)| tiles.tiles()) {
                reached[tile as usize / 64] |= 1 << (tile % 64);
            }
            return;
        }
        for (tile, ends) in (self.first_tile as usize..).zip(self.starts.windows(2)) {
            reached[tile / 64] |= u64::from(ends[0] < ends[1]) << (tile % 64);
        }
    }

    /// Adds the number of entries of each tile, by tile, to those of other chunks; nothing while
    /// they wait.
    pub(crate) fn add_costs(&self, entries: &[AtomicU32]) {
        let tiles = entries.iter().skip(self.first_tile as usize);
        for (entries, ends) in tiles.zip(self.starts.windows(2)) {
            if ends[0] < ends[1] {
                tile_costs::add(entries, ends[1] - ends[0]);
            }
        }
    }

    /// The entries of a tile, in submission order.
    #[inline]
    pub(crate) fn of_tile(&self, tile: u32) -> &[BinEntry] {
        let Some(at) = tile.checked_sub(self.first_tile).map(|at| at as usize) else {
            return &[];
        };
        match (self.starts.get(at), self.starts.get(at + 1)) {
            (Some(&from), Some(&to)) => &self.sorted[from as usize..to as usize],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_back_by_tile_in_order() {
        let mut bins = Bins::default();
        for (index, tile) in (0..).zip([7, 3, 7, 9, 3, 7]) {
            bins.push(TileSpan::of_tile(tile), BinEntry::Point(index));
        }
        bins.sort(u64::MAX);
        let points = |tile| -> Vec<u32> {
            let point = |entry: &BinEntry| match entry {
                BinEntry::Point(point) => *point,
                other => panic!("{other:?} is not a point"),
            };
            bins.of_tile(tile).iter().map(point).collect()
        };
        assert_eq!(points(3), [1, 4]);
        assert_eq!(points(7), [0, 2, 5]);
        assert_eq!(points(9), [3]);
        for tile in [0, 2, 4, 8, 10, u32::MAX] {
            assert!(bins.of_tile(tile).is_empty(), "tile {tile}");
        }
    }

    #[test]
    fn reached_tiles_are_those_with_entries() {
        for tiles in [vec![0], vec![63, 64], vec![70, 190, 130], vec![200], vec![]] {
            let mut bins = Bins::default();
            // Twice, because memory is used again.
            for _ in 0..2 {
                bins.clear();
                for &tile in &tiles {
                    bins.push(TileSpan::of_tile(tile), BinEntry::Point(tile));
                }
                bins.sort(u64::MAX);
                let mut reached = [0; 5];
                bins.note_reached(&mut reached);
                for tile in 0..320 {
                    let bit = reached[tile as usize / 64] >> (tile % 64) & 1;
                    assert_eq!(bit == 1, tiles.contains(&tile), "tile {tile} of {tiles:?}");
                }
            }
        }
    }

    #[test]
    fn entries_beyond_the_limit_wait_for_their_band() {
        let mut bins = Bins::default();
        for (index, tile) in (0..).zip([3, 40, 90]) {
            bins.push(TileSpan::new(tile, 100), BinEntry::Point(index));
        }
        bins.sort(300);
        assert!(!bins.waits());
        assert_eq!(bins.sorted.len(), 300);
        let all: Vec<Vec<BinEntry>> = (0..200).map(|tile| bins.of_tile(tile).to_vec()).collect();
        let mut reached = [[0; 4]; 2];
        bins.note_reached(&mut reached[0]);
        bins.sort(299);
        assert!(bins.waits());
        bins.note_reached(&mut reached[1]);
        assert_eq!(reached[0], reached[1]);
        for first in [190, 0, 60, 120] {
            let band = first..first + 60;
            bins.sort_band(&band);
            for (tile, entries) in (0..).zip(&all) {
                let wanted = if band.contains(&tile) {
                    entries
                } else {
                    &vec![]
                };
                assert_eq!(bins.of_tile(tile), wanted, "tile {tile} of {band:?}");
            }
        }
    }

    #[test]
    fn lanes_merge_only_until_the_packet_ends() {
        let mut bins = Bins::default();
        let triangles = |lanes| BinEntry::Triangles { packet: 0, lanes };
        bins.push_lane(1, triangles(0b1));
        bins.push_lane(2, triangles(0b10));
        bins.push_lane(1, triangles(0b100));
        bins.end_packet();
        bins.push_lane(1, triangles(0b1000));
        bins.sort(u64::MAX);
        let expected = [triangles(0b101), triangles(0b1000)];
        assert_eq!(bins.of_tile(1), expected);
    }
}
