//! Who does the work: this thread alone, or a pool.
//!
//! Work is a slice of independent items; each worker brings its own scratch. The pool is
//! rayon's own threads; `install` moves the caller's work into it for a whole pass, so that it is woken
//! once. (The caller as a member of the pool would save that wake-up, but binds the pool to one thread.)

use std::sync::{Mutex, PoisonError};

/// Runs independent items, serially or on a pool of threads.
#[derive(Debug)]
pub(crate) enum Executor {
    /// On the calling thread.
    Serial,
    /// On a pool.
    Pool(rayon::ThreadPool),
}

/// Why there is no executor.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the system gave no pool of {threads} threads: {reason}")]
pub struct ThreadError {
    /// How many were asked for.
    pub threads: usize,
    /// What the system said.
    pub reason: String,
}

impl Executor {
    /// An executor of `threads` threads; 0 means one for each processor.
    pub(crate) fn new(threads: usize) -> Result<Self, ThreadError> {
        let available = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { available() } else { threads };
        if threads == 1 {
            return Ok(Self::Serial);
        }
        let builder = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|index| format!("estampe-{index}"));
        let pool = builder.build().map_err(|error| ThreadError {
            threads,
            reason: error.to_string(),
        })?;
        Ok(Self::Pool(pool))
    }

    /// How many items run at once.
    pub(crate) fn threads(&self) -> usize {
        match self {
            Self::Serial => 1,
            Self::Pool(pool) => pool.current_num_threads(),
        }
    }

    /// Runs `work` inside the pool, so that every [`Executor::for_each`] below it starts at once
    /// instead of waking the pool anew.
    pub(crate) fn enter<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self {
            Self::Serial => work(),
            Self::Pool(pool) => pool.install(work),
        }
    }

    /// Runs `work` for every item, each with one worker's scratch.
    pub(crate) fn for_each<T: Send, C: Send>(
        &self,
        items: &mut [T],
        scratch: &[Mutex<C>],
        work: impl Fn(&mut T, &mut C) + Sync,
    ) {
        use rayon::prelude::*;
        match self {
            Self::Serial => {
                let mut mine = lock(&scratch[0]);
                items.iter_mut().for_each(|item| work(item, &mut mine));
            }
            Self::Pool(pool) => pool.install(|| {
                items.par_iter_mut().with_max_len(1).for_each(|item| {
                    // A worker's index is below the number of threads, hence of scratches.
                    let worker = rayon::current_thread_index().unwrap_or(0);
                    work(item, &mut lock(&scratch[worker]));
                });
            }),
        }
    }
}

/// Locks scratch. A worker's scratch is only ever locked by that worker, so this never waits, and its
/// contents mean nothing between items, so a panic in one does not spoil it.
fn lock<C>(scratch: &Mutex<C>) -> std::sync::MutexGuard<'_, C> {
    scratch.lock().unwrap_or_else(PoisonError::into_inner)
}
