//! Helpers that stay awake during a pass.
//!
//! A pass is a few lists of jobs with short serial parts between them. A helper that finds nothing
//! to do falls asleep within some microseconds, and takes fifty to wake up, which is as long as
//! many of the lists. So helpers are woken when a pass begins, while the caller still prepares it,
//! and wait for the next list of jobs without falling asleep until the pass ends.

use super::pause;
use rayon::ThreadPool;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What helpers that wait look at.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// The passes that are being drawn.
    passes: AtomicUsize,
    /// Counts the lists of jobs that began, and how often the last pass at hand ended: helpers that
    /// wait stop when it changes.
    changes: AtomicUsize,
}

/// How long a helper waits at most: 200 µs, four times as long as it takes to be woken.
const ROUNDS: usize = 256;

impl Watch {
    /// Says that a list of jobs begins: helpers that wait will look for its jobs.
    pub(super) fn begin_jobs(&self) {
        if self.passes.load(Ordering::Relaxed) > 0 {
            self.changes.fetch_add(1, Ordering::Release);
        }
    }

    /// Lets a helper that has done its part of a list of jobs wait for the next one, once its other
    /// work is done.
    pub(super) fn wait_for_more(watch: &Arc<Self>) {
        let before = watch.changes.load(Ordering::Acquire);
        if watch.passes.load(Ordering::Relaxed) == 0 {
            return;
        }
        let watch = Arc::clone(watch);
        rayon::spawn(move || {
            // Calls for helpers that did not wake up yet.
            while rayon::yield_local() == Some(rayon::Yield::Executed) {}
            watch.wait(before);
        });
    }

    /// Waits until something changes.
    fn wait(&self, before: usize) {
        for _ in 0..ROUNDS {
            if self.changes.load(Ordering::Acquire) != before {
                break;
            }
            pause();
            // Where there are more threads than processors, the caller must go on.
            std::thread::yield_now();
        }
    }
}

/// While it lives, helpers stay awake.
#[derive(Debug)]
pub struct Awake {
    watch: Option<Arc<Watch>>,
}

impl Awake {
    /// Wakes the helpers, unless a pass before did.
    pub(super) fn new(pool: &ThreadPool, watch: &Arc<Watch>) -> Self {
        if watch.passes.fetch_add(1, Ordering::Relaxed) == 0 {
            let before = watch.changes.load(Ordering::Acquire);
            let (helpers, watch) = (pool.current_num_threads(), Arc::clone(watch));
            pool.spawn(move || wake(&watch, helpers, before));
        }
        Self {
            watch: Some(Arc::clone(watch)),
        }
    }

    /// Without helpers that could be kept awake.
    pub(super) const NOBODY: Self = Self { watch: None };
}

impl Drop for Awake {
    fn drop(&mut self) {
        if let Some(watch) = &self.watch {
            // A pass of a submission leaves them awake for the next one.
            if watch.passes.fetch_sub(1, Ordering::Relaxed) == 1 {
                watch.changes.fetch_add(1, Ordering::Release);
            }
        }
    }
}

/// Wakes the other ones of some helpers as a tree, and waits.
fn wake(watch: &Arc<Watch>, helpers: usize, before: usize) {
    let mut others = helpers.saturating_sub(1);
    while others > 0 && watch.changes.load(Ordering::Acquire) == before {
        let half = others.div_ceil(2);
        let watch = Arc::clone(watch);
        rayon::spawn(move || wake(&watch, half, before));
        others -= half;
    }
    watch.wait(before);
}

#[cfg(test)]
mod tests {
    use super::super::Executor;
    use super::*;
    use rayon::ThreadPoolBuilder;

    #[test]
    fn lists_of_jobs_are_done_while_helpers_wait() {
        let pool = Arc::new(ThreadPoolBuilder::new().num_threads(2).build().unwrap());
        let watch = Arc::<Watch>::default();
        let executor = Executor {
            watch: Some(Arc::clone(&watch)),
            ..Executor::on_pool(pool)
        };
        for len in [1, 2, 3, 100] {
            // A pass within another one, as in a submission.
            let outer = executor.awake();
            for _ in 0..3 {
                let _inner = executor.awake();
                let mut items = vec![0; len];
                for _ in 0..20 {
                    executor.for_each_alone(&mut items, |item| *item += 1);
                }
                assert_eq!(items, vec![20; len]);
            }
            assert_eq!(watch.passes.load(Ordering::Relaxed), 1);
            // Helpers wait for the next pass of a submission, and no longer when all have ended.
            let changes = || watch.changes.load(Ordering::Acquire);
            let before = changes();
            drop(executor.awake());
            assert_eq!(changes(), before);
            drop(outer);
            assert_eq!(changes(), before + 1);
            assert_eq!(watch.passes.load(Ordering::Relaxed), 0);
        }
    }

    #[test]
    fn a_helper_waits_until_something_changes() {
        let watch = Watch::default();
        // What it looked at has changed already.
        watch.wait(1);
        std::thread::scope(|scope| {
            let waits = scope.spawn(|| watch.wait(0));
            watch.changes.fetch_add(1, Ordering::Release);
            waits.join().unwrap();
        });
        // Without a pass no list of jobs is announced.
        watch.begin_jobs();
        assert_eq!(watch.changes.load(Ordering::Acquire), 1);
        watch.passes.fetch_add(1, Ordering::Relaxed);
        watch.begin_jobs();
        assert_eq!(watch.changes.load(Ordering::Acquire), 2);
    }

    #[test]
    fn nobody_is_kept_awake_alone() {
        assert!(Executor::alone().awake().watch.is_none());
        assert!(Executor::profiling(8).awake().watch.is_none());
    }
}
