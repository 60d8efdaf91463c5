//! Errors and warnings with the JSON Pointer of the value.

use super::document::Index;
use crate::AssetError;
use crate::model::load::Context;

const ADVICE: &str = "export the file again, or check it with a glTF validator";

/// The value at `pointer` breaks glTF's rules.
pub(super) fn malformed(pointer: impl Into<String>, what: impl Into<String>) -> AssetError {
    AssetError::malformed(what, ADVICE).at_json(pointer)
}

/// The element of a list; an error if there is none. `what` names an element, `pointer` is the
/// place of the index.
pub(super) fn element<'a, T>(
    list: &'a [T],
    index: Index,
    what: &str,
    pointer: impl FnOnce() -> String,
) -> Result<&'a T, AssetError> {
    list.get(index.0).ok_or_else(|| {
        let count = list.len();
        malformed(
            pointer(),
            format!("{what} {index} does not exist; the file has {count}"),
        )
    })
}

/// A name of a sensible length. Many meshes may have the name of one node.
pub(super) fn shortened(name: &str) -> String {
    const MAX_CHARACTERS: usize = 256;
    name.chars().take(MAX_CHARACTERS).collect()
}

/// Adds a warning about the value at `pointer`.
pub(super) fn warn(context: &mut Context<'_>, pointer: impl Into<String>, what: impl Into<String>) {
    let name = context.name;
    context
        .warnings
        .add_at_json(name, || (pointer.into(), what.into()));
}
