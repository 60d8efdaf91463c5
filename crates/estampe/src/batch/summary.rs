//! What a batch says: what became of each picture, the sum at the end, and the report.

use super::job::{Outcome, Status};
use super::lines::Lines;
use super::plan::Content;
use crate::values::shown;
use serde_json::{Value, json};
use std::time::Duration;

/// Shows outcomes. Failures are shown always.
pub(super) fn show(lines: &Lines, outcomes: &[Outcome]) {
    for outcome in outcomes {
        let output = shown(&outcome.picture.output);
        match &outcome.status {
            Status::Failed(problem) | Status::Limit(problem) => lines.show(&output, Err(problem)),
            Status::Drawn => lines.show(&output, Ok(&format!("{} ms", outcome.time.as_millis()))),
            Status::UpToDate => lines.show(&output, Ok("up to date")),
            Status::Cancelled => lines.show(&output, Ok("not begun")),
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
        json!({
            "input": outcome.input,
            "output": outcome.picture.output.to_string_lossy(),
            "passes": match &outcome.picture.content {
                Content::Picture(_) => Vec::new(),
                Content::Passes(_, file) => file.passes.iter().map(|pass| pass.name()).collect(),
            },
            "view": outcome.picture.shot.view_name(),
            "camera": outcome.picture.shot.camera_name(),
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
