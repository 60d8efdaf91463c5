//! WebP, read by `image-webp`: lossy and lossless, with alpha; the first frame of an animation
//! (Google, *WebP Container Specification*).

mod decode;

pub(super) use decode::{decode, is_webp, stated_size};

#[cfg(test)]
mod tests;
