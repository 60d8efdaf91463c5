//! The storage order of pixels in attachments.

use estampe_types::TextureFormat;

/// Side of a storage block, in pixels.
pub(crate) const BLOCK: u32 = 64;

/// The most pixels of a target's side.
pub(crate) const MAX_SIDE: u32 = 16_384;

/// The division of a target into the tiles of a pass.
///
/// A tile is 64×64 pixels for one sample, so that RGBA8 and depth fill the first-level cache, 32
/// KiB. It is as large for four samples, 128 KiB: what each triangle costs in each tile that it
/// touches is more than what the second-level cache does (`msaa4` took a tenth longer with tiles of
/// 32×32 pixels). It is 32×32 for 2, 8 and 16 samples, and where tiles are
/// [few for the threads](TileGrid::for_threads). Tiles are numbered in storage order: tile `n`
/// is the `n`-th slice of `tile_pixels() * samples`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TileGrid {
    /// Blocks in a row of the target.
    blocks_x: u32,
    /// Blocks in a column of the target.
    blocks_y: u32,
    /// log₂ of a tile's side: 6 or 5.
    tile_log2: u32,
}

impl TileGrid {
    pub(crate) fn new(width: u32, height: u32, samples: u32) -> Self {
        Self {
            blocks_x: width.div_ceil(BLOCK),
            blocks_y: height.div_ceil(BLOCK),
            tile_log2: match samples {
                1 | 4 => 6,
                _ => 5,
            },
        }
    }

    /// The grid of a pass that so many threads draw: of smaller tiles where these are so few that
    /// threads would wait for a third of the time. What a primitive costs in each tile that it
    /// touches is why tiles are not small otherwise (`blend` took half as long again with 960 for
    /// 64 threads in place of 240). Images and their order of storage are the same.
    pub(crate) fn for_threads(self, threads: usize) -> Self {
        let tiles = self.tiles();
        let taken = tiles.div_ceil(threads) * threads;
        if tiles * 3 >= taken * 2 {
            return self;
        }
        self.of_small_tiles()
    }

    /// [`TileGrid::for_threads`] for a pass of few primitives, as of filters: smaller tiles cost
    /// hardly more then, so that there are eight a thread.
    pub(crate) fn for_threads_with_few_primitives(self, threads: usize) -> Self {
        if threads == 1 || self.tiles() >= 8 * threads {
            return self;
        }
        self.of_small_tiles()
    }

    fn of_small_tiles(self) -> Self {
        Self {
            tile_log2: 5,
            ..self
        }
    }

    /// True if tiles are whole blocks.
    pub(crate) fn tiles_are_blocks(self) -> bool {
        1 << self.tile_log2 == BLOCK
    }

    /// log₂ of a tile's side.
    pub(crate) fn tile_log2(self) -> u32 {
        self.tile_log2
    }

    /// Pixels of a tile.
    pub(crate) fn tile_pixels(self) -> usize {
        1 << (2 * self.tile_log2)
    }

    /// Pixels of the target with its padding to whole blocks.
    pub(crate) fn stored_pixels(self) -> usize {
        self.blocks_x as usize * self.blocks_y as usize * (BLOCK * BLOCK) as usize
    }

    /// Number of tiles.
    pub(crate) fn tiles(self) -> usize {
        self.stored_pixels() / self.tile_pixels()
    }

    /// The most runs of tiles that follow one another in which a primitive lies.
    pub(crate) fn most_spans(self) -> u64 {
        let blocks = match self.tiles_are_blocks() {
            true => self.blocks_y,
            // Two rows of two tiles each.
            false => self
                .blocks_x
                .saturating_mul(self.blocks_y)
                .saturating_mul(2),
        };
        u64::from(blocks.max(1))
    }

