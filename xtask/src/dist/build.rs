//! The program of a package: a release build without paths of this machine.
//!
//! Rejected: a profile with one unit per crate and thin LTO between crates. The program is slightly
//! smaller, but takes half again as long for physically based shading.

use std::env;
use std::error::Error;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::programs::{self, cargo};

/// The target of this machine.
pub(super) fn host() -> Result<String, Box<dyn Error>> {
    let output = Command::new(cargo()).arg("-vV").output()?;
    let text = String::from_utf8(output.stdout)?;
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(host.ok_or("`cargo -vV` names no host")?.to_owned())
}

/// Builds the command for a target and returns the program's path.
pub(super) fn program(root: &Path, target: &str) -> Result<PathBuf, Box<dyn Error>> {
    let mut command = Command::new(cargo());
    command
        .current_dir(root)
        .args(["build", "--release", "--locked"])
        .args(["--package", "estampe", "--bin", "estampe"])
        .args(["--target", target])
        .env("CARGO_ENCODED_RUSTFLAGS", flags(root));
    let programs = programs::run(&mut command)?;
    let program = programs.into_iter().next();
    program.ok_or_else(|| "cargo names no program".into())
}

/// The compiler's flags: those of the caller, then those by which messages of the program name its
/// sources relative to the repository or the registry, not to this machine.
fn flags(root: &Path) -> OsString {
    let mut flags: Vec<OsString> = Vec::new();
    if let Some(encoded) = env::var_os("CARGO_ENCODED_RUSTFLAGS") {
        flags.extend((!encoded.is_empty()).then_some(encoded));
    } else if let Ok(plain) = env::var("RUSTFLAGS") {
        flags.extend(plain.split_whitespace().map(OsString::from));
    }
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| env::home_dir().map(|home| home.join(".cargo")));
    let registry = home.map(|home| (home.join("registry/src"), "registry"));
    let repository = (root.to_owned(), "estampe");
    for (path, name) in registry.into_iter().chain([repository]) {
        let mut flag = OsString::from("--remap-path-prefix=");
        flag.push(path);
        flag.push("=");
        flag.push(name);
        flags.push(flag);
    }
    flags.join("\x1f".as_ref())
}

/// The program that writes scripts and pages: that of the package if this machine runs it, else one
/// that is built for this machine.
pub(super) fn runnable(
    root: &Path,
    program: &Path,
    target: &str,
    host: &str,
) -> Result<PathBuf, Box<dyn Error>> {
    let run = Command::new(program)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match run {
        Ok(status) if status.success() => Ok(program.to_owned()),
        _ if target != host => self::program(root, host),
        Ok(status) => Err(format!("{}: {status}", program.display()).into()),
        Err(error) => Err(super::located(program, error).into()),
    }
}
