//! The jobs of a pass: a target, off whose front workers take tiles.
//!
//! Tiles follow one another in memory, so the tiles that are left are slices of the attachments,
//! and so are those that a worker takes. A list of all tiles would be made by one thread while all
//! others wait: only where some are much dearer than others (`tile_queue.rs`).

use super::{MAX_TARGETS, TileJob, TileStores};
use crate::attachment::{RenderTarget, StoredRows};
use crate::layout::texel_words;
use estampe_simd::LANES;
use std::ops::Range;

/// Tiles that follow one another, and their shares of the attachments.
#[derive(Debug, Default)]
pub(crate) struct TileJobs<'a> {
    tiles: Range<u32>,
    /// Colour attachments.
    targets: usize,
    colors: [TilePackets<'a, u32>; MAX_TARGETS],
    depth: TilePackets<'a, f32>,
    stencil: TilePackets<'a, u8>,
    /// The images that colours are resolved into.
    resolved: [TilePackets<'a, u32>; MAX_TARGETS],
}

/// An attachment's share of tiles that follow one another, in packets of sixteen elements. Nothing
/// where there is no such attachment, or no memory of it.
#[derive(Debug, Default)]
pub(super) struct TilePackets<'a, T> {
    pub(super) packets: &'a mut [[T; LANES]],
    /// Packets of a tile.
    pub(super) of_tile: usize,
}

