//! The comparison with lavapipe: both renderers draw the same scenes in one session, scene by scene
//! in turn.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- compare
//! ```
//!
//! * [`peer`] finds or builds `peerbench`, and runs it and estampe, pinned to one or two cores;
//! * [`results`] reads the results of both, and selects among rounds; [`runs`] has all of a scene;
//! * [`limits`] has lower bounds of frame times on the machine;
//! * [`table`] makes the tables, [`section`] the section of PERFORMANCE.md that contains them.

pub mod limits;
pub mod peer;
pub mod results;
pub mod runs;
pub mod section;
pub mod table;

use crate::frame::FrameSize;
use crate::provenance::Versions;
use crate::scene::SceneEntry;
use crate::{BenchError, document};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use limits::Limits;
use peer::{Effort, Session};
use runs::Runs;
use std::io::Write;
use std::path::PathBuf;
use table::Table;

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
    /// Rounds, of which the one with the fastest frame counts
    #[arg(long, default_value_t = 4, value_name = "N")]
    pub rounds: usize,
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
    scenes: &[&'static SceneEntry],
    out: &mut impl Write,
) -> Result<bool, BenchError> {
    let session = Session::new(arguments.peerbench.as_deref())?;
    let (effort, rounds) = if arguments.quick {
        (Effort::QUICK, 1)
    } else {
        (Effort::THOROUGH, arguments.rounds.max(1))
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
            let mut runs = Runs::new(scene);
            for _ in 0..rounds {
                bar.set_message(format!("{}, {cores} cores", scene.name));
                bar.tick();
                runs.draw(&session, &arguments.sizes, cores, effort)?;
                bar.inc(1);
            }
            for table in tables.iter_mut().filter(|table| table.cores == cores) {
                table
                    .lines
                    .push(runs.line(&session, table.size, cores, &limits)?);
            }
            if let Some(run) = runs.theirs.first() {
                driver.clone_from(&run.driver);
            }
        }
    }
    bar.finish_and_clear();

    let versions = Versions::here();
    let text = section::section(&tables, &driver, &versions);
    let print = |error| BenchError::File {
        path: "standard output".into(),
        source: error,
    };
    writeln!(out, "{text}").map_err(print)?;
    if !arguments.quick {
        let path = (arguments.document.clone()).unwrap_or_else(document::default_document);
        let name = format!("compare on {}", versions.vendor);
        document::update(&path, &name, &text)?;
        writeln!(out, "written to {}", path.display()).map_err(print)?;
    }
    let mut lines = tables.iter().flat_map(|table| &table.lines);
    Ok(lines.all(|line| line.difference.passes()))
}
