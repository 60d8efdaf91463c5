//! ZIP archives: the list of entries at the end of the file, and their bytes.
//!
//! ```text
//! | entry | entry | … | record of each entry | [ZIP64 end] | end |
//! ```
//!
//! The end has the place of the records, which have the name, the packed and unpacked length, the
//! CRC-32 and the place of each entry. Only the records are believed: an entry's own header gives
//! the place of its bytes alone. Entries that overlap are refused, so all of them together unpack
//! to no more than their bytes justify, 1032 times their length at most.
//!
//! Source: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", version 6.3.10.

use crate::{AssetError, Limits, Location};
use std::collections::HashMap;
use std::io::Read;

/// The first bytes of an archive that has entries.
pub(super) const SIGNATURE: &[u8] = b"PK\x03\x04";

const ADVICE: &str = "the file is damaged or cut off; copy or export it again";

/// An archive in memory.
#[derive(Debug)]
pub(super) struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
    /// Index of each entry by its name in small letters: names of parts differ in more than case.
    by_name: HashMap<String, usize>,
    /// Unpacked bytes that may still be read from all entries together.
    bytes_left: u64,
}

#[derive(Debug)]
struct Entry {
    name: String,
    method: u16,
    is_encrypted: bool,
    crc: u32,
    packed_len: u64,
    unpacked_len: u64,
    /// Place of its header.
    offset: u64,
}

/// Where the records are.
struct Directory {
    count: u64,
    len: u64,
    offset: u64,
}

impl<'a> Archive<'a> {
    /// Reads the records of the entries; all together may unpack to `max_bytes`.
    pub(super) fn open(bytes: &'a [u8], max_bytes: u64) -> Result<Self, AssetError> {
        let directory = Directory::find(bytes)?;
        let start = directory.offset;
        let records = usize::try_from(start)
            .ok()
            .and_then(|start| bytes.get(start..))
            .and_then(|rest| rest.get(..usize::try_from(directory.len).ok()?))
            .ok_or_else(|| malformed(start, "the list of entries is not in the file"))?;
        let mut archive = Self {
            bytes,
            entries: Vec::new(),
            by_name: HashMap::new(),
            bytes_left: max_bytes,
        };
        let mut at = 0;
        for _ in 0..directory.count {
            let place = start + at as u64;
            let (entry, len) = Entry::read(&records[at..], place)?;
            at += len;
            check_name(&entry.name).map_err(|what| malformed(place, what))?;
            let index = archive.entries.len();
            let key = entry.name.to_ascii_lowercase();
            if archive.by_name.insert(key, index).is_some() {
                let what = format!("two entries have the name `{}`", entry.name);
                return Err(malformed(place, what));
            }
            archive.entries.push(entry);
        }
        archive.check_overlap(start)?;
        Ok(archive)
    }

    /// Entries with their headers lie one after the other, before the records.
    fn check_overlap(&self, records: u64) -> Result<(), AssetError> {
        let mut spans: Vec<_> = { self.entries.iter() }
            .map(|entry| (entry.offset, entry.least_len(), entry.name.as_str()))
            .collect();
        spans.sort_unstable();
        let nexts = spans.iter().skip(1).map(|span| span.0).chain([records]);
        for (&(offset, len, name), next) in spans.iter().zip(nexts) {
            if offset.checked_add(len).is_none_or(|end| end > next) {
                let what = format!("the entry `{name}` overlaps what follows it");
                return Err(malformed(offset, what));
            }
        }
        Ok(())
    }

    /// The names of the entries, in the order of the file.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// The unpacked bytes of an entry; `None` if there is none of this name.
    pub(super) fn read(&mut self, name: &str) -> Result<Option<Vec<u8>>, AssetError> {
        let Some(&index) = self.by_name.get(&name.to_ascii_lowercase()) else {
            return Ok(None);
        };
        let entry = &self.entries[index];
        let what = format!("unpacked bytes of `{}`", entry.name);
        Limits::check(&what, entry.unpacked_len, self.bytes_left)?;
        self.bytes_left -= entry.unpacked_len;
        entry.unpack(self.bytes).map(Some)
    }
}

