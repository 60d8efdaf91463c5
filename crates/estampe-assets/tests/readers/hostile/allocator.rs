//! An allocator that counts the bytes of each thread, so that a test can state the most that a call
//! held at one time, while other tests run beside it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    /// Bytes that this thread allocated and did not free; below zero if it frees those of others.
    static HELD: Cell<isize> = const { Cell::new(0) };
    /// The maximum of [`HELD`] since the measurement began.
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

/// A thread that ends has no counters any more, and its last blocks are not counted.
fn count(change: isize) {
    let counted = HELD.try_with(|held| {
        held.set(held.get() + change);
        held.get()
    });
    if let Ok(held) = counted {
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(held)));
    }
}

fn size(layout: Layout) -> isize {
    isize::try_from(layout.size()).unwrap_or(isize::MAX)
}

// SAFETY: every call is passed on to the system's allocator unchanged. The counters start as
// constants and have no destructor, so that to reach them allocates nothing.
#[expect(unsafe_code, reason = "a global allocator is an unsafe trait")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(size(layout));
        // SAFETY: the caller guarantees the system allocator's conditions.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(size(layout));
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-size(layout));
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        // The block is there twice while it moves.
        count(isize::try_from(new_size).unwrap_or(isize::MAX));
        count(-size(layout));
        // SAFETY: as above.
        unsafe { System.realloc(memory, layout, new_size) }
    }
}

/// Calls a function; returns its result with the bytes that this thread held at most meanwhile.
pub(crate) fn peak_bytes<R>(run: impl FnOnce() -> R) -> (R, usize) {
    let before = HELD.get();
    PEAK.set(before);
    let result = run();
    let most = PEAK.get() - before;
    (result, usize::try_from(most).unwrap_or(0))
}
