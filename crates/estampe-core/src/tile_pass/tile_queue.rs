//! The tiles of a pass in the order in which workers take them: that of storage, or the dearest
//! first.

use super::jobs::{TileJobs, TilePackets};
use super::{MAX_TARGETS, TileJob};
use crate::recycle::recycled;
use crate::schedule::Jobs;
use estampe_simd::LANES;

/// The tiles that are left.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one for a pass, and a box would be allocated each time"
)]
pub(crate) enum TileQueue<'m, 'a> {
    /// In the order of storage.
    Stored(TileJobs<'a>),
    /// In an order of their own: these tiles are left.
    Ordered(&'m [u32], &'m mut TileShares<'a>),
}

impl<'a> Jobs for TileQueue<'_, 'a> {
    type Taken = TileJobs<'a>;

    fn job_type() -> &'static str {
        std::any::type_name::<TileJob<'_>>()
    }

    fn left(&self) -> usize {
        match self {
            Self::Stored(jobs) => jobs.left(),
            Self::Ordered(order, _) => order.len(),
        }
    }

    /// In an order of their own tiles are taken one by one, whatever the count.
    fn take_first(&mut self, count: usize) -> TileJobs<'a> {
        match self {
            Self::Stored(jobs) => jobs.take_first(count),
            Self::Ordered(order, shares) => match order.split_first() {
                Some((tile, others)) => {
                    *order = others;
                    shares.take(*tile)
                }
                None => TileJobs::default(),
            },
        }
    }
}

/// By tile, its share of each attachment that there is memory of.
#[derive(Debug, Default)]
pub(crate) struct TileShares<'a> {
    targets: usize,
    colors: [Shares<'a, u32>; MAX_TARGETS],
    depth: Shares<'a, f32>,
    stencil: Shares<'a, u8>,
    resolved: [Shares<'a, u32>; MAX_TARGETS],
}

impl<'a> TileShares<'a> {
    /// The shares of all tiles, in the memory of others.
    pub(crate) fn new(jobs: TileJobs<'a>, memory: TileShares<'_>) -> Self {
        let (targets, [colors, resolved], depth, stencil) = jobs.into_packets();
        let all = |of: [TilePackets<'a, u32>; MAX_TARGETS],
                   memory: [Shares<'_, u32>; MAX_TARGETS]| {
            let mut pairs = of.into_iter().zip(memory);
            std::array::from_fn(|_| match pairs.next() {
                Some((packets, memory)) => Shares::new(packets, memory),
                None => Shares::default(),
            })
        };
        Self {
            targets,
            colors: all(colors, memory.colors),
            depth: Shares::new(depth, memory.depth),
            stencil: Shares::new(stencil, memory.stencil),
            resolved: all(resolved, memory.resolved),
        }
    }

    /// The memory, without shares.
    pub(crate) fn recycled<'b>(self) -> TileShares<'b> {
        TileShares::new(TileJobs::default(), self)
    }

    /// Takes a tile out.
    fn take(&mut self, tile: u32) -> TileJobs<'a> {
        let place = tile as usize;
        let mut colors: [TilePackets<'a, u32>; MAX_TARGETS] = Default::default();
        let mut resolved: [TilePackets<'a, u32>; MAX_TARGETS] = Default::default();
        let to = colors.iter_mut().zip(&mut resolved);
        let from = self.colors.iter_mut().zip(&mut self.resolved);
        for ((color, resolved), (colors, images)) in to.zip(from).take(self.targets) {
            *color = colors.take(place);
            *resolved = images.take(place);
        }
        let (depth, stencil) = (self.depth.take(place), self.stencil.take(place));
        TileJobs::of_tile(tile, (self.targets, [colors, resolved], depth, stencil))
    }
}

/// By tile, its share of an attachment; nothing once it is taken.
#[derive(Debug)]
struct Shares<'a, T> {
    shares: Vec<&'a mut [[T; LANES]]>,
    /// Packets of a tile.
    of_tile: usize,
}

impl<T> Default for Shares<'_, T> {
    fn default() -> Self {
        Self {
            shares: Vec::new(),
            of_tile: 0,
        }
    }
}

impl<'a, T> Shares<'a, T> {
    fn new(packets: TilePackets<'a, T>, memory: Shares<'_, T>) -> Self {
        let TilePackets { packets, of_tile } = packets;
        let mut shares = recycled(memory.shares);
        shares.extend(packets.chunks_exact_mut(of_tile.max(1)));
        Self { shares, of_tile }
    }

    fn take(&mut self, tile: usize) -> TilePackets<'a, T> {
        let share = self.shares.get_mut(tile);
        TilePackets {
            packets: share.map(std::mem::take).unwrap_or_default(),
            of_tile: self.of_tile,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{ColorTexels, ImageSize, RenderTarget};
    use estampe_types::TextureFormat;

    /// Each of six tiles holds its number in the first attachment; the second has no memory.
    #[test]
    fn tiles_are_taken_in_an_order_of_their_own_with_their_shares() {
        let size = ImageSize {
            width: 150,
            height: 100,
            samples: 1,
        };
        let mut stored = ColorTexels::zeros(TextureFormat::Rgba16Float, size).unwrap();
        for (tile, words) in (0..).zip(stored.words_mut().chunks_mut(64 * 64 * 2)) {
            words.fill(tile);
        }
        let without = ColorTexels::without_memory(TextureFormat::Rgba8Unorm, size);
        let mut target = RenderTarget::of_images(size, vec![stored, without], None);
        let mut memory = TileShares::default();
        let order = [3, 0, 5, 1, 4, 2];
        // Twice, because memory is used again.
        for _ in 0..2 {
            let (jobs, _) = TileJobs::of_target(&mut target, true);
            let mut shares = TileShares::new(jobs, memory);
            let mut queue = TileQueue::Ordered(&order, &mut shares);
            assert_eq!(queue.left(), 6);
            for expected in order {
                let mut jobs = queue.take_first(4);
                let job = jobs.take_tile().unwrap();
                assert_eq!(job.tile, expected);
                assert_eq!(job.colors[0].len(), 64 * 64 * 2 / LANES);
                assert!(job.colors[0].iter().all(|line| *line == [expected; LANES]));
                assert!(job.colors[1].is_empty() && job.depth.is_empty());
                assert!(jobs.take_tile().is_none() && jobs.first_tile().is_none());
            }
            assert_eq!(queue.left(), 0);
            memory = shares.recycled();
        }
    }
}
