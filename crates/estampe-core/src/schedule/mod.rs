//! Threads: work is done by the calling thread alone, or by it and helpers.
//!
//! Work is a list of independent [`Jobs`]; each worker brings its own scratch. The calling thread
//! is one of the workers: it begins at once, and the helpers, which are rayon's threads, join it
//! when they have woken up. (The whole pass inside rayon's pool costs a wake-up before the first
//! job and another after the last, while the caller sleeps.) Workers take jobs from the front of
//! what is left, many at first and one by one in the end, so that they finish together.

mod awake;

use crate::profile::{JobTimings, Profiler};
use awake::Watch;
use rayon::Scope;
use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub use awake::Awake;
pub use rayon::{ThreadPool, ThreadPoolBuilder};

/// Independent jobs, taken off the front some at a time.
pub(crate) trait Jobs: Send {
    /// The jobs that are taken off.
    type Taken;

    /// The Rust type of a job, for people to read.
    fn job_type() -> &'static str;

    /// The number of jobs that are left.
    fn left(&self) -> usize;

    /// Takes the first jobs off, or all that are left.
    fn take_first(&mut self, count: usize) -> Self::Taken;
}

impl<T: Send> Jobs for &mut [T] {
    type Taken = Self;

    fn job_type() -> &'static str {
        std::any::type_name::<T>()
    }

    fn left(&self) -> usize {
        self.len()
    }

    fn take_first(&mut self, count: usize) -> Self {
        let all = std::mem::take(self);
        let (first, others) = all.split_at_mut(count.min(all.len()));
        *self = others;
        first
    }
}

/// Runs independent jobs on the calling thread and its helpers.
#[derive(Debug)]
pub(crate) struct Executor {
    helpers: Option<Arc<ThreadPool>>,
    /// Keeps them awake during a pass, if each has a processor and no other work.
    watch: Option<Arc<Watch>>,
    /// Measures each job, if the context is made for profiling.
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

/// The least number of times that each worker takes jobs, if there are enough. A smaller
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

    /// An executor of the calling thread alone that measures what each job takes. Work is divided
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

    /// Returns the time of each job since the last call, and clears it; empty without profiling.
    pub(crate) fn take_timings(&self) -> Vec<JobTimings> {
        let profiler = self.profiler.as_ref();
        profiler.map(Profiler::take).unwrap_or_default()
    }

    /// Returns the number of jobs that run at once, or would if they were not measured.
    pub(crate) fn threads(&self) -> usize {
        self.threads
    }

    /// The number of threads that run jobs at the same time.
    pub(crate) fn concurrent_threads(&self) -> usize {
        if self.helpers.is_some() {
            self.threads
        } else {
            1
        }
    }

    /// Runs `work` for every job.
    pub(crate) fn for_each_alone<T: Send>(&self, jobs: &mut [T], work: impl Fn(&mut T) + Sync) {
        self.share(jobs, |_, next| {
            while let Some(jobs) = next() {
                jobs.iter_mut().for_each(&work);
            }
        });
    }

    /// Runs `work` once for each worker, with what gives it jobs and with its scratch.
    pub(crate) fn for_each_worker<J: Jobs, C: Send>(
        &self,
        jobs: J,
        scratch: &[Mutex<C>],
        work: impl Fn(&mut dyn FnMut() -> Option<J::Taken>, &mut C) + Sync,
    ) {
        self.share(jobs, |worker, next| work(next, &mut lock(&scratch[worker])));
    }

    /// Runs `work` once for each worker, with its number and what gives it jobs.
    fn share<J: Jobs>(
        &self,
        mut jobs: J,
        work: impl Fn(usize, &mut dyn FnMut() -> Option<J::Taken>) + Sync,
    ) {
        let workers = self.threads().min(jobs.left());
        let calls_helpers = workers > 1 && !AtWork::is_current();
        let Some(pool) = self.helpers.as_ref().filter(|_| calls_helpers) else {
            if let Some(profiler) = &self.profiler {
                let kind = (J::job_type(), jobs.left());
                profiler.hand_out(kind, || take_some(&mut jobs, 1), |next| work(0, next));
                return;
            }
            work(0, &mut || take_some(&mut jobs, usize::MAX));
            return;
        };
        let left = Mutex::new(jobs);
        let running = AtomicUsize::new(workers);
        let watch = self.watch.as_ref();
        let run = |worker: usize| {
            let at_work = AtWork::begin();
            work(worker, &mut || {
                let mut left = lock(&left);
                let count = left.left().div_ceil(workers * TURNS);
                take_some(&mut *left, count)
            });
            drop(at_work);
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

thread_local! {
    static IS_AT_WORK: Cell<bool> = const { Cell::new(false) };
}

/// While it lives, the thread does a job: if that is a list of jobs itself, as a pass beside others
/// is, the thread does all of them. If it called helpers and waited for them, it could take up
/// another job meanwhile, in the middle of one that holds a lock.
struct AtWork {
    before: bool,
}

impl AtWork {
    fn begin() -> Self {
        Self {
            before: IS_AT_WORK.replace(true),
        }
    }

    fn is_current() -> bool {
        IS_AT_WORK.get()
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        IS_AT_WORK.set(self.before);
    }
}

/// Takes the first jobs off, or all that are left; `None` if there are none.
fn take_some<J: Jobs>(jobs: &mut J, count: usize) -> Option<J::Taken> {
    (jobs.left() > 0).then(|| jobs.take_first(count))
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

/// Waits for the helpers' last jobs without going to sleep, because to be woken again takes longer
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

/// Locks what only holds plain data: after a panic elsewhere it is as good as before. A worker's
/// scratch is only ever locked by that worker, so that it never waits.
pub(crate) fn lock<T>(data: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    data.lock().unwrap_or_else(PoisonError::into_inner)
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

    /// A job that is a list of jobs, and holds a lock meanwhile: if another job were taken up in
    /// the middle of it, the thread would wait for itself.
    #[test]
    fn a_thread_does_the_jobs_of_its_job_alone() {
        for threads in [1, 2, 3, 8] {
            let executor = Executor::new(threads).unwrap();
            for _ in 0..200 {
                let held = Mutex::new(());
                let mut lists = vec![vec![None; 20]; 16];
                executor.for_each_alone(&mut lists, |list| {
                    let _held = lock(&held);
                    executor.for_each_alone(list, |by| *by = Some(std::thread::current().id()));
                });
                let by_one = |list: &Vec<Option<_>>| list.iter().all(|by| *by == list[0]);
                assert!(lists.iter().all(|list| list[0].is_some() && by_one(list)));
            }
            // Threads have helpers again.
            assert!(!AtWork::is_current());
        }
    }

    #[test]
    fn every_item_is_worked_on_once() {
        for threads in [1, 2, 7] {
            let executor = Executor::new(threads).unwrap();
            let scratch: Vec<Mutex<usize>> = (0..threads).map(|_| Mutex::default()).collect();
            for len in [0, 1, 2, 3, 100, 1000] {
                let mut items = vec![0; len];
                executor.for_each_worker(&mut items[..], &scratch, |next, sum| {
                    while let Some(items) = next() {
                        items.iter_mut().for_each(|item| *item += 1);
                        *sum += items.len();
                    }
                });
                executor.for_each_alone(&mut items, |item| *item += 1);
                assert_eq!(items, vec![2; len]);
            }
            let sum: usize = scratch.iter().map(|sum| *lock(sum)).sum();
            assert_eq!(sum, 1106);
        }
    }
}
