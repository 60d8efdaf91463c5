#![forbid(unsafe_code)]
//! The command `estampe-bench`.

use clap::Parser;
use estampe_bench::command::{Arguments, Outcome, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    match run(&Arguments::parse(), &mut std::io::stdout().lock()) {
        Ok(Outcome::Agreement) => ExitCode::SUCCESS,
        Ok(Outcome::Difference) => ExitCode::from(1),
        Err(error) => {
            eprintln!("estampe-bench: {error}");
            ExitCode::from(if error.is_usage() { 2 } else { 3 })
        }
    }
}
