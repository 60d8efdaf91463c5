//! The files in a folder and below, by their names.

use std::collections::{HashMap, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};

use super::name;

/// The most entries of a folder and all below it that are looked at.
const MAX_ENTRIES: usize = 10_000;
/// The most folders within each other.
const MAX_DEPTH: usize = 16;

/// The files below a folder, listed once.
#[derive(Debug, Clone)]
pub(super) struct Index {
    /// Canonical.
    root: PathBuf,
    /// By names in lower case: paths below the root, the nearest ones first, in the order of names.
    files: HashMap<String, Vec<String>>,
    shown: String,
}

impl Index {
    /// Lists the files below the canonical path `root`. Links to folders are not followed, and
    /// names that begin with a point are left out. A folder with more entries than are left of the
    /// most is the end of the list, so that the list does not depend on the order of the system.
    pub(super) fn new(root: PathBuf, mut shown: String) -> Self {
        let mut files: HashMap<String, Vec<String>> = HashMap::new();
        let mut left = MAX_ENTRIES;
        let mut folders = VecDeque::from([(String::new(), 0)]);
        while let Some((folder, depth)) = folders.pop_front() {
            let Some(entries) = list(&root.join(&folder), left) else {
                shown += &format!(" (of which the first {} entries)", MAX_ENTRIES - left);
                break;
            };
            left -= entries.len();
            for (entry, is_folder) in entries {
                let path = match folder.as_str() {
                    "" => entry.clone(),
                    folder => format!("{folder}/{entry}"),
                };
                if !is_folder {
                    files.entry(entry.to_lowercase()).or_default().push(path);
                } else if depth < MAX_DEPTH {
                    folders.push_back((path, depth + 1));
                }
            }
        }
        Self { root, files, shown }
    }

    /// The canonical path of the file that shares most parts of the path `wanted`, counted from the
    /// end; of several the nearest one. Links that lead out of the folder are no files.
    pub(super) fn best(&self, wanted: &str) -> Option<PathBuf> {
        let found = self.files.get(&name::last(wanted)?.to_lowercase())?;
        let shared = |path: &String| {
            let pairs = name::reversed(path).zip(name::reversed(wanted));
            let count = pairs.take_while(|(a, b)| a == b).count();
            (
                count,
                wanted.ends_with(path.rsplit('/').next().unwrap_or_default()),
            )
        };
        let mut ranked: Vec<_> = found.iter().map(|path| (shared(path), path)).collect();
        ranked.sort_by(|(a, _), (b, _)| b.cmp(a));
        ranked.into_iter().find_map(|(_, path)| {
            let path = fs::canonicalize(self.root.join(path)).ok()?;
            (self.contains(&path) && path.is_file()).then_some(path)
        })
    }

    /// True if a canonical path is below the folder.
    pub(super) fn contains(&self, path: &Path) -> bool {
        path.starts_with(&self.root)
    }

    /// The folder's name in messages.
    pub(super) fn shown(&self) -> &str {
        &self.shown
    }
}

/// The names in a folder in their order, and whether each is a folder. `None` if there are more
/// than `most`.
fn list(folder: &Path, most: usize) -> Option<Vec<(String, bool)>> {
    // A folder that may not be read has no files for us.
    let Ok(entries) = fs::read_dir(folder) else {
        return Some(Vec::new());
    };
    let mut listed = Vec::new();
    for (at, entry) in entries.enumerate() {
        if at >= most {
            return None;
        }
        let Ok(entry) = entry else {
            continue;
        };
        // The type of a link is that of the link.
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if let Ok(name) = entry.file_name().into_string()
            && !name.starts_with('.')
        {
            listed.push((name, is_folder));
        }
    }
    listed.sort_unstable();
    Some(listed)
}
