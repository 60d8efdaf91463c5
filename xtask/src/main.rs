#![forbid(unsafe_code)]
//! The command line of the repository's checks; see the library for what they check.

mod dist;
mod programs;

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use clap::{Parser, Subcommand};
use xtask::{CHECKS, Repository, check_binary, check_book, conformance_document, write_book};

/// Checks of the repository
#[derive(Debug, Parser)]
#[command(bin_name = "cargo run -p xtask --", disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Check sources, documents and dependencies
    Check,
    /// Check that hot code is inlined into its SIMD level
    Asm {
        /// Programs to check; without any, those of the repository are built and checked
        programs: Vec<PathBuf>,
        /// Build and check the programs of this package alone
        #[arg(long, conflicts_with = "programs", value_parser = programs::PACKAGES.to_vec())]
        package: Vec<String>,
    },
    /// Check the book and write its pages into target/book
    Book,
    /// Write the package of the command into target/dist: program, completion scripts, manual
    /// pages, licences
    Dist {
        /// The target of the program; without it, that of this machine
        #[arg(long, value_name = "TRIPLE")]
        target: Option<String>,
    },
    /// Write docs/CONFORMANCE.md: the tests that prove each row of the pipeline
    Conformance,
    /// Run random tests for long: `fuzz raster` draws triangles that share edges and counts how
    /// often each sample is covered
    Fuzz {
        /// Arguments of the program `fuzz` of estampe-tests, such as `raster --seconds 60 --seed 1`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
        arguments: Vec<String>,
    },
}

/// The outcome of a task: whether everything passed, or why it could not run.
type Outcome = Result<bool, Box<dyn std::error::Error>>;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().task {
        Task::Check => check(),
        Task::Asm { programs, package } => asm(programs, package),
        Task::Book => book(),
        Task::Dist { target } => dist(target.as_deref()),
        Task::Conformance => conformance(),
        Task::Fuzz { arguments } => fuzz(&arguments),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs every check of the sources.
fn check() -> Outcome {
    let repository = Repository::of_this_build()?;
    let mut passed = true;
    for (name, check) in CHECKS {
        let findings = check(&repository);
        let errors = findings.iter().filter(|finding| finding.is_error()).count();
        let result = match errors {
            0 => "ok".to_owned(),
            _ => format!("{errors} errors"),
        };
        eprintln!("{name}: {result}");
        for finding in findings {
            eprintln!("  {finding}");
        }
        passed &= errors == 0;
    }
    Ok(passed)
}

/// Checks the machine code of the given programs, or of the repository's: those of `packages`, or
/// all.
fn asm(programs: Vec<PathBuf>, packages: Vec<String>) -> Outcome {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        eprintln!("asm: skipped, only x86-64 Linux is checked");
        return Ok(true);
    }
    let programs = if programs.is_empty() {
        let packages = if packages.is_empty() {
            programs::PACKAGES.iter().map(ToString::to_string).collect()
        } else {
            packages
        };
        programs::build(Repository::of_this_build()?.root(), &packages)?
    } else {
        programs
    };
    let mut passed = true;
    for path in programs {
        let located = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let file = std::fs::read(&path).map_err(|error| located(&error))?;
        let report = check_binary(&file).map_err(|error| located(&error))?;
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

/// Checks the book, and writes its pages even if something is wrong, for a look at them.
fn book() -> Outcome {
    let repository = Repository::of_this_build()?;
    let documents = xtask::check_documents(&repository).into_iter();
    let of_the_book = documents.filter(|finding| finding.path.starts_with("book"));
    let mut passed = true;
    for finding in check_book(&repository).into_iter().chain(of_the_book) {
        eprintln!("  {finding}");
        passed &= !finding.is_error();
    }
    let folder = repository.root().join("target/book");
    let count = write_book(&repository, &folder)?;
    eprintln!("{count} chapters: {}", folder.join("index.html").display());
    Ok(passed)
}

/// Writes the package of the command and says what the program needs.
fn dist(target: Option<&str>) -> Outcome {
    let repository = Repository::of_this_build()?;
    let dist = dist::write(repository.root(), target)?;
    let mut out = io::stdout().lock();
    for path in [&dist.folder, &dist.archive, &dist.checksums] {
        writeln!(out, "{}", path.display())?;
    }
    if let Some(requirement) = &dist.requirement {
        writeln!(out, "{requirement}")?;
    }
    Ok(true)
}

/// Writes `docs/CONFORMANCE.md`.
fn conformance() -> Outcome {
    let repository = Repository::of_this_build()?;
    let path = repository.root().join("docs/CONFORMANCE.md");
    std::fs::write(path, conformance_document(&repository))?;
    Ok(true)
}

/// Runs the program of the long random tests.
fn fuzz(arguments: &[String]) -> Outcome {
    let repository = Repository::of_this_build()?;
    let status = Command::new(programs::cargo())
        .current_dir(repository.root())
        .args(["run", "--release", "--locked", "--package", "estampe-tests"])
        .args(["--bin", "fuzz", "--"])
        .args(arguments)
        .status()?;
    Ok(status.success())
}
