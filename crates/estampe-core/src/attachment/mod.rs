//! Attachments: the storage of pixels.
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
//! A packet of 16 RGBA8 or depth values is therefore one aligned 64-byte line, any aligned
//! power-of-two tile is one contiguous slice, and workers get safe `&mut` slices. Filling was
//! measured three times slower with rows in memory, where every packet touches four lines; rows are
//! made once: on read-back, or tile by tile when an image that shaders sample is drawn.

mod bands;
mod depth_texture;
mod detile;
mod readback;
pub(crate) mod resolve;
pub(crate) mod resolve_depth;
mod retile;
pub(crate) mod row_order;
mod target;
mod texels;
mod tile_rows;

pub(crate) use depth_texture::StoredBounds;
pub use resolve_depth::ResolveMode;
pub use row_order::row_order_words;
pub use target::{ColorResolve, ColorRows, RenderTarget, TargetShape};
pub use texels::{ColorTexels, DepthStencilTexels, ImageSize};
pub(crate) use tile_rows::{RowsPlace, StoredRows, TileLines};
