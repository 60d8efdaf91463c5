//! Which blocks are on all ways to others: dominators (Cooper, Harvey and Kennedy 2001).

use super::{BlockId, Kernel};

/// The dominators of the blocks that are reached.
#[derive(Debug, Default)]
pub(super) struct Dominators {
    /// For each block, where its part of the tree of dominators begins and ends in an order in
    /// which each block comes before those that it dominates; `None` if it is never reached.
    spans: Vec<Option<(usize, usize)>>,
}

impl Dominators {
    /// The dominators of a kernel whose jumps go to blocks.
    pub(super) fn of(kernel: &Kernel) -> Self {
        let order = reverse_postorder(kernel);
        let mut number = vec![usize::MAX; kernel.blocks.len()];
        for (at, block) in order.iter().enumerate() {
            number[block.index()] = at;
        }
        // From here on, blocks are known by their places in the order.
        let mut before: Vec<Vec<usize>> = vec![Vec::new(); order.len()];
        for (at, block) in order.iter().enumerate() {
            for jump in kernel.blocks[block.index()].terminator.jumps() {
                before[number[jump.to.index()]].push(at);
            }
        }
        let parents = parents(&before);
        let spans = spans(&parents);
        Self {
            spans: number
                .into_iter()
                .map(|at| spans.get(at).copied())
                .collect(),
        }
    }

    /// True if the block is executed at all.
    pub(super) fn is_reached(&self, block: BlockId) -> bool {
        self.span(block).is_some()
    }

    /// True if all ways to the second block go through the first.
    pub(super) fn dominates(&self, first: BlockId, second: BlockId) -> bool {
        match (self.span(first), self.span(second)) {
            (Some((begin, end)), Some((at, _))) => begin <= at && at < end,
            _ => false,
        }
    }

    fn span(&self, block: BlockId) -> Option<(usize, usize)> {
        self.spans.get(block.index()).copied().flatten()
    }
}

/// The blocks that are reached; each comes before those that are reached through it alone.
fn reverse_postorder(kernel: &Kernel) -> Vec<BlockId> {
    let mut is_seen = vec![false; kernel.blocks.len()];
    let mut order = Vec::new();
    // Each block with the number of its jumps that were followed.
    let mut path = vec![(BlockId(0), 0)];
    if let Some(first) = is_seen.first_mut() {
        *first = true;
    }
    while let Some((block, followed)) = path.last_mut() {
        let jumps = &kernel.blocks[block.index()].terminator;
        let next = jumps.jumps().nth(*followed).map(|jump| jump.to);
        *followed += 1;
        match next {
            Some(to) if !is_seen[to.index()] => {
                is_seen[to.index()] = true;
                path.push((to, 0));
            }
            Some(_) => {}
            None => order.extend(path.pop().map(|(block, _)| block)),
        }
    }
    order.reverse();
    order
}

/// The immediate dominator of each block, from the blocks before it. The first one is its own.
fn parents(before: &[Vec<usize>]) -> Vec<usize> {
    let mut parents = vec![usize::MAX; before.len()];
    if let Some(first) = parents.first_mut() {
        *first = 0;
    }
    let mut has_changed = true;
    while has_changed {
        has_changed = false;
        for at in 1..before.len() {
            let known = before[at]
                .iter()
                .filter(|&&from| parents[from] != usize::MAX);
            let parent = known.copied().reduce(|a, b| common(&parents, a, b));
            let parent = parent.unwrap_or(0);
            has_changed |= std::mem::replace(&mut parents[at], parent) != parent;
        }
    }
    parents
}

/// The last block on all ways to both.
fn common(parents: &[usize], mut a: usize, mut b: usize) -> usize {
    while a != b {
        if a > b {
            a = parents[a];
        } else {
            b = parents[b];
        }
    }
    a
}

/// Numbers the tree so that each block's part is a range.
fn spans(parents: &[usize]) -> Vec<(usize, usize)> {
    let mut sizes = vec![1; parents.len()];
    for at in (1..parents.len()).rev() {
        sizes[parents[at]] += sizes[at];
    }
    // Each block takes a part of its parent's range, after its elder siblings.
    let mut next = vec![0; parents.len()];
    let mut spans = vec![(0, 0); parents.len()];
    for at in 0..parents.len() {
        let begin = if at == 0 { 0 } else { next[parents[at]] };
        spans[at] = (begin, begin + sizes[at]);
        next[at] = begin + 1;
        if at > 0 {
            next[parents[at]] += sizes[at];
        }
    }
    spans
}
