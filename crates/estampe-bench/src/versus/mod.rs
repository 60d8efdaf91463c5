//! The comparison with lavapipe: both renderers draw the same scenes in one session, scene by scene
//! in turn.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- compare
//! ```
//!
//! * [`peer`] finds or builds `peerbench`, and runs it and estampe, pinned to one or two cores;
//! * [`results`] reads the results of both, and selects among rounds;
//! * [`limits`] has lower bounds of frame times on the machine;
//! * [`table`] makes the tables, [`section`] the section of PERFORMANCE.md that contains them.

pub mod limits;
pub mod peer;
pub mod results;
pub mod section;
pub mod table;

use crate::frame::FrameSize;
use crate::picture::{Difference, Picture};
use crate::provenance::Versions;
use crate::{BenchError, document};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use limits::Limits;
use peer::{Effort, Session};
use results::{Measured, RunResults, choose};
use std::io::Write;
use std::path::PathBuf;
use table::{Line, Table};

/// The compared numbers of cores.
const CORES: [usize; 2] = [1, 2];

/// Compares estampe with lavapipe and writes the tables of PERFORMANCE.md.
///
/// Needs Linux with Debian's packages mesa-vulkan-drivers and libvulkan1, and the peer's client,
/// peerbench, in ../shared/peerbench.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Scenes to draw, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub scenes: Vec<String>,
    /// Frame sizes, separated by commas
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "WxH,…",
        default_value = "1280x720,1920x1080"
    )]
    pub sizes: Vec<FrameSize>,
    /// Measure few frames in one round without limits, and leave PERFORMANCE.md unchanged
    #[arg(long)]
    pub quick: bool,
    /// A built peerbench, with its limits beside it [default: built from ../shared/peerbench]
    #[arg(long, value_name = "FILE")]
    pub peerbench: Option<PathBuf>,
    /// The document in which the tables are written [default: PERFORMANCE.md of the repository]
    #[arg(long, value_name = "FILE")]
    pub document: Option<PathBuf>,
}

/// Runs the comparison; the tables are written to `out` too. Returns whether all pictures agree.
///
/// # Errors
/// [`BenchError`] if a requirement is missing or a run fails.
pub fn run(
    arguments: &CompareArguments,
    scenes: &[&'static str],
    out: &mut impl Write,
) -> Result<bool, BenchError> {
    let session = Session::new(arguments.peerbench.as_deref())?;
    let (effort, rounds) = if arguments.quick {
        (Effort::QUICK, 1)
    } else {
        (Effort::THOROUGH, 2)
    };
    let steps = scenes.len() * CORES.len() * rounds;
    let bar = ProgressBar::new(steps as u64);
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} {msg}");
    bar.set_style(style.expect("the template is a constant that was tried"));
    let limits = if arguments.quick {
        Limits::default()
    } else {
        bar.set_message("limits of the machine");
        bar.tick();
        session.limits()?
    };

    let mut tables = Vec::new();
    for &size in &arguments.sizes {
        tables.extend(CORES.map(|cores| Table::new(size, cores)));
    }
    let mut driver = String::new();
    for &scene in scenes {
        for cores in CORES {
            let (mut ours, mut theirs): (Vec<RunResults>, Vec<RunResults>) = Default::default();
            for _ in 0..rounds {
                bar.set_message(format!("{scene}, {cores} cores"));
                bar.tick();
                ours.push(session.run_ours(scene, &arguments.sizes, cores, effort)?);
                theirs.push(session.run_peer(scene, &arguments.sizes, cores, effort)?);
                bar.inc(1);
            }
            for table in tables.iter_mut().filter(|table| table.cores == cores) {
                let size = table.size;
                let found = |runs: &[RunResults], who: &str| -> Result<Measured, BenchError> {
                    choose(runs, scene, size).ok_or_else(|| BenchError::Command {
                        command: who.to_owned(),
                        reason: format!("measured no {scene} at {size}"),
                    })
                };
                let (ours, theirs) = (found(&ours, "estampe-bench")?, found(&theirs, "peerbench")?);
                let pictures = session.pictures(scene, size);
                let [ours_picture, theirs_picture] = &pictures;
                let difference = Difference::between(
                    &Picture::read_png(ours_picture)?,
                    &Picture::read_png(theirs_picture)?,
                );
                let difference = difference.ok_or_else(|| BenchError::Picture {
                    path: theirs_picture.clone(),
                    reason: format!("is not of {size} pixels"),
                })?;
                table.lines.push(Line {
                    limit: limits.of_scene(scene, size, cores, ours.fragments),
                    ours,
                    theirs,
                    difference,
                });
            }
            if let Some(run) = theirs.first() {
                driver.clone_from(&run.driver);
            }
        }
    }
    bar.finish_and_clear();

    let text = section::section(&tables, &driver, &Versions::here());
    let print = |error| BenchError::File {
        path: "standard output".into(),
        source: error,
    };
    writeln!(out, "{text}").map_err(print)?;
    if !arguments.quick {
        let path = (arguments.document.clone()).unwrap_or_else(document::default_document);
        document::update(&path, "compare", &text)?;
        writeln!(out, "written to {}", path.display()).map_err(print)?;
    }
    let mut lines = tables.iter().flat_map(|table| &table.lines);
    Ok(lines.all(|line| line.difference.passes()))
}
