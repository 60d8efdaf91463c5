//! Batches that a program did not finish.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts the batches of a program that were stopped because they executed more jumps than
/// [`Limits::max_shader_jumps`](crate::Limits::max_shader_jumps) allows.
///
/// After the first one of a pass the other batches need not run: the pass ends with an error.
#[derive(Debug, Default)]
pub struct StoppedBatches {
    count: AtomicU64,
    is_stopped: AtomicBool,
}

impl StoppedBatches {
    /// Counts a batch that was stopped.
    pub fn stop(&self) {
        self.count.fetch_add(1, Ordering::Relaxed);
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    /// True between the first batch that was stopped and the end of the pass.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// The batches that were stopped so far.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// Lets batches run again: the pass has ended.
    pub fn end_pass(&self) {
        self.is_stopped.store(false, Ordering::Relaxed);
    }
}
