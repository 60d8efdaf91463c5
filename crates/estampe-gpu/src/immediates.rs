//! The immediates of a draw or dispatch: WebGPU's `setImmediates`, Vulkan's push constants.

use crate::Limits;

/// The rule that the immediates of a draw or dispatch break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImmediatesError {
    /// The shader reads bytes that are not given.
    #[error("{given} bytes of immediates are given, and the shader reads {needed}")]
    TooFew {
        /// The bytes that are given.
        given: usize,
        /// The bytes up to the last one that the shader reads.
        needed: u32,
    },
    /// More bytes than the limit are given.
    #[error("{given} bytes of immediates are given; the limit max_immediate_size is {limit}")]
    TooMany {
        /// The bytes that are given.
        given: usize,
        /// The limit.
        limit: u32,
    },
    /// The bytes are not whole words.
    #[error("{given} bytes of immediates are given, which is not a multiple of 4")]
    Words {
        /// The bytes that are given.
        given: usize,
    },
}

/// Checks the bytes that are given to a shader that reads `needed` of them. More than it reads are
/// no error, so that draws of several pipelines can give the same bytes.
pub(crate) fn check_immediates(
    bytes: &[u8],
    needed: u32,
    limits: &Limits,
) -> Result<(), ImmediatesError> {
    let (given, limit) = (bytes.len(), limits.max_immediate_size);
    if given > limit as usize {
        return Err(ImmediatesError::TooMany { given, limit });
    }
    if !given.is_multiple_of(4) {
        return Err(ImmediatesError::Words { given });
    }
    if given < needed as usize {
        return Err(ImmediatesError::TooFew { given, needed });
    }
    Ok(())
}

/// The words of bytes that were checked, little-endian as those of buffers.
pub(crate) fn immediate_words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    let (words, _) = bytes.as_chunks::<4>();
    words.iter().map(|word| u32::from_le_bytes(*word))
}
