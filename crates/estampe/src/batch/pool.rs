//! Threads that do jobs, each with a device of its own.

use super::job::{Outcome, Shared, Status};
use super::plan::Job;
use crate::failure::Failure;
use crate::render;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Does all jobs, and returns their outcomes in the order of the jobs. `on_done` is called as each
/// ends.
pub(super) fn outcomes(
    shared: &Shared,
    jobs: &[Job],
    on_done: impl Fn(&[Outcome]) + Sync,
) -> Result<Vec<Outcome>, Failure> {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    let chosen = shared.args.parallel.map_or_else(available, usize::from);
    let workers = chosen.min(jobs.len()).max(1);
    // Where models are drawn side by side, each has one thread, unless the options say otherwise.
    let mut picture = shared.args.picture.clone();
    if workers > 1 && picture.threads.is_none() {
        picture.threads = Some(1);
    }
    let mut devices = Vec::with_capacity(workers);
    for _ in 0..workers {
        devices.push(Arc::new(render::device(&picture)?));
    }
    let next = AtomicUsize::new(0);
    let has_failed = AtomicBool::new(false);
    let done: Vec<Mutex<Vec<Outcome>>> = jobs.iter().map(|_| Mutex::default()).collect();
    let work = |device: &Arc<estampe::Device>| {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let (Some(job), Some(slot)) = (jobs.get(index), done.get(index)) else {
                return;
            };
            let outcomes = if shared.args.fail_fast && has_failed.load(Ordering::Relaxed) {
                cancelled(job)
            } else {
                shared.outcomes(job, device)
            };
            let is_failure =
                |outcome: &Outcome| matches!(outcome.status, Status::Failed(_) | Status::Limit(_));
            if outcomes.iter().any(is_failure) {
                has_failed.store(true, Ordering::Relaxed);
            }
            on_done(&outcomes);
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = outcomes;
        }
    };
    std::thread::scope(|scope| {
        let (own, others) = devices.split_first().expect("at least one worker");
        for device in others {
            // If the system refuses a thread, the others do the work.
            let _ = std::thread::Builder::new().spawn_scoped(scope, || work(device));
        }
        work(own);
    });
    let done = done.into_iter();
    Ok(done
        .flat_map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner))
        .collect())
}

fn cancelled(job: &Job) -> Vec<Outcome> {
    let pictures = job.pictures.iter().cloned();
    pictures
        .map(|picture| Outcome {
            input: crate::values::shown(&job.input.path),
            picture,
            status: Status::Cancelled,
            time: Duration::ZERO,
            warnings: Vec::new(),
        })
        .collect()
}
