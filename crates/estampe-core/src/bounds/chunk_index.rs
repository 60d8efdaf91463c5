//! The chunk index: for each tile the chunks that have entries for it.
//!
//! A frame can have hundreds of chunks of which hardly any reaches a given tile: asking each chunk
//! took longer than drawing. Each chunk notes the tiles that it reaches as a row of bits, on its
//! own thread. The rows follow one another in memory, so that here, where all other threads wait,
//! they are read quickly and only transposed, 64 chunks by 64 tiles at a time.

/// For each tile the chunks that have entries for it, one bit each.
#[derive(Debug, Default)]
pub(crate) struct ChunkIndex {
    /// By chunk, `row_words` words: bit b of word w is tile 64 · w + b.
    rows: Vec<u64>,
    row_words: usize,
    /// By tile, `words_each` words: bit b of word w is chunk 64 · w + b.
    bits: Vec<u64>,
    words_each: usize,
}

impl ChunkIndex {
    /// Begins a draw batch, without chunks, in a target of so many tiles.
    pub(crate) fn begin(&mut self, tiles: usize) {
        self.rows.clear();
        self.row_words = tiles.div_ceil(64);
    }

    /// Adds so many chunks, which reach no tile; gives their rows, in order. A row has a bit for
    /// each tile, and ends with a whole word.
    pub(crate) fn add(&mut self, chunks: usize) -> impl Iterator<Item = &mut [u64]> {
        let before = self.rows.len();
        self.rows.resize(before + chunks * self.row_words, 0);
        self.rows[before..].chunks_exact_mut(self.row_words.max(1))
    }

    /// Sorts the chunks by the tiles that they reach.
    pub(crate) fn build(&mut self) {
        let chunks = self.rows.len().checked_div(self.row_words).unwrap_or(0);
        self.words_each = chunks.div_ceil(64);
        // Every word is written below.
        self.bits.resize(self.row_words * 64 * self.words_each, 0);
        for (word, rows) in self.rows.chunks(64 * self.row_words.max(1)).enumerate() {
            for of_tiles in 0..self.row_words {
                let mut square = [0; 64];
                let words = rows[of_tiles..].iter().step_by(self.row_words);
                for (row, reached) in square.iter_mut().zip(words) {
                    *row = *reached;
                }
                if chunks == 1 {
                    let of_one = square[0];
                    for (tile, bits) in square.iter_mut().enumerate() {
                        *bits = of_one >> tile & 1;
                    }
                } else if square != [0; 64] {
                    transpose(&mut square);
                }
                let first = of_tiles * 64 * self.words_each + word;
                let of_chunks = self.bits[first..].iter_mut().step_by(self.words_each);
                for (of_tile, bits) in of_chunks.zip(square) {
                    *of_tile = bits;
                }
            }
        }
    }

    /// The numbers of the chunks that have entries for a tile, in order.
    pub(crate) fn of_tile(&self, tile: u32) -> ChunksOfTile<'_> {
        let first = tile as usize * self.words_each;
        let words = self.bits.get(first..first + self.words_each);
        ChunksOfTile {
            words: words.unwrap_or_default(),
            bits: 0,
            first: 0,
        }
    }

    /// Returns true if no chunk has entries for a tile.
    pub(crate) fn is_empty(&self, tile: u32) -> bool {
        self.of_tile(tile).words.iter().all(|bits| *bits == 0)
    }
}

/// See [`ChunkIndex::of_tile`].
#[derive(Debug, Clone)]
pub(crate) struct ChunksOfTile<'a> {
    /// The words after that at hand.
    words: &'a [u64],
    /// The chunks that are left of that word.
    bits: u64,
    /// The number of the chunk of the next word's bit 0.
    first: u32,
}

impl Iterator for ChunksOfTile<'_> {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        while self.bits == 0 {
            let (bits, others) = self.words.split_first()?;
            (self.bits, self.words) = (*bits, others);
            self.first += 64;
        }
        let bit = self.bits.trailing_zeros();
        self.bits &= self.bits - 1;
        Some(self.first - 64 + bit)
    }
}

/// Transposes a square of bits: bit b of row r becomes bit r of row b. Squares of half the side
/// change places, then those of a quarter within each, and so on (Warren, *Hacker's Delight*,
/// 7-3).
fn transpose(rows: &mut [u64; 64]) {
    let mut side = 32;
    let mut low = 0x0000_0000_FFFF_FFFF_u64;
    while side > 0 {
        for pair in rows.chunks_exact_mut(2 * side) {
            let (upper, lower) = pair.split_at_mut(side);
            for (a, b) in upper.iter_mut().zip(lower) {
                let changed = (*a >> side ^ *b) & low;
                *a ^= changed << side;
                *b ^= changed;
            }
        }
        side /= 2;
        low ^= low << side;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An index of chunks that reach these tiles, in groups of some chunks each.
    fn build(index: &mut ChunkIndex, tiles: usize, chunks: &[Vec<u32>], group: usize) {
        index.begin(tiles);
        for chunks in chunks.chunks(group) {
            for (row, reached) in index.add(chunks.len()).zip(chunks) {
                for tile in reached {
                    row[*tile as usize / 64] |= 1 << (tile % 64);
                }
            }
        }
        index.build();
    }

    #[test]
    fn an_index_names_each_tiles_chunks_in_order() {
        let chunks = [vec![3, 1], vec![], vec![0, 1], vec![3]];
        let mut index = ChunkIndex::default();
        // Several times, because its memory is used again.
        for group in [1, 4, 3] {
            build(&mut index, 4, &chunks, group);
            let found = [0, 1, 2, 3, 4].map(|tile| index.of_tile(tile).collect::<Vec<_>>());
            assert_eq!(found, [vec![2], vec![0, 2], vec![], vec![0, 3], vec![]]);
            let empty = [0, 1, 2, 3].map(|tile| index.is_empty(tile));
            assert_eq!(empty, [false, false, true, false]);
        }
    }

    #[test]
    fn hundreds_of_chunks_and_tiles_find_each_other() {
        let reaches = |chunk: u32, tile: u32| (chunk * 7 + tile * 13).is_multiple_of(29);
        let mut index = ChunkIndex::default();
        // The larger one first, so that the memory holds bits of another index.
        for (chunks, tiles) in [(200, 500), (64, 64), (65, 129), (1, 1)] {
            let all: Vec<Vec<u32>> = (0..chunks)
                .map(|number| (0..tiles).filter(|tile| reaches(number, *tile)).collect())
                .collect();
            build(&mut index, tiles as usize, &all, 60);
            for tile in 0..tiles {
                let expected = (0..chunks).filter(|number| reaches(*number, tile));
                assert!(index.of_tile(tile).eq(expected), "tile {tile} of {tiles}");
            }
        }
    }

    #[test]
    fn no_chunks_reach_no_tile() {
        let mut index = ChunkIndex::default();
        build(&mut index, 100, &[], 1);
        assert!(index.is_empty(7) && index.of_tile(7).next().is_none());
    }

    #[test]
    fn bits_are_transposed() {
        let mut rows = [0; 64];
        let is_set = |row: usize, bit: usize| (row * 5 + bit * 3) % 7 < 2;
        for (row, word) in rows.iter_mut().enumerate() {
            *word = (0..64).map(|bit| u64::from(is_set(row, bit)) << bit).sum();
        }
        transpose(&mut rows);
        for (row, word) in rows.iter().enumerate() {
            for bit in 0..64 {
                assert_eq!(word >> bit & 1 == 1, is_set(bit, row));
            }
        }
    }
}
