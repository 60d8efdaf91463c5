//! UTF-16 text as UTF-8: some editors and spreadsheets write it.

/// The text as UTF-8 if it is UTF-16 with a byte order mark, which is removed. What is no character
/// becomes U+FFFD.
pub(super) fn utf8_from_utf16(bytes: &[u8]) -> Option<Vec<u8>> {
    let (units, is_big) = match bytes {
        [0xff, 0xfe, units @ ..] => (units, false),
        [0xfe, 0xff, units @ ..] => (units, true),
        _ => return None,
    };
    let (pairs, odd) = units.as_chunks::<2>();
    let unit = |&pair: &[u8; 2]| {
        if is_big {
            u16::from_be_bytes(pair)
        } else {
            u16::from_le_bytes(pair)
        }
    };
    let mut text = String::with_capacity(pairs.len());
    for character in char::decode_utf16(pairs.iter().map(unit)) {
        text.push(character.unwrap_or(char::REPLACEMENT_CHARACTER));
    }
    if !odd.is_empty() {
        text.push(char::REPLACEMENT_CHARACTER);
    }
    Some(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::utf8_from_utf16;

    #[test]
    fn text_with_a_mark_is_decoded() {
        let encoded = |to: fn(u16) -> [u8; 2]| -> Vec<u8> {
            "\u{feff}v é 𝄞\n".encode_utf16().flat_map(to).collect()
        };
        for bytes in [encoded(u16::to_le_bytes), encoded(u16::to_be_bytes)] {
            assert_eq!(utf8_from_utf16(&bytes).unwrap(), "v é 𝄞\n".as_bytes());
            let cut = utf8_from_utf16(&bytes[..bytes.len() - 1]).unwrap();
            assert_eq!(cut, "v é 𝄞\u{fffd}".as_bytes());
        }
        assert_eq!(
            utf8_from_utf16(b"\xff\xfe\x00\xd8A\0").unwrap(),
            "\u{fffd}A".as_bytes()
        );
        assert_eq!(utf8_from_utf16("\u{feff}v 0 0 0".as_bytes()), None);
        assert_eq!(utf8_from_utf16(b""), None);
    }
}
