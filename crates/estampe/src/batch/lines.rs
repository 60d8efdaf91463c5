//! How far a command with many pictures is: a bar on a terminal, else a line for each picture.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Shows which pictures are done, from any thread.
pub(crate) struct Lines {
    bar: Option<ProgressBar>,
    is_quiet: bool,
    count: usize,
    done: AtomicUsize,
}

impl Lines {
    /// For this number of pictures. If quiet, problems alone are shown.
    pub(crate) fn new(count: usize, is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let bar = is_shown.then(|| {
            let bar = ProgressBar::new(count as u64);
            let form = "{spinner} [{bar:32}] {pos}/{len} {msg} (about {eta} left)";
            if let Ok(style) = ProgressStyle::with_template(form) {
                bar.set_style(style);
            }
            bar
        });
        Self {
            bar,
            is_quiet,
            count,
            done: AtomicUsize::new(0),
        }
    }

    /// Shows that a picture of this name is done, or the problem, which has the name in it.
    pub(crate) fn show(&self, name: &str, result: Result<&str, &str>) {
        let number = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let line = match result {
            Ok(what) => format!("[{number}/{}] {name}: {what}", self.count),
            Err(problem) => format!("error: {problem}"),
        };
        match &self.bar {
            Some(bar) => {
                bar.set_message(name.to_owned());
                bar.inc(1);
                if result.is_err() {
                    bar.println(line);
                }
            }
            // If standard error is closed, lines are lost.
            None if result.is_err() || !self.is_quiet => {
                let _ = writeln!(std::io::stderr(), "{line}");
            }
            None => {}
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
