//! Animations: pictures of one size that follow each other at a constant rate.
//!
//! ```text
//!   frames ── changed_area ──▶ APNG, WebP, GIF      what differs from the frame before is stored
//!   frames ──────────────────▶ Y4M                  every frame, for video encoders
//! ```
//!
//! All writers use fixed settings and integers, or floats without the system's functions, so that
//! the same frames always give the same bytes. APNG and Y4M are written frame by frame; WebP states
//! its size first, and GIF has one palette for all frames ([`super::gif`]).

mod apng;
mod area;
mod rate;
mod webp;
mod y4m;

pub use apng::ApngWriter;
pub(super) use area::{Area, area_of, changed_area, crop};
pub use rate::FrameRate;
pub use webp::WebpAnimation;
pub use y4m::{Chroma, LumaWeights, Y4mWriter};

use estampe_scene::Image;
use std::io;

/// Refuses a frame of another size than the animation's.
pub(super) fn check_frame(frame: &Image, (width, height): (u32, u32)) -> io::Result<()> {
    let bytes = u64::from(width) * u64::from(height) * 4;
    if (frame.width, frame.height) == (width, height) && frame.rgba.len() as u64 == bytes {
        return Ok(());
    }
    Err(invalid(format!(
        "a frame of {}x{} in an animation of {width}x{height}",
        frame.width, frame.height
    )))
}

/// The caller's mistake.
pub(super) fn invalid(what: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, what)
}
