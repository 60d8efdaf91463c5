//! A depth attachment as a texture: the same memory, and the bounds of its packets beside it.
//!
//! Once a texture was taken of an attachment, its next passes find the bounds of each tile while
//! its depths are in the cache: afterwards, they would come from memory once more. When a texture
//! is taken, bounds are joined to windows, which reach over the edges of tiles.

use super::bands::Bands;
use super::texels::DepthStencilTexels;
use crate::layout::{BLOCK, TileGrid};
use estampe_simd::Level;
use estampe_types::{Lines, ShadowMap};
use std::sync::Arc;

/// The bounds of an image's packets.
#[derive(Debug, Clone, Default)]
pub(super) struct DepthBounds {
    /// Of each packet.
    words: Vec<u32>,
    /// Of the windows that begin at each packet. Shared with depth textures; memory that is used
    /// again when these are gone.
    windows: Arc<Vec<u32>>,
    /// True if a depth texture was taken of the image.
    are_wanted: bool,
    /// What is those of the depths that the image holds.
    current: Current,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Current {
    #[default]
    Nothing,
    Bounds,
    BoundsAndWindows,
}

/// The bounds of an image's packets, in rows, which workers find tile by tile.
#[derive(Debug)]
pub(crate) struct StoredBounds<'a> {
    /// Words of a row, one for each packet.
    stride: usize,
    /// Packets along a side of a tile.
    tile_packets: usize,
    /// The rows of packets of a block each.
    bands: Bands<'a>,
}

impl StoredBounds<'_> {
    /// Finds the bounds of the depths of the tile with this left column and top row.
    pub(crate) fn find(&self, level: Level, origin: (u32, u32), depths: &[f32]) {
        self.store(origin, ShadowMap::bounds_of_block(level, depths));
    }

    /// Sets the bounds of a tile of one depth.
    pub(crate) fn fill(&self, origin: (u32, u32), depth: f32) {
        let bounds = ShadowMap::bounds_of_depth(depth);
        self.store(origin, [[bounds; PACKETS]; PACKETS]);
    }

    fn store(&self, (left, top): (u32, u32), bounds: [[u32; PACKETS]; PACKETS]) {
        let Some(mut band) = self.bands.lock((top / BLOCK) as usize) else {
            return;
        };
        let rows = band.chunks_exact_mut(self.stride);
        let rows = rows.skip((top % BLOCK) as usize / 4).zip(bounds);
        for (row, of_row) in rows.take(self.tile_packets) {
            let row = &mut row[left as usize / 4..][..self.tile_packets];
            row.copy_from_slice(&of_row[..self.tile_packets]);
        }
    }
}

/// A part of an image whose bounds a worker finds.
#[derive(Debug)]
pub(crate) enum BoundsJob<'a, 'b> {
    /// The bounds of the tile with this left column and top row.
    Tile {
        depths: &'a [f32],
        origin: (u32, u32),
        bounds: &'a StoredBounds<'b>,
    },
    /// Rows of windows, from the bounds of these rows on.
    Windows {
        stride: usize,
        bounds: &'a [u32],
        windows: &'a mut [u32],
    },
}

impl BoundsJob<'_, '_> {
    /// Finds the bounds.
    pub(crate) fn run(&mut self, level: Level) {
        match self {
            Self::Tile {
                depths,
                origin,
                bounds,
            } => bounds.find(level, *origin, depths),
            Self::Windows {
                stride,
                bounds,
                windows,
            } => ShadowMap::find_windows(level, *stride, bounds, windows),
        }
    }
}

