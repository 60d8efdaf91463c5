//! The memory of the runs of machine code: a thread's own.
//!
//! A run writes to most of its memory, so what another thread used last would be in another core's
//! cache: with one list for all threads, a batch of packets took a microsecond more on two cores.

use estampe_x86::{Code, Scratch};
use std::cell::RefCell;

/// The codes whose memory a thread keeps: those of a few pipelines.
const MOST: usize = 16;

/// The bytes of memory that are not kept: those of large arrays, and of work-groups with many.
const MOST_BYTES: usize = 1 << 22;

thread_local! {
    /// The memory of the codes that ran last, the latest one at the end.
    #[expect(clippy::vec_box, reason = "a batch moves one out and in again")]
    static WORKSPACES: RefCell<Vec<Box<Scratch>>> = const { RefCell::new(Vec::new()) };
}

/// Runs something with the memory that this thread has for a code.
#[inline]
pub(super) fn with_workspace<T>(code: &Code, run: impl FnOnce(&mut Scratch) -> T) -> T {
    // It is taken out while it is used: what a run calls may run other code.
    let kept = WORKSPACES.with_borrow_mut(|kept| {
        let at = kept.iter().rposition(|scratch| scratch.is_of(code))?;
        Some(kept.remove(at))
    });
    let mut scratch = kept.unwrap_or_default();
    let result = run(&mut scratch);
    if scratch.bytes() <= MOST_BYTES {
        WORKSPACES.with_borrow_mut(|kept| {
            if kept.len() == MOST {
                kept.remove(0);
            }
            kept.push(scratch);
        });
    }
    result
}
