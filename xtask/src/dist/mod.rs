//! The package of the command: the program with its completion scripts, manual pages, thumbnailer
//! and licences, as a folder and as an archive.
//!
//! The same sources and compiler give the same archive: its files have a fixed order, time and
//! owner, and the program contains no path of the machine that built it.

mod archive;
mod build;
mod checksums;
mod contents;
mod glibc;
mod notices;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use archive::Entry;

/// A package that was written.
#[derive(Debug)]
pub(crate) struct Dist {
    /// The folder.
    pub(crate) folder: PathBuf,
    /// The compressed archive of the folder.
    pub(crate) archive: PathBuf,
    /// The checksums of all archives beside it.
    pub(crate) checksums: PathBuf,
    /// What the program needs of the C library, as a sentence; absent for formats other than ELF.
    pub(crate) requirement: Option<String>,
}

/// Builds the command for a target, or for this machine, and writes its package into `target/dist`.
pub(crate) fn write(root: &Path, target: Option<&str>) -> Result<Dist, Box<dyn Error>> {
    let host = build::host()?;
    let target = target.unwrap_or(&host);
    let program = build::program(root, target)?;
    let runnable = build::runnable(root, &program, target, &host)?;
    let all = root.join("target/dist");
    fs::create_dir_all(&all)?;

    let bytes = fs::read(&program).map_err(|error| located(&program, error))?;
    let requirement = glibc::requirement(&bytes)?;
    let name = format!("estampe-{}-{target}", env!("CARGO_PKG_VERSION"));
    let mut entries = contents::of_commands(&runnable, &all)?;
    entries.extend(contents::of_repository(root)?);
    entries.push(Entry::file(
        "THIRD-PARTY-NOTICES.txt",
        notices::of(root, target)?,
    ));
    let program_name = program.file_name().ok_or("the program has no name")?;
    entries.push(Entry::program(&program_name.to_string_lossy(), bytes));
    entries.sort_by(|a, b| a.path.cmp(&b.path));

    let folder = all.join(&name);
    contents::write(&folder, &entries)?;
    let archive = all.join(format!("{name}.tar.gz"));
    fs::write(&archive, archive::tar_gz(&name, &entries)?)
        .map_err(|error| located(&archive, error))?;
    let checksums = checksums::write(&all)?;
    Ok(Dist {
        folder,
        archive,
        checksums,
        requirement,
    })
}

/// An error of a file, with its path.
fn located(path: &Path, error: std::io::Error) -> String {
    format!("{}: {error}", path.display())
}
