//! Many draws, cut on all threads.
//!
//! To cut ten thousand small draws takes one thread 0.44 ms, and sixteen threads 1.1 ms to do their
//! geometry (`many_draws`); to cut 150 that differ in their scissors and read other indices takes
//! 0.09 ms (`ui`). So each thread cuts some draws into a batch of its own, and these batches are
//! joined in order. A part ends before a draw that is large or restarts
//! primitives: this draw, and those behind it in the part, are then cut one after the other, so
//! that no thread makes much that waits.
//!
//! ```text
//!   draws ─▶ parts ─▶ each cut by a thread ─▶ joined in order, with what they left between
//! ```

use super::{GROUP_BUDGET, UncutDraws, cut};
use crate::attachment::RenderTarget;
use crate::commands::DrawIter;
use crate::plan::draw_batch::DrawBatch;
use crate::plan::index_extremes::KnownExtremes;
use crate::schedule::Executor;
use estampe_simd::Level;
use std::collections::VecDeque;

/// Draws of a part, at most and at least.
const PART_DRAWS: [usize; 2] = [256, 16];

/// Fewer draws than this are cut by one thread.
const MANY_DRAWS: usize = 64;

/// Parts for each thread that are cut at once.
const PARTS_PER_THREAD: usize = 2;

/// Parts of draws that are not in the batch yet, in order.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    level: Level,
    cut: VecDeque<Part<'a>>,
    memory: Vec<DrawBatch<'a>>,
}

/// Draws that follow each other, those at the beginning cut.
#[derive(Debug)]
struct Part<'a> {
    /// How many draws there are.
    draws: usize,
    left: UncutDraws<'a>,
    batch: DrawBatch<'a>,
}

impl<'a> Parts<'a> {
    /// No parts; theirs will be in the memory of batches.
    pub(super) fn new(level: Level, memory: Vec<DrawBatch<'a>>) -> Self {
        Self {
            level,
            cut: VecDeque::new(),
            memory,
        }
    }

    /// The number of draws of the parts that no batch has begun.
    pub(super) fn draws_left(&self) -> usize {
        self.cut.iter().map(|part| part.draws).sum()
    }

    /// Adds the next parts to a batch, up to one some of whose draws were not cut, or until
    /// `is_full` says so of the batch's vertices and primitives. Gives the draws that were not cut.
    pub(super) fn join_next(
        &mut self,
        executor: &Executor,
        batch: &mut DrawBatch<'a>,
        is_full: impl Fn([usize; 2]) -> bool,
    ) -> Option<UncutDraws<'a>> {
        let mut sizes = [batch.vertices, batch.primitives];
        let mut left = None;
        let mut joined = Vec::new();
        while !is_full(sizes)
            && left.as_ref().is_none_or(UncutDraws::is_empty)
            && let Some(part) = self.cut.pop_front()
        {
            sizes[0] += part.batch.vertices;
            sizes[1] += part.batch.primitives;
            left = Some(part.left);
            joined.push(part.batch);
        }
        batch.append(executor, &mut joined);
        self.memory.append(&mut joined);
        left
    }

    /// Cuts the next draws of a list in parts, on all threads. `false`, with nothing done, if there
    /// is one thread, or there are few draws.
    pub(super) fn cut(
        &mut self,
        executor: &Executor,
        target: &RenderTarget,
        draws: &mut DrawIter<'a>,
    ) -> bool {
        if executor.threads() == 1 || draws.len() < MANY_DRAWS {
            return false;
        }
        let parts = PARTS_PER_THREAD.saturating_mul(executor.threads());
        let [most, least] = PART_DRAWS;
        let count = (draws.len() / parts).clamp(least, most);
        for _ in 0..parts {
            let part = draws.take_first(count);
            if part.len() == 0 {
                break;
            }
            self.cut.push_back(Part {
                draws: part.len(),
                left: UncutDraws::of(part),
                batch: self.memory.pop().unwrap_or_default(),
            });
        }
        let level = self.level;
        executor.for_each_alone(self.cut.make_contiguous(), |part| part.cut(level, target));
        true
    }

    /// The memory of the parts.
    pub(super) fn into_memory(self) -> Vec<DrawBatch<'a>> {
        let mut memory = self.memory;
        memory.extend(self.cut.into_iter().map(|part| part.batch));
        memory
    }
}

impl Part<'_> {
    /// Cuts the draws up to one that is not small, or until there is as much as a thread should
    /// draw at once.
    fn cut(&mut self, level: Level, target: &RenderTarget) {
        let alone = Executor::alone();
        let mut known = KnownExtremes::new(level);
        let batch = &mut self.batch;
        while batch.vertices < GROUP_BUDGET && batch.primitives < GROUP_BUDGET {
            let Some(open) = self.left.take() else {
                break;
            };
            if !open.is_small() {
                self.left.current = Some(open);
                break;
            }
            self.left.current = cut(open, (&alone, &mut known), target, batch);
        }
    }
}
