//! WebP through the `image-webp` crate: read (lossy and lossless, with alpha; the first frame of an
//! animation) and written lossless (Google, *WebP Container Specification*).

mod decode;
mod encode;

pub(super) use decode::{decode, is_webp, stated_size};
pub use encode::encode_webp;

#[cfg(test)]
mod tests;
