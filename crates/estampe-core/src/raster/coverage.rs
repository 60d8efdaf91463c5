//! Coverage of one primitive in one tile: a list of packets with a mask for each sample.

use super::clip_masks::ClipMasks;
use super::walk::WalkScratch;
use super::{MAX_SAMPLES, SampleSet, packet_origin};
use crate::bounds::pixel_rect::PixelRect;
use estampe_simd::LANES;

/// Packets of the largest tile.
pub(crate) const MAX_PACKETS: usize = 256;

/// A packet of a tile and which of its samples are covered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Covered<const N: usize> {
    /// Number of the packet in the tile, in Morton order.
    pub(crate) packet: u16,
    /// By sample: bit `i` is lane `i`.
    pub(crate) masks: [u16; N],
}

impl<const N: usize> Covered<N> {
    /// The lanes of which any sample is covered.
    #[inline(always)]
    pub(crate) fn any(&self) -> u16 {
        self.masks.iter().fold(0, |all, mask| all | mask)
    }
}

impl<const N: usize> Covered<N> {
    /// Clips it to a rectangle of the tile's pixels.
    #[inline(always)]
    pub(crate) fn clip(&mut self, rect: &PixelRect) {
        let (x, y) = packet_origin(u32::from(self.packet));
        let inside = rect_mask(rect, x, y);
        self.masks.iter_mut().for_each(|mask| *mask &= inside);
    }

    /// Returns the number of covered samples.
    #[inline(always)]
    pub(crate) fn count(&self) -> u64 {
        let counts = self.masks.iter().map(|mask| u64::from(mask.count_ones()));
        counts.sum()
    }
}

/// The packets of a tile that one primitive covers, each at most once.
#[derive(Debug, Default)]
pub(crate) struct CoverageList<const N: usize> {
    pub(super) covered: CoveredPackets<N>,
    /// Memory of the walk over a polygon's packets.
    pub(super) walk: WalkScratch,
}

/// The items of a list.
#[derive(Debug)]
pub(super) struct CoveredPackets<const N: usize> {
    pub(super) samples: SampleSet<N>,
    pub(super) items: [Covered<N>; MAX_PACKETS],
    pub(super) len: usize,
}

impl<const N: usize> Default for CoveredPackets<N> {
    fn default() -> Self {
        Self {
            samples: SampleSet::new(N),
            items: [Covered {
                packet: 0,
                masks: [0; N],
            }; MAX_PACKETS],
            len: 0,
        }
    }
}

impl<const N: usize> Clone for CoverageList<N> {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    /// Copies the items alone.
    fn clone_from(&mut self, from: &Self) {
        let (covered, from) = (&mut self.covered, &from.covered);
        covered.samples = from.samples;
        covered.items[..from.len].copy_from_slice(&from.items[..from.len]);
        covered.len = from.len;
    }
}

