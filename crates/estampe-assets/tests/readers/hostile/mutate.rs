//! Mutations of a file's bytes.

use fastrand::Rng;
use std::ops::Range;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mutation {
    FlipBit,
    SetByte,
    /// Sets a byte to a character with a meaning in text formats.
    SetMeaningful,
    /// Sets four bytes to a special whole or real number.
    SetWord,
    /// Sets eight bytes to a special real number.
    SetDouble,
    /// Replaces a number of a text by a special one.
    ReplaceNumber,
    Remove,
    Insert,
    Repeat,
    /// Puts many nines in front of a digit.
    Enlarge,
    DuplicateLine,
    /// Sets a length, count or offset of a ZIP archive or a GLB file.
    SetField,
}

pub(super) const MUTATIONS: [Mutation; 12] = [
    Mutation::FlipBit,
    Mutation::SetByte,
    Mutation::SetMeaningful,
    Mutation::SetWord,
    Mutation::SetDouble,
    Mutation::ReplaceNumber,
    Mutation::Remove,
    Mutation::Insert,
    Mutation::Repeat,
    Mutation::Enlarge,
    Mutation::DuplicateLine,
    Mutation::SetField,
];

/// In place of numbers of texts: codes and indices that exist, and numbers at the ends of types.
/// The last ones are no JSON.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "2",
    "3",
    "7",
    "-1",
    "255",
    "65535",
    "5120",
    "5123",
    "5125",
    "5126",
    "2147483648",
    "4294967295",
    "18446744073709551615",
    "49999999",
    "0.5",
    "1e39",
    "1e308",
    "-1e308",
    "null",
    "\"\"",
    "{}",
    "[]",
    "NaN",
    "-inf",
    "1e-46",
    "",
];

/// The mutations of some bytes, which have at least one.
pub(super) fn mutate(bytes: &mut Vec<u8>, mutation: Mutation, random: &mut Rng) {
    let at = random.usize(..bytes.len());
    let end = (at + random.usize(..20)).min(bytes.len());
    match mutation {
        Mutation::FlipBit => bytes[at] ^= 1 << random.usize(..8),
        Mutation::SetByte => bytes[at] = random.u8(..),
        Mutation::SetMeaningful => {
            let meaningful = b" \t\n\r\\/#-+.0123456789einfvtpsolmgx\"{}[]<>&;:,\0\xff";
            bytes[at] = meaningful[random.usize(..meaningful.len())];
        }
        Mutation::SetWord => set_word(bytes, at, random),
        Mutation::SetDouble => {
            let doubles = [0.0, -1.0, 2_147_483_648.0, 1e308, f64::NAN, f64::INFINITY];
            let double = doubles[random.usize(..doubles.len())];
            let is_little = random.bool();
            set(bytes, at, &ordered(double.to_le_bytes(), is_little));
        }
        Mutation::ReplaceNumber => {
            let numbers = numbers(bytes);
            if !numbers.is_empty() {
                let number = numbers[random.usize(..numbers.len())].clone();
                let text = NUMBERS[random.usize(..NUMBERS.len())];
                bytes.splice(number, text.bytes());
            }
        }
        Mutation::Remove => drop(bytes.drain(at..end)),
        Mutation::Insert => {
            let inserted: Vec<u8> = (0..random.usize(..12)).map(|_| random.u8(..)).collect();
            bytes.splice(at..at, inserted);
        }
        Mutation::Repeat => {
            let part = bytes[at..end].to_vec();
            bytes.splice(at..at, part.repeat(1 + random.usize(..30)));
        }
        Mutation::Enlarge => {
            if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                bytes.splice(at + digit..at + digit, vec![b'9'; random.usize(..25)]);
            }
        }
        Mutation::DuplicateLine => {
            let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
            let start = bytes[..at]
                .iter()
                .rposition(is_end)
                .map_or(0, |end| end + 1);
            let len = bytes[at..].iter().position(is_end).map(|end| end + 1);
            let end = len.map_or(bytes.len(), |len| at + len);
            // Of JSON in one line, which would grow beyond the limits, some words.
            let line = bytes[start..end.min(start + 1000)].to_vec();
            bytes.splice(start..start, line.repeat(1 + random.usize(..3)));
        }
        Mutation::SetField => {
            let fields = fields(bytes);
            if !fields.is_empty() {
                let field = fields[random.usize(..fields.len())].clone();
                set_field(bytes, field, random);
            }
        }
    }
    if bytes.is_empty() {
        bytes.push(0);
    }
}

