//! Random watertightness test: triangles that share edges cover each sample exactly once, through
//! the public API.
//!
//! A batch is several [meshes](crate::shared_edges) over one target, each of which covers every
//! pixel once. Additive blending adds one code per hit, so each sample must end with a code equal
//! to the number of meshes.

mod batch;
mod worker;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};
use worker::Fuzzer;

/// The number of batches and triangles drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Batches drawn.
    pub batches: u64,
    /// Triangles in them.
    pub primitives: u64,
}

/// Draws batches until the time is up, at least one; the first has seed `first_seed`, and each
/// further one the next seed. All processors work.
///
/// # Errors
/// A sample that was not hit once, with the seed of its batch and the mesh.
pub fn run(time: Duration, first_seed: u64) -> Result<Tally, String> {
    let start = Instant::now();
    let next = AtomicU64::new(0);
    let has_failed = AtomicBool::new(false);
    let work = || {
        let mut tally = Tally::default();
        let mut fuzzer = Fuzzer::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number > 0 && (start.elapsed() >= time || has_failed.load(Ordering::Relaxed)) {
                return Ok(tally);
            }
            match fuzzer.batch(first_seed.wrapping_add(number)) {
                Ok(primitives) => tally.primitives += primitives,
                Err(failure) => {
                    has_failed.store(true, Ordering::Relaxed);
                    return Err(failure);
                }
            }
            tally.batches += 1;
        }
    };
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        let mut sum = Tally::default();
        for handle in handles {
            let tally = match handle.join() {
                Ok(tally) => tally?,
                Err(panic) => std::panic::resume_unwind(panic),
            };
            sum.batches += tally.batches;
            sum.primitives += tally.primitives;
        }
        Ok(sum)
    })
}
