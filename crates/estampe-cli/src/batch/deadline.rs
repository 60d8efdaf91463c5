//! A job with a deadline: it runs on a thread of its own, which is left behind if it is late.
//!
//! Readers and shaders cannot be stopped from outside, so a thread that is late goes on, but what
//! it draws is not written: the claim is taken either by the writer or by the deadline.

use super::job::Done;
use super::plan::Job;
use crate::limits::timeout_message;
use crate::values::shown;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Who may go on: the job, while it is not given up.
#[derive(Debug, Default)]
pub(super) struct Claim(AtomicU8);

const RUNNING: u8 = 0;
const WRITING: u8 = 1;
const GIVEN_UP: u8 = 2;

impl Claim {
    /// False if the job was given up.
    pub(super) fn begin_writing(&self) -> bool {
        self.change(RUNNING, WRITING)
    }

    pub(super) fn end_writing(&self) {
        self.0.store(RUNNING, Ordering::Release);
    }

    /// False while a picture is written.
    fn give_up(&self) -> bool {
        self.change(RUNNING, GIVEN_UP)
    }

    fn change(&self, from: u8, to: u8) -> bool {
        let (success, failure) = (Ordering::AcqRel, Ordering::Acquire);
        self.0.compare_exchange(from, to, success, failure).is_ok()
    }
}

/// Runs a job; the error is the message of a job that was given up.
pub(super) fn run(
    job: &Job,
    timeout: Duration,
    work: impl FnOnce(&Claim) -> Done + Send + 'static,
) -> Result<Done, String> {
    let claim = Arc::new(Claim::default());
    let (sender, receiver) = channel();
    let theirs = claim.clone();
    let end = Instant::now() + timeout;
    let thread = std::thread::Builder::new().spawn(move || {
        // If the job was given up, nobody receives.
        let _ = sender.send(work(&theirs));
    });
    let name = shown(&job.input.path);
    if let Err(error) = thread {
        return Err(format!(
            "{name}: no thread: {error}; choose fewer --parallel"
        ));
    }
    let mut wait = end.saturating_duration_since(Instant::now());
    loop {
        match receiver.recv_timeout(wait) {
            Ok(done) => return Ok(done),
            Err(RecvTimeoutError::Timeout) if !claim.give_up() => {
                wait = Duration::from_millis(5);
            }
            Err(_) => return Err(timeout_message(&name, timeout)),
        }
    }
}