/// The attachments of some tiles: how many colours there are, these and the images that they are
/// resolved into, depths and stencil values.
type Packets<'a> = (
    usize,
    [[TilePackets<'a, u32>; MAX_TARGETS]; 2],
    TilePackets<'a, f32>,
    TilePackets<'a, u8>,
);

impl<'a, T> TilePackets<'a, T> {
    /// An attachment of so many elements a tile.
    fn new(elements: &'a mut [T], of_tile: usize) -> Self {
        Self {
            packets: elements.as_chunks_mut().0,
            of_tile: of_tile / LANES,
        }
    }

    /// Takes the share of the first tiles off.
    #[inline]
    fn take_first(&mut self, tiles: usize) -> Self {
        let packets = std::mem::take(&mut self.packets);
        let count = (tiles * self.of_tile).min(packets.len());
        let (first, others) = packets.split_at_mut(count);
        self.packets = others;
        Self {
            packets: first,
            of_tile: self.of_tile,
        }
    }

    /// The share of the first tile.
    fn first(&self) -> &[[T; LANES]] {
        &self.packets[..self.of_tile.min(self.packets.len())]
    }
}

impl<'a> TileJobs<'a> {
    /// All tiles of a target, and what they store to. `keeps_depths` says that they are drawn last,
    /// and that their depths are kept.
    pub(crate) fn of_target(
        target: &'a mut RenderTarget,
        keeps_depths: bool,
    ) -> (Self, TileStores<'a>) {
        let mut stores = TileStores::default();
        let grid = target.grid();
        let elements = grid.tile_pixels() * target.samples() as usize;
        let mut jobs = Self {
            tiles: 0..u32::try_from(grid.tiles()).unwrap_or(u32::MAX),
            targets: target.colors.len(),
            ..Self::default()
        };
        for (packets, color) in jobs.colors.iter_mut().zip(&mut target.colors) {
            let words = texel_words(color.format());
            *packets = TilePackets::new(color.words_mut(), elements * words);
        }
        for resolve in &mut target.resolves {
            let words = texel_words(resolve.into.format());
            let pixels = grid.tile_pixels() * words;
            jobs.resolved[resolve.color] = TilePackets::new(resolve.into.words_mut(), pixels);
        }
        for rows in target.rows.iter_mut().filter(|rows| rows.is_done) {
            let color = (rows.color, target.color_formats[rows.color]);
            let words = rows.words_mut();
            let image = words.map(|words| StoredRows::of_image(color, (target.size, grid), words));
            stores.rows.extend(image);
        }
        if let Some(texels) = &mut target.depth_stencil {
            let (depth, stencil, bounds) = texels.tiles_mut(keeps_depths.then_some(grid));
            jobs.depth = TilePackets::new(depth, elements);
            jobs.stencil = TilePackets::new(stencil, elements);
            stores.bounds = bounds;
        }
        (jobs, stores)
    }

    /// The shares of all tiles.
    pub(super) fn into_packets(self) -> Packets<'a> {
        let colors = [self.colors, self.resolved];
        (self.targets, colors, self.depth, self.stencil)
    }

    /// One tile with its share.
    pub(super) fn of_tile(tile: u32, share: Packets<'a>) -> Self {
        let (targets, [colors, resolved], depth, stencil) = share;
        Self {
            tiles: tile..tile + 1,
            targets,
            colors,
            depth,
            stencil,
            resolved,
        }
    }

    /// The tiles.
    pub(crate) fn tiles(&self) -> Range<u32> {
        self.tiles.clone()
    }

    /// Takes the first tile off.
    pub(super) fn take_tile(&mut self) -> Option<TileJob<'a>> {
        let tile = self.tiles.next()?;
        let mut job = TileJob {
            tile,
            depth: self.depth.take_first(1).packets,
            stencil: self.stencil.take_first(1).packets,
            ..TileJob::default()
        };
        // The others are empty.
        let of_targets = job.colors.iter_mut().zip(&mut self.colors);
        let images = job.resolved.iter_mut().zip(&mut self.resolved);
        for ((colors, of_color), (resolved, of_image)) in of_targets.zip(images).take(self.targets)
        {
            *colors = of_color.take_first(1).packets;
            *resolved = of_image.take_first(1).packets.as_flattened_mut();
        }
        Some(job)
    }

    /// The number of the first tile.
    pub(super) fn first_tile(&self) -> Option<u32> {
        (!self.tiles.is_empty()).then_some(self.tiles.start)
    }

    /// The first tile's share of the first colour attachment.
    pub(super) fn first_colors(&self) -> &[[u32; LANES]] {
        self.colors[0].first()
    }

    /// The first tile's depths.
    pub(super) fn first_depths(&self) -> &[[f32; LANES]] {
        self.depth.first()
    }

    /// The number of tiles.
    pub(crate) fn left(&self) -> usize {
        self.tiles.len()
    }

    /// Takes the first tiles off, or all that are left.
    pub(crate) fn take_first(&mut self, count: usize) -> Self {
        let tiles = count.min(self.tiles.len());
        let start = self.tiles.start;
        self.tiles.start += u32::try_from(tiles).unwrap_or(u32::MAX);
        Self {
            tiles: start..self.tiles.start,
            targets: self.targets,
            colors: self.colors.each_mut().map(|color| color.take_first(tiles)),
            depth: self.depth.take_first(tiles),
            stencil: self.stencil.take_first(tiles),
            resolved: self
                .resolved
                .each_mut()
                .map(|image| image.take_first(tiles)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{ColorTexels, ImageSize};
    use estampe_types::TextureFormat;

    /// Each of four tiles holds its number in the first attachment; the second has no memory.
    #[test]
    fn tiles_are_taken_in_order_with_their_shares() {
        let size = ImageSize {
            width: 100,
            height: 100,
            samples: 1,
        };
        let mut stored = ColorTexels::zeros(TextureFormat::Rgba16Float, size).unwrap();
        for (tile, words) in (0..).zip(stored.words_mut().chunks_mut(64 * 64 * 2)) {
            words.fill(tile);
        }
        let without = ColorTexels::without_memory(TextureFormat::Rgba8Unorm, size);
        let mut target = RenderTarget::of_images(size, vec![stored, without], None);
        for taken in [1, 3, usize::MAX] {
            let (mut jobs, _) = TileJobs::of_target(&mut target, true);
            assert_eq!(jobs.left(), 4);
            let mut next = 0;
            while jobs.left() > 0 {
                let mut some = jobs.take_first(taken);
                assert_eq!(jobs.first_tile().is_none(), jobs.left() == 0);
                while let Some(job) = some.take_tile() {
                    assert_eq!(job.tile, next);
                    assert_eq!(job.colors[0].len(), 64 * 64 * 2 / LANES);
                    assert!(job.colors[0].iter().all(|line| *line == [next; LANES]));
                    assert!(job.colors[1].is_empty() && job.depth.is_empty());
                    next += 1;
                    let ahead = some.first_colors();
                    assert!(ahead.iter().all(|line| *line == [next; LANES]));
                    assert_eq!(ahead.is_empty(), some.left() == 0);
                }
            }
            assert_eq!(next, 4);
        }
    }
}
