//! The repository as the checks see it: a root folder and the text files that belong to it.
//!
//! Files are found by walking, not by asking git, so that a check also sees a file that is not yet
//! added, and runs where there is no git. Build output and hidden folders are left out.

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders that hold no source of ours. `fixtures` and `corpus` folders hold input of tests.
const SKIPPED_FOLDERS: &[&str] = &["target", "corpus", "fixtures", "goldens"];

/// Endings of the files that the checks read.
const TEXT_ENDINGS: &[&str] = &["rs", "md", "toml"];

/// One text file.
#[derive(Debug, Clone)]
pub(crate) struct TextFile {
    /// Relative to the root, with `/` between the parts.
    pub(crate) path: PathBuf,
    /// The whole text.
    pub(crate) text: String,
}

impl TextFile {
    /// Returns true if the file's name ends in `.ending`.
    pub(crate) fn has_ending(&self, ending: &str) -> bool {
        self.path.extension().is_some_and(|found| found == ending)
    }

    /// Returns true if the file holds only tests: `tests.rs`, `tests_*.rs`, or anything below a
    /// `tests` or `benches` folder.
    pub(crate) fn is_test(&self) -> bool {
        let in_test_folder = self
            .path
            .iter()
            .any(|part| part == "tests" || part == "benches");
        let stem = self
            .path
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        in_test_folder || stem.is_some_and(|stem| stem == "tests" || stem.starts_with("tests_"))
    }
}

/// The root folder and every text file in it, read once.
#[derive(Debug, Clone)]
pub struct Repository {
    root: PathBuf,
    files: Vec<TextFile>,
}

impl Repository {
    /// Reads the text files below `root`.
    ///
    /// # Errors
    /// A folder or file that cannot be read, or a text file that is not UTF-8.
    pub fn open(root: impl Into<PathBuf>) -> Result<Self, RepositoryError> {
        let root = root.into();
        let mut files = Vec::new();
        walk(&root, &root, &mut files)?;
        files.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(Self { root, files })
    }

    /// The repository that this program was built in.
    ///
    /// # Errors
    /// See [`Repository::open`].
    pub fn of_this_build() -> Result<Self, RepositoryError> {
        let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
        Self::open(xtask.parent().expect("xtask lies in the workspace's root"))
    }

    /// A repository that exists only in memory: what the tests of the checks are made of. Its root
    /// does not exist, so that no path outside `files` is found.
    #[cfg(test)]
    pub(crate) fn synthetic(files: &[(&str, &str)]) -> Self {
        let files = files
            .iter()
            .map(|&(path, text)| TextFile {
                path: path.into(),
                text: text.to_owned(),
            })
            .collect();
        Self {
            root: PathBuf::from("/nonexistent-root-of-a-synthetic-repository"),
            files,
        }
    }

    /// The root folder.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Every text file, sorted by path.
    pub(crate) fn files(&self) -> impl Iterator<Item = &TextFile> {
        self.files.iter()
    }

    /// Every Rust source, sorted by path.
    pub(crate) fn rust_files(&self) -> impl Iterator<Item = &TextFile> {
        self.files().filter(|file| file.has_ending("rs"))
    }

    /// The text file at `path`.
    pub(crate) fn file(&self, path: impl AsRef<Path>) -> Option<&TextFile> {
        self.files.iter().find(|file| file.path == path.as_ref())
    }

    /// Returns true if `path`, relative to the root, names a file or folder.
    pub(crate) fn exists(&self, path: &Path) -> bool {
        self.files.iter().any(|file| file.path.starts_with(path)) || self.root.join(path).exists()
    }
}

fn walk(root: &Path, folder: &Path, files: &mut Vec<TextFile>) -> Result<(), RepositoryError> {
    let located = |path: &Path| {
        let path = path.to_owned();
        move |source| RepositoryError { path, source }
    };
    for entry in fs::read_dir(folder).map_err(located(folder))? {
        let entry = entry.map_err(located(folder))?;
        let (name, path) = (entry.file_name(), entry.path());
        let is_hidden = name.to_string_lossy().starts_with('.');
        let kind = entry.file_type().map_err(located(&path))?;
        if kind.is_dir() {
            if !is_hidden && !SKIPPED_FOLDERS.iter().any(|skipped| name == *skipped) {
                walk(root, &path, files)?;
            }
        } else if kind.is_file()
            && path
                .extension()
                .is_some_and(|e| TEXT_ENDINGS.iter().any(|ending| e == *ending))
        {
            let text = fs::read_to_string(&path).map_err(located(&path))?;
            let path = path
                .strip_prefix(root)
                .expect("the walk starts at the root")
                .to_owned();
            files.push(TextFile { path, text });
        }
    }
    Ok(())
}

/// A part of the repository could not be read.
#[derive(Debug)]
pub struct RepositoryError {
    path: PathBuf,
    source: io::Error,
}

impl fmt::Display for RepositoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot read {}: {}", self.path.display(), self.source)
    }
}

impl std::error::Error for RepositoryError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.source)
    }
}
