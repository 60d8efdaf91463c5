//! Access to the side files of a model: regular files below its own folder only.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A source of a model's side files.
pub trait Resources {
    /// Finds the file that a model calls `name`, and returns one name per file for all its
    /// spellings.
    ///
    /// # Errors
    /// The reason why the file cannot or must not be opened.
    fn resolve(&self, name: &str) -> Result<String, ResourceError>;

    /// The bytes of a file that [`Self::resolve`] found, if there are at most `max_bytes`.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError>;
}

/// The reason why a side file is not opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResourceError {
    /// The input has no folder (it came from a pipe).
    #[error("side files are not available for this input")]
    Unavailable,
    /// No file of that name.
    #[error("no such file in the model's folder")]
    NotFound,
    /// The name leads out of the model's folder.
    #[error("it is outside the model's folder; side files are read from that folder only")]
    Outside,
    /// A folder, a device, a pipe.
    #[error("it is not a regular file")]
    NotRegular,
    /// Larger than allowed.
    #[error("it is larger than the limit of {0} bytes")]
    TooLarge(u64),
    /// The system's message.
    #[error("{0}")]
    Io(String),
}

/// No side files, for models from a pipe.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoResources;

impl Resources for NoResources {
    fn resolve(&self, _name: &str) -> Result<String, ResourceError> {
        Err(ResourceError::Unavailable)
    }

    fn read(&self, _resolved: &str, _max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        Err(ResourceError::Unavailable)
    }
}

/// The regular files below one folder.
///
/// Both `/` and `\` separate the names of folders. A name that is absolute or contains `..` is
/// refused, and so is a link that leads out of the folder. If no file has the exact name, a file
/// whose name differs in upper and lower case is used (the first in the order of names).
#[derive(Debug, Clone)]
pub struct Folder {
    /// Canonical, so that canonical paths of files can be compared with it.
    root: Option<PathBuf>,
}

impl Folder {
    /// Longer than any real path; longer names are refused.
    const MAX_NAME_BYTES: usize = 4096;
    const MAX_DEPTH: usize = 64;

    /// The files below `root`.
    #[must_use]
    pub fn new(root: &Path) -> Self {
        Self {
            root: fs::canonicalize(root).ok(),
        }
    }

    /// The files below the folder of the model at `path`.
    #[must_use]
    pub fn of_model(path: &Path) -> Self {
        match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => Self::new(parent),
            _ => Self::new(Path::new(".")),
        }
    }

    /// The path of `name`, with links followed, always below the root.
    fn find(&self, name: &str) -> Result<PathBuf, ResourceError> {
        let root = self.root.as_ref().ok_or(ResourceError::Unavailable)?;
        if name.is_empty() || name.len() > Self::MAX_NAME_BYTES || name.contains('\0') {
            return Err(ResourceError::NotFound);
        }
        let is_separator = |c: char| c == '/' || c == '\\';
        if name.starts_with(is_separator) || Path::new(name).is_absolute() {
            return Err(ResourceError::Outside);
        }
        let mut path = root.clone();
        let parts = name
            .split(is_separator)
            .filter(|part| !part.is_empty() && *part != ".");
        for (depth, part) in parts.enumerate() {
            // A colon means a drive or a stream on Windows, and is unusual elsewhere.
            if part == ".." || part.contains(':') || depth >= Self::MAX_DEPTH {
                return Err(ResourceError::Outside);
            }
            path = Self::step(&path, part)?;
            // Checked at every step, so that not even the names in an outside folder are read.
            if !path.starts_with(root) {
                return Err(ResourceError::Outside);
            }
        }
        Ok(path)
    }

    /// The canonical path of the entry `part` of `folder`, in another case if necessary.
    fn step(folder: &Path, part: &str) -> Result<PathBuf, ResourceError> {
        let exact = folder.join(part);
        if let Ok(path) = fs::canonicalize(&exact) {
            return Ok(path);
        }
        let wanted = part.to_lowercase();
        let entries = fs::read_dir(folder).map_err(|_| ResourceError::NotFound)?;
        let found = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|entry| entry.to_lowercase() == wanted)
            .min()
            .ok_or(ResourceError::NotFound)?;
        fs::canonicalize(folder.join(found)).map_err(|_| ResourceError::NotFound)
    }
}

impl Resources for Folder {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        let path = self.find(name)?;
        // The type is tested before the file is opened: opening a pipe would wait for its writer.
        let metadata = fs::metadata(&path).map_err(|error| ResourceError::Io(error.to_string()))?;
        if !metadata.is_file() {
            return Err(ResourceError::NotRegular);
        }
        path.into_os_string()
            .into_string()
            .map_err(|_| ResourceError::Io("its path is not Unicode".to_owned()))
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let failed = |error: std::io::Error| ResourceError::Io(error.to_string());
        let root = self.root.as_ref().ok_or(ResourceError::Unavailable)?;
        let path = fs::canonicalize(resolved).map_err(failed)?;
        if !path.starts_with(root) {
            return Err(ResourceError::Outside);
        }
        let metadata = fs::metadata(&path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(ResourceError::NotRegular);
        }
        if metadata.len() > max_bytes {
            return Err(ResourceError::TooLarge(max_bytes));
        }
        let mut bytes = Vec::new();
        let file = File::open(&path).map_err(failed)?;
        file.take(max_bytes.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(failed)?;
        if bytes.len() as u64 > max_bytes {
            return Err(ResourceError::TooLarge(max_bytes));
        }
        Ok(bytes)
    }
}
