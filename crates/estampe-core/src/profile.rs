//! Profiling: what each job of a frame took.
//!
//! A context made by [`Context::profiling`](crate::Context::profiling) draws on the calling thread
//! alone. It hands the same jobs out in the same order one by one, and reads the clock between
//! them. Other contexts have no profiler, which costs them a branch for each list of jobs.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The times of one list of independent jobs: vertices, chunks of primitives, tiles, …
#[derive(Debug, Clone)]
pub struct JobTimings {
    /// The Rust type of the jobs, for people to read.
    pub job_type: &'static str,
    /// When the first job began. The work between the end of one list of jobs and the beginning of
    /// the next one is done by the calling thread alone, however many threads there are.
    pub start: Instant,
    /// The duration of each job, in the order in which workers take them.
    pub jobs: Vec<Duration>,
}

/// Keeps timings until they are taken.
#[derive(Debug, Default)]
pub(crate) struct Profiler {
    timings: Mutex<Vec<JobTimings>>,
}

impl Profiler {
    /// Runs `work` with what gives it jobs of a type, one at a time; `count` is how many there are.
    pub(crate) fn hand_out<J>(
        &self,
        (job_type, count): (&'static str, usize),
        mut next: impl FnMut() -> Option<J>,
        work: impl FnOnce(&mut dyn FnMut() -> Option<J>),
    ) {
        let mut times = Vec::with_capacity(count + 1);
        work(&mut || {
            times.push(Instant::now());
            next()
        });
        let Some(&start) = times.first() else {
            return;
        };
        let times = times.windows(2).map(|ends| ends[1] - ends[0]);
        let timings = JobTimings {
            job_type,
            start,
            jobs: times.collect(),
        };
        self.lock().push(timings);
    }

    /// The timings since the last call.
    pub(crate) fn take(&self) -> Vec<JobTimings> {
        std::mem::take(&mut *self.lock())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<JobTimings>> {
        self.timings.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schedule::Executor;

    #[test]
    fn each_item_is_worked_on_once_and_timed() {
        let executor = Executor::profiling(1);
        let mut items = [3_u64, 1, 2];
        let sleep = |item: &mut u64| {
            std::thread::sleep(Duration::from_millis(*item));
            *item += 10;
        };
        executor.for_each_alone(&mut items, sleep);
        executor.for_each_alone(&mut [0_u8; 0], |_| {});
        assert_eq!(items, [13, 11, 12]);
        let timings = executor.take_timings();
        assert_eq!(timings[0].job_type, "u64");
        assert_eq!(timings[0].jobs.len(), 3);
        for (time, item) in timings[0].jobs.iter().zip(items) {
            assert!(*time >= Duration::from_millis(item - 10));
        }
        assert!(timings[1].jobs.is_empty() && timings[1].start >= timings[0].start);
        assert!(executor.take_timings().is_empty());
    }
}
