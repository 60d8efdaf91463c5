//! Archives with the same bytes on every machine: ustar (POSIX.1-2001, `pax`, "ustar Interchange
//! Format") in gzip.
//!
//! Rejected: the crate `tar`, which also reads archives and asks the system for owners and times;
//! of all that a header of 512 bytes is needed.

use std::error::Error;
use std::io::Write;

use flate2::{Compression, GzBuilder};

/// A header, and the unit to which contents are filled up, in bytes.
const RECORD_LEN: usize = 512;

/// The time of every file: 1 January 1980, before which some programs know no time.
const TIME_S: u64 = 315_532_800;

/// A file of the package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Entry {
    /// Relative to the package's folder, with `/` between the parts.
    pub(crate) path: String,
    pub(crate) is_program: bool,
    pub(crate) bytes: Vec<u8>,
}

impl Entry {
    /// A file that is read.
    pub(crate) fn file(path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            path: path.to_owned(),
            is_program: false,
            bytes: bytes.into(),
        }
    }

    /// A file that is executed.
    pub(crate) fn program(path: &str, bytes: Vec<u8>) -> Self {
        Self {
            is_program: true,
            ..Self::file(path, bytes)
        }
    }
}

/// A header's kind of file.
#[derive(Debug, Clone, Copy)]
enum Kind {
    File,
    Folder,
}

/// The compressed archive of a folder with these files, in their order. Each folder precedes its
/// first file.
pub(crate) fn tar_gz(folder: &str, entries: &[Entry]) -> Result<Vec<u8>, Box<dyn Error>> {
    let builder = GzBuilder::new().mtime(0).operating_system(255);
    let mut out = builder.write(Vec::new(), Compression::best());
    out.write_all(&tar(folder, entries)?)?;
    Ok(out.finish()?)
}

fn tar(folder: &str, entries: &[Entry]) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let mut folders: Vec<String> = Vec::new();
    for entry in entries {
        let path = format!("{folder}/{}", entry.path);
        for (end, _) in path.match_indices('/') {
            let parent = &path[..=end];
            if !folders.iter().any(|known| known == parent) {
                out.extend(header(parent, Kind::Folder, 0o755, 0)?);
                folders.push(parent.to_owned());
            }
        }
        let mode = if entry.is_program { 0o755 } else { 0o644 };
        out.extend(header(&path, Kind::File, mode, entry.bytes.len())?);
        out.extend(&entry.bytes);
        out.resize(out.len().next_multiple_of(RECORD_LEN), 0);
    }
    // The end: two empty records.
    out.resize(out.len() + 2 * RECORD_LEN, 0);
    Ok(out)
}

/// A header of the owner and group 0, called `root`.
fn header(path: &str, kind: Kind, mode: u64, len: usize) -> Result<[u8; RECORD_LEN], String> {
    const CHECKSUM: usize = 148;
    let mut header = [0; RECORD_LEN];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    // A longer path could be split in two fields; none is longer.
    if path.len() > 100 {
        return Err(format!("{path}: longer than 100 bytes"));
    }
    put(0, path.as_bytes());
    put(100, octal(mode, 7)?.as_bytes());
    put(108, octal(0, 7)?.as_bytes()); // owner
    put(116, octal(0, 7)?.as_bytes()); // group
    put(124, octal(len as u64, 11)?.as_bytes());
    put(136, octal(TIME_S, 11)?.as_bytes());
    put(CHECKSUM, b"        ");
    let kind = match kind {
        Kind::File => b"0",
        Kind::Folder => b"5",
    };
    put(156, kind);
    put(257, b"ustar\x0000");
    put(265, b"root");
    put(297, b"root");
    // The sum of all bytes, with spaces in the place of the sum.
    let sum = header.iter().map(|&byte| u64::from(byte)).sum();
    let sum = format!("{}\0 ", octal(sum, 6)?);
    header[CHECKSUM..CHECKSUM + sum.len()].copy_from_slice(sum.as_bytes());
    Ok(header)
}

