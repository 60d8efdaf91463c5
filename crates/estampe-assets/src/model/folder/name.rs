//! Names of files as models write them: paths of any system.

use std::path::{Path, PathBuf};

use crate::model::resources::ResourceError;

/// Longer than any real path; longer names are refused.
const MAX_NAME_BYTES: usize = 4096;
const MAX_DEPTH: usize = 64;

/// The parts of a path.
pub(super) enum Parts<'n> {
    /// Those of a relative path that goes down only.
    Below(Vec<&'n str>),
    /// Those of a path that is absolute or contains `..`.
    Leading(Vec<&'n str>),
}

fn is_separator(c: char) -> bool {
    c == '/' || c == '\\'
}

/// Divides a path at `/` and `\`.
///
/// # Errors
/// `NotFound` for names that no file has, `Outside` for drives and very deep paths.
pub(super) fn parts(name: &str) -> Result<Parts<'_>, ResourceError> {
    if name.is_empty() || name.len() > MAX_NAME_BYTES || name.contains('\0') {
        return Err(ResourceError::NotFound);
    }
    let parts = name
        .split(is_separator)
        .filter(|part| !part.is_empty() && *part != ".");
    let parts: Vec<&str> = parts.collect();
    // A colon means a drive or a stream on Windows, and is unusual elsewhere.
    if parts.len() > MAX_DEPTH || parts.iter().any(|part| part.contains(':')) {
        return Err(ResourceError::Outside);
    }
    let is_leading = name.starts_with(is_separator) || parts.contains(&"..");
    Ok(match is_leading {
        true => Parts::Leading(parts),
        false => Parts::Below(parts),
    })
}

/// `from` with the parts of a path behind it, of which `..` removes one. The result is text: no
/// link is followed.
pub(super) fn joined(from: &Path, parts: &[&str]) -> Option<PathBuf> {
    let mut path = from.to_owned();
    for part in parts {
        match *part {
            ".." if !path.pop() => return None,
            ".." => {}
            part => path.push(part),
        }
    }
    Some(path)
}

/// The last part of a path, which may begin with a drive.
pub(super) fn last(name: &str) -> Option<&str> {
    let is_end = |c: char| is_separator(c) || c == ':';
    let last = name.rsplit(is_end).find(|part| !part.is_empty())?;
    let is_name = last != "." && last != ".." && !last.contains('\0');
    (is_name && name.len() <= MAX_NAME_BYTES).then_some(last)
}

/// The parts of a path from its end on, in lower case.
pub(super) fn reversed(name: &str) -> impl Iterator<Item = String> {
    let parts = name.rsplit(|c| is_separator(c) || c == ':');
    parts.filter(|part| !part.is_empty()).map(str::to_lowercase)
}
