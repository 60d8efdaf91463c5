//! GIF: animations of at most 256 colours.
//!
//! ```text
//!   frames ─ palette ─▶ one palette: exact, or median cut and k-means in Oklab
//!          ─ dither ──▶ indices: error diffusion, where a frame has changed
//!          ─ write ───▶ LZW, by the `gif` crate, of the changed area
//! ```
//!
//! All frames share the palette, and a texel that has not changed keeps its index, so what stands
//! still does not flicker.

mod dither;
mod indexed;
mod oklab;
mod palette;
mod write;

pub use indexed::{Indexed, indexed};
pub use write::{MAX_GIF_RATE, write_gif};