/// A number with this many octal digits.
fn octal(number: u64, digits: usize) -> Result<String, String> {
    let text = format!("{number:0digits$o}");
    if text.len() > digits {
        return Err(format!("{number} has more than {digits} octal digits"));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;

    fn entries() -> Vec<Entry> {
        vec![
            Entry::program("estampe", vec![7; 600]),
            Entry::file("man/a.1", "one"),
            Entry::file("man/b.1", ""),
        ]
    }

    fn unpacked(archive: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let read = GzDecoder::new(archive).read_to_end(&mut bytes);
        read.expect("the archive is gzip");
        bytes
    }

    /// Path, mode, kind and length of each header, and the contents.
    fn listed(mut tar: &[u8]) -> Vec<(String, String, u8, Vec<u8>)> {
        let text = |bytes: &[u8]| {
            let end = bytes.iter().position(|&byte| byte == 0);
            String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]).into_owned()
        };
        let mut files = Vec::new();
        while tar[0] != 0 {
            let len = usize::from_str_radix(&text(&tar[124..136]), 8).expect("octal");
            let sum = u64::from_str_radix(&text(&tar[148..156]), 8).expect("octal");
            let (before, after) = (tar[..148].iter(), tar[156..RECORD_LEN].iter());
            let computed: u64 = before.chain(after).map(|&byte| u64::from(byte)).sum();
            assert_eq!(computed + 8 * u64::from(b' '), sum);
            let contents = tar[RECORD_LEN..RECORD_LEN + len].to_vec();
            files.push((text(&tar[..100]), text(&tar[100..108]), tar[156], contents));
            tar = &tar[RECORD_LEN + len.next_multiple_of(RECORD_LEN)..];
        }
        assert_eq!(tar, [0; 2 * RECORD_LEN]);
        files
    }

    #[test]
    fn files_are_in_order_and_folders_precede_them() {
        let tar = unpacked(&tar_gz("p", &entries()).expect("short paths"));
        let file = |path: &str, mode: &str, kind, bytes: &[u8]| {
            (path.to_owned(), mode.to_owned(), kind, bytes.to_vec())
        };
        assert_eq!(
            listed(&tar),
            [
                file("p/", "0000755", b'5', &[]),
                file("p/estampe", "0000755", b'0', &[7; 600]),
                file("p/man/", "0000755", b'5', &[]),
                file("p/man/a.1", "0000644", b'0', b"one"),
                file("p/man/b.1", "0000644", b'0', b""),
            ]
        );
    }

    /// A header byte by byte, so that neither the machine nor the time of the build is in it.
    #[test]
    fn headers_have_fixed_bytes() {
        let header = header("p/man/a.1", Kind::File, 0o644, 3).expect("a short path");
        let text: String = header
            .iter()
            .map(|&byte| if byte == 0 { '.' } else { char::from(byte) })
            .collect();
        assert!(text.starts_with("p/man/a.1......"), "{text}");
        let numbers = "0000644.0000000.0000000.00000000003.02263523000.";
        assert_eq!(&text[100..148], numbers);
        assert_eq!(&text[156..157], "0");
        assert_eq!(&text[257..269], "ustar.00root");
        assert_eq!(&text[297..302], "root.");
    }

    #[test]
    fn the_same_files_give_the_same_bytes() {
        let first = tar_gz("p", &entries()).expect("short paths");
        let second = tar_gz("p", &entries()).expect("short paths");
        assert_eq!(first, second);
        // No time, and no system.
        assert_eq!(first[4..8], [0; 4]);
        assert_eq!(first[9], 255);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(header(&"a".repeat(101), Kind::File, 0o644, 0).is_err());
        assert!(octal(0o1000, 3).is_err());
        assert_eq!(octal(0o777, 3).as_deref(), Ok("777"));
    }
}
