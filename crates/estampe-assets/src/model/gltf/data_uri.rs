//! URIs: data within the JSON, and names of files with escapes.

use crate::AssetError;
use std::borrow::Cow;

/// True for `data:` URIs (RFC 2397).
pub(super) fn is_data(uri: &str) -> bool {
    uri.get(..5)
        .is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

/// The contents of a `data:` URI. `None` if it is not one.
pub(super) fn data(uri: &str) -> Option<Result<Vec<u8>, AssetError>> {
    let rest = is_data(uri).then(|| &uri[5..])?;
    let Some((media_type, data)) = rest.split_once(',') else {
        return Some(Err(bad("the data URI has no comma before its data")));
    };
    if media_type.to_ascii_lowercase().ends_with(";base64") {
        return Some(base64(data.as_bytes()));
    }
    Some(Ok(percent_decoded(data).into_owned()))
}

/// The bytes of a text whose characters may be escaped as `%20`.
pub(in crate::model) fn percent_decoded(text: &str) -> Cow<'_, [u8]> {
    if !text.contains('%') {
        return Cow::Borrowed(text.as_bytes());
    }
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let digits = after.first_chunk::<2>().map(|pair| pair.map(hex));
        if let (b'%', Some([Some(high), Some(low)])) = (byte, digits) {
            bytes.push(high << 4 | low);
            rest = &after[2..];
        } else {
            bytes.push(byte);
            rest = after;
        }
    }
    Cow::Owned(bytes)
}

fn hex(digit: u8) -> Option<u8> {
    match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'a'..=b'f' => Some(digit - b'a' + 10),
        b'A'..=b'F' => Some(digit - b'A' + 10),
        _ => None,
    }
}

/// The value of each character; `INVALID` for those that are none of base64.
const VALUES: [u8; 256] = values();
const INVALID: u8 = 0xff;

const fn values() -> [u8; 256] {
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut values = [INVALID; 256];
    let mut value = 0;
    while value < 64 {
        values[alphabet[value as usize] as usize] = value;
        value += 1;
    }
    // The alphabet for URLs (RFC 4648, §5).
    values[b'-' as usize] = 62;
    values[b'_' as usize] = 63;
    values
}

/// Decodes base64 (RFC 4648, §4), with or without padding.
fn base64(text: &[u8]) -> Result<Vec<u8>, AssetError> {
    let padding = text
        .iter()
        .rev()
        .take(2)
        .take_while(|&&c| c == b'=')
        .count();
    let text = &text[..text.len() - padding];
    let (groups, rest) = text.as_chunks::<4>();
    let mut bytes = Vec::with_capacity(groups.len() * 3 + 2);
    let mut is_valid = true;
    for group in groups {
        let [a, b, c, d] = group.map(|character| VALUES[usize::from(character)]);
        is_valid &= (a | b | c | d) < 64;
        bytes.extend_from_slice(&[a << 2 | b >> 4, b << 4 | c >> 2, c << 6 | d]);
    }
    // Two characters are one byte, three are two.
    let values: Vec<u8> = rest.iter().map(|&c| VALUES[usize::from(c)]).collect();
    is_valid &= values.iter().all(|&value| value < 64);
    match *values {
        [] => {}
        [a, b] => bytes.push(a << 2 | b >> 4),
        [a, b, c] => bytes.extend_from_slice(&[a << 2 | b >> 4, b << 4 | c >> 2]),
        _ => return Err(bad("the base64 data ends within a byte")),
    }
    if is_valid {
        return Ok(bytes);
    }
    let at = text.iter().position(|&c| VALUES[usize::from(c)] == INVALID);
    Err(bad(&format!(
        "character {} of the base64 data is not of base64",
        at.unwrap_or_default()
    )))
}

fn bad(what: &str) -> AssetError {
    AssetError::malformed(what, "export the file again")
}

#[cfg(test)]
mod tests {
    use super::{data, percent_decoded};

    #[test]
    fn base64_is_decoded() {
        // The vectors of RFC 4648, §10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zm9vYmE", "fooba"),
        ] {
            let uri = format!("data:application/octet-stream;base64,{text}");
            assert_eq!(data(&uri).unwrap().unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(data("DATA:;BASE64,-_8").unwrap().unwrap(), [0xfb, 0xff]);
        for (text, message) in [
            ("Zm9*", "character 3 of the base64 data is not of base64"),
            ("Z=9v", "character 1"),
            ("Zm9vY", "ends within a byte"),
            ("Z\u{e9}", "character 1"),
        ] {
            let error = data(&format!("data:;base64,{text}")).unwrap().unwrap_err();
            assert!(error.to_string().contains(message), "{error}");
        }
        assert!(data("data:nothing").unwrap().is_err());
        assert!(data("file.bin").is_none() && data("dat").is_none());
    }

    #[test]
    fn escapes_are_decoded() {
        assert_eq!(&*percent_decoded("a%20b%2Fc%zz%4"), b"a b/c%zz%4");
        assert_eq!(data("data:,a%00b").unwrap().unwrap(), b"a\0b");
    }
}
