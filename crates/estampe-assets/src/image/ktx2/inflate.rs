//! Levels without their supercompression.

use super::header::Scheme;
use crate::AssetError;
use crate::image::fault::malformed;
use std::borrow::Cow;
use std::io::Read;

/// The first `len` bytes of a level, which is stored at byte `at`.
pub(super) fn inflated<'b>(
    stored: &'b [u8],
    scheme: Scheme,
    len: usize,
    at: usize,
) -> Result<Cow<'b, [u8]>, AssetError> {
    match scheme {
        Scheme::None => match stored.get(..len) {
            Some(stored) => Ok(Cow::Borrowed(stored)),
            None => Err(too_short(len, stored.len(), at + stored.len())),
        },
        Scheme::Zlib => read(flate2::read::ZlibDecoder::new(stored), len, at, "zlib"),
        Scheme::Zstandard => match ruzstd::decoding::StreamingDecoder::new(stored) {
            Ok(decoder) => read(decoder, len, at, "Zstandard"),
            Err(error) => Err(malformed(
                at,
                format!("the Zstandard data is not valid: {error}"),
            )),
        },
    }
}

/// Memory grows with what is read, so that a file that states much and holds little takes little.
fn read<'b>(
    decoder: impl Read,
    len: usize,
    at: usize,
    name: &str,
) -> Result<Cow<'b, [u8]>, AssetError> {
    let mut bytes = Vec::new();
    decoder
        .take(len as u64)
        .read_to_end(&mut bytes)
        .map_err(|error| malformed(at, format!("the {name} data is not valid: {error}")))?;
    if bytes.len() < len {
        return Err(too_short(len, bytes.len(), at));
    }
    Ok(Cow::Owned(bytes))
}

fn too_short(needed: usize, found: usize, at: usize) -> AssetError {
    malformed(
        at,
        format!("the KTX2 level needs {needed} bytes and has {found}"),
    )
}
