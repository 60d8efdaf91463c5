//! The models: files, globs, and lists on standard input.

use super::arguments::BatchArgs;
use crate::failure::Failure;
use crate::values::shown;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A model's file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Input {
    pub(super) path: PathBuf,
    /// The folder below which `{dir}` begins: that of the glob, or the file's own.
    pub(super) base: PathBuf,
}

/// The greatest list on standard input.
const MOST_LIST_BYTES: u64 = 1 << 28;

/// All models of the arguments in the order of their paths, each once.
pub(super) fn inputs(args: &BatchArgs) -> Result<Vec<Input>, Failure> {
    let mut found = BTreeMap::new();
    for argument in &args.inputs {
        if argument == "-" {
            for path in list()? {
                add(&mut found, path, None);
            }
            continue;
        }
        match pattern(argument) {
            Some(pattern) => expand(pattern, &mut found)?,
            None => add(&mut found, PathBuf::from(argument), None),
        }
    }
    Ok(found.into_values().collect())
}

fn add(found: &mut BTreeMap<PathBuf, Input>, path: PathBuf, base: Option<&Path>) {
    let own = path.parent().unwrap_or(Path::new(""));
    let base = base.unwrap_or(own).to_owned();
    found.entry(path.clone()).or_insert(Input { path, base });
}

/// The text of an argument that is a glob, and no file of that name.
pub(crate) fn pattern(argument: &OsStr) -> Option<&str> {
    let text = argument.to_str()?;
    let is_glob = text.contains(['*', '?', '[']);
    (is_glob && !Path::new(argument).exists()).then_some(text)
}

/// Adds the files that a glob matches.
fn expand(pattern: &str, found: &mut BTreeMap<PathBuf, Input>) -> Result<(), Failure> {
    // The folders before the first one with a wildcard.
    let fixed = pattern.find(['*', '?', '[']).unwrap_or(0);
    let base = match pattern[..fixed].rfind(['/', std::path::MAIN_SEPARATOR]) {
        Some(end) => PathBuf::from(&pattern[..=end]),
        None => PathBuf::new(),
    };
    for path in matches(pattern)? {
        add(found, path, Some(&base));
    }
    Ok(())
}

/// The files that a glob matches, at least one, in the order of their paths.
pub(crate) fn matches(pattern: &str) -> Result<Vec<PathBuf>, Failure> {
    let wrong = |reason: String| Failure::Usage(format!("{pattern}: {reason}"));
    let paths = glob::glob(pattern).map_err(|error| wrong(error.to_string()))?;
    let mut found = Vec::new();
    for path in paths {
        let path = path.map_err(|error| {
            Failure::Input(format!(
                "{pattern}: {error}; check the folder's permissions"
            ))
        })?;
        if path.is_file() {
            found.push(path);
        }
    }
    if found.is_empty() {
        return Err(Failure::Input(format!(
            "{pattern}: no file matches; check the folder and the pattern"
        )));
    }
    Ok(found)
}

/// The paths of the list on standard input, one a line; empty lines are skipped.
pub(crate) fn list() -> Result<Vec<PathBuf>, Failure> {
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(MOST_LIST_BYTES + 1);
    { read }.read_to_end(&mut bytes).map_err(|error| {
        Failure::Input(format!(
            "standard input: {error}; check the program that writes the list"
        ))
    })?;
    if bytes.len() as u64 > MOST_LIST_BYTES {
        return Err(Failure::Input(format!(
            "standard input: a list of more than {MOST_LIST_BYTES} bytes; split it, or use --shard"
        )));
    }
    let lines = bytes.split(|&byte| byte == b'\n');
    let lines = lines.map(|line| line.strip_suffix(b"\r").unwrap_or(line));
    lines.filter(|line| !line.is_empty()).map(path_of).collect()
}

/// The path of a line: any bytes where the system has such names.
#[cfg(unix)]
fn path_of(line: &[u8]) -> Result<PathBuf, Failure> {
    use std::os::unix::ffi::OsStrExt;
    Ok(PathBuf::from(OsStr::from_bytes(line)))
}

#[cfg(not(unix))]
fn path_of(line: &[u8]) -> Result<PathBuf, Failure> {
    match std::str::from_utf8(line) {
        Ok(text) => Ok(PathBuf::from(text)),
        Err(_) => Err(Failure::Input(format!(
            "standard input: {:?} is not UTF-8; write the list as UTF-8",
            String::from_utf8_lossy(line)
        ))),
    }
}

/// The path below the base, without what leads out of it.
pub(super) fn folder_below(input: &Input) -> PathBuf {
    let folder = input.path.parent().unwrap_or(Path::new(""));
    let below = folder.strip_prefix(&input.base).unwrap_or(Path::new(""));
    let names = below
        .components()
        .filter(|part| matches!(part, std::path::Component::Normal(_)));
    names.collect()
}

/// For messages.
pub(super) fn name(input: &Input) -> String {
    shown(&input.path)
}
