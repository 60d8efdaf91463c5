//! The files of a package beside its program and the notices.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::archive::Entry;
use super::located;

/// The shells, and the names under which they look for the script.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "completions/estampe.bash"),
    ("elvish", "completions/estampe.elv"),
    ("fish", "completions/estampe.fish"),
    ("powershell", "completions/_estampe.ps1"),
    ("zsh", "completions/_estampe"),
];

/// Files of the repository, and their names in the package. The README is that of the command,
/// whose links lead nowhere else.
const COPIED: &[(&str, &str)] = &[
    ("CHANGELOG.md", "CHANGELOG.md"),
    ("LICENSE-APACHE", "LICENSE-APACHE"),
    ("LICENSE-MIT", "LICENSE-MIT"),
    ("crates/estampe/README.md", "README.md"),
    (
        "crates/estampe/desktop/estampe.thumbnailer",
        "thumbnailers/estampe.thumbnailer",
    ),
    (
        "crates/estampe/desktop/estampe.xml",
        "mime/packages/estampe.xml",
    ),
];

/// The completion scripts and manual pages that the program writes, pages by way of a folder in
/// `scratch`.
pub(super) fn of_commands(program: &Path, scratch: &Path) -> Result<Vec<Entry>, Box<dyn Error>> {
    let mut entries = Vec::new();
    for (shell, path) in COMPLETIONS {
        let script = output(Command::new(program).args(["completions", shell]))?;
        entries.push(Entry::file(path, script));
    }
    let pages = scratch.join(".pages");
    remove(&pages)?;
    output(Command::new(program).args(["man", "--output"]).arg(&pages))?;
    for entry in fs::read_dir(&pages).map_err(|error| located(&pages, error))? {
        let entry = entry?;
        let page = fs::read(entry.path()).map_err(|error| located(&entry.path(), error))?;
        let path = format!("man/{}", entry.file_name().to_string_lossy());
        entries.push(Entry::file(&path, page));
    }
    remove(&pages)?;
    Ok(entries)
}

/// The files that are copied from the repository.
pub(super) fn of_repository(root: &Path) -> Result<Vec<Entry>, Box<dyn Error>> {
    let mut entries = Vec::new();
    for (from, to) in COPIED {
        let from = root.join(from);
        let bytes = fs::read(&from).map_err(|error| located(&from, error))?;
        entries.push(Entry::file(to, bytes));
    }
    Ok(entries)
}

/// Writes the package's folder anew.
pub(super) fn write(folder: &Path, entries: &[Entry]) -> Result<(), Box<dyn Error>> {
    remove(folder)?;
    for entry in entries {
        let path = folder.join(&entry.path);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(|error| located(parent, error))?;
        fs::write(&path, &entry.bytes).map_err(|error| located(&path, error))?;
        if entry.is_program {
            allow_execution(&path)?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn allow_execution(path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o755))
}

/// On other systems the name alone makes a program.
#[cfg(not(unix))]
fn allow_execution(_: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Removes a folder of an earlier run.
fn remove(folder: &Path) -> Result<(), String> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(located(folder, error)),
        _ => Ok(()),
    }
}

/// The standard output of a command that succeeds.
fn output(command: &mut Command) -> Result<Vec<u8>, Box<dyn Error>> {
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("{command:?}: {}", output.status).into());
    }
    Ok(output.stdout)
}

#[cfg(test)]
mod tests {
    use super::*;
    use xtask::Repository;

    #[test]
    fn every_copied_file_exists() {
        let repository = Repository::of_this_build().expect("the repository can be read");
        let entries = of_repository(repository.root()).expect("the files can be read");
        assert_eq!(entries.len(), COPIED.len());
        assert!(entries.iter().all(|entry| !entry.bytes.is_empty()));
    }
}
