//! OpenEXR through the `exr` crate: channels of floats and integers, written without loss; and
//! colours, read for light from all around (Academy Software Foundation, *OpenEXR File Layout*).

mod decode;
mod encode;

#[cfg(test)]
mod tests;

pub use decode::decode_exr;
pub use encode::{ExrChannel, ExrSamples, encode_exr};

/// True if the bytes begin as such a file.
#[must_use]
pub fn is_exr(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
}
