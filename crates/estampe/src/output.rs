//! Output files, written completely or not at all.

use crate::failure::Failure;
use crate::interrupt::Part;
use crate::terminal;
use crate::values::{Destination, shown};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::LazyLock;
use twox_hash::XxHash3_128;

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
        remove_abandoned(folder);
        return Ok(());
    }
    let (name, folder) = (shown(path), shown(folder));
    Err(Failure::Output(format!(
        "{name}: the folder {folder} does not exist; create it first"
    )))
}

/// Refuses a destination that is one of the files that are read, through links too.
pub(crate) fn check_inputs<'p>(
    destination: &Destination,
    inputs: impl IntoIterator<Item = &'p Path>,
) -> Result<(), Failure> {
    let Destination::File(path) = destination else {
        return Ok(());
    };
    // A destination that does not exist is no input.
    let Some(identity) = Identity::of(path) else {
        return Ok(());
    };
    let is_it = |input: &&Path| Identity::of(input).as_ref() == Some(&identity);
    match inputs.into_iter().find(is_it) {
        Some(input) => Err(Failure::Usage(format!(
            "{}: this is the input {}, which would be overwritten; name another output",
            shown(path),
            shown(input)
        ))),
        None => Ok(()),
    }
}

/// A regular file, whatever its path: its number where the system has one, else its canonical path.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Identity(
    #[cfg(unix)] (u64, u64),
    #[cfg(not(unix))] std::path::PathBuf,
);

impl Identity {
    /// `None` if there is no regular file.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            Some(Self((metadata.dev(), metadata.ino())))
        }
        #[cfg(not(unix))]
        {
            drop(metadata);
            fs::canonicalize(path).ok().map(Self)
        }
    }
}

/// Writes a report for people or programs to standard output. A reader that has enough and closes
/// it, such as `head`, is no error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let text = terminal::lines(text);
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Output(format!(
            "the report: {error}; check the program that reads standard output"
        ))),
        _ => Ok(()),
    }
}

/// Writes the bytes.
pub(crate) fn write(destination: &Destination, bytes: &[u8]) -> Result<(), Failure> {
    write_with(destination, |out| Ok(out.write_all(bytes)?))
}

/// The reason why an output was not written: the output's, or that there is nothing to write.
#[derive(Debug)]
pub(crate) enum Unwritten {
    /// The output fails.
    Io(io::Error),
    /// What was to be written failed.
    Failed(Failure),
}

impl From<io::Error> for Unwritten {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Failure> for Unwritten {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

/// Writes what `fill` writes, piece by piece. A file is there as a whole, or not at all.
pub(crate) fn write_with(
    destination: &Destination,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), Unwritten>,
) -> Result<(), Failure> {
    let (written, name, advice) = match destination {
        Destination::StandardOutput => {
            let written = filled(io::stdout().lock(), fill);
            let name = "standard output".to_owned();
            (written, name, "check the program that reads it")
        }
        Destination::File(path) => (
            write_whole(path, fill),
            shown(path),
            "check the folder, its permissions and space",
        ),
    };
    written.map_err(|reason| match reason {
        Unwritten::Io(error) => Failure::Output(format!("{name}: {error}; {advice}")),
        Unwritten::Failed(failure) => failure,
    })
}

/// Fills an output through a buffer.
fn filled(
    out: impl Write,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), Unwritten>,
) -> Result<(), Unwritten> {
    let mut out = BufWriter::new(out);
    fill(&mut out)?;
    Ok(out.flush()?)
}

/// Writes a temporary file in the same folder, then renames it, so that other processes see the old
/// file or the new one. Links are followed, and the permissions of the old file stay. A device or
/// pipe is written in place, because it must not be replaced.
fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), Unwritten>,
) -> Result<(), Unwritten> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let old = fs::metadata(&path).ok();
    if old.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        return filled(OpenOptions::new().write(true).open(&path)?, fill);
    }
    let (part, file) = create_part(&path)?;
    let permitted = match old {
        // Before there is anything to read in it.
        Some(metadata) => fs::set_permissions(part.path(), metadata.permissions()),
        None => Ok(()),
    };
    let written = { permitted.map_err(Unwritten::from) }.and_then(|()| filled(file, fill));
    let written = written.and_then(|()| Ok(fs::rename(part.path(), &path)?));
    if written.is_err() {
        // The first error is reported; removing the temporary file may fail.
        let _ = fs::remove_file(part.path());
    }
    written
}

/// Creates the temporary file: hidden, in the same folder, and always a new file, so that no
/// existing file or link is overwritten.
fn create_part(path: &Path) -> io::Result<(Part, File)> {
    const MOST_TRIES: u32 = 100;
    let mut tries = 0;
    loop {
        let mut name = std::ffi::OsString::from(".");
        name.push(path.file_name().unwrap_or_default());
        name.push(format!(".{}.{}.{tries}.part", host(), std::process::id()));
        let part = Part::create(path.with_file_name(name), |part| {
            OpenOptions::new().write(true).create_new(true).open(part)
        });
        match part {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tries < MOST_TRIES => {
                tries += 1;
            }
            result => return result,
        }
    }
}

/// Removes temporary files that killed processes of this host left in a folder. Those of processes
/// that run stay, and so do those of other hosts, which may share the folder; where it is unknown
/// which processes run, all stay.
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
        let process = name.to_str().and_then(|name| process_of_part(name, host()));
        let is_abandoned =
            process.is_some_and(|process| !Path::new("/proc").join(process).exists());
        if is_abandoned {
            // If it cannot be removed, it stays.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process in the name of a temporary file of this host: `.NAME.HOST.PROCESS.TRY.part`.
fn process_of_part<'n>(name: &'n str, host: &str) -> Option<&'n str> {
    let name = name.strip_prefix('.')?.strip_suffix(".part")?;
    let mut parts = name.rsplit('.');
    let (number, process, of) = (parts.next()?, parts.next()?, parts.next()?);
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_part = is_number(number) && is_number(process) && of == host && parts.next().is_some();
    is_part.then_some(process)
}

/// Tells hosts and containers apart, whose processes have the same numbers: a digest of the boot's
/// name and of the namespace of processes.
fn host() -> &'static str {
    static HOST: LazyLock<String> = LazyLock::new(|| {
        let mut bytes = fs::read("/proc/sys/kernel/random/boot_id").unwrap_or_default();
        let space = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
        bytes.extend_from_slice(space.as_os_str().as_encoded_bytes());
        format!("{:032x}", XxHash3_128::oneshot(&bytes))[..12].to_owned()
    });
    &HOST
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::process_of_part;

    #[test]
    fn temporary_files_of_this_host_are_recognised() {
        let process = |name| process_of_part(name, "0af3");
        assert_eq!(process(".one.png.0af3.417.0.part"), Some("417"));
        assert_eq!(process(".a.b.0af3.1.99.part"), Some("1"));
        for other in [
            ".one.png.77fe.417.0.part",
            "one.png.0af3.417.0.part",
            ".0af3.417.0.part",
            ".one.png.0af3.x.0.part",
            ".one.png.0af3.417..part",
            ".one.png.0af3.417.0",
            "notes.part",
            ".part",
        ] {
            assert_eq!(process(other), None, "{other}");
        }
    }
}