/// No name leads out of the archive, or means something else on another system.
fn check_name(name: &str) -> Result<(), String> {
    let is_hostile = name.contains(['\\', '\0'])
        || name.starts_with('/')
        || name.split('/').any(|part| matches!(part, "." | ".."));
    if is_hostile {
        return Err(format!(
            "the entry `{}` is outside of the archive",
            name.escape_debug()
        ));
    }
    Ok(())
}

impl Directory {
    fn find(bytes: &[u8]) -> Result<Self, AssetError> {
        const LEN: usize = 22;
        const MAX_COMMENT: usize = 0xffff;
        let missing = || malformed(bytes.len() as u64, "the archive has no end");
        let last = bytes.len().checked_sub(LEN).ok_or_else(missing)?;
        let first = last.saturating_sub(MAX_COMMENT);
        let ends_here = |&at: &usize| {
            let comment_len = u16_at(bytes, at + 20).map(usize::from);
            bytes[at..].starts_with(b"PK\x05\x06")
                && comment_len.is_some_and(|len| at + LEN + len <= bytes.len())
        };
        let at = (first..=last).rev().find(ends_here).ok_or_else(missing)?;
        let field16 = |offset| {
            u16_at(bytes, at + offset)
                .map(u64::from)
                .ok_or_else(missing)
        };
        let field32 = |offset| {
            u32_at(bytes, at + offset)
                .map(u64::from)
                .ok_or_else(missing)
        };
        if field16(4)? != field16(6)? {
            return Err(AssetError::unsupported(
                "an archive of several files cannot be read",
                "join its files",
            ));
        }
        let directory = Self {
            count: field16(10)?,
            len: field32(12)?,
            offset: field32(16)?,
        };
        let is_zip64 =
            directory.count == 0xffff || [directory.len, directory.offset].contains(&0xffff_ffff);
        if is_zip64 {
            Self::find_zip64(bytes, at).ok_or_else(missing)
        } else {
            Ok(directory)
        }
    }

    /// The larger numbers, whose place is in the 20 bytes before the end at `end`.
    fn find_zip64(bytes: &[u8], end: usize) -> Option<Self> {
        let locator = bytes.get(end.checked_sub(20)?..end)?;
        let at = usize::try_from(u64_at(locator, 8)?).ok()?;
        let record = bytes.get(at..)?;
        let is_found = locator.starts_with(b"PK\x06\x07") && record.starts_with(b"PK\x06\x06");
        is_found.then_some(())?;
        Some(Self {
            count: u64_at(record, 32)?,
            len: u64_at(record, 40)?,
            offset: u64_at(record, 48)?,
        })
    }
}

impl Entry {
    /// Reads a record, which is at `place` of the file; also returns its length.
    fn read(record: &[u8], place: u64) -> Result<(Self, usize), AssetError> {
        Self::try_read(record)
            .ok_or_else(|| malformed(place, "the record of an entry is damaged or cut off"))
    }

    fn try_read(record: &[u8]) -> Option<(Self, usize)> {
        const LEN: usize = 46;
        record.starts_with(b"PK\x01\x02").then_some(())?;
        let lens = [28, 30, 32].map(|at| u16_at(record, at).map_or(0, usize::from));
        let end = LEN + lens.iter().sum::<usize>();
        let behind = record.get(LEN..end)?;
        let (name, behind) = behind.split_at(lens[0]);
        let mut entry = Self {
            name: String::from_utf8_lossy(name).into_owned(),
            method: u16_at(record, 10)?,
            is_encrypted: u16_at(record, 8)? & 1 != 0,
            crc: u32_at(record, 16)?,
            packed_len: u32_at(record, 20)?.into(),
            unpacked_len: u32_at(record, 24)?.into(),
            offset: u32_at(record, 42)?.into(),
        };
        entry.widen(&behind[..lens[1]])?;
        Some((entry, end))
    }

