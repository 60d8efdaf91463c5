//! Records of pictures that are up to date: what each was made of, as digests.
//!
//! The record of `out/x.png` is `out/.estampe/x.png.json`. It has the digests of the options, of
//! the model's file, of each file that the model named, and of the picture itself, and where its
//! textures were found. It is written
//! after the picture, whole or not at all: whatever a killed process leaves, a picture without its
//! right record is drawn again.

use super::plan::Picture;
use crate::output;
use crate::values::Destination;
use estampe_assets::model::{Folder, ResourceError, Resources};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use twox_hash::XxHash3_128;

/// The digest of bytes, for comparison with itself alone.
pub(super) fn digest(bytes: &[u8]) -> String {
    format!("{:032x}", XxHash3_128::oneshot(bytes))
}

/// The files that a model names, with the digests of those that it read.
pub(super) struct NamedFiles {
    folder: Folder,
    read: Mutex<BTreeMap<String, Option<String>>>,
    searched: Mutex<BTreeMap<String, Option<String>>>,
}

impl NamedFiles {
    pub(super) fn new(folder: Folder) -> Self {
        Self {
            folder,
            read: Mutex::default(),
            searched: Mutex::default(),
        }
    }

    /// The names with the digests; none of files that could not be read.
    pub(super) fn digests(&self) -> BTreeMap<String, Option<String>> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.clone()
    }

    /// The names of textures that were searched, with the files that were found.
    pub(super) fn searched(&self) -> BTreeMap<String, Option<String>> {
        let searched = self.searched.lock();
        searched.unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn note(&self, name: &str, digest: Option<String>) {
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(name.to_owned(), digest);
    }
}

impl Resources for NamedFiles {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        let resolved = self.folder.resolve(name);
        if resolved.is_err() {
            self.note(name, None);
        }
        resolved
    }

    fn search(&self, name: &str) -> Result<String, ResourceError> {
        let found = self.folder.search(name);
        let searched = self.searched.lock();
        let mut searched = searched.unwrap_or_else(PoisonError::into_inner);
        searched.insert(name.to_owned(), found.as_ref().ok().cloned());
        found
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let bytes = self.folder.read(resolved, max_bytes);
        self.note(resolved, bytes.as_ref().ok().map(|bytes| digest(bytes)));
        bytes
    }
}

/// What a picture is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Sources {
    /// Of the options and versions.
    pub(super) options: String,
    /// Of the model's file.
    pub(super) model: String,
    /// Of the files that the model named; none if one was missing.
    pub(super) named: BTreeMap<String, Option<String>>,
    /// The files that were found for names of textures; none if there was none.
    pub(super) searched: BTreeMap<String, Option<String>>,
}

/// The record's file.
fn path_of(picture: &Path) -> PathBuf {
    let mut name = picture.file_name().unwrap_or_default().to_owned();
    name.push(".json");
    picture.with_file_name(".estampe").join(name)
}

/// True if the picture is there, unchanged, and made of these options and this model, whose other
/// files are unchanged too.
pub(super) fn is_up_to_date(
    picture: &Picture,
    (options, model): (&str, &str),
    folder: &Folder,
    max_bytes: u64,
) -> bool {
    let Ok(text) = std::fs::read(path_of(&picture.output)) else {
        return false;
    };
    let Ok(record) = serde_json::from_slice::<Value>(&text) else {
        return false;
    };
    if record["options"] != options || record["model"] != model {
        return false;
    }
    let Some(named) = record["named"].as_object() else {
        return false;
    };
    let are_same = named.iter().all(|(name, known)| match known.as_str() {
        // The name is that which the folder found.
        Some(known) => folder
            .read(name, max_bytes)
            .is_ok_and(|bytes| digest(&bytes) == known),
        None => folder.resolve(name).is_err(),
    });
    // Pictures of versions without a search have no such record.
    let are_found = record["searched"].as_object().is_some_and(|searched| {
        let mut searched = searched.iter();
        searched.all(|(name, known)| folder.search(name).ok().as_deref() == known.as_str())
    });
    let drawn = std::fs::read(&picture.output);
    are_same && are_found && drawn.is_ok_and(|bytes| record["picture"] == digest(&bytes).as_str())
}

/// Writes the record of a picture. If that fails, the picture is drawn again next time.
pub(super) fn write(picture: &Path, bytes: &[u8], sources: &Sources) {
    let path = path_of(picture);
    let record = json!({
        "picture": digest(bytes),
        "options": sources.options,
        "model": sources.model,
        "named": sources.named,
        "searched": sources.searched,
    });
    if let Some(folder) = path.parent() {
        let _ = std::fs::create_dir_all(folder);
    }
    let _ = output::write(&Destination::File(path), record.to_string().as_bytes());
}
