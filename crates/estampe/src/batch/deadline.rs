//! A job with a deadline: it runs on a thread of its own, which is left behind if it is late.
//!
//! Readers and shaders cannot be stopped from outside, so a thread that is late goes on, but what
//! it draws is not written: the claim is taken either by the writer or by the deadline, and no
//! writer takes it after the deadline, however late the thread that waits is woken.

use crate::limits::timeout_message;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Who may go on: the job, while it is not given up.
#[derive(Debug, Default)]
pub(crate) struct Claim {
    state: AtomicU8,
    /// Without it the job may take any time.
    end: Option<Instant>,
}

const RUNNING: u8 = 0;
const WRITING: u8 = 1;
const GIVEN_UP: u8 = 2;

impl Claim {
    /// False if the job was given up, or is late.
    pub(crate) fn begin_writing(&self) -> bool {
        if self.end.is_some_and(|end| Instant::now() >= end) {
            self.give_up();
        }
        self.change(RUNNING, WRITING)
    }

    pub(crate) fn end_writing(&self) {
        self.state.store(RUNNING, Ordering::Release);
    }

    fn is_given_up(&self) -> bool {
        self.state.load(Ordering::Acquire) == GIVEN_UP
    }

    /// False while a picture is written.
    fn give_up(&self) -> bool {
        self.change(RUNNING, GIVEN_UP)
    }

    fn change(&self, from: u8, to: u8) -> bool {
        let (success, failure) = (Ordering::AcqRel, Ordering::Acquire);
        let changed = self.state.compare_exchange(from, to, success, failure);
        changed.is_ok()
    }
}

/// Runs the work on the model of this name; the error is the message of work that was given up.
pub(crate) fn run<T: Send + 'static>(
    name: &str,
    timeout: Duration,
    work: impl FnOnce(&Claim) -> T + Send + 'static,
) -> Result<T, String> {
    let end = Instant::now().checked_add(timeout);
    let claim = Arc::new(Claim {
        state: AtomicU8::new(RUNNING),
        end,
    });
    let (sender, receiver) = channel();
    let theirs = claim.clone();
    let thread = std::thread::Builder::new().spawn(move || {
        // If the job was given up, nobody receives.
        let _ = sender.send(work(&theirs));
    });
    if let Err(error) = thread {
        return Err(format!(
            "{name}: no thread: {error}; choose fewer --parallel"
        ));
    }
    let mut wait = end.map_or(timeout, |end| end.saturating_duration_since(Instant::now()));
    loop {
        match receiver.recv_timeout(wait) {
            Ok(done) if !claim.is_given_up() => return Ok(done),
            Err(RecvTimeoutError::Timeout) if !claim.give_up() => {
                wait = Duration::from_millis(5);
            }
            _ => return Err(timeout_message(name, timeout)),
        }
    }
}
