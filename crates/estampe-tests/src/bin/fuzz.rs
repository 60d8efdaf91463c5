#![forbid(unsafe_code)]
//! Command-line entry of the random tests for long runs: `cargo xtask fuzz raster --seconds 60`.

use std::process::ExitCode;
use std::time::Duration;

const USAGE: &str = "usage: fuzz raster [--seconds N] [--seed N]";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((seconds, seed)) = parse(&arguments) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let start = std::time::Instant::now();
    match estampe_tests::fuzz::run(Duration::from_secs(seconds), seed) {
        Ok(tally) => {
            let taken = start.elapsed().as_secs_f64();
            say(&format!(
                "{} primitives in {} batches, from seed {seed} on, in {taken:.1} s: each sample was covered once",
                tally.primitives, tally.batches
            ));
            ExitCode::SUCCESS
        }
        Err(failure) => {
            say(&failure);
            ExitCode::FAILURE
        }
    }
}

#[expect(clippy::print_stdout, reason = "the program's answer")]
fn say(text: &str) {
    println!("{text}");
}

fn parse(arguments: &[String]) -> Option<(u64, u64)> {
    let (topic, mut options) = arguments.split_first()?;
    let (mut seconds, mut seed) = (10, 0);
    while let [name, value, rest @ ..] = options {
        let value = value.parse().ok()?;
        match name.as_str() {
            "--seconds" => seconds = value,
            "--seed" => seed = value,
            _ => return None,
        }
        options = rest;
    }
    (topic == "raster" && options.is_empty()).then_some((seconds, seed))
}
