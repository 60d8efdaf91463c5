//! The files of a model on a disk: regular files below its own folder, and below folders that the
//! user names.
//!
//! ```text
//!   resolve   the path as it is written:  model's folder, then each root
//!   search    its last part alone:        model's folder and below, textures/ beside it, each root
//! ```
//!
//! Textures are searched because exporters write the paths of another machine. Nothing outside of
//! these folders is opened, whatever a model names and wherever links lead.

mod index;
mod name;

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use self::index::Index;
use super::resources::{ResourceError, Resources};

/// The regular files below one folder, and below further roots.
///
/// Both `/` and `\` separate the names of folders. A name that leads out of all of the folders is
/// refused, and so is a link that leads out of its folder. If no file has the exact name, a file
/// whose name differs in upper and lower case is used (the first in the order of names).
#[derive(Debug, Clone)]
pub struct Folder {
    /// The model's folder.
    own: Option<Root>,
    roots: Vec<Root>,
    /// The places of [`Resources::search`], listed when they are first needed.
    places: OnceLock<Vec<Index>>,
}

/// A folder in which files may be opened.
#[derive(Debug, Clone)]
struct Root {
    /// As the user wrote it, made absolute.
    given: PathBuf,
    /// Canonical, so that canonical paths of files can be compared with it.
    canonical: PathBuf,
    /// For messages.
    shown: String,
}

impl Root {
    fn new(path: &Path) -> Option<Self> {
        Some(Self {
            given: std::path::absolute(path).ok()?,
            canonical: fs::canonicalize(path).ok()?,
            shown: path.display().to_string(),
        })
    }
}

impl Folder {
    /// Names of folders with textures, beside the folder of a model.
    const TEXTURE_FOLDERS: [&str; 4] = ["textures", "Textures", "texture", "Texture"];

