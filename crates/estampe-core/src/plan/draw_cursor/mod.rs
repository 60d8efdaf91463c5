//! The draw cursor: cuts a pass's draws into batches of sub-draws.
//!
//! Of a pass of many draws, parts of some dozens or hundreds each are cut [on all threads](parts),
//! and added to the batch in order. Large draws, and all draws of other passes, are cut one after
//! the other.

mod open_draw;
mod parts;

use super::draw_batch::DrawBatch;
use super::index_extremes::KnownExtremes;
use crate::attachment::RenderTarget;
use crate::commands::{DrawIter, DrawList};
use crate::schedule::Executor;
use estampe_simd::Level;
use open_draw::OpenDraw;
use parts::Parts;
use std::ops::Range;

/// Vertices or primitives that a batch holds before it is drawn.
const BATCH_BUDGET: usize = 2_000_000;

/// Vertices or primitives for each thread whose geometry is done together: their indices, and their
/// vertices in the window, stay in a core's second-level cache from the first use to the last. A
/// frame of a million triangles read 12 MB of indices twice, and wrote and read 8 MB of positions,
/// when it was one group.
const GROUP_BUDGET: usize = 1 << 16;

/// The position in a pass's draws up to which they are cut into batches.
#[derive(Debug)]
pub(crate) struct DrawCursor<'a> {
    /// The draws that are cut one after the other now.
    now: UncutDraws<'a>,
    known: KnownExtremes,
    /// Those behind them, of which threads have cut the beginnings.
    parts: Parts<'a>,
    /// Those behind these.
    later: DrawIter<'a>,
}

/// Draws that follow each other, and what is left of one that is being cut.
#[derive(Debug)]
struct UncutDraws<'a> {
    current: Option<OpenDraw<'a>>,
    draws: DrawIter<'a>,
}

impl<'a> DrawCursor<'a> {
    /// A cursor before the first of a pass's draws. Indices are read at a SIMD level; parts of
    /// draws are cut in the memory of batches.
    pub(crate) fn new(draws: DrawList<'a>, level: Level, memory: Vec<DrawBatch<'a>>) -> Self {
        Self {
            now: UncutDraws::of(DrawList::default().iter()),
            known: KnownExtremes::new(level),
            parts: Parts::new(level, memory),
            later: draws.iter(),
        }
    }

    /// Returns the number of draws that no batch has begun.
    pub(crate) fn draws_left(&self) -> usize {
        self.now.draws.len() + self.parts.draws_left() + self.later.len()
    }

    /// Returns true if all draws are cut.
    pub(crate) fn is_at_end(&self) -> bool {
        self.now.current.is_none() && self.draws_left() == 0
    }

    /// The memory of batches in which parts of draws were cut.
    pub(crate) fn into_memory(self) -> Vec<DrawBatch<'a>> {
        self.parts.into_memory()
    }

    /// Cuts the next group of a batch's sub-draws, whose vertices lie together; none when the batch
    /// is full or no draws are left.
    pub(crate) fn next_group(
        &mut self,
        executor: &Executor,
        target: &RenderTarget,
        batch: &mut DrawBatch<'a>,
    ) -> Option<Range<usize>> {
        let first = batch.begin_group();
        let before = [batch.vertices, batch.primitives];
        // More threads have more work at once, and wait for each other as rarely as few.
        let budget = GROUP_BUDGET.saturating_mul(executor.threads());
        let is_full = |sizes: [usize; 2]| {
            let mut sizes = sizes.into_iter().zip(before);
            sizes.any(|(now, before)| now - before >= budget || now >= BATCH_BUDGET)
        };
        while !is_full([batch.vertices, batch.primitives]) {
            if let Some(open) = self.now.take() {
                let indices = (executor, &mut self.known);
                self.now.current = cut(open, indices, target, batch);
            } else if let Some(left) = self.parts.join_next(executor, batch, is_full) {
                self.now = left;
            } else if self.later.len() == 0 {
                break;
            } else if !self.parts.cut(executor, target, &mut self.later) {
                let none = DrawList::default().iter();
                self.now = UncutDraws::of(std::mem::replace(&mut self.later, none));
            }
        }
        let end = batch.sub_draws.len();
        (end > first).then_some(first..end)
    }
}

impl<'a> UncutDraws<'a> {
    fn of(draws: DrawIter<'a>) -> Self {
        Self {
            current: None,
            draws,
        }
    }

    fn is_empty(&self) -> bool {
        self.current.is_none() && self.draws.len() == 0
    }

    /// Takes the draw that is being cut, or the next one of at least one primitive.
    fn take(&mut self) -> Option<OpenDraw<'a>> {
        let current = self.current.take();
        current.or_else(|| self.draws.find_map(OpenDraw::new))
    }
}

/// Adds the next sub-draw of a draw to a batch. Gives what is left of the draw.
fn cut<'a>(
    mut open: OpenDraw<'a>,
    indices: (&Executor, &mut KnownExtremes),
    target: &RenderTarget,
    batch: &mut DrawBatch<'a>,
) -> Option<OpenDraw<'a>> {
    let state = batch.state_of(open.draw, target)?;
    batch.invisible_primitives += open.take_invisible();
    let (mut sub_draw, listed) = open.take(indices);
    sub_draw.state = state;
    if sub_draw.total_primitives() > 0 {
        batch.push(sub_draw, listed);
    }
    (!open.is_done()).then_some(open)
}

#[cfg(test)]
mod tests;
