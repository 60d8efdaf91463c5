//! Runs `estampe batch`.

use super::arguments::BatchArgs;
use super::job::Shared;
use super::record::digest;
use super::summary::{Counts, Lines, report};
use super::{plan, pool};
use crate::failure::{DONE, Failure};
use crate::input::read_file;
use crate::output;
use crate::values::Destination;
use estampe_assets::Limits;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// The exit code if a picture failed.
const INCOMPLETE: u8 = 1;

/// Runs the command, and returns its exit code.
pub(crate) fn run(args: &BatchArgs) -> Result<u8, Failure> {
    let start = Instant::now();
    args.picture.check()?;
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
        args,
        options: options_text(args)?,
        limits: Limits {
            max_triangles: args.max_triangles,
            max_total_image_pixels: args.max_pixels,
            max_image_pixels: Limits::default().max_image_pixels.min(args.max_pixels),
            max_file_bytes: args.max_bytes,
            threads: args.picture.thread_count(),
            ..Limits::default()
        },
    };
    let count = jobs.iter().map(|job| job.pictures.len()).sum();
    let lines = Lines::new(count, args.quiet);
    let outcomes = pool::outcomes(&shared, &jobs, |outcomes| lines.show(outcomes))?;
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

/// Everything beside the model that a picture depends on. Options that change no byte (threads,
/// SIMD level) are not in it.
fn options_text(args: &BatchArgs) -> Result<String, Failure> {
    let mut picture = args.picture.clone();
    picture.threads = None;
    picture.simd = estampe::Level::best();
    picture.view = None;
    let digest_of = |path: Option<&Path>| -> Result<String, Failure> {
        match path {
            Some(path) => Ok(digest(&read_file(path, &Limits::default())?)),
            None => Ok(String::new()),
        }
    };
    Ok(format!(
        "{} {} {picture:?} {:?} {:?} {} {} {}",
        env!("CARGO_PKG_VERSION"),
        estampe_renderer::PICTURE_VERSION,
        args.choice,
        args.format,
        digest_of(picture.texture.as_deref())?,
        digest_of(picture.shader.file())?,
        digest_of(picture.pbr.panorama())?,
    ))
}
