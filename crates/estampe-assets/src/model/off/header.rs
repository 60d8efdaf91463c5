//! The first line and the numbers of elements.

use crate::model::number::parse_i64;
use crate::model::statements::Statements;
use crate::{AssetError, Location};

/// What a file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Header {
    pub(super) has_uvs: bool,
    pub(super) has_colors: bool,
    pub(super) has_normals: bool,
    /// Positions have a fourth number, by which they are divided.
    pub(super) has_w: bool,
    pub(super) vertices: u64,
    pub(super) faces: u64,
}

/// The letters before `OFF`, and the text behind it. `None` if the word is no such header.
fn keyword(word: &[u8]) -> Option<(Header, &[u8])> {
    let mut header = Header::default();
    let mut rest = word;
    loop {
        if let Some(behind) = rest.strip_prefix(b"OFF") {
            return Some((header, behind));
        }
        let (flag, behind) = match rest {
            [b'S', b'T', behind @ ..] => (&mut header.has_uvs, behind),
            [b'C', behind @ ..] => (&mut header.has_colors, behind),
            [b'N', behind @ ..] => (&mut header.has_normals, behind),
            [b'4', behind @ ..] => (&mut header.has_w, behind),
            _ => return None,
        };
        if std::mem::replace(flag, true) {
            return None;
        }
        rest = behind;
    }
}

/// True if the first word is a header of OFF.
pub(in crate::model) fn is_off(bytes: &[u8]) -> bool {
    const EXAMINED_BYTES: usize = 4096;
    let head = &bytes[..bytes.len().min(EXAMINED_BYTES)];
    let word = Statements::new(head).next_keyword();
    let behind = word.and_then(keyword);
    // Some programs write the number of vertices without a blank.
    behind.is_some_and(|(_, behind)| behind.iter().all(u8::is_ascii_digit))
}

impl Header {
    /// Reads the header, up to the line of the first vertex.
    pub(super) fn read(statements: &mut Statements<'_>) -> Result<Self, AssetError> {
        let advice = "check that the file is an OFF file in text";
        let mut header = Self::default();
        let mut word = statements.next_keyword();
        if let Some((known, behind)) = word.and_then(keyword) {
            header = known;
            word = match behind {
                [] => statements.next_keyword(),
                behind => Some(behind),
            };
        } else if word.is_some_and(|word| word.ends_with(b"nOFF")) {
            let what = "an OFF file with positions of n numbers (nOFF) cannot be read";
            return Err(AssetError::unsupported(what, "save it with three numbers")
                .at(statements.location()));
        }
        if word == Some(b"BINARY") {
            return Err(AssetError::unsupported(
                "binary OFF cannot be read",
                "save it as text, or as binary PLY",
            )
            .at(statements.location()));
        }
        let count = |word: Option<&[u8]>, what: &str, at: Location| {
            word.and_then(natural).ok_or_else(|| {
                let what = format!("the header has no number of {what}");
                AssetError::malformed(what, advice).at(at)
            })
        };
        header.vertices = count(word, "vertices", statements.location())?;
        let word = statements.next_keyword();
        header.faces = count(word, "faces", statements.location())?;
        // The number of edges, which some programs leave out: a line of its own has one word.
        let is_missing = statements.is_at_end() && {
            let mut ahead = statements.clone();
            ahead.next_keyword();
            !ahead.is_at_end()
        };
        if !is_missing {
            statements.next_keyword();
        }
        Ok(header)
    }
}

/// A word that is a whole number from 0 on.
pub(super) fn natural(word: &[u8]) -> Option<u64> {
    let (number, len) = parse_i64(word)?;
    if len == word.len() {
        u64::try_from(number).ok()
    } else {
        None
    }
}
