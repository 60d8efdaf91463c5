//! The cost of each state of the pipeline: every format, test and kind of blending compared with
//! the baseline, which is RGBA8 and 32-bit float depth with one sample.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- states
//! ```
//!
//! A state is measured with every load to which it applies. A frame in the state and one in the
//! baseline are drawn in turn, on the calling thread alone. The result is CPU time, and the median
//! of the ratios of consecutive frames.
//!
//! * [`Load`]s say what is drawn: vertices in `geometry`, textures in `texture_views`, shaders in
//!   `shaders`;
//! * [`State`]s are changes of the baseline; `case` combines both;
//! * [`table`] writes the table of PERFORMANCE.md and the JSON.

mod case;
mod geometry;
mod load;
mod measure;
mod shaders;
mod state;
pub mod table;
mod texture_views;

pub use load::Load;
pub use state::{Group, State};

use crate::frame::FrameSize;
use crate::provenance::Versions;
use crate::{BenchError, document};
use case::Case;
use clap::Args;
use estampe::{Device, DeviceDescriptor, Level};
use indicatif::{ProgressBar, ProgressStyle};
use measure::{Effort, measure};
use std::io::Write;
use std::path::PathBuf;
use table::Row;
use texture_views::Pictures;

/// The size of the frames: at this size, some hundred pairs of a state and a load take minutes.
pub const SIZE: FrameSize = FrameSize {
    width: 640,
    height: 360,
};

/// Measures every state of the pipeline and writes the table of PERFORMANCE.md.
///
/// The table is written if everything was measured: not with --quick, --states or --loads.
#[derive(Debug, Args)]
pub struct StatesArguments {
    /// States or groups of states to measure, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub states: Vec<String>,
    /// Loads to measure them with, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_enum, value_name = "LOAD,…")]
    pub loads: Vec<Load>,
    /// SIMD level: auto, scalar, sse2, avx2 or avx512
    #[arg(long, default_value = "auto")]
    pub simd: String,
    /// Measure few frames, and leave PERFORMANCE.md unchanged
    #[arg(long)]
    pub quick: bool,
    /// Write the results to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// The document in which the table is written [default: PERFORMANCE.md of the repository]
    #[arg(long, value_name = "FILE")]
    pub document: Option<PathBuf>,
}

impl StatesArguments {
    /// The requested states.
    fn states(&self) -> Result<Vec<State>, BenchError> {
        let all = State::all();
        let is_meant =
            |state: &State, name: &String| *name == state.name || name == state.group.name();
        for name in &self.states {
            if !all.iter().any(|state| is_meant(state, name)) {
                let known: Vec<&str> = all.iter().map(|state| state.name.as_str()).collect();
                return Err(BenchError::UnknownState {
                    name: name.clone(),
                    known: known.join(", "),
                });
            }
        }
        let is_wanted = |state: &State| {
            self.states.is_empty() || self.states.iter().any(|name| is_meant(state, name))
        };
        Ok(all.into_iter().filter(is_wanted).collect())
    }

    fn loads(&self) -> Vec<Load> {
        let is_wanted = |load: &Load| self.loads.is_empty() || self.loads.contains(load);
        Load::ALL.into_iter().filter(is_wanted).collect()
    }

    /// Returns true if all states and loads are measured without `--quick`, so that the table may
    /// be published.
    fn is_complete(&self) -> bool {
        !self.quick && self.states.is_empty() && self.loads.is_empty()
    }
}

/// Measures the states; the table is written to `out` too.
///
/// # Errors
/// [`BenchError`]: wrong usage, or a file that cannot be written.
pub fn run(arguments: &StatesArguments, out: &mut impl Write) -> Result<(), BenchError> {
    let (states, loads) = (arguments.states()?, arguments.loads());
    let device = Device::new(&DeviceDescriptor {
        threads: 1,
        level: Level::named(&arguments.simd)?,
        ..DeviceDescriptor::default()
    })?;
    let effort = if arguments.quick {
        Effort::QUICK
    } else {
        Effort::THOROUGH
    };
    let rows = measure_all(&device, &states, &loads, effort)?;
    let text = table::section(&states, &rows, device.level().name(), &Versions::here());
    let print = |error| BenchError::File {
        path: "standard output".into(),
        source: error,
    };
    writeln!(out, "{text}").map_err(print)?;
    if let Some(path) = &arguments.json {
        std::fs::write(path, table::to_json(&rows)).map_err(|source| BenchError::File {
            path: path.clone(),
            source,
        })?;
    }
    if arguments.is_complete() {
        let path = (arguments.document.clone()).unwrap_or_else(document::default_document);
        document::update(&path, "states", &text)?;
        writeln!(out, "written to {}", path.display()).map_err(print)?;
    }
    Ok(())
}

