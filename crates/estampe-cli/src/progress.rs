//! A progress bar, on a terminal, for what takes over a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Nothing is shown before this.
const PATIENCE: Duration = Duration::from_secs(1);

/// Shows which stage of a job runs. Dropping it removes the bar.
#[derive(Debug)]
pub(crate) struct Progress {
    watcher: Option<(Sender<&'static str>, JoinHandle<()>)>,
}

impl Progress {
    /// Watches a job of so many stages; silent where standard error is no terminal.
    pub(crate) fn new(stages: u64, is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let watcher = is_shown.then(|| {
            let (sender, receiver) = channel();
            (sender, std::thread::spawn(move || watch(&receiver, stages)))
        });
        Self { watcher }
    }

    /// The next stage begins.
    pub(crate) fn stage(&self, name: &'static str) {
        if let Some((sender, _)) = &self.watcher {
            // A watcher that has ended has nothing to show.
            let _ = sender.send(name);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.watcher.take() {
            drop(sender);
            // It has no result, and a panic in it was printed already.
            let _ = thread.join();
        }
    }
}

/// Counts the stages; shows a bar once patience has run out, until the sender is gone.
fn watch(stages: &Receiver<&'static str>, count: u64) {
    let start = Instant::now();
    let mut bar: Option<ProgressBar> = None;
    let (mut begun, mut current) = (0_u64, "starting");
    loop {
        let patience = match bar {
            None => PATIENCE.saturating_sub(start.elapsed()),
            Some(_) => Duration::from_millis(100),
        };
        match stages.recv_timeout(patience) {
            Ok(name) => {
                begun += 1;
                current = name;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if start.elapsed() >= PATIENCE {
            let bar = bar.get_or_insert_with(|| new_bar(count));
            bar.set_position(begun.saturating_sub(1));
            bar.set_message(current);
            bar.tick();
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
}

fn new_bar(count: u64) -> ProgressBar {
    let bar = ProgressBar::new(count);
    if let Ok(style) = ProgressStyle::with_template("{spinner} [{bar:24}] {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar
}