impl<const N: usize> CoverageList<N> {
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.covered.len = 0;
    }

    /// The samples of a pixel.
    #[inline(always)]
    pub(crate) fn samples(&self) -> SampleSet<N> {
        self.covered.samples
    }

    /// Empties the list for a target with other samples.
    pub(crate) fn set_samples(&mut self, samples: SampleSet<N>) {
        self.covered.samples = samples;
        self.covered.len = 0;
    }

    /// Adds a packet. Masks of samples beyond the target's are dropped.
    #[inline(always)]
    pub(crate) fn push(&mut self, packet: u32, mut masks: [u16; N]) {
        debug_assert!(self.covered.len < MAX_PACKETS, "a packet comes once");
        if N == MAX_SAMPLES {
            masks[self.covered.samples.count()..].fill(0);
        }
        let packet = (packet & 0xFF) as u16;
        if let Some(item) = self.covered.items.get_mut(self.covered.len) {
            *item = Covered { packet, masks };
            self.covered.len += 1;
        }
    }

    /// Adds an item if it covers anything; there is no branch on it.
    #[inline(always)]
    pub(super) fn push_covered(&mut self, item: Covered<N>) {
        debug_assert!(self.covered.len < MAX_PACKETS, "a packet comes once");
        self.covered.items[self.covered.len % MAX_PACKETS] = item;
        self.covered.len += usize::from(item.any() != 0);
    }

    #[inline(always)]
    pub(crate) fn items(&self) -> &[Covered<N>] {
        &self.covered.items[..self.covered.len]
    }

    /// Clips each sample to a rectangle of the tile's pixels.
    pub(crate) fn clip_samples(&mut self, pixels: &[PixelRect; N]) {
        self.retain(|item| {
            let (x, y) = packet_origin(u32::from(item.packet));
            for (mask, pixels) in item.masks.iter_mut().zip(pixels) {
                *mask &= rect_mask(pixels, x, y);
            }
        });
    }

    /// Drops the samples that are not in a mask, bit by bit.
    pub(crate) fn keep_samples(&mut self, sample_mask: u32) {
        self.retain(|item| {
            for (sample, mask) in item.masks.iter_mut().enumerate() {
                if sample_mask >> sample & 1 == 0 {
                    *mask = 0;
                }
            }
        });
    }

    /// Replaces each item by what `change` makes of it, and drops those that are left empty.
    #[inline(always)]
    pub(crate) fn retain(&mut self, mut change: impl FnMut(&mut Covered<N>)) {
        let mut kept = 0;
        for at in 0..self.covered.len {
            let mut item = self.covered.items[at];
            change(&mut item);
            self.covered.items[kept] = item;
            kept += usize::from(item.any() != 0);
        }
        self.covered.len = kept;
    }

    /// Puts the packets in the order of their numbers, which is the same at every SIMD level.
    pub(crate) fn sort(&mut self) {
        self.covered.items[..self.covered.len].sort_unstable_by_key(|item| item.packet);
    }

    /// Clips the list to a rectangle of the tile's pixels.
    pub(crate) fn clip(&mut self, rect: &PixelRect) {
        self.retain(|item| item.clip(rect));
    }

    /// [`CoverageList::clip`], where many lists are clipped to one rectangle.
    #[inline(always)]
    pub(crate) fn clip_to(&mut self, masks: &ClipMasks) {
        self.retain(
            #[inline(always)]
            |item| {
                let inside = masks.of_packet(item.packet);
                item.masks.iter_mut().for_each(|mask| *mask &= inside);
            },
        );
    }
}

/// The lanes of the packet at (x, y) that lie in a rectangle of the tile's pixels.
#[inline(always)]
pub(crate) fn rect_mask(rect: &PixelRect, x: i32, y: i32) -> u16 {
    let at = |edge: i32, origin: i32| (edge - origin).clamp(0, 4) as usize;
    COLUMNS_FROM[at(rect.x0, x)]
        & !COLUMNS_FROM[at(rect.x1, x)]
        & ROWS_FROM[at(rect.y0, y)]
        & !ROWS_FROM[at(rect.y1, y)]
}

/// The lanes of a packet that begins at column x whose columns are from one on, before another one.
#[inline(always)]
pub(super) fn lanes_of_columns([first, end]: [i32; 2], x: i32) -> u16 {
    let at = |edge: i32| (edge - x).clamp(0, 4) as usize;
    COLUMNS_FROM[at(first)] & !COLUMNS_FROM[at(end)]
}

/// The lanes of a packet that begins at row y whose rows are from one on, before another one.
#[inline(always)]
pub(super) fn lanes_of_rows([first, end]: [i32; 2], y: i32) -> u16 {
    let at = |edge: i32| (edge - y).clamp(0, 4) as usize;
    ROWS_FROM[at(first)] & !ROWS_FROM[at(end)]
}

/// Lanes whose column (row) is at least 0, 1, 2, 3, 4.
const COLUMNS_FROM: [u16; 5] = lanes_from(&estampe_simd::LANE_X);
const ROWS_FROM: [u16; 5] = lanes_from(&estampe_simd::LANE_Y);

const fn lanes_from(coordinate: &[u8; LANES]) -> [u16; 5] {
    let mut masks = [0; 5];
    let mut from = 0;
    while from < 5 {
        let mut lane = 0;
        while lane < LANES {
            if coordinate[lane] as usize >= from {
                masks[from] |= 1 << lane;
            }
            lane += 1;
        }
        from += 1;
    }
    masks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_confines_lane_by_lane() {
        let rect = PixelRect {
            x0: 1,
            y0: 2,
            x1: 7,
            y1: 5,
        };
        for (x, y) in [(0, 0), (4, 0), (0, 4), (4, 4), (8, 0)] {
            let mask = rect_mask(&rect, x, y);
            for lane in 0..LANES {
                let (px, py) = (
                    x + i32::from(estampe_simd::LANE_X[lane]),
                    y + i32::from(estampe_simd::LANE_Y[lane]),
                );
                let inside = (1..7).contains(&px) && (2..5).contains(&py);
                assert_eq!(mask >> lane & 1 == 1, inside, "pixel ({px}, {py})");
            }
        }
    }
}
