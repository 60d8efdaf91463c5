//! Threads: work is done by the calling thread alone, or by it and helpers.
//!
//! Work is a slice of independent items; each worker brings its own scratch. The calling thread is
//! one of the workers: it begins at once, and the helpers, which are rayon's threads, join it when
//! they have woken up. (The whole pass inside rayon's pool costs a wake-up before the first item
//! and another after the last, while the caller sleeps.) Workers take items from the front of what
//! is left, many at first and one by one in the end, so that they finish together.

mod awake;

use crate::profile::{JobTimings, Profiler};
use awake::Watch;
use rayon::Scope;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub use awake::Awake;
pub use rayon::{ThreadPool, ThreadPoolBuilder};

/// Runs independent items on the calling thread and its helpers.
#[derive(Debug)]
pub(crate) struct Executor {
    helpers: Option<Arc<ThreadPool>>,
    /// Keeps them awake during a pass, if each has a processor and no other work.
    watch: Option<Arc<Watch>>,
    /// Measures each item, if the context is made for profiling.
    profiler: Option<Profiler>,
    /// The number of threads for which work is divided, the caller included.
    threads: usize,
}

/// The error returned if the thread pool cannot be created.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the system gave no pool of {threads} threads: {reason}")]
pub struct ThreadError {
    /// The number of threads requested.
    pub threads: usize,
    /// The system's error message.
    pub reason: String,
}

/// The least number of times that each worker takes items, if there are enough. A smaller
/// number makes workers wait less for each other, and the last one end later.
const TURNS: usize = 4;

impl Executor {
    /// An executor of `threads` threads, the caller included; 0 means one for each processor.
    pub(crate) fn new(threads: usize) -> Result<Self, ThreadError> {
        let available = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { available() } else { threads };
        if threads == 1 {
            return Ok(Self::alone());
        }
        let builder = rayon::ThreadPoolBuilder::new()
            .num_threads(threads - 1)
            .thread_name(|index| format!("estampe-{}", index + 1));
        let pool = builder.build().map_err(|error| ThreadError {
            threads,
            reason: error.to_string(),
        })?;
        Ok(Self {
            watch: (threads <= available()).then(Arc::default),
            ..Self::on_pool(Arc::new(pool))
        })
    }

    /// An executor of the caller and the threads of a pool.
    pub(crate) fn on_pool(pool: Arc<ThreadPool>) -> Self {
        Self {
            threads: 1 + pool.current_num_threads(),
            helpers: Some(pool),
            watch: None,
            profiler: None,
        }
    }

    /// An executor of the calling thread.
    pub(crate) fn alone() -> Self {
        Self {
            helpers: None,
            watch: None,
            profiler: None,
            threads: 1,
        }
    }

    /// An executor of the calling thread alone that measures what each item takes. Work is divided
    /// as for this many threads.
    pub(crate) fn profiling(threads: usize) -> Self {
        Self {
            helpers: None,
            watch: None,
            profiler: Some(Profiler::default()),
            threads: threads.max(1),
        }
    }

    /// Keeps the helpers awake while the value lives.
    pub(crate) fn awake(&self) -> Awake {
        match (&self.helpers, &self.watch) {
            (Some(pool), Some(watch)) => Awake::new(pool, watch),
            _ => Awake::NOBODY,
        }
    }

    /// Returns the time of each item since the last call, and clears it; empty without profiling.
    pub(crate) fn take_timings(&self) -> Vec<JobTimings> {
        let profiler = self.profiler.as_ref();
        profiler.map(Profiler::take).unwrap_or_default()
    }

    /// Returns the number of items that run at once, or would if they were not measured.
    pub(crate) fn threads(&self) -> usize {
        self.threads
    }

    /// Runs `work` for every item, each with one worker's scratch.
    pub(crate) fn for_each<T: Send, C: Send>(
        &self,
        items: &mut [T],
        scratch: &[Mutex<C>],
        work: impl Fn(&mut T, &mut C) + Sync,
    ) {
        self.share(items, |worker, next| {
            let mut mine = lock(&scratch[worker]);
            while let Some(items) = next() {
                items.iter_mut().for_each(|item| work(item, &mut mine));
            }
        });
    }

    /// [`Executor::for_each`] that also gives the item that the worker takes next, if it knows.
    pub(crate) fn for_each_ahead<T: Send + Sync, C: Send>(
        &self,
        items: &mut [T],
        scratch: &[Mutex<C>],
        work: impl Fn(&mut T, Option<&T>, &mut C) + Sync,
    ) {
        self.share(items, |worker, next| {
            let mut mine = lock(&scratch[worker]);
            while let Some(mut items) = next() {
                while let Some((item, others)) = items.split_first_mut() {
                    work(item, others.first(), &mut mine);
                    items = others;
                }
            }
        });
    }

