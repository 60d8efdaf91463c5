//! Pictures to and from bytes: PNG, JPEG and TGA.
//!
//! ```text
//!   bytes --format::decode--> Image            (by content: signature, or a plausible TGA header)
//!   Image --format::encode--> bytes            (by the output's ImageFormat)
//!   Image --transform-------> Image            (flips, nearest scaling)
//! ```
//!
//! PNG stands on the `png` crate and JPEG on the `image` crate; TGA is our own. Every reader checks a
//! picture's announced size against [`Limits`](crate::Limits) before it allocates. Every writer uses
//! fixed settings, so the same picture is always the same bytes.

mod fault;
mod format;
pub mod jpeg;
pub mod png;
pub mod tga;
mod transform;

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "samples cut random numbers to size"
)]
mod samples;

pub use format::{AlphaChannel, ImageFormat, decode, encode};
pub use jpeg::encode_jpeg;
pub use png::encode_png;
pub use transform::{flip_horizontal, flip_vertical, scale_nearest};