    /// The number of the tile at a column and row of tiles.
    #[inline(always)]
    pub(crate) fn tile_at(self, column: u32, row: u32) -> u32 {
        let shift = 6 - self.tile_log2;
        let block = (row >> shift) * self.blocks_x + (column >> shift);
        let inside = (column & shift) | ((row & shift) << 1);
        (block << (2 * shift)) | inside
    }

    /// Left column and top row of a tile, in pixels.
    pub(crate) fn tile_origin(self, tile: u32) -> (u32, u32) {
        let shift = 6 - self.tile_log2;
        let block = tile >> (2 * shift);
        let (inside_x, inside_y) = (tile & shift, (tile >> 1) & shift);
        let x = (block % self.blocks_x) * BLOCK + (inside_x << self.tile_log2);
        let y = (block / self.blocks_x) * BLOCK + (inside_y << self.tile_log2);
        (x, y)
    }

    /// Returns the index at which the packet that holds a pixel is stored, in packets.
    #[inline]
    pub(crate) fn packet_of(self, x: u32, y: u32) -> usize {
        let block = (y / BLOCK) * self.blocks_x + x / BLOCK;
        let (px, py) = (x % BLOCK / 4, y % BLOCK / 4);
        block as usize * 256 + morton(px, py) as usize
    }
}

/// Words of 32 bits that a texel of a colour format takes in an attachment: smaller ones take one
/// all the same.
pub(crate) fn texel_words(format: TextureFormat) -> usize {
    (format.block_bytes() as usize).div_ceil(4)
}

/// Interleaves the low four bits of x and y: bit 0 of x is bit 0, bit 0 of y is bit 1.
#[inline(always)]
pub(crate) const fn morton(x: u32, y: u32) -> u32 {
    spread(x) | (spread(y) << 1)
}

/// Moves bit `i` of a four-bit number to bit `2i`.
#[inline(always)]
const fn spread(v: u32) -> u32 {
    let v = (v | (v << 2)) & 0x33;
    (v | (v << 1)) & 0x55
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_numbered_in_storage_order() {
        for (samples, threads) in [(1, 1), (4, 1), (8, 1), (4, 64), (8, 64)] {
            let grid = TileGrid::new(200, 130, samples).for_threads(threads);
            let side = 1u32 << grid.tile_log2();
            let mut seen = vec![false; grid.tiles()];
            for y in (0..192u32).step_by(side as usize) {
                for x in (0..256u32).step_by(side as usize) {
                    let tile = grid.tile_at(x / side, y / side);
                    assert_eq!(grid.tile_origin(tile), (x, y));
                    assert!(!std::mem::replace(&mut seen[tile as usize], true));
                    let first = grid.packet_of(x, y) * 16;
                    assert_eq!(first, tile as usize * grid.tile_pixels());
                }
            }
            assert!(seen.into_iter().all(|seen| seen));
        }
    }

    #[test]
    fn tiles_are_smaller_where_threads_would_wait() {
        let tiles = |side, threads| TileGrid::new(side, side, 1).for_threads(threads).tiles();
        let of_16 = [1, 2, 4, 8, 12, 14, 16, 24, 25].map(|threads| tiles(256, threads));
        assert_eq!(of_16, [16, 16, 16, 16, 16, 64, 16, 16, 64]);
        let of_9 = [1, 2, 4, 5, 6, 7, 8, 9, 13, 14].map(|threads| tiles(192, threads));
        assert_eq!(of_9, [9, 9, 9, 9, 9, 36, 36, 9, 9, 36]);
        assert_eq!([1, 2, 64].map(|threads| tiles(1, threads)), [1, 4, 4]);
        let tiles = |threads| {
            let grid = TileGrid::new(256, 256, 4);
            grid.for_threads_with_few_primitives(threads).tiles()
        };
        assert_eq!([1, 2, 3, 64].map(tiles), [16, 16, 64, 64]);
    }

    #[test]
    fn morton_interleaves() {
        assert_eq!(morton(0b1111, 0), 0b0101_0101);
        assert_eq!(morton(0, 0b1010), 0b1000_1000);
    }
}
