//! The chunk plan: which chunk takes which primitives of a batch.
//!
//! Tiles read chunks in order, so that where a chunk ends changes no image. Small sub-draws share a
//! chunk, large ones take several; with many threads chunks are smaller, so that all have some.

use super::draw_batch::DrawBatch;
use super::sub_draw::SubDraw;
use crate::bounds::chunk::number;
use std::ops::Range;

/// Primitives of a chunk at most, but for stippled strips, which are not cut; then the limit where
/// there are too few for the threads. Where a mesh lies all over the picture, each tile has a run
/// of each chunk, which costs as much as some triangles: with 4096 primitives runs had sixteen.
const CHUNK_PRIMITIVES: [usize; 2] = [16_384, 512];

/// Sub-draws of a chunk at most, then the limit where there are too few for the threads: each costs
/// about as much as the geometry of 64 triangles.
const CHUNK_RUNS: [usize; 2] = [64, 8];

/// Vertices that one worker shades at a time, then their number where there are too few for the
/// threads.
pub(crate) const VERTEX_CHUNK: [usize; 2] = [4096, 512];

/// The size of the parts of a whole, of which several threads should have some each: between the
/// most and the least.
pub(crate) fn part_size(whole: usize, threads: usize, [most, least]: [usize; 2]) -> usize {
    const PARTS_PER_THREAD: usize = 8;
    match threads {
        0 | 1 => most,
        _ => (whole / (threads * PARTS_PER_THREAD)).clamp(least, most),
    }
}

/// Primitives of one sub-draw that go into one chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ChunkPart {
    /// The sub-draw's number in the batch.
    pub(crate) sub_draw: u32,
    /// The primitives, counted over all instances; half-open.
    pub(crate) primitives: [u32; 2],
}

/// The parts of all chunks of a batch.
#[derive(Debug, Default)]
pub(crate) struct ChunkPlan {
    parts: Vec<ChunkPart>,
    /// For each chunk the end of its parts, which begin where those of the chunk before end.
    ends: Vec<usize>,
    most: Most,
}

/// The most that a chunk holds.
#[derive(Debug, Default)]
struct Most {
    primitives: u32,
    runs: usize,
}

impl ChunkPlan {
    /// Divides the primitives of a group of a batch's sub-draws among threads.
    pub(crate) fn build(&mut self, (batch, group): (&DrawBatch<'_>, Range<usize>), threads: usize) {
        let (first, count) = (group.start, group.len());
        let sub_draws = batch.sub_draws.range(group);
        self.parts.clear();
        self.ends.clear();
        let all = sub_draws.clone().map(SubDraw::total_primitives).sum();
        let size = part_size(all, threads, CHUNK_PRIMITIVES);
        self.most = Most {
            primitives: u32::try_from(size).unwrap_or(u32::MAX),
            runs: part_size(count, threads, CHUNK_RUNS),
        };
        let mut open = OpenChunk::default();
        for (number, sub_draw) in (number(first)..).zip(sub_draws) {
            let total = sub_draw.total_primitives();
            debug_assert!(
                u32::try_from(total).is_ok(),
                "a batch's budget is far below 2³²"
            );
            let total = u32::try_from(total).unwrap_or(u32::MAX);
            // Without a look at the draw, which is in no near cache.
            let size = if batch.state(sub_draw).is_uncut {
                sub_draw.primitives
            } else {
                self.most.primitives
            };
            self.add(number, total, size.max(1), &mut open);
        }
        self.close(&mut open);
    }

    /// Adds a sub-draw that is cut into parts of `size` primitives, unless it fits into the open
    /// chunk whole.
    fn add(&mut self, sub_draw: u32, total: u32, size: u32, open: &mut OpenChunk) {
        let is_full = open.runs >= self.most.runs;
        if is_full || open.primitives.saturating_add(total) > self.most.primitives {
            self.close(open);
        }
        let mut from = 0;
        while from < total {
            let to = from.saturating_add(size).min(total);
            self.parts.push(ChunkPart {
                sub_draw,
                primitives: [from, to],
            });
            open.primitives = open.primitives.saturating_add(to - from);
            open.runs += 1;
            from = to;
            if from < total {
                self.close(open);
            }
        }
    }

    /// Ends a chunk, if it has parts.
    fn close(&mut self, open: &mut OpenChunk) {
        if open.runs > 0 {
            self.ends.push(self.parts.len());
        }
        *open = OpenChunk::default();
    }

    /// The number of chunks.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The end of those chunks from a first one on that have so many primitives together, at least
    /// one chunk.
    pub(crate) fn end_of_some(&self, first: usize, most: u64) -> usize {
        let mut primitives = 0;
        let chunks = self.chunks().enumerate().skip(first);
        for (number, parts) in chunks {
            let of_part = |part: &ChunkPart| u64::from(part.primitives[1] - part.primitives[0]);
            primitives += parts.iter().map(of_part).sum::<u64>();
            if primitives > most {
                return number.max(first + 1);
            }
        }
        self.len()
    }

    /// The parts of each chunk, in order.
    pub(crate) fn chunks(&self) -> impl Iterator<Item = &[ChunkPart]> {
        let mut from = 0;
        self.ends.iter().map(move |&to| {
            let parts = &self.parts[from..to];
            from = to;
            parts
        })
    }
}

/// The numbers of primitives and runs in the chunk that is being planned.
#[derive(Debug, Default)]
struct OpenChunk {
    primitives: u32,
    runs: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: usize = 64;

