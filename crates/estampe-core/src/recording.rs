//! What each job of a frame took, for those who measure.
//!
//! A context made by [`Context::recording`](crate::Context::recording) draws on the calling thread alone, and
//! hands the same items out in the same order one by one, with a look at the clock between them. Other
//! contexts have no recorder, which costs them a branch for each list of items.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// One list of independent jobs: vertices, chunks of primitives, tiles, …
#[derive(Debug, Clone)]
pub struct Phase {
    /// The Rust type of the jobs, for people to read.
    pub job_type: &'static str,
    /// When the first job began. What lies between the end of a phase and the beginning of the next one is
    /// done by the calling thread alone, however many there are.
    pub start: Instant,
    /// What each job took, in the order in which workers take them.
    pub jobs: Vec<Duration>,
}

/// Keeps what was noted until someone asks.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    phases: Mutex<Vec<Phase>>,
}

impl Recorder {
    /// Runs `work` with what gives it `items`, one at a time.
    pub(crate) fn hand_out<'i, T>(
        &self,
        items: &'i mut [T],
        work: impl FnOnce(&mut dyn FnMut() -> Option<&'i mut [T]>),
    ) {
        let mut left = items.chunks_mut(1);
        let mut times = Vec::with_capacity(left.len() + 1);
        work(&mut || {
            times.push(Instant::now());
            left.next()
        });
        let Some(&start) = times.first() else {
            return;
        };
        let jobs = times.windows(2).map(|ends| ends[1] - ends[0]);
        let phase = Phase {
            job_type: std::any::type_name::<T>(),
            start,
            jobs: jobs.collect(),
        };
        self.lock().push(phase);
    }

    /// What was noted since the last call.
    pub(crate) fn take(&self) -> Vec<Phase> {
        std::mem::take(&mut *self.lock())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Phase>> {
        self.phases.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schedule::Executor;

    #[test]
    fn each_item_is_worked_on_once_and_timed() {
        let executor = Executor::recording();
        let mut items = [3_u64, 1, 2];
        let sleep = |item: &mut u64| {
            std::thread::sleep(Duration::from_millis(*item));
            *item += 10;
        };
        executor.for_each_alone(&mut items, sleep);
        executor.for_each_alone(&mut [0_u8; 0], |_| {});
        assert_eq!(items, [13, 11, 12]);
        let phases = executor.take_phases();
        assert_eq!(phases[0].job_type, "u64");
        assert_eq!(phases[0].jobs.len(), 3);
        for (time, item) in phases[0].jobs.iter().zip(items) {
            assert!(*time >= Duration::from_millis(item - 10));
        }
        assert!(phases[1].jobs.is_empty() && phases[1].start >= phases[0].start);
        assert!(executor.take_phases().is_empty());
    }
}
