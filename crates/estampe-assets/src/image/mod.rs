//! Reading images (PNG, JPEG, WebP, TGA, BMP, DDS, KTX2) and writing them (PNG, JPEG, TGA, WebP);
//! Radiance HDR and OpenEXR, whose numbers are floats; and writing animations ([`animation`]).
//!
//! ```text
//!   bytes --format::decode--> Image            (by content: signature, or a plausible TGA header)
//!   bytes --reduce----------> Image            (a mip level of a large image, row by row)
//!   Image --format::encode--> bytes            (by the output's ImageFormat)
//!   Image --transform-------> Image            (flips, nearest scaling)
//!   Images --animation, gif-> bytes            (GIF, APNG, WebP, Y4M)
//! ```
//!
//! PNG uses the `png` crate, JPEG `zune-jpeg` and `jpeg-encoder`, WebP `image-webp`, GIF `gif`,
//! OpenEXR `exr`, the blocks of DDS `bcdec_rs`, those of KTX2 estampe-texture; TGA, BMP and HDR are
//! implemented here. Every reader checks the size in an image's header against
//! [`Limits`](crate::Limits) before it allocates. Every writer uses fixed settings, so that the
//! same image always gives the same bytes.

pub mod animation;
mod bmp;
mod channel;
mod dds;
pub mod exr;
mod fault;
mod format;
pub mod gif;
pub mod hdr;
pub mod jpeg;
mod ktx2;
pub mod png;
mod reduce;
pub mod tga;
mod transform;
pub mod webp;

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "samples cut random numbers to size"
)]
mod samples;

pub use exr::{ExrChannel, ExrSamples, decode_exr, encode_exr};
pub use format::{AlphaChannel, ImageFormat, decode, decode_reduced, encode, stated_size};
pub(crate) use format::{decode_with_alpha, reduced, signed_size};
pub use hdr::{decode_hdr, encode_hdr};
pub use jpeg::encode_jpeg;
pub(crate) use ktx2::BasisUniversal;
pub use png::{encode_drawing_png, encode_png, encode_png_16};
pub(crate) use reduce::Reduced;
pub use reduce::{Reduction, TexelContent};
pub use transform::{flip_horizontal, flip_vertical, scale_nearest};
pub use webp::encode_webp;