    fn plan(sub_draws: &[(u32, u32)]) -> Vec<Vec<(u32, [u32; 2])>> {
        let mut plan = ChunkPlan {
            most: Most {
                primitives: 4096,
                runs: RUNS,
            },
            ..ChunkPlan::default()
        };
        let mut open = OpenChunk::default();
        for (number, &(total, size)) in (0..).zip(sub_draws) {
            plan.add(number, total, size, &mut open);
        }
        plan.close(&mut open);
        let parts = |parts: &[ChunkPart]| {
            let part = |part: &ChunkPart| (part.sub_draw, part.primitives);
            parts.iter().map(part).collect()
        };
        assert_eq!(plan.chunks().count(), plan.len());
        plan.chunks().map(parts).collect()
    }

    #[test]
    fn small_sub_draws_share_a_chunk_and_large_ones_take_several() {
        let chunks = plan(&[
            (10, 4096),
            (4000, 4096),
            (90, 4096),
            (9000, 4096),
            (5, 4096),
        ]);
        let expected = [
            vec![(0, [0, 10]), (1, [0, 4000])],
            vec![(2, [0, 90])],
            vec![(3, [0, 4096])],
            vec![(3, [4096, 8192])],
            vec![(3, [8192, 9000]), (4, [0, 5])],
        ];
        assert_eq!(chunks, expected);
    }

    #[test]
    fn some_chunks_have_few_primitives_together() {
        let ends = vec![1, 2, 3, 4];
        let parts = [3, 4, 5, 100].map(|end| ChunkPart {
            sub_draw: 0,
            primitives: [0, end],
        });
        let plan = ChunkPlan {
            parts: parts.to_vec(),
            ends,
            most: Most::default(),
        };
        let ends = |most| [0, 1, 2, 3].map(|first| plan.end_of_some(first, most));
        assert_eq!(ends(u64::MAX), [4; 4]);
        assert_eq!(ends(0), [1, 2, 3, 4]);
        assert_eq!(ends(9), [2, 3, 3, 4]);
        assert_eq!(ends(12), [3, 3, 3, 4]);
    }

    #[test]
    fn a_chunk_has_a_limited_number_of_runs() {
        let chunks = plan(&vec![(2, 4096); RUNS * 2 + 1]);
        let sizes: Vec<usize> = chunks.iter().map(Vec::len).collect();
        assert_eq!(sizes, [RUNS, RUNS, 1]);
    }

    #[test]
    fn each_thread_has_several_parts() {
        let size = |whole, threads| part_size(whole, threads, VERTEX_CHUNK);
        assert_eq!(size(10, 1), 4096);
        // Few vertices: parts are not so small that their number costs time.
        assert_eq!(size(10, 64), 512);
        assert_eq!(size(65_536, 2), 4096);
        assert_eq!(size(65_536, 16), 512);
        assert_eq!(size(1_000_000, 64), 1953);
        assert_eq!(size(10_000_000, 64), 4096);
    }

    #[test]
    fn uncut_primitives_are_one_part() {
        let chunks = plan(&[(1, 4096), (30_000, 10_000), (7, 4096)]);
        let expected = [
            vec![(0, [0, 1])],
            vec![(1, [0, 10_000])],
            vec![(1, [10_000, 20_000])],
            vec![(1, [20_000, 30_000])],
            vec![(2, [0, 7])],
        ];
        assert_eq!(chunks, expected);
        assert!(plan(&[]).is_empty());
    }
}
