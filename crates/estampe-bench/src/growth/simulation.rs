//! Simulated speed-up by more cores: the scheduler of `estampe-core`, run with the measured costs
//! of its jobs.
//!
//! A frame is a sequence of phases (vertices, chunks of primitives, tiles), each a list of
//! independent jobs, with serial parts between them. In a phase the caller and the helpers that it
//! has woken wake the others, as a tree, and begin. Each free worker takes a batch of jobs from the
//! front of the remaining list, as in the scheduler. The phase ends when the last worker is done.
//! Jobs cost the same as on one core: contention for memory is not modelled.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The least number of batches per worker, if there are enough jobs: the scheduler's own constant.
const TURNS: usize = 4;

/// The cost of waking a helper, in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WakeUp {
    /// The time of a worker for each helper that it wakes.
    pub call_ns: u64,
    /// From the call to the helper's first instruction.
    pub arrival_ns: u64,
}

/// The time of a list of jobs on `workers`, in nanoseconds.
#[must_use]
pub fn makespan_ns(jobs_ns: &[u64], workers: usize, wake_up: WakeUp) -> u64 {
    let workers = workers.min(jobs_ns.len());
    if workers <= 1 {
        return jobs_ns.iter().sum();
    }
    // When each worker is free: once it has arrived and called its part of the others.
    let mut free = BinaryHeap::new();
    let caller = call_helpers(0, workers - 1, wake_up, &mut free);
    free.push(Reverse(caller));
    let mut left = jobs_ns;
    while !left.is_empty() {
        let Some(Reverse(now)) = free.pop() else {
            break;
        };
        let (batch, others) = left.split_at(left.len().div_ceil(workers * TURNS));
        left = others;
        free.push(Reverse(now + batch.iter().sum::<u64>()));
    }
    // The scheduler waits for every helper, even if no jobs remain for it.
    free.into_iter().map(|Reverse(end)| end).max().unwrap_or(0)
}

/// Lets a worker call so many helpers, as the scheduler does: one of them calls half of the others
/// and so on. Returns when the worker is free; those times of the helpers go to `free`.
fn call_helpers(
    start_ns: u64,
    helpers: usize,
    wake_up: WakeUp,
    free: &mut BinaryHeap<Reverse<u64>>,
) -> u64 {
    let (mut now, mut left) = (start_ns, helpers);
    while left > 0 {
        now += wake_up.call_ns;
        let others = left - left / 2 - 1;
        let helper = call_helpers(now + wake_up.arrival_ns, others, wake_up, free);
        free.push(Reverse(helper));
        left /= 2;
    }
    now
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
        // With more workers than jobs, the others have nothing to do.
        assert_eq!(makespan_ns(&jobs, 1000, FREE), 10);
        assert_eq!(makespan_ns(&[], 8, FREE), 0);
    }

    #[test]
    fn no_schedule_ends_before_its_largest_job() {
        // Greedy: 3 and 3, then 2 begins at 3 on either worker.
        assert_eq!(makespan_ns(&[3, 3, 2], 2, FREE), 5);
        assert_eq!(makespan_ns(&[1, 1, 1, 100], 4, FREE), 100);
        // A large job at the end delays the result: 2 workers, 1+1+1+1 each, then 100.
        assert_eq!(makespan_ns(&[1, 1, 1, 1, 1, 1, 1, 1, 100], 2, FREE), 104);
    }

    #[test]
    fn batches_are_an_eighth_of_what_is_left_for_two() {
        // 16 jobs, 2 workers: the first batch is two jobs, so the worker that has the slow one of
        // them also does the other.
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
        // The caller begins at 2 and has done both jobs before its helper arrives at 32; it waits
        // for the helper.
        assert_eq!(makespan_ns(&[10, 10], 2, wake_up), 32);
        // Long jobs: the helper's begins at 32.
        assert_eq!(makespan_ns(&[1000, 1000], 2, wake_up), 1032);
        // One job needs no help.
        assert_eq!(makespan_ns(&[10], 2, wake_up), 10);
    }

    #[test]
    fn helpers_are_called_as_a_tree() {
        let wake_up = WakeUp {
            call_ns: 2,
            arrival_ns: 30,
        };
        let mut free = BinaryHeap::new();
        // The caller calls one that calls another, at 2 and 34, and then a third.
        assert_eq!(call_helpers(0, 3, wake_up, &mut free), 4);
        let times: Vec<u64> = free
            .into_sorted_vec()
            .into_iter()
            .map(|one| one.0)
            .collect();
        assert_eq!(times, [64, 34, 34]);
        // Of 63 helpers each calls at most six, and the last is called in six steps.
        let mut free = BinaryHeap::new();
        assert_eq!(call_helpers(0, 63, wake_up, &mut free), 12);
        let last = free.into_iter().map(|one| one.0).max().unwrap();
        assert_eq!((free_len(63), last), (63, 6 * 32));
    }

    fn free_len(helpers: usize) -> usize {
        let mut free = BinaryHeap::new();
        call_helpers(0, helpers, WakeUp::default(), &mut free);
        free.len()
    }
}
