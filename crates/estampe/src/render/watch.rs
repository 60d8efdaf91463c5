//! `estampe render --watch`: draws again when a file changes.
//!
//! Times and lengths of the files are read four times a second: no system interface is needed, and
//! it works on network folders, where notifications do not. Rejected: a crate of notifications,
//! which brings one back end for each system.

use super::arguments::RenderArgs;
use super::command;
use crate::failure::Failure;
use crate::terminal;
use crate::values::Source;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The time between looks at the files.
const BETWEEN: Duration = Duration::from_millis(250);
/// A file that changes is looked at until it has been the same for this time.
const SETTLED: Duration = Duration::from_millis(100);
/// The most looks at a file that does not settle.
const MOST_LOOKS: u32 = 50;

/// Time and length of a file; `None` if there is none.
type Stamp = Option<(Option<SystemTime>, u64)>;

/// Draws, and draws again whenever the model or one of its files changes, until the process is
/// interrupted. Errors are reported, except those of usage, which no file mends.
pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let is_standard_output = |output: &crate::values::Destination| output.is_standard_output();
    if args.output.as_ref().is_none_or(is_standard_output) || args.model == Source::StandardInput {
        return Err(Failure::Usage(
            "--watch draws again and again: name a file for the model and the picture, not -"
                .to_owned(),
        ));
    }
    let mut files = of_options(args);
    if files.is_empty() {
        return Err(Failure::Usage(
            "--watch has no file to watch; a built-in model changes with its --shader or --texture \
             alone"
                .to_owned(),
        ));
    }
    loop {
        let before = stamps(&files);
        match command::draw_once(args) {
            Ok(named) => {
                files = of_options(args);
                files.extend(named);
            }
            Err(failure @ Failure::Usage(_)) => return Err(failure),
            Err(failure) => {
                let message = failure.to_string();
                // If standard error is closed, the message is lost.
                let _ = writeln!(
                    std::io::stderr(),
                    "estampe render: {}",
                    terminal::lines(&message)
                );
            }
        }
        // What changed while it was drawn is drawn again.
        let mut seen = stamps(&files);
        seen.extend(before.into_iter().filter(|(path, _)| files.contains(path)));
        wait_for_change(&seen);
    }
}

/// The model's file, and those of the options.
fn of_options(args: &RenderArgs) -> Vec<PathBuf> {
    let model = match &args.model {
        Source::File(path) => Some(path.as_path()),
        Source::Builtin(_) | Source::StandardInput => None,
    };
    let picture = &args.picture;
    let files = [
        model,
        args.cameras.cameras.as_deref(),
        picture.texture.as_deref(),
        picture.shader.file(),
        picture.pbr.panorama(),
    ];
    files.into_iter().flatten().map(Path::to_owned).collect()
}

fn stamps(files: &[PathBuf]) -> BTreeMap<PathBuf, Stamp> {
    let stamp = |path: &PathBuf| {
        let metadata = std::fs::metadata(path).ok()?;
        Some((metadata.modified().ok(), metadata.len()))
    };
    let stamps = files.iter().map(|path| (path.clone(), stamp(path)));
    stamps.collect()
}

/// Returns when a file is another than it was, and no longer changes.
fn wait_for_change(seen: &BTreeMap<PathBuf, Stamp>) {
    let files: Vec<PathBuf> = seen.keys().cloned().collect();
    let mut last = stamps(&files);
    while last == *seen {
        std::thread::sleep(BETWEEN);
        last = stamps(&files);
    }
    for _ in 0..MOST_LOOKS {
        std::thread::sleep(SETTLED);
        let now = stamps(&files);
        if now == last {
            return;
        }
        last = now;
    }
}