fn measure_all(
    device: &Device,
    states: &[State],
    loads: &[Load],
    effort: Effort,
) -> Result<Vec<Row>, BenchError> {
    let count = |load: &Load| states.iter().filter(|s| s.applies_to(*load)).count() as u64;
    let bar = ProgressBar::new(loads.iter().map(count).sum());
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} {msg}");
    bar.set_style(style.expect("the template is a constant that was tried"));
    let pictures = Pictures::new()?;
    let mut rows = Vec::new();
    for &load in loads {
        let mut baseline = Case::new(device, load, SIZE, None, &pictures)?;
        for state in states.iter().filter(|state| state.applies_to(load)) {
            bar.set_message(format!("{}, {}", load.name(), state.name));
            let mut case = Case::new(device, load, SIZE, Some(state), &pictures)?;
            let cost = measure(&mut baseline, &mut case, effort);
            let each = |count: u64| rounded(cost.frame_ns / count.max(1) as f64);
            rows.push(Row {
                state: state.name.clone(),
                load,
                ns: each(case.fragments()),
                ratio: rounded(cost.ratio),
                ns_per_triangle: (load == Load::Tris8).then(|| each(u64::from(case.primitives()))),
            });
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// A number rounded to three decimals.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        arguments: StatesArguments,
    }

    fn parsed(line: &str) -> StatesArguments {
        Line::try_parse_from(line.split(' ')).unwrap().arguments
    }

    #[test]
    fn states_are_chosen_by_name_or_group() {
        assert_eq!(parsed("states").states().unwrap(), State::all());
        let some = parsed("states --states samples,scissor").states().unwrap();
        let names: Vec<_> = some.iter().map(|state| state.name.as_str()).collect();
        let expected = [
            "2-samples",
            "4-samples",
            "8-samples",
            "16-samples",
            "alpha-to-coverage",
            "sample-mask",
            "scissor",
        ];
        assert_eq!(names, expected);
        let error = parsed("states --states scissors").states().unwrap_err();
        assert!(
            error.is_usage() && error.to_string().contains("occlusion-query"),
            "{error}"
        );
        assert!(Line::try_parse_from(["states", "--loads", "quads"]).is_err());
    }

    #[test]
    fn only_complete_tables_are_written_to_the_document() {
        assert!(parsed("states").is_complete());
        for line in [
            "states --quick",
            "states --states scissor",
            "states --loads fill",
        ] {
            assert!(!parsed(line).is_complete(), "{line}");
        }
    }

    #[test]
    fn a_run_measures_the_requested_states() {
        let path = std::env::temp_dir().join(format!("estampe-states-{}.json", std::process::id()));
        let line = format!(
            "states --quick --states points,rgba8unorm --loads tris8,textured --json {}",
            path.display()
        );
        let mut table = Vec::new();
        run(&parsed(&line), &mut table).unwrap();
        let json = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let rows: serde_json::Value = serde_json::from_str(&json).unwrap();
        let rows = rows.as_array().unwrap();
        let names: Vec<_> = rows
            .iter()
            .map(|r| (r["load"].as_str(), r["state"].as_str()))
            .collect();
        let expected = [
            ("tris8", "rgba8unorm"),
            ("tris8", "points"),
            ("textured", "rgba8unorm"),
        ];
        assert_eq!(
            names,
            expected.map(|(load, state)| (Some(load), Some(state)))
        );
        assert!(rows.iter().all(|row| row["ns"].as_f64() > Some(0.0)));
        let table = String::from_utf8(table).unwrap();
        assert_eq!(table.matches('–').count(), 4, "{table}");
    }
}
