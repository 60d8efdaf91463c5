#![forbid(unsafe_code)]
//! The command line of the repository's chores; see the library for what they are.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use xtask::{CHECKS, Repository, check_binary, conformance_document, write_models};

/// The packages whose programs the check of the assembly builds.
const HOT_PROGRAMS: &[&str] = &["estampe-bench", "estampe-cli"];

const USAGE: &str = "\
usage: cargo run -p xtask -- check          check sources and documents
       cargo run -p xtask -- models FOLDER  write the models on which the whole process is measured
       cargo run -p xtask -- conformance    write which tests prove which row of the pipeline
       cargo run -p xtask -- fuzz raster [--seconds N] [--seed N]
                                            draw random triangles that share edges, for so long, and count how
                                            often each sample is covered
       cargo run -p xtask -- asm [BINARY]…  check that hot code is inlined into its SIMD level;
                                            without BINARY, builds the programs and checks them";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match arguments.as_slice() {
        ["check"] => check(),
        ["models", folder] => write_models(folder.as_ref())
            .map(|()| true)
            .map_err(|error| format!("{folder}: {error}")),
        ["conformance"] => conformance(),
        ["fuzz", arguments @ ..] => fuzz(arguments),
        ["asm", binaries @ ..] => asm(binaries),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Runs every check of the sources; says whether all passed.
fn check() -> Result<bool, String> {
    let repository = Repository::of_this_build().map_err(|error| error.to_string())?;
    let mut passed = true;
    for (name, check) in CHECKS {
        let findings = check(&repository);
        let errors = findings.iter().filter(|finding| finding.is_error()).count();
        eprintln!(
            "{name}: {}",
            if errors == 0 {
                "ok".into()
            } else {
                format!("{errors} errors")
            }
        );
        for finding in findings {
            eprintln!("  {finding}");
        }
        passed &= errors == 0;
    }
    Ok(passed)
}

/// Checks the machine code of the given programs, or of our own; says whether all passed.
fn asm(binaries: &[&str]) -> Result<bool, String> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        eprintln!("asm: skipped, only x86-64 Linux is checked");
        return Ok(true);
    }
    let binaries = if binaries.is_empty() {
        build_hot_programs()?
    } else {
        binaries.iter().map(PathBuf::from).collect()
    };
    let mut passed = true;
    for path in binaries {
        let file = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let report = check_binary(&file).map_err(|error| format!("{}: {error}", path.display()))?;
        for call in &report.calls {
            eprintln!("  note: out of line: {call}");
        }
        for offence in &report.offences {
            eprintln!("  error: {offence}");
        }
        eprintln!(
            "{}: {} level entries, {} offences",
            path.display(),
            report.entries,
            report.offences.len()
        );
        passed &= report.offences.is_empty();
    }
    Ok(passed)
}

/// Writes `docs/CONFORMANCE.md`.
fn conformance() -> Result<bool, String> {
    let repository = Repository::of_this_build().map_err(|error| error.to_string())?;
    let path = repository.root().join("docs/CONFORMANCE.md");
    std::fs::write(&path, conformance_document(&repository))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(true)
}

/// Runs the long random tests, which are a program of the tests' own; says whether they passed.
fn fuzz(arguments: &[&str]) -> Result<bool, String> {
    let repository = Repository::of_this_build().map_err(|error| error.to_string())?;
    let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(repository.root())
        .args(["run", "--release", "--locked", "--package", "estampe-tests"])
        .args(["--bin", "fuzz", "--"])
        .args(arguments)
        .status()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    Ok(status.success())
}

/// Builds the programs in release form with symbols that show generic arguments, in a folder of its
/// own so that ordinary builds stay valid, and returns their paths.
fn build_hot_programs() -> Result<Vec<PathBuf>, String> {
    let repository = Repository::of_this_build().map_err(|error| error.to_string())?;
    let target = repository.root().join("target/asm");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(repository.root())
        .args(["build", "--release", "--locked", "--bins"])
        .args([
            "--message-format",
            "json-render-diagnostics",
            "--target-dir",
        ])
        .arg(&target)
        .env("CARGO_ENCODED_RUSTFLAGS", "-Csymbol-mangling-version=v0");
    for package in HOT_PROGRAMS {
        cargo.args(["--package", package]);
    }
    let output = cargo
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if !output.status.success() {
        return Err("the programs do not build".to_owned());
    }
    // Each message is one line of JSON; a program's has its path under the key `executable`.
    let messages = String::from_utf8_lossy(&output.stdout);
    let programs: Vec<PathBuf> = messages
        .lines()
        .filter_map(|line| line.split_once("\"executable\":\"")?.1.split_once('"'))
        .map(|(path, _)| PathBuf::from(path))
        .collect();
    if programs.is_empty() {
        return Err(format!("none of {} has a program", HOT_PROGRAMS.join(", ")));
    }
    Ok(programs)
}
