//! What a batch says: a line for each picture or a bar, the sum at the end, and the report.

use super::job::{Outcome, Status};
use crate::values::shown;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Shows which pictures are done: a bar on a terminal, else a line for each.
pub(super) struct Lines {
    bar: Option<ProgressBar>,
    is_quiet: bool,
    count: usize,
    done: AtomicUsize,
}

impl Lines {
    pub(super) fn new(count: usize, is_quiet: bool) -> Self {
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

    /// Shows outcomes. Failures are shown always.
    pub(super) fn show(&self, outcomes: &[Outcome]) {
        for outcome in outcomes {
            let number = self.done.fetch_add(1, Ordering::Relaxed) + 1;
            let output = shown(&outcome.picture.output);
            let line = match &outcome.status {
                Status::Failed(problem) | Status::Limit(problem) => format!("error: {problem}"),
                Status::Drawn => {
                    let ms = outcome.time.as_millis();
                    format!("[{number}/{}] {output}: {ms} ms", self.count)
                }
                Status::UpToDate => format!("[{number}/{}] {output}: up to date", self.count),
                Status::Cancelled => format!("[{number}/{}] {output}: not begun", self.count),
            };
            let is_problem = matches!(outcome.status, Status::Failed(_) | Status::Limit(_));
            match &self.bar {
                Some(bar) => {
                    bar.set_message(output);
                    bar.inc(1);
                    if is_problem {
                        bar.println(line);
                    }
                }
                // If standard error is closed, lines are lost.
                None if is_problem || !self.is_quiet => {
                    let _ = writeln!(std::io::stderr(), "{line}");
                }
                None => {}
            }
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Numbers of outcomes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) drawn: usize,
    pub(super) up_to_date: usize,
    pub(super) failed: usize,
    pub(super) limit: usize,
    pub(super) cancelled: usize,
}

impl Counts {
    pub(super) fn of(outcomes: &[Outcome]) -> Self {
        let mut counts = Self::default();
        for outcome in outcomes {
            *match outcome.status {
                Status::Drawn => &mut counts.drawn,
                Status::UpToDate => &mut counts.up_to_date,
                Status::Failed(_) => &mut counts.failed,
                Status::Limit(_) => &mut counts.limit,
                Status::Cancelled => &mut counts.cancelled,
            } += 1;
        }
        counts
    }

    /// True if every picture is there.
    pub(super) fn is_complete(&self) -> bool {
        self.failed + self.limit + self.cancelled == 0
    }

    /// The sum as one line.
    pub(super) fn line(&self, time: Duration) -> String {
        let mut parts = vec![format!("{} drawn", self.drawn)];
        let others = [
            (self.up_to_date, "up to date"),
            (self.failed, "failed"),
            (self.limit, "over a limit"),
            (self.cancelled, "not begun"),
        ];
        for (count, name) in others {
            if count > 0 {
                parts.push(format!("{count} {name}"));
            }
        }
        format!("{} in {:.1} s", parts.join(", "), time.as_secs_f64())
    }
}

/// The report.
pub(super) fn report(outcomes: &[Outcome], counts: &Counts) -> Value {
    let pictures = outcomes.iter().map(|outcome| {
        let (status, error) = match &outcome.status {
            Status::Drawn => ("drawn", None),
            Status::UpToDate => ("up-to-date", None),
            Status::Failed(problem) => ("failed", Some(problem)),
            Status::Limit(problem) => ("limit", Some(problem)),
            Status::Cancelled => ("cancelled", None),
        };
        let view = outcome.picture.view.as_ref();
        let view = view.and_then(ValueEnum::to_possible_value);
        json!({
            "input": outcome.input,
            "output": outcome.picture.output.to_string_lossy(),
            "view": view.as_ref().map(clap::builder::PossibleValue::get_name),
            "status": status,
            "error": error,
            "milliseconds": crate::render::rounded_milliseconds(outcome.time),
            "warnings": outcome.warnings,
        })
    });
    json!({
        "pictures": pictures.collect::<Vec<_>>(),
        "counts": {
            "drawn": counts.drawn,
            "up_to_date": counts.up_to_date,
            "failed": counts.failed,
            "limit": counts.limit,
            "cancelled": counts.cancelled,
        },
    })
}
