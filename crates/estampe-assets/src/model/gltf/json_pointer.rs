//! The JSON Pointer (RFC 6901) of a place in a text.

/// An object or an array around the place.
enum Level<'a> {
    /// The last key, between its quotes; `None` before the first one.
    Object(Option<&'a [u8]>),
    /// The element's number.
    Array(usize),
}

/// Levels of a pointer; deeper ones are left out. No property that is read is so deep.
const MAX_DEPTH: usize = 128;

/// The pointer of the value that the first `end` bytes end with, or within. They should be valid.
pub(super) fn of_end(json: &[u8], end: usize) -> String {
    let mut levels = Vec::new();
    let mut is_key = false;
    let mut rest = &json[..end.min(json.len())];
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        match byte {
            b'{' | b'[' if levels.len() >= MAX_DEPTH => break,
            b'{' => {
                levels.push(Level::Object(None));
                is_key = true;
            }
            b'[' => {
                levels.push(Level::Array(0));
                is_key = false;
            }
            b'}' | b']' => {
                levels.pop();
                is_key = false;
            }
            b',' => match levels.last_mut() {
                Some(Level::Array(index)) => *index += 1,
                Some(Level::Object(_)) => is_key = true,
                None => {}
            },
            b'"' => {
                let string = after;
                rest = after_quote(after);
                let length = string.len() - rest.len();
                if is_key && let Some(Level::Object(key)) = levels.last_mut() {
                    *key = Some(&string[..length.saturating_sub(1)]);
                    is_key = false;
                }
            }
            _ => {}
        }
    }
    levels.iter().map(segment).collect()
}

fn segment(level: &Level<'_>) -> String {
    match level {
        Level::Object(None) => String::new(),
        Level::Object(Some(key)) => {
            let key = String::from_utf8_lossy(key);
            format!("/{}", key.replace('~', "~0").replace('/', "~1"))
        }
        Level::Array(index) => format!("/{index}"),
    }
}

/// The text after the string at its start.
pub(super) fn after_string(json: &[u8]) -> &[u8] {
    after_quote(json.get(1..).unwrap_or_default())
}

/// The text after the next quote that is not escaped.
fn after_quote(mut json: &[u8]) -> &[u8] {
    while let Some(at) = json.iter().position(|&b| b == b'"' || b == b'\\') {
        let skipped = if json[at] == b'"' { at + 1 } else { at + 2 };
        let is_end = json[at] == b'"';
        json = json.get(skipped..).unwrap_or_default();
        if is_end {
            return json;
        }
    }
    &[]
}

#[cfg(test)]
mod tests {
    use super::of_end;

    #[test]
    fn the_pointer_names_the_value_at_the_place() {
        for (text, pointer) in [
            (r#""#, ""),
            (r#"{"#, ""),
            (r#"{"a""#, "/a"),
            (r#"{"a":[1"#, "/a/0"),
            (r#"{"a":[1,"#, "/a/1"),
            (r#"{"a":[1,{"b/c~":"x]\"{""#, "/a/1/b~1c~0"),
            (r#"{"a":[1,{"b":"x]","d":[[],{"#, "/a/1/d/1"),
            (r#"{"a":[1,{"b":"x]","d":[[],{}"#, "/a/1/d/1"),
            (r#"{"a":[1,{"b":"x]","d":[[],{}]}],"e":2"#, "/e"),
            (r#"{"a":{"b":1}}"#, ""),
            (r#"]]}"#, ""),
        ] {
            assert_eq!(of_end(text.as_bytes(), text.len()), pointer, "{text}");
        }
        assert_eq!(of_end(br#"{"a":{"b":["#, 99), "/a/b/0");
        let deep = "[".repeat(1000);
        assert_eq!(of_end(deep.as_bytes(), 1000).len(), 2 * super::MAX_DEPTH);
    }
}