    /// Runs `work` for every item.
    pub(crate) fn for_each_alone<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        self.share(items, |_, next| {
            while let Some(items) = next() {
                items.iter_mut().for_each(&work);
            }
        });
    }

    /// Runs `work` once for each worker, with its number and what gives it items.
    fn share<'i, T: Send>(
        &self,
        items: &'i mut [T],
        work: impl Fn(usize, &mut dyn FnMut() -> Option<&'i mut [T]>) + Sync,
    ) {
        let workers = self.threads().min(items.len());
        let Some(pool) = self.helpers.as_ref().filter(|_| workers > 1) else {
            if let Some(profiler) = &self.profiler {
                profiler.hand_out(items, |next| work(0, next));
                return;
            }
            let mut all = Some(items);
            work(0, &mut || all.take());
            return;
        };
        let left = Mutex::new(items);
        let running = AtomicUsize::new(workers);
        let watch = self.watch.as_ref();
        let run = |worker: usize| {
            work(worker, &mut || take_some(&left, workers));
            running.fetch_sub(1, Ordering::Release);
            if let Some(watch) = watch.filter(|_| worker > 0) {
                Watch::wait_for_more(watch);
            }
        };
        if let Some(watch) = watch {
            watch.begin_jobs();
        }
        pool.in_place_scope(|scope| {
            call_helpers(scope, 1..workers, &run);
            run(0);
            wait_a_little(&running);
        });
    }
}

/// Calls the helpers that are the workers of a range, as a tree: who calls the first worker of the
/// upper half leaves the others of that half to it, and goes on with the lower half. To wake a
/// thread takes the caller several microseconds, so sixty-three calls one after the other would
/// take longer than many passes.
fn call_helpers<'scope>(
    scope: &Scope<'scope>,
    workers: Range<usize>,
    run: &'scope (impl Fn(usize) + Sync),
) {
    let Range { start, mut end } = workers;
    while start < end {
        let first = start + (end - start) / 2;
        let others = first + 1..end;
        scope.spawn(move |scope| {
            call_helpers(scope, others, run);
            run(first);
        });
        end = first;
    }
}

/// Waits for the helpers' last items without going to sleep, because to be woken again takes longer
/// than most of these. Beyond the limit, or after a helper's panic, the caller blocks in rayon's
/// scope.
fn wait_a_little(running: &AtomicUsize) {
    for _ in 0..ROUNDS {
        if running.load(Ordering::Acquire) == 0 {
            break;
        }
        pause();
    }
    // The time that rayon takes to observe that a helper is done.
    pause();
}

/// The number of times that a finished worker checks for the others, and the number of pauses
/// between: 50 µs in all.
const ROUNDS: usize = 128;
const PAUSES: usize = 16;

/// Some pauses.
fn pause() {
    (0..PAUSES).for_each(|_| std::hint::spin_loop());
}

/// Takes items off the front of what is left.
fn take_some<'i, T>(left: &Mutex<&'i mut [T]>, workers: usize) -> Option<&'i mut [T]> {
    let mut left = lock(left);
    let all = std::mem::take(&mut *left);
    let count = all.len().div_ceil(workers * TURNS).max(1);
    let (first, others) = all.split_at_mut_checked(count)?;
    *left = others;
    Some(first)
}

/// Locks what only holds plain data: after a panic elsewhere it is as good as before. A worker's
/// scratch is only ever locked by that worker, so that it never waits.
fn lock<C>(scratch: &Mutex<C>) -> std::sync::MutexGuard<'_, C> {
    scratch.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_helper_is_called_once() {
        for workers in [1, 2, 3, 8, 64, 100] {
            let calls: Vec<AtomicUsize> = (0..workers).map(|_| AtomicUsize::new(0)).collect();
            let pool = ThreadPoolBuilder::new().num_threads(3).build().unwrap();
            let run = |worker: usize| {
                calls[worker].fetch_add(1, Ordering::Relaxed);
            };
            pool.in_place_scope(|scope| call_helpers(scope, 1..workers, &run));
            let calls: Vec<_> = calls.into_iter().map(AtomicUsize::into_inner).collect();
            assert_eq!(calls[0], 0);
            assert_eq!(calls[1..], vec![1; workers - 1]);
        }
    }

    #[test]
    fn every_item_is_worked_on_once() {
        for threads in [1, 2, 7] {
            let executor = Executor::new(threads).unwrap();
            let scratch: Vec<Mutex<u32>> = (0..threads).map(|_| Mutex::default()).collect();
            for len in [0, 1, 2, 3, 100, 1000] {
                let mut items = vec![0; len];
                executor.for_each(&mut items, &scratch, |item, sum| {
                    *item += 1;
                    *sum += 1;
                });
                executor.for_each_alone(&mut items, |item| *item += 1);
                assert_eq!(items, vec![2; len]);
            }
            let sum: u32 = scratch.iter().map(|sum| *lock(sum)).sum();
            assert_eq!(sum, 1106);
        }
    }
}
