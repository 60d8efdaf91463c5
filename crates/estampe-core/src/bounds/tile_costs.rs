//! What each tile may cost, by which threads draw the dearest tiles first.
//!
//! Threads take tiles one by one, and wait in the end for the one that draws the last tile. In the
//! order of storage that may be the dearest: sixty-four threads waited for a quarter of the time of
//! `blend`, and for a fifth of that of `small_tris`. With the dearest first the last tiles are
//! the cheapest: longest processing time first (Graham, *Bounds on Multiprocessing Timing
//! Anomalies*, 1969).
//!
//! The estimate is the number of entries of the tile's bins. It knows nothing of shaders; where it
//! says that all tiles cost nearly the same, they stay in the order of storage. Tiles of one class
//! of costs do, too: neighbours read the same vertices and texels.

use std::sync::atomic::{AtomicU32, Ordering};

/// Tiles for each thread at most: of more, the last one matters less than that a thread draws
/// neighbours one after the other.
const TILES_PER_THREAD: usize = 8;

/// Threads that seldom wait for each other.
const FEW_THREADS: usize = 4;

/// Classes of costs: 0, and each power of two.
const CLASSES: usize = 33;

/// The costs of all tiles.
#[derive(Debug, Default)]
pub(crate) struct TileCosts {
    /// The entries of each tile; of no tile if the order does not matter.
    entries: Vec<AtomicU32>,
    order: Vec<u32>,
}

impl TileCosts {
    /// Begins a batch, which so many threads draw in so many tiles.
    pub(crate) fn begin(&mut self, tiles: usize, threads: usize) {
        self.entries.clear();
        if threads >= FEW_THREADS && tiles <= threads * TILES_PER_THREAD {
            self.entries.resize_with(tiles, AtomicU32::default);
        }
    }

    /// The entries of each tile so far, to which threads add. No tile if nobody asks for them.
    pub(crate) fn entries(&self) -> &[AtomicU32] {
        &self.entries
    }

    /// All tiles, the dearest first, those of a class in their order; none if no tile costs half as
    /// much again as their mean.
    pub(crate) fn dearest_first(&mut self) -> Option<&[u32]> {
        let costs = self.entries.iter_mut().map(|entries| *entries.get_mut());
        let (mut sum, mut most) = (0, 0);
        for cost in costs {
            sum += u64::from(cost);
            most = most.max(u64::from(cost));
        }
        if most * self.entries.len() as u64 * 2 <= sum * 3 {
            return None;
        }
        // Sorted by counting, the dearest class first.
        let mut first_of = [0; CLASSES + 1];
        for entries in &mut self.entries {
            first_of[class(*entries.get_mut()) + 1] += 1;
        }
        for at in 1..first_of.len() {
            first_of[at] += first_of[at - 1];
        }
        self.order.resize(self.entries.len(), 0);
        for (tile, entries) in (0..).zip(&mut self.entries) {
            let place: &mut u32 = &mut first_of[class(*entries.get_mut())];
            self.order[*place as usize] = tile;
            *place += 1;
        }
        Some(&self.order)
    }
}

/// The class of a cost: 0 of the greatest.
fn class(cost: u32) -> usize {
    cost.leading_zeros() as usize
}

/// Adds the entries of a chunk to those of a tile.
#[inline]
pub(crate) fn add(entries: &AtomicU32, more: u32) {
    entries.fetch_add(more, Ordering::Relaxed);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(costs: &[u32]) -> Option<Vec<u32>> {
        let mut all = TileCosts::default();
        // Twice, because memory is used again.
        all.begin(100, 4);
        all.begin(costs.len(), costs.len().max(FEW_THREADS));
        for (entries, &cost) in all.entries().iter().zip(costs) {
            add(entries, cost / 2);
            add(entries, cost - cost / 2);
        }
        all.dearest_first().map(<[u32]>::to_vec)
    }

    #[test]
    fn the_dearest_tiles_come_first() {
        let costs = [3, 90, 0, 3, 1000, 91, 0, u32::MAX, 5];
        assert_eq!(order(&costs).unwrap(), [7, 4, 1, 5, 8, 0, 3, 2, 6]);
        let mut state = 3_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state
        };
        for _ in 0..100 {
            let costs: Vec<u32> = (0..50).map(|_| random() >> (random() >> 27)).collect();
            let Some(order) = order(&costs) else {
                continue;
            };
            let of = |tile: u32| f64::from(costs[tile as usize]);
            for pair in order.windows(2) {
                assert!(of(pair[0]) * 2.0 >= of(pair[1]), "{pair:?} of {costs:?}");
            }
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..50));
        }
    }

    #[test]
    fn tiles_of_nearly_one_cost_keep_their_order() {
        assert_eq!(order(&[2, 3, 2, 3]), None);
        assert_eq!(order(&[2, 3, 2, 3, 6]).unwrap(), [4, 0, 1, 2, 3]);
        assert_eq!(order(&[0; 9]), None);
        assert_eq!(order(&[]), None);
    }

    #[test]
    fn few_threads_and_many_tiles_have_no_order() {
        let counted = |tiles, threads| {
            let mut costs = TileCosts::default();
            costs.begin(tiles, threads);
            costs.entries().len()
        };
        assert_eq!(counted(10, 1), 0);
        assert_eq!(counted(10, 3), 0);
        assert_eq!(counted(10, 4), 10);
        assert_eq!(counted(64, 8), 64);
        assert_eq!(counted(65, 8), 0);
    }
}
