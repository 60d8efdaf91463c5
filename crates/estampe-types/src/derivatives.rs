//! A note that derivatives were taken on this thread, for an assertion of debug builds.

use std::cell::Cell;

thread_local! {
    static TAKEN: Cell<bool> = const { Cell::new(false) };
}

/// Notes that derivatives are taken.
#[inline(always)]
pub(crate) fn note() {
    if cfg!(debug_assertions) {
        TAKEN.set(true);
    }
}

/// Returns true if derivatives were taken since the last call.
#[inline(always)]
pub(crate) fn were_taken() -> bool {
    cfg!(debug_assertions) && TAKEN.replace(false)
}
