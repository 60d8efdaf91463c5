//! Where pixels live.
//!
//! *In* values of covered samples · *Out* images · *Space* window · *Precision* the format's.
//!
//! Attachments are stored tile-major: 64×64 pixel blocks in row order, inside a block Morton order
//! down to 4×4 packets, inside a packet the samples one after the other, and inside a sample the
//! sixteen lanes, again in Morton order:
//!
//! ```text
//!     block (64×64) ─▶ 256 packets ─▶ 1 or 4 samples ─▶ 16 lanes
//! ```
//!
//! So a packet of 16 RGBA8 or depth values is one aligned 64-byte line, any aligned power-of-two
//! tile is one contiguous slice, and safe `&mut` slices go to the workers. Row order was measured
//! three times slower for filling (every packet touches four lines); it is made once, on read-back.

mod depth_texture;
mod detile;
mod readback;
pub(crate) mod resolve;
mod target;

pub use readback::ReadbackError;
pub use resolve::ResolveError;
pub(crate) use target::format_names;
pub use target::{RenderTarget, RenderTargetDescriptor, TargetError};
