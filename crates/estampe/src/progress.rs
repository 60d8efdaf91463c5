//! A progress bar, on a terminal, for jobs that take over a second.

use estampe_renderer::FrameStage;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Delay before the bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// What the bar is told.
#[derive(Debug)]
enum Message {
    /// The next stage begins.
    Stage(&'static str),
    /// What the current stage does.
    Part(String),
}

/// Shows the current stage of a job. Dropping it removes the bar.
#[derive(Debug)]
pub(crate) struct Progress {
    watcher: Option<(Sender<Message>, JoinHandle<()>)>,
}

impl Progress {
    /// Progress of a job with this number of stages; silent if standard error is no terminal.
    pub(crate) fn new(stages: u64, is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let watcher = is_shown.then(|| {
            let (sender, receiver) = channel();
            (sender, std::thread::spawn(move || watch(&receiver, stages)))
        });
        Self { watcher }
    }

    /// Starts the next stage.
    pub(crate) fn stage(&self, name: &'static str) {
        if let Some((sender, _)) = &self.watcher {
            // If the thread has ended, there is no bar to update.
            let _ = sender.send(Message::Stage(name));
        }
    }

    /// Shows a part of drawing in place of the stage's name.
    pub(crate) fn frame(&self, stage: FrameStage) {
        if let Some((sender, _)) = &self.watcher {
            // If the thread has ended, there is no bar to update.
            let _ = sender.send(Message::Part(text_of(stage)));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.watcher.take() {
            drop(sender);
            // The thread has no result, and its panic was printed already.
            let _ = thread.join();
        }
    }
}

/// A stage of a frame in words.
fn text_of(stage: FrameStage) -> String {
    match stage {
        FrameStage::Preparing => "drawing: vertices and textures".to_owned(),
        FrameStage::Shadows => "drawing: shadows".to_owned(),
        FrameStage::Drawing { begun, all } if all > 1 => {
            format!("drawing: {begun} of {all} parts")
        }
        FrameStage::ReadingBack => "drawing: pixels".to_owned(),
        _ => "drawing".to_owned(),
    }
}

/// Counts the stages and shows a bar after the delay, until the sender is dropped.
fn watch(stages: &Receiver<Message>, count: u64) {
    let start = Instant::now();
    let mut bar: Option<ProgressBar> = None;
    let (mut begun, mut current) = (0_u64, "starting".to_owned());
    loop {
        let patience = match bar {
            None => PATIENCE.saturating_sub(start.elapsed()),
            Some(_) => Duration::from_millis(100),
        };
        match stages.recv_timeout(patience) {
            Ok(Message::Stage(name)) => {
                begun += 1;
                name.clone_into(&mut current);
            }
            Ok(Message::Part(text)) => current = text,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if start.elapsed() >= PATIENCE {
            let bar = bar.get_or_insert_with(|| new_bar(count));
            bar.set_position(begun.saturating_sub(1));
            bar.set_message(current.clone());
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

#[cfg(test)]
mod tests {
    use super::text_of;
    use estampe_renderer::FrameStage;

    #[test]
    fn parts_are_counted_if_there_are_several() {
        let of = |begun, all| text_of(FrameStage::Drawing { begun, all });
        assert_eq!(of(3, 120), "drawing: 3 of 120 parts");
        assert_eq!(of(1, 1), "drawing");
    }
}
