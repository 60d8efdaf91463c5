//! Reading the bytes of a file, up to the limit.

use crate::Limits;
use crate::zeros::zeros;
use estampe_scene::Workers;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// Reads a file with an expected length, which may be wrong; the file may be a pipe.
///
/// Large files are read by several threads (`Limits::threads`). If the file is in the system's
/// cache, the time goes not to the disk but to the system's page faults for fresh memory, 4 KiB at
/// a time.
///
/// # Errors
/// The system's error, or `FileTooLarge` for more than `Limits::max_file_bytes`.
pub fn read_bytes(mut file: File, expected: u64, limits: &Limits) -> io::Result<Vec<u8>> {
    let mut bytes = read_parts(&file, expected, limits).unwrap_or_default();
    if !bytes.is_empty() {
        // Bytes that were added in the meantime; usually none.
        file.seek(SeekFrom::Start(bytes.len() as u64))?;
    }
    read_rest(file, &mut bytes, expected, limits)?;
    Ok(bytes)
}

/// Reads a stream without a known length, such as standard input.
///
/// # Errors
/// As [`read_bytes`].
pub fn read_stream(from: impl Read, limits: &Limits) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    read_rest(from, &mut bytes, 0, limits)?;
    Ok(bytes)
}

fn read_rest(
    from: impl Read,
    bytes: &mut Vec<u8>,
    expected: u64,
    limits: &Limits,
) -> io::Result<()> {
    let limit = limits.max_file_bytes;
    let expected = usize::try_from(expected.min(limit)).unwrap_or(0);
    bytes.reserve_exact(expected.saturating_sub(bytes.len()));
    from.take((limit - bytes.len() as u64).saturating_add(1))
        .read_to_end(bytes)?;
    if bytes.len() as u64 > limit {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(())
}

/// The bytes of a large file. `None` if it is small, cannot be read at offsets, or is shorter than
/// expected.
#[cfg(unix)]
fn read_parts(file: &File, expected: u64, limits: &Limits) -> Option<Vec<u8>> {
    use std::os::unix::fs::FileExt;
    /// Bytes of a part: about a millisecond of work.
    const PART: usize = 1 << 20;
    let len = usize::try_from(expected).ok()?;
    if len <= PART || expected > limits.max_file_bytes || !file.metadata().ok()?.is_file() {
        return None;
    }
    let mut bytes = zeros(len);
    let parts = bytes.chunks_mut(PART).zip((0_u64..).step_by(PART));
    let read = Workers::new(limits.threads).map(parts, |(part, at)| file.read_exact_at(part, at));
    read.into_iter().all(|read| read.is_ok()).then_some(bytes)
}

#[cfg(not(unix))]
fn read_parts(_: &File, _: u64, _: &Limits) -> Option<Vec<u8>> {
    None
}

#[cfg(test)]
mod tests {
    use super::{read_bytes, read_stream};
    use crate::Limits;
    use std::fs::File;
    use std::io::ErrorKind;

    #[test]
    fn files_are_read_whole_whatever_was_expected() {
        let path = std::env::temp_dir().join(format!("estampe-file-{}", std::process::id()));
        let content: Vec<u8> = (0..3_000_001_u32).map(|i| i.to_le_bytes()[1]).collect();
        std::fs::write(&path, &content).unwrap();
        let len = content.len() as u64;
        let limits = Limits {
            max_file_bytes: len,
            threads: 3,
            ..Limits::default()
        };
        for expected in [0, 5, len - 1_000_000, len - 1, len, len + 1] {
            let read = read_bytes(File::open(&path).unwrap(), expected, &limits).unwrap();
            assert!(read == content, "{expected} expected");
        }
        let few = Limits {
            max_file_bytes: len - 1,
            ..limits
        };
        for expected in [0, len - 1, len] {
            let error = read_bytes(File::open(&path).unwrap(), expected, &few).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::FileTooLarge, "{expected} expected");
        }
        std::fs::remove_file(&path).unwrap();
        assert!(read_stream(&content[..], &limits).unwrap() == content);
        assert!(read_stream(&content[..], &few).is_err());
    }
}
