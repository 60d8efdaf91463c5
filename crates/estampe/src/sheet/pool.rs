//! Threads that draw models, each with a device of its own.

use super::job::{Done, Shared};
use crate::failure::Failure;
use crate::render;
use crate::values::Source;
use estampe::Device;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Draws all models, and returns what became of them in their order. `on_done` is called as each
/// ends.
pub(super) fn draw(
    shared: &Shared,
    models: &[Source],
    on_done: impl Fn(&Source, &Done) + Sync,
) -> Result<Vec<Done>, Failure> {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    let chosen = shared.args.parallel.map_or_else(available, usize::from);
    let workers = chosen.min(models.len()).max(1);
    // Where models are drawn side by side, each has one thread, unless the options say otherwise.
    let mut picture = shared.args.picture.clone();
    if workers > 1 && picture.threads.is_none() {
        picture.threads = Some(1);
    }
    let devices = (0..workers).map(|_| render::device(&picture).map(Arc::new));
    let devices: Vec<Arc<Device>> = devices.collect::<Result<_, _>>()?;
    let next = AtomicUsize::new(0);
    let done: Vec<Mutex<Option<Done>>> = models.iter().map(|_| Mutex::default()).collect();
    let work = |device: &Arc<Device>| {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let (Some(model), Some(slot)) = (models.get(at), done.get(at)) else {
                return;
            };
            let one = shared.draw(model, at * shared.views.count(), device);
            on_done(model, &one);
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(one);
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
    let done = done.map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner));
    Ok(done
        .map(|one| one.expect("every model was drawn"))
        .collect())
}
