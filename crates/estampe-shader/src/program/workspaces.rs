//! The memory of the runs of a stage: a place for each thread.
//!
//! A run writes to most of its memory, so what another thread used last would be in another core's
//! cache: with one list for all threads, a batch of packets took a microsecond more on two cores.

use estampe_x86::Scratch;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, TryLockError};

static THREADS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// The number of this thread among those that have run shaders.
    static THREAD: usize = THREADS.fetch_add(1, Ordering::Relaxed);
}

/// The places of a stage's threads.
#[derive(Debug, Default)]
pub(super) struct Workspaces {
    /// Two for each core, as there may be threads that are no longer.
    places: OnceLock<Box<[Place]>>,
}

/// Two cache lines at least, which processors fetch together: of no other thread.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Place(Mutex<Scratch>);

impl Workspaces {
    /// Runs something with the memory of this thread; with new memory if all is in use.
    pub(super) fn with<T>(&self, run: impl FnOnce(&mut Scratch) -> T) -> T {
        let places = self.places.get_or_init(|| {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            std::iter::repeat_with(Place::default)
                .take(2 * cores)
                .collect()
        });
        let first = THREAD.with(|number| number % places.len());
        let (before, after) = places.split_at(first);
        for place in after.iter().chain(before) {
            match place.0.try_lock() {
                Ok(mut scratch) => return run(&mut scratch),
                Err(TryLockError::Poisoned(error)) => return run(&mut error.into_inner()),
                Err(TryLockError::WouldBlock) => {}
            }
        }
        run(&mut Scratch::default())
    }
}
