//! What more cores would give: the scheduler of `estampe-core`, played with measured costs of its jobs.
//!
//! A frame is a sequence of phases (vertices, chunks of primitives, tiles), each a list of independent jobs, with
//! serial parts between them. In a phase the caller wakes its helpers and begins; each worker that is free takes
//! jobs from the front of what is left, a batch at a time, as the scheduler hands them out; the phase is over
//! when the last worker is. Jobs cost what they cost on one core: no memory is slower for being shared.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How many times each worker takes jobs at least, where there are enough: the scheduler's own number.
const TURNS: usize = 4;

/// What it takes to get help, in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WakeUp {
    /// The caller's time for each helper that it wakes.
    pub call_ns: u64,
    /// From the call to the helper's first instruction.
    pub arrival_ns: u64,
}

/// How long a list of jobs takes `workers`, in nanoseconds.
#[must_use]
pub fn makespan_ns(jobs_ns: &[u64], workers: usize, wake_up: WakeUp) -> u64 {
    let workers = workers.min(jobs_ns.len());
    if workers <= 1 {
        return jobs_ns.iter().sum();
    }
    let helpers = workers as u64 - 1;
    // When each worker is free: the helpers as they arrive, the caller once it has called them all.
    let arrivals = (1..=helpers).map(|helper| helper * wake_up.call_ns + wake_up.arrival_ns);
    let caller = std::iter::once(helpers * wake_up.call_ns);
    let mut free: BinaryHeap<Reverse<u64>> = caller.chain(arrivals).map(Reverse).collect();
    let mut left = jobs_ns;
    while !left.is_empty() {
        let Some(Reverse(now)) = free.pop() else {
            break;
        };
        let (batch, others) = left.split_at(left.len().div_ceil(workers * TURNS));
        left = others;
        free.push(Reverse(now + batch.iter().sum::<u64>()));
    }
    // The scheduler waits for every helper, also for those that find nothing left.
    free.into_iter().map(|Reverse(end)| end).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: WakeUp = WakeUp {
        call_ns: 0,
        arrival_ns: 0,
    };

    #[test]
    fn equal_jobs_are_shared_equally() {
        let jobs = [10; 64];
        for workers in [1, 2, 4, 16, 64] {
            assert_eq!(makespan_ns(&jobs, workers, FREE), 640 / workers as u64);
        }
        // Beyond one job each, more workers have nothing to do.
        assert_eq!(makespan_ns(&jobs, 1000, FREE), 10);
        assert_eq!(makespan_ns(&[], 8, FREE), 0);
    }

    #[test]
    fn no_schedule_ends_before_its_largest_job() {
        // Greedy: 3 and 3, then 2 begins at 3 beside the other that is free at 3.
        assert_eq!(makespan_ns(&[3, 3, 2], 2, FREE), 5);
        assert_eq!(makespan_ns(&[1, 1, 1, 100], 4, FREE), 100);
        // A large job at the end is waited for: 2 workers, 1+1+1+1 each, then 100.
        assert_eq!(makespan_ns(&[1, 1, 1, 1, 1, 1, 1, 1, 100], 2, FREE), 104);
    }

    #[test]
    fn batches_are_an_eighth_of_what_is_left_for_two() {
        // 16 jobs, 2 workers: the first batch is two jobs, and the worker that has the slow one of them keeps
        // the other.
        let mut jobs = [0; 16];
        jobs[0] = 50;
        jobs[1] = 50;
        assert_eq!(makespan_ns(&jobs, 2, FREE), 100);
        assert_eq!(makespan_ns(&jobs[..8], 2, FREE), 50);
    }

    #[test]
    fn wake_ups_are_paid_by_caller_and_helpers() {
        let wake_up = WakeUp {
            call_ns: 2,
            arrival_ns: 30,
        };
        // The caller begins at 2, and has done both before its helper arrives at 32, which it waits for.
        assert_eq!(makespan_ns(&[10, 10], 2, wake_up), 32);
        // Long jobs: the helper's begins at 32.
        assert_eq!(makespan_ns(&[1000, 1000], 2, wake_up), 1032);
        // One job needs no help.
        assert_eq!(makespan_ns(&[10], 2, wake_up), 10);
    }
}
