//! From the bytes of the JSON to the document.

use super::document::Document;
use super::fault::malformed;
use super::glb::Container;
use super::json_pointer;
use crate::{AssetError, Limits, Location};

/// Objects of one file. An object of two bytes becomes some hundred bytes in memory, so this bounds
/// what a small file can cost; a scene of a million nodes has about as many.
const MAX_OBJECTS: u64 = 4_000_000;

/// Reads the JSON. Errors have the byte in the file and the JSON Pointer.
pub(super) fn parse<'a>(container: &Container<'a>) -> Result<Document<'a>, AssetError> {
    let json = container.json;
    Limits::check("JSON objects", count_objects(json), MAX_OBJECTS)?;
    // The types have a fixed depth, and serde_json skips everything else without recursion.
    serde_json::from_slice(json).map_err(|error| {
        let offset = offset_of(json, error.line(), error.column());
        let message = error.to_string();
        let message = message
            .rfind(" at line ")
            .map_or(&*message, |end| &message[..end]);
        // A wrong value was read up to and with this byte; other errors are before it.
        let (end, what) = if error.is_data() {
            (offset + 1, message.to_owned())
        } else {
            (offset, format!("the JSON is not valid: {message}"))
        };
        malformed(json_pointer::of_end(json, end), what)
            .at(Location::Byte((container.json_offset + offset) as u64))
    })
}

/// Number of `{` outside of strings.
fn count_objects(json: &[u8]) -> u64 {
    let mut count = 0;
    let mut rest = json;
    while let Some(quote) = rest.iter().position(|&byte| byte == b'"') {
        count += braces(&rest[..quote]);
        rest = json_pointer::after_string(&rest[quote..]);
    }
    count + braces(rest)
}

fn braces(json: &[u8]) -> u64 {
    json.iter().map(|&byte| u64::from(byte == b'{')).sum()
}

/// The byte of a line and a column, both counted from 1.
fn offset_of(json: &[u8], line: usize, column: usize) -> usize {
    let mut start = 0;
    for _ in 1..line {
        let Some(end) = json[start..].iter().position(|&byte| byte == b'\n') else {
            break;
        };
        start += end + 1;
    }
    (start + column.saturating_sub(1)).min(json.len())
}
