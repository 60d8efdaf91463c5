//! The stream of stored texels, raw or run-length encoded.
//!
//! A packet is a byte and texels: `0nnnnnnn` is followed by n + 1 texels, `1nnnnnnn` by one texel
//! that is repeated n + 1 times. TGA 2 requires that packets end with their row and TGA 1 does not,
//! so a packet may cross rows; a packet that exceeds the image is cut off.

use crate::AssetError;
use crate::image::fault::malformed;

/// The most texels of one packet.
pub(super) const MAX_PACKET: usize = 128;

/// Position and encoding of the texels in the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stream {
    /// Offset of the first byte.
    pub(super) start: usize,
    /// Bytes of a stored texel, 1 to 4.
    pub(super) texel_len: usize,
    /// Texels in the image.
    pub(super) texels: usize,
    /// True if the texels are in packets.
    pub(super) is_rle: bool,
}

impl Stream {
    /// Refuses a stream that is too short for the image at any compression, so that a few bytes
    /// cannot make the caller allocate a large image.
    ///
    /// # Errors
    /// `Malformed` at the end of the file.
    pub(super) fn check_length(&self, bytes: &[u8]) -> Result<(), AssetError> {
        let available = bytes.len().saturating_sub(self.start);
        let least = if self.is_rle {
            self.texels
                .div_ceil(MAX_PACKET)
                .saturating_mul(1 + self.texel_len)
        } else {
            self.texels.saturating_mul(self.texel_len)
        };
        if available < least {
            return Err(self.cut_short(bytes, available / self.texel_len.max(1)));
        }
        Ok(())
    }

    /// Calls `put` for every texel in file order, with (offset in the file, stored bytes,
    /// repetitions). The repetitions add up to the number of texels.
    ///
    /// # Errors
    /// `Malformed` if the file ends first, and the errors of `put`.
    pub(super) fn for_each<F>(&self, bytes: &[u8], mut put: F) -> Result<(), AssetError>
    where
        F: FnMut(usize, &[u8], usize) -> Result<(), AssetError>,
    {
        let (mut at, mut done) = (self.start, 0);
        while done < self.texels {
            let (stored, repeat) = if self.is_rle {
                let Some(&packet) = bytes.get(at) else {
                    return Err(self.cut_short(bytes, done));
                };
                at += 1;
                let count = (usize::from(packet & 0x7f) + 1).min(self.texels - done);
                if packet & 0x80 == 0 {
                    (count, 1)
                } else {
                    (1, count)
                }
            } else {
                (self.texels, 1)
            };
            let available = &bytes[at.min(bytes.len())..];
            for texel in available.chunks_exact(self.texel_len).take(stored) {
                put(at, texel, repeat)?;
                at += self.texel_len;
                done += repeat;
            }
            if available.len() / self.texel_len < stored {
                return Err(self.cut_short(bytes, done));
            }
        }
        Ok(())
    }

    /// The file ends after `done` texels.
    fn cut_short(&self, bytes: &[u8], done: usize) -> AssetError {
        malformed(
            bytes.len(),
            format!(
                "the file ends within the TGA texels, {done} of {} read",
                self.texels
            ),
        )
    }
}
