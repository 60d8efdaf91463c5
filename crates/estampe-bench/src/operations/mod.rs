//! The cost of each operation of shaders as text: what sixteen invocations of a compute shader in
//! WGSL take for it.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- operations
//! ```
//!
//! Scenes measure what programs do most; here what they may do is measured, one by one, so that
//! nothing is slow unseen. A kernel does one operation again and again on four values, or sixteen
//! accesses to a texture, at every SIMD level for which there is machine code.
//!
//! * [`Operation`]s are lists: `numbers`, `memory` and `textures`;
//! * `kernel` makes a pipeline with its resources of one, and dispatches it;
//! * [`table`] writes the table of PERFORMANCE.md and the JSON.

mod kernel;
mod memory;
mod numbers;
mod operation;
pub mod table;
mod textures;

pub use operation::{Group, Operation};

use crate::provenance::Versions;
use crate::{BenchError, clock, document};
use clap::Args;
use estampe::{Device, DeviceDescriptor, Level};
use indicatif::{ProgressBar, ProgressStyle};
use kernel::Kernel;
use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use table::Row;

/// Measures each operation of shaders as text and writes the table of PERFORMANCE.md.
///
/// The table is written if everything was measured: not with --quick, --operations or --simd.
#[derive(Debug, Args)]
pub struct OperationsArguments {
    /// Operations or groups of operations to measure, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub operations: Vec<String>,
    /// SIMD levels, separated by commas [default: avx2 and avx512, as far as they are there]
    #[arg(long, value_delimiter = ',', value_name = "LEVEL,…")]
    pub simd: Vec<String>,
    /// Measure briefly, and leave PERFORMANCE.md unchanged
    #[arg(long)]
    pub quick: bool,
    /// Write the results to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// The document in which the table is written [default: PERFORMANCE.md of the repository]
    #[arg(long, value_name = "FILE")]
    pub document: Option<PathBuf>,
}

impl OperationsArguments {
    /// The requested operations.
    fn operations(&self) -> Result<Vec<Operation>, BenchError> {
        let all = Operation::all();
        let is_meant =
            |one: &Operation, name: &String| name == one.name || name == one.group.name();
        for name in &self.operations {
            if !all.iter().any(|one| is_meant(one, name)) {
                let known: Vec<&str> = all.iter().map(|one| one.name).collect();
                return Err(BenchError::UnknownOperation {
                    name: name.clone(),
                    known: known.join(", "),
                });
            }
        }
        let is_wanted = |one: &Operation| {
            self.operations.is_empty() || self.operations.iter().any(|name| is_meant(one, name))
        };
        Ok(all.into_iter().filter(is_wanted).collect())
    }

    /// The requested SIMD levels; without a request those with machine code, or the best one.
    fn levels(&self) -> Result<Vec<Level>, BenchError> {
        if !self.simd.is_empty() {
            let levels = self.simd.iter().map(|name| Level::named(name));
            return Ok(levels.collect::<Result<_, _>>()?);
        }
        let has_code = |level: &Level| ["avx2", "avx512"].contains(&level.name());
        let mut levels = Level::all_available();
        levels.retain(has_code);
        if levels.is_empty() {
            levels.push(Level::best());
        }
        Ok(levels)
    }

    /// Returns true if everything is measured without `--quick`, so that the table may be
    /// published.
    fn is_complete(&self) -> bool {
        !self.quick && self.operations.is_empty() && self.simd.is_empty()
    }
}

/// Measures the operations; the table is written to `out` too.
///
/// # Errors
/// [`BenchError`]: wrong usage, or a file that cannot be written.
pub fn run(arguments: &OperationsArguments, out: &mut impl Write) -> Result<(), BenchError> {
    let (operations, levels) = (arguments.operations()?, arguments.levels()?);
    let time = Duration::from_millis(if arguments.quick { 20 } else { 200 });
    let rows = measure_all(&operations, &levels, time)?;
    let names: Vec<&str> = levels.iter().map(|level| level.name()).collect();
    let text = table::section(&operations, &names, &rows, &Versions::here());
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
        document::update(&path, "operations", &text)?;
        writeln!(out, "written to {}", path.display()).map_err(print)?;
    }
    Ok(())
}

fn measure_all(
    operations: &[Operation],
    levels: &[Level],
    time: Duration,
) -> Result<Vec<Row>, BenchError> {
    let bar = ProgressBar::new((operations.len() * levels.len()) as u64);
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} {msg}");
    bar.set_style(style.expect("the template is a constant that was tried"));
    let mut rows = Vec::new();
    for &level in levels {
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            level,
            ..DeviceDescriptor::default()
        })?;
        for operation in operations {
            bar.set_message(format!("{}, {}", level.name(), operation.name));
            let kernel = Kernel::new(&device, operation, kernel::Size::MEASURED)?;
            rows.push(Row {
                operation: operation.name,
                level: level.name(),
                ns: measure(&kernel, time)?,
            });
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// The fewest dispatches, of which the first ones make the optimised machine code.
const FEWEST: usize = 12;

/// Nanoseconds of CPU time of an operation of sixteen invocations, of the fastest dispatch.
fn measure(kernel: &Kernel<'_>, time: Duration) -> Result<f64, BenchError> {
    let start = Instant::now();
    let (mut least, mut count) = (Duration::MAX, 0);
    while count < FEWEST || start.elapsed() < time {
        let before = clock::process_cpu_time();
        kernel.dispatch()?;
        least = least.min(clock::process_cpu_time().saturating_sub(before));
        count += 1;
    }
    Ok(least.as_secs_f64() * 1e9 / kernel.packets())
}

#[cfg(test)]
mod tests;