    /// Replaces numbers that do not fit 32 bits by those of the ZIP64 field.
    fn widen(&mut self, mut fields: &[u8]) -> Option<()> {
        const ZIP64: u16 = 1;
        const ELSEWHERE: u64 = 0xffff_ffff;
        let numbers = [
            &mut self.unpacked_len,
            &mut self.packed_len,
            &mut self.offset,
        ];
        if numbers.iter().all(|number| **number != ELSEWHERE) {
            return Some(());
        }
        loop {
            let (id, len) = (u16_at(fields, 0)?, usize::from(u16_at(fields, 2)?));
            let field = fields.get(4..4 + len)?;
            if id == ZIP64 {
                let mut wide = field.as_chunks::<8>().0.iter();
                for number in numbers {
                    if *number == ELSEWHERE {
                        *number = u64::from_le_bytes(*wide.next()?);
                    }
                }
                return Some(());
            }
            fields = &fields[4 + len..];
        }
    }

    /// Bytes of the header, the name and the packed bytes.
    fn least_len(&self) -> u64 {
        (LOCAL_LEN as u64 + self.name.len() as u64).saturating_add(self.packed_len)
    }

    fn unpack(&self, archive: &[u8]) -> Result<Vec<u8>, AssetError> {
        const STORED: u16 = 0;
        const DEFLATED: u16 = 8;
        let name = &self.name;
        let damaged = |what: &str| malformed(self.offset, format!("the entry `{name}` {what}"));
        let packed = self
            .packed(archive)
            .ok_or_else(|| damaged("is not in the file"))?;
        if self.is_encrypted {
            let what = format!("the entry `{name}` is encrypted");
            return Err(AssetError::unsupported(what, "save it without a password"));
        }
        // What is reserved depends on the bytes that are there, not on the stated length alone.
        const MAX_RATIO: usize = 1032;
        let stated = usize::try_from(self.unpacked_len).unwrap_or(usize::MAX);
        let room = stated.min(packed.len().saturating_mul(MAX_RATIO));
        let mut unpacked = Vec::new();
        let read = match self.method {
            STORED => {
                unpacked.extend_from_slice(packed);
                Ok(())
            }
            DEFLATED => {
                unpacked.reserve_exact(room);
                let inflated = flate2::read::DeflateDecoder::new(packed);
                // One byte more shows that the stated length is wrong.
                let mut bounded = inflated.take(self.unpacked_len.saturating_add(1));
                bounded.read_to_end(&mut unpacked).map(drop)
            }
            method => {
                let what = format!("the entry `{name}` is packed by method {method}");
                let advice = "pack it again by the method Deflate";
                return Err(AssetError::unsupported(what, advice).at(Location::Byte(self.offset)));
            }
        };
        read.map_err(|error| damaged(&format!("cannot be unpacked: {error}")))?;
        if unpacked.len() as u64 != self.unpacked_len {
            return Err(damaged("has another length than its record states"));
        }
        let mut crc = flate2::Crc::new();
        crc.update(&unpacked);
        if crc.sum() != self.crc {
            return Err(damaged("has another checksum than its record states"));
        }
        Ok(unpacked)
    }

    /// The bytes behind the entry's own header.
    fn packed<'a>(&self, archive: &'a [u8]) -> Option<&'a [u8]> {
        let header = archive.get(usize::try_from(self.offset).ok()?..)?;
        header.starts_with(SIGNATURE).then_some(())?;
        let lens = usize::from(u16_at(header, 26)?) + usize::from(u16_at(header, 28)?);
        let behind = header.get(LOCAL_LEN + lens..)?;
        behind.get(..usize::try_from(self.packed_len).ok()?)
    }
}

/// Bytes of an entry's own header, before its name.
const LOCAL_LEN: usize = 30;

fn malformed(offset: u64, what: impl Into<String>) -> AssetError {
    AssetError::malformed(what, ADVICE).at(Location::Byte(offset))
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}