impl DepthBounds {
    /// The bounds of an image of one sample, to be found tile by tile.
    fn stored(&mut self, [width, height]: [u32; 2], grid: TileGrid) -> StoredBounds<'_> {
        self.words.resize(ShadowMap::bounds_len(width, height), 0);
        let stride = ShadowMap::bounds_stride(width);
        StoredBounds {
            stride,
            tile_packets: 1 << (grid.tile_log2() - 2),
            bands: Bands::of(&mut self.words, stride * PACKETS),
        }
    }

    /// The rows of windows of each row of tiles, to be written.
    fn windows(&mut self, width: u32) -> impl Iterator<Item = BoundsJob<'_, '_>> {
        if Arc::get_mut(&mut self.windows).is_none() {
            self.windows = Arc::default();
        }
        // Not shared, as was just seen to.
        let windows = Arc::make_mut(&mut self.windows);
        windows.resize(self.words.len(), 0);
        let stride = ShadowMap::bounds_stride(width);
        let band = stride * PACKETS;
        let (firsts, words) = ((0..).step_by(band), &self.words[..]);
        let bands = firsts.zip(windows.chunks_exact_mut(band));
        bands.map(move |(first, windows)| BoundsJob::Windows {
            stride,
            bounds: &words[first..words.len().min(first + band + stride)],
            windows,
        })
    }
}

/// The packets along a side of a block.
const PACKETS: usize = BLOCK as usize / 4;

impl DepthStencilTexels {
    /// The depths, to be changed.
    pub(crate) fn depths_mut(&mut self) -> &mut Lines<f32> {
        self.bounds.current = Current::Nothing;
        Arc::make_mut(&mut self.depth)
    }

    /// The depths and stencil values, to be changed. They are `kept` as the last tiles of a pass
    /// leave them; then also their bounds, if these are to be found with them, and are taken to be
    /// found.
    pub(crate) fn tiles_mut(
        &mut self,
        kept: Option<TileGrid>,
    ) -> (&mut Lines<f32>, &mut Lines<u8>, Option<StoredBounds<'_>>) {
        let finds = self.bounds.are_wanted && self.has_texture();
        let found = kept.filter(|_| finds);
        self.bounds.current = match found {
            Some(_) => Current::Bounds,
            None => Current::Nothing,
        };
        let size = [self.size.width, self.size.height];
        let bounds = found.map(|grid| self.bounds.stored(size, grid));
        (Arc::make_mut(&mut self.depth), &mut self.stencil, bounds)
    }

    /// Returns true if there are depths, of one sample.
    fn has_texture(&self) -> bool {
        !self.depth.is_empty() && self.size.samples == 1
    }

