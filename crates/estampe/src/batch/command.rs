//! Runs `estampe batch`.

use super::arguments::BatchArgs;
use super::job::Shared;
use super::lines::Lines;
use super::summary::{Counts, report, show};
use super::{plan, pool};
use crate::failure::{DONE, Failure};
use crate::output;
use crate::values::Destination;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// The exit code if a picture failed.
const INCOMPLETE: u8 = 1;

/// Runs the command, and returns its exit code.
pub(crate) fn run(args: &BatchArgs) -> Result<u8, Failure> {
    let start = Instant::now();
    let jobs = plan::jobs(args)?;
    let report_to = args.report.as_ref().map(|path| {
        if path.as_os_str() == "-" {
            Destination::StandardOutput
        } else {
            Destination::File(path.clone())
        }
    });
    if let Some(destination) = &report_to {
        output::check(destination)?;
    }
    let pictures = jobs.iter().flat_map(|job| &job.pictures);
    let folders: BTreeSet<&Path> = { pictures }.filter_map(|p| p.output.parent()).collect();
    for folder in folders {
        output::remove_abandoned(folder);
    }
    let shared = Shared {
        args: Arc::new(args.clone()),
        limits: args.limits.of_reader(args.picture.thread_count()),
    };
    let count = jobs.iter().map(|job| job.pictures.len()).sum();
    let lines = Lines::new(count, args.quiet);
    let outcomes = pool::outcomes(&shared, &jobs, |outcomes| show(&lines, outcomes))?;
    lines.finish();
    let counts = Counts::of(&outcomes);
    if !args.quiet {
        // If standard error is closed, the line is lost.
        let _ = writeln!(std::io::stderr(), "{}", counts.line(start.elapsed()));
    }
    if let Some(destination) = &report_to {
        let mut text = report(&outcomes, &counts).to_string();
        text.push('\n');
        output::write(destination, text.as_bytes())?;
    }
    Ok(if counts.is_complete() {
        DONE
    } else {
        INCOMPLETE
    })
}
