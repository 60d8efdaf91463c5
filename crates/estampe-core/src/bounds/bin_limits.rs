//! How much memory bins take, whatever is drawn.
//!
//! A primitive that covers the whole target has an entry for each tile: of millions of those, or
//! in the largest target, the entries of all tiles together would take gigabytes. So a batch ends
//! when its bins are full, and where a chunk has far more entries than primitives, the tiles are
//! drawn in bands, and the chunk's entries are sorted band by band.

/// The most that bins hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BinLimits {
    /// Runs of tiles of a batch: when it has as many, its tiles are drawn.
    pub(crate) spans: u64,
    /// Entries of a chunk, which are sorted when it is made. Those of others wait.
    pub(crate) of_chunk: u64,
    /// Entries of all chunks that wait, in a band of tiles.
    pub(crate) of_band: u64,
}

impl BinLimits {
    /// 200 MB of spans, 2 MB of a chunk's entries, 128 MB of a band's. Few frames have chunks of so
    /// many entries, which lie in sixteen tiles for each primitive.
    pub(crate) const DEFAULT: Self = Self {
        spans: 1 << 24,
        of_chunk: 1 << 18,
        of_band: 1 << 24,
    };

    /// So little that small pictures meet the limits.
    pub(crate) const SMALL: Self = Self {
        spans: 24,
        of_chunk: 6,
        of_band: 48,
    };

    /// The tiles of a band, where so many primitives wait: each has at most one entry a tile.
    pub(crate) fn tiles_of_band(self, waiting: u64) -> usize {
        let tiles = self.of_band.checked_div(waiting);
        tiles.map_or(usize::MAX, |tiles| {
            usize::try_from(tiles).unwrap_or(usize::MAX).max(1)
        })
    }
}

/// What the bins of some chunks hold.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct BinSizes {
    /// Runs of tiles.
    pub(crate) spans: u64,
    /// Primitives of the chunks whose entries are not sorted yet.
    pub(crate) waiting: u64,
}

impl std::ops::AddAssign for BinSizes {
    fn add_assign(&mut self, other: Self) {
        self.spans += other.spans;
        self.waiting += other.waiting;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_have_few_tiles_where_many_primitives_wait() {
        let limits = BinLimits::DEFAULT;
        assert_eq!(limits.tiles_of_band(0), usize::MAX);
        assert_eq!(limits.tiles_of_band(1 << 14), 1 << 10);
        assert_eq!(limits.tiles_of_band(u64::MAX), 1);
    }
}