    /// The depths as a texture, its bounds found by `run_all`, unless the last pass has found them;
    /// `None` without depth or with several samples.
    pub(crate) fn depth_texture(
        &mut self,
        mut run_all: impl FnMut(&mut [BoundsJob<'_, '_>]),
    ) -> Option<ShadowMap> {
        if !self.has_texture() {
            return None;
        }
        let (width, height) = (self.size.width, self.size.height);
        if self.bounds.current == Current::Nothing {
            let grid = self.size.grid();
            let bounds = &self.bounds.stored([width, height], grid);
            let tiles = self.depth.chunks_exact(grid.tile_pixels());
            let jobs = (0..).zip(tiles).map(|(tile, depths)| BoundsJob::Tile {
                depths,
                origin: grid.tile_origin(tile),
                bounds,
            });
            let mut jobs: Vec<_> = jobs.collect();
            run_all(&mut jobs);
            self.bounds.current = Current::Bounds;
        }
        if self.bounds.current == Current::Bounds {
            let mut jobs: Vec<BoundsJob<'_, '_>> = self.bounds.windows(width).collect();
            run_all(&mut jobs);
            self.bounds.current = Current::BoundsAndWindows;
        }
        self.bounds.are_wanted = true;
        let shared = (Arc::clone(&self.depth), Arc::clone(&self.bounds.windows));
        Some(ShadowMap::from_storage((width, height), shared.0, shared.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::ImageSize;
    use estampe_types::TextureFormat;

    /// At any level, windows hold the depths of their texels, and as tightly as they can.
    #[test]
    fn windows_are_those_of_their_depths() {
        for (width, height) in [(1, 1), (64, 64), (70, 130), (200, 64)] {
            let size = ImageSize {
                width,
                height,
                samples: 1,
            };
            let mut texels = DepthStencilTexels::zeros(TextureFormat::Depth32Float, size).unwrap();
            let mut number = 1u32;
            for depth in texels.depths_mut().iter_mut() {
                number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                *depth = (number >> 8) as f32 / 16_777_216.0;
            }
            for level in Level::all_available() {
                let jobs =
                    |jobs: &mut [BoundsJob<'_, '_>]| jobs.iter_mut().for_each(|job| job.run(level));
                texels.bounds.current = Current::Nothing;
                let map = texels.depth_texture(jobs).unwrap();
                let stride = ShadowMap::bounds_stride(width);
                for y in 0..height {
                    for x in 0..width {
                        let scaled = map.texel(x, y) * ShadowMap::BOUND_SCALE;
                        // All windows that the texel is in.
                        for (left, top) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                            let (Some(left), Some(top)) =
                                ((x / 4).checked_sub(left), (y / 4).checked_sub(top))
                            else {
                                continue;
                            };
                            let word = map.windows()[top as usize * stride + left as usize];
                            let [low, high] = [word & 0xFFFF, word >> 16].map(|bound| bound as f32);
                            assert!(low <= scaled && scaled <= high, "{level:?} {x} {y}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn passes_find_bounds_once_a_texture_was_taken() {
        let size = ImageSize {
            width: 130,
            height: 70,
            samples: 1,
        };
        let mut texels = DepthStencilTexels::zeros(TextureFormat::Depth32Float, size).unwrap();
        let grid = size.grid();
        let untaken = texels.tiles_mut(Some(grid)).2;
        assert!(untaken.is_none(), "no texture was taken");
        let run = |jobs: &mut [BoundsJob<'_, '_>]| {
            jobs.iter_mut().for_each(|job| job.run(Level::best()));
            // Six tiles; two rows of them.
            assert!(matches!(jobs, [BoundsJob::Tile { .. }, ..]) == (jobs.len() == 6));
            assert!(matches!(jobs.len(), 6 | 2));
        };
        assert!(texels.depth_texture(run).is_some());
        for grid in [grid, grid.for_threads(64)] {
            let (depths, _, bounds) = texels.tiles_mut(Some(grid));
            let bounds = bounds.unwrap();
            for (tile, depths) in (0..).zip(depths.chunks_exact_mut(grid.tile_pixels())) {
                let origin = grid.tile_origin(tile);
                let depth = f32::from(u16::try_from(tile).unwrap()) / 32.0;
                depths.fill(depth);
                match tile % 2 {
                    0 => bounds.find(Level::best(), origin, depths),
                    _ => bounds.fill(origin, depth),
                }
            }
            let map = texels.depth_texture(|jobs| {
                assert!(
                    matches!(jobs, [BoundsJob::Windows { .. }, _]),
                    "the bounds are found"
                );
                jobs.iter_mut().for_each(|job| job.run(Level::best()));
            });
            let (map, stride) = (map.unwrap(), ShadowMap::bounds_stride(size.width));
            for tile in 0..u32::try_from(grid.tiles()).unwrap() {
                let (x, y) = grid.tile_origin(tile);
                let word = map.windows()[y as usize / 4 * stride + x as usize / 4];
                // The window of a tile's first packet lies in the tile; 0x8000 is a depth of 1.
                let depth = tile * 0x8000 / 32;
                assert_eq!(word, depth << 16 | depth, "tile {tile} of {grid:?}");
            }
        }
        let map = texels.depth_texture(|_| panic!("all is found"));
        assert!(map.is_some());
        assert!(
            texels.tiles_mut(None).2.is_none(),
            "depths that are not kept"
        );
        assert!(texels.bounds.current == Current::Nothing);
    }
}
