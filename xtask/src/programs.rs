//! Programs that cargo builds; and those whose machine code is checked, built as users build them,
//! but with their symbols.

use cargo_metadata::Message;
use std::ffi::OsString;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The packages whose programs are checked.
pub(crate) const PACKAGES: &[&str] = &["estampe-bench", "estampe"];

/// The profile of the workspace's `Cargo.toml` that is `release` with symbols, for the crates that
/// have lane code.
const PROFILE: &str = "asm";

/// The cargo that runs this program, or the one on the path.
pub(crate) fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Builds the programs of packages, with symbols that show generic arguments, and returns their
/// paths. A target folder of their own keeps ordinary builds valid, whose flags differ.
pub(crate) fn build(
    root: &Path,
    packages: &[String],
) -> Result<Vec<PathBuf>, Box<dyn std::error::Error>> {
    let mut command = Command::new(cargo());
    command
        .current_dir(root)
        .args(["build", "--profile", PROFILE, "--locked", "--bins"])
        .arg("--target-dir")
        .arg(root.join("target/asm"))
        .env("CARGO_ENCODED_RUSTFLAGS", "-Csymbol-mangling-version=v0");
    for package in packages {
        command.args(["--package", package]);
    }
    let programs = run(&mut command)?;
    if programs.is_empty() {
        return Err(format!("none of {} has a program", packages.join(", ")).into());
    }
    Ok(programs)
}

/// Runs a build of cargo that writes JSON messages, and returns the paths of its programs.
pub(crate) fn run(command: &mut Command) -> Result<Vec<PathBuf>, Box<dyn std::error::Error>> {
    command
        .args(["--message-format", "json-render-diagnostics"])
        .stdout(Stdio::piped());
    let mut child = command.spawn()?;
    let messages = child.stdout.take().expect("standard output is piped");
    let mut programs = Vec::new();
    for message in Message::parse_stream(BufReader::new(messages)) {
        if let Message::CompilerArtifact(artifact) = message? {
            programs.extend(artifact.executable.map(PathBuf::from));
        }
    }
    if !child.wait()?.success() {
        return Err("the programs do not build".into());
    }
    Ok(programs)
}
