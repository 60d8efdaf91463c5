//! Output files, written completely or not at all.

use crate::failure::Failure;
use crate::values::{Destination, shown};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Checks a destination before any work is done, and refuses one that cannot be written.
pub(crate) fn check(destination: &Destination) -> Result<(), Failure> {
    let Destination::File(path) = destination else {
        return Ok(());
    };
    if path.is_dir() {
        let name = shown(path);
        return Err(Failure::Output(format!(
            "{name}: this is a folder; name a file in it"
        )));
    }
    let folder = folder_of(path);
    if folder.is_dir() {
        return Ok(());
    }
    let (name, folder) = (shown(path), shown(folder));
    Err(Failure::Output(format!(
        "{name}: the folder {folder} does not exist; create it first"
    )))
}

/// Writes the bytes.
pub(crate) fn write(destination: &Destination, bytes: &[u8]) -> Result<(), Failure> {
    match destination {
        Destination::StandardOutput => {
            let mut out = io::stdout().lock();
            out.write_all(bytes)
                .and_then(|()| out.flush())
                .map_err(|error| {
                    Failure::Output(format!(
                        "standard output: {error}; check the program that reads it"
                    ))
                })
        }
        Destination::File(path) => write_whole(path, bytes).map_err(|error| {
            let name = shown(path);
            Failure::Output(format!(
                "{name}: {error}; check the folder, its permissions and space"
            ))
        }),
    }
}

/// Writes a temporary file in the same folder, then renames it, so that other processes see the old
/// file or the new one. Links are followed. A device or pipe is written in place, because it must
/// not be replaced.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file()) {
        return OpenOptions::new().write(true).open(&path)?.write_all(bytes);
    }
    let (part, file) = create_part(&path)?;
    let written = { file }
        .write_all(bytes)
        .and_then(|()| fs::rename(&part, &path));
    if written.is_err() {
        // The first error is reported; removing the temporary file may fail.
        let _ = fs::remove_file(&part);
    }
    written
}

/// Creates the temporary file: hidden, in the same folder, and always a new file, so that no
/// existing file or link is overwritten.
fn create_part(path: &Path) -> io::Result<(PathBuf, File)> {
    const MOST_TRIES: u32 = 100;
    let mut tries = 0;
    loop {
        let mut name = std::ffi::OsString::from(".");
        name.push(path.file_name().unwrap_or_default());
        name.push(format!(".{}.{tries}.part", std::process::id()));
        let part = path.with_file_name(name);
        match OpenOptions::new().write(true).create_new(true).open(&part) {
            Ok(file) => return Ok((part, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tries < MOST_TRIES => {
                tries += 1;
            }
            Err(error) => return Err(error),
        }
    }
}

/// Removes temporary files that killed processes left in a folder. Those of processes that run
/// stay; where it is unknown which ones run, all stay.
pub(crate) fn remove_abandoned(folder: &Path) {
    if !Path::new("/proc/self").exists() {
        return;
    }
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let process = name.to_str().and_then(process_of_part);
        let is_abandoned =
            process.is_some_and(|process| !Path::new("/proc").join(process).exists());
        if is_abandoned {
            // If it cannot be removed, it stays.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process in the name of a temporary file: `.NAME.PROCESS.TRY.part`.
fn process_of_part(name: &str) -> Option<&str> {
    let name = name.strip_prefix('.')?.strip_suffix(".part")?;
    let mut parts = name.rsplit('.');
    let (number, process) = (parts.next()?, parts.next()?);
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (is_number(number) && is_number(process) && parts.next().is_some()).then_some(process)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