fn ordered<const N: usize>(mut bytes: [u8; N], is_little: bool) -> [u8; N] {
    if !is_little {
        bytes.reverse();
    }
    bytes
}

/// Overwrites bytes as far as there are some.
fn set(bytes: &mut [u8], at: usize, with: &[u8]) {
    let end = (at + with.len()).min(bytes.len());
    bytes[at..end].copy_from_slice(&with[..end - at]);
}

fn set_word(bytes: &mut [u8], at: usize, random: &mut Rng) {
    let reals = [
        0.0,
        -1.0,
        2_147_483_648.0,
        f32::MAX,
        f32::NAN,
        f32::INFINITY,
    ];
    let reals = reals.map(f32::to_bits);
    let wholes = [u32::MAX, 1 << 31, 1, 1 << 24, 49_999_999];
    let words = [&reals[..], &wholes[..]].concat();
    let word = words[random.usize(..words.len())];
    let is_little = random.bool();
    set(bytes, at, &ordered(word.to_le_bytes(), is_little));
}

/// Sets a field to a special number, or to one near its own.
fn set_field(bytes: &mut [u8], field: Range<usize>, random: &mut Rng) {
    let mut word = [0; 4];
    word[..field.len()].copy_from_slice(&bytes[field.clone()]);
    let own = u32::from_le_bytes(word);
    let len = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
    let near = own.wrapping_add(random.u32(..9)).wrapping_sub(4);
    let special = [
        0,
        1,
        4,
        u32::MAX,
        1 << 31,
        len,
        len - 1,
        len + 1,
        near,
        near,
    ];
    let value = special[random.usize(..special.len())].to_le_bytes();
    bytes[field.clone()].copy_from_slice(&value[..field.len()]);
}

/// The numbers of a text.
fn numbers(bytes: &[u8]) -> Vec<Range<usize>> {
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+');
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let len = { bytes[at..].iter() }.position(|&byte| !is_part(byte));
        let end = len.map_or(bytes.len(), |len| at + len);
        if bytes[at..end]
            .first()
            .is_some_and(|first| !first.is_ascii_alphabetic())
        {
            found.push(at..end);
        }
        at = end + 1;
    }
    found
}

/// Offset in a record, and length.
type Field = (usize, usize);

/// The lengths, counts and offsets of a ZIP archive (APPNOTE 4.3) or a GLB file.
fn fields(bytes: &[u8]) -> Vec<Range<usize>> {
    if bytes.starts_with(b"glTF") {
        let json_len = bytes.get(12..16).and_then(|len| len.try_into().ok());
        let second = json_len.map_or(0, |len| {
            20_usize.saturating_add(u32::from_le_bytes(len) as usize)
        });
        let starts = [4, 8, 12, 16, second, second.saturating_add(4)];
        let words = starts.map(|start| start..start.saturating_add(4));
        return words
            .into_iter()
            .filter(|word| word.end <= bytes.len())
            .collect();
    }
    // The signature of each kind of record with its fields.
    let kinds: [(&[u8], &[Field]); 3] = [
        (b"PK\x03\x04", &[(18, 4), (22, 4), (26, 2), (28, 2)]),
        (
            b"PK\x01\x02",
            &[
                (10, 2),
                (20, 4),
                (24, 4),
                (28, 2),
                (30, 2),
                (32, 2),
                (42, 4),
            ],
        ),
        (b"PK\x05\x06", &[(8, 2), (10, 2), (12, 4), (16, 4), (20, 2)]),
    ];
    let mut found = Vec::new();
    for (signature, fields) in kinds {
        let starts = bytes.windows(4).enumerate();
        for (start, _) in starts.filter(|(_, window)| *window == signature) {
            let fields = fields
                .iter()
                .map(|(offset, len)| start + offset..start + offset + len);
            found.extend(fields.filter(|field| field.end <= bytes.len()));
        }
    }
    found
}