    /// The files below `root`.
    #[must_use]
    pub fn new(root: &Path) -> Self {
        Self {
            own: Root::new(root),
            ..Self::none()
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

    /// No files, for a model from a pipe; [`Self::with_roots`] adds some.
    #[must_use]
    pub fn none() -> Self {
        Self {
            own: None,
            roots: Vec::new(),
            places: OnceLock::new(),
        }
    }

    /// Adds folders in which files of the model may be looked for, in this order, after its own.
    /// Those that do not exist have no files.
    #[must_use]
    pub fn with_roots<P: AsRef<Path>>(mut self, roots: &[P]) -> Self {
        let roots = roots.iter().filter_map(|root| Root::new(root.as_ref()));
        self.roots.extend(roots);
        self.places = OnceLock::new();
        self
    }

    fn all(&self) -> impl Iterator<Item = &Root> {
        self.own.iter().chain(&self.roots)
    }

    /// The path of `name`, with links followed, always below one of the folders.
    fn find(&self, name: &str) -> Result<PathBuf, ResourceError> {
        if self.all().next().is_none() {
            return Err(ResourceError::Unavailable);
        }
        let parts = match name::parts(name)? {
            name::Parts::Below(parts) => parts,
            name::Parts::Leading(up) => return self.find_leading(name, &up),
        };
        let mut found = Err(ResourceError::Unavailable);
        for root in self.all() {
            let next = walk(&root.canonical, &parts);
            if next.is_ok() {
                return next;
            }
            // The reason in the model's own folder is the one to report.
            if found == Err(ResourceError::Unavailable) {
                found = next;
            }
        }
        found
    }

    /// The file of a path that is absolute or contains `..`, if that is below one of the folders.
    /// The path is compared as text, so that no folder outside is read.
    fn find_leading(&self, name: &str, parts: &[&str]) -> Result<PathBuf, ResourceError> {
        let starts = |root: &Root| [root.given.clone(), root.canonical.clone()];
        let from = self.own.iter().flat_map(starts);
        let targets: Vec<PathBuf> = match name.starts_with(['/', '\\']) {
            true => name::joined(Path::new("/"), parts).into_iter().collect(),
            false => from.filter_map(|from| name::joined(&from, parts)).collect(),
        };
        let mut found = Err(ResourceError::Outside);
        for root in self.all() {
            let below = targets.iter().flat_map(|target| {
                let starts = [&root.given, &root.canonical].into_iter();
                starts.filter_map(|start| target.strip_prefix(start).ok())
            });
            for below in below {
                let parts: Option<Vec<&str>> = below.iter().map(|part| part.to_str()).collect();
                let Some(parts) = parts.filter(|parts| !parts.is_empty()) else {
                    continue;
                };
                found = walk(&root.canonical, &parts);
                if found.is_ok() {
                    return found;
                }
            }
        }
        found
    }

    /// The folders that are searched.
    fn places(&self) -> &[Index] {
        self.places.get_or_init(|| {
            let own = self.own.iter().map(|own| {
                let shown = "the model's folder".to_owned();
                Index::new(own.canonical.clone(), shown)
            });
            let beside = self.own.iter().flat_map(|own| {
                let parent = own.canonical.parent();
                let named = Self::TEXTURE_FOLDERS.iter().filter_map(move |name| {
                    let path = fs::canonicalize(parent?.join(name)).ok()?;
                    // Where case does not count, four names are one folder.
                    let is_beside = path.parent() == parent && path.is_dir();
                    (is_beside && path != own.canonical).then_some(path)
                });
                let mut named: Vec<PathBuf> = named.collect();
                named.dedup();
                named
            });
            let beside = beside.map(|path| {
                let name = path.file_name().unwrap_or_default().display();
                let shown = format!("`../{name}`");
                Index::new(path, shown)
            });
            let roots = self.roots.iter().map(|root| {
                let shown = format!("the root `{}`", root.shown);
                Index::new(root.canonical.clone(), shown)
            });
            own.chain(beside).chain(roots).collect()
        })
    }

    /// True if files at this canonical path may be opened.
    fn contains(&self, path: &Path) -> bool {
        self.all().any(|root| path.starts_with(&root.canonical))
            || self.places().iter().any(|place| place.contains(path))
    }
}

/// The canonical path of the entry `parts` below `root`.
fn walk(root: &Path, parts: &[&str]) -> Result<PathBuf, ResourceError> {
    let mut path = root.to_owned();
    for part in parts {
        path = step(&path, part)?;
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

/// The path as text, if it is a regular file.
fn regular(path: PathBuf) -> Result<String, ResourceError> {
    // The type is tested before the file is opened: opening a pipe would wait for its writer.
    let metadata = fs::metadata(&path).map_err(|error| ResourceError::Io(error.to_string()))?;
    if !metadata.is_file() {
        return Err(ResourceError::NotRegular);
    }
    path.into_os_string()
        .into_string()
        .map_err(|_| ResourceError::Io("its path is not Unicode".to_owned()))
}

impl Resources for Folder {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        regular(self.find(name)?)
    }

    fn search(&self, name: &str) -> Result<String, ResourceError> {
        let Some(own_name) = name::last(name) else {
            return Err(ResourceError::NotFound);
        };
        if self.all().next().is_none() {
            return Err(ResourceError::Unavailable);
        }
        for place in self.places() {
            if let Some(found) = place.best(name).and_then(|path| regular(path).ok()) {
                return Ok(found);
            }
        }
        let shown: Vec<&str> = self.places().iter().map(Index::shown).collect();
        Err(ResourceError::NotFoundIn {
            name: own_name.to_owned(),
            places: match shown.split_last() {
                Some((last, [])) => format!("{last} or below"),
                Some((last, first)) => format!("{} or {last}, or below", first.join(", ")),
                None => String::new(),
            },
        })
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let failed = |error: std::io::Error| ResourceError::Io(error.to_string());
        if self.all().next().is_none() {
            return Err(ResourceError::Unavailable);
        }
        let path = fs::canonicalize(resolved).map_err(failed)?;
        if !self.contains(&path) {
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
