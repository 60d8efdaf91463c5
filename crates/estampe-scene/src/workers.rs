//! Threads for work on a scene's data: reading, normals, vertex buffers.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// The number of threads that may work at once.
///
/// Work is divided by its size alone, and results are in the order of the pieces, so that no result
/// depends on the number of threads. Threads live as long as one call. A piece should take some
/// hundred microseconds; starting a thread takes thirty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Workers {
    count: usize,
}

impl Default for Workers {
    /// One thread for each processor.
    fn default() -> Self {
        Self::new(0)
    }
}

impl Workers {
    /// The calling thread alone.
    pub const ONE: Self = Self { count: 1 };

    /// `count` threads, the calling thread included; 0 for one per processor.
    #[must_use]
    pub fn new(count: usize) -> Self {
        let available = || std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            count: if count == 0 { available() } else { count },
        }
    }

    /// The maximum number of threads, the calling thread included.
    #[must_use]
    pub fn count(self) -> usize {
        self.count
    }

    /// Calls `work` on each item, and returns the results in the order of the items.
    pub fn map<T: Send, R: Send>(
        self,
        items: impl IntoIterator<Item = T>,
        work: impl Fn(T) -> R + Sync,
    ) -> Vec<R> {
        let items: Vec<T> = items.into_iter().collect();
        let helpers = self.count.min(items.len()).saturating_sub(1);
        if helpers == 0 {
            return items.into_iter().map(work).collect();
        }
        let mut results: Vec<Option<R>> = items.iter().map(|_| None).collect();
        // Each thread takes the next item when it has finished one.
        let queue = Mutex::new(items.into_iter().zip(&mut results));
        let run = || {
            loop {
                let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((item, result)) = next else { break };
                *result = Some(work(item));
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..helpers {
                // If the system refuses a thread, the existing threads do the work.
                let _ = std::thread::Builder::new().spawn_scoped(scope, run);
            }
            run();
        });
        drop(queue);
        results.into_iter().flatten().collect()
    }

    /// Calls both functions, on two threads if there are two.
    pub fn join<A: Send, B: Send>(
        self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.count < 2 {
            return (first(), second());
        }
        let second = Mutex::new(Some(second));
        let take = || {
            let work = second.lock().unwrap_or_else(PoisonError::into_inner).take();
            work.map(|work| work())
        };
        std::thread::scope(|scope| {
            let helper = std::thread::Builder::new().spawn_scoped(scope, take);
            let a = first();
            let b = match helper.map(std::thread::ScopedJoinHandle::join) {
                Ok(Ok(b)) => b,
                Ok(Err(panic)) => std::panic::resume_unwind(panic),
                Err(_) => take(),
            };
            (a, b.expect("a thread has done the work"))
        })
    }
}

/// Ranges of length `size` that cover `0..len`; the last one may be shorter.
pub fn pieces(len: usize, size: usize) -> impl Iterator<Item = Range<usize>> {
    (0..len)
        .step_by(size.max(1))
        .map(move |start| start..len.min(start.saturating_add(size.max(1))))
}

#[cfg(test)]
mod tests {
    use super::{Workers, pieces};

    #[test]
    fn results_are_in_the_order_of_the_items_for_any_number_of_threads() {
        let expected: Vec<usize> = (0..100).map(|item| item * item).collect();
        for threads in [1, 2, 7] {
            let squares = Workers::new(threads).map(0..100, |item: usize| item * item);
            assert_eq!(squares, expected, "{threads} threads");
        }
        assert_eq!(Workers::new(3).map(0..0, |item: usize| item), []);
    }

    #[test]
    fn items_may_be_parts_of_a_slice() {
        let mut numbers = vec![0_usize; 1000];
        let parts = pieces(1000, 64).zip(numbers.chunks_mut(64));
        Workers::new(3).map(parts, |(range, part)| {
            for (number, slot) in range.zip(part) {
                *slot = number;
            }
        });
        assert!(numbers.iter().copied().eq(0..1000));
    }

    #[test]
    fn both_sides_of_a_join_are_done() {
        for threads in [1, 2] {
            assert_eq!(Workers::new(threads).join(|| 1, || "two"), (1, "two"));
        }
    }

    #[test]
    fn pieces_cover_everything_once() {
        for (len, size) in [(0, 4), (1, 4), (8, 4), (9, 4), (3, 0)] {
            assert!(pieces(len, size).flatten().eq(0..len), "{len} by {size}");
        }
    }
}
